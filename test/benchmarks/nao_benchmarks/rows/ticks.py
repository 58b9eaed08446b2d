"""What a part of the simulation costs: ticks with it beside ticks without it."""

from __future__ import annotations

from nao_sim_bridge.base.settings import load_settings

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..timings import run_timings

ROUNDS = 3000


class Tick(Row):
    """A tick of the simulation, timed in a process of its own by a program that alternates both kinds.

    Args:
        name: See `Row`.
        subject: See `Row`.
        against: See `Row`.
        most: Bound of the ratio.
        program: Of programs/.
        options: Of the program.
        rounds: How many times it measures each kind.
    """

    unit = "us"

    def __init__(
        self, name: str, subject: str, against: str, most: float, program: str, *options: str, rounds: int = ROUNDS
    ) -> None:
        self.name, self.subject, self.against, self.bound = name, subject, against, at_most(most)
        self._program, self._options, self._rounds = program, options, rounds

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        ours, reference = run_timings(self._program, self._rounds, *self._options)
        note = f"{ours.median / load_settings().tick_s:.1%} of real time"
        return Figures.compared(ours, reference, scale=1e6, note=note)


STILL, ALONE = "the same, standing still", "the same, one robot alone"
TICKS = (
    # Services are registered and idle.
    Tick("physics_tick", "tick with services and sensors", "bare stepSimulation, same robot and state", 1.25,
         "standing_ticks"),
    # The motors are told anew at every tick, and while legs move the body is watched for falls.
    Tick("moving_tick", "tick with 26 joints interpolated", STILL, 1.35, "moving_ticks"),
    Tick("walking_tick", "tick while walking", STILL, 1.4, "walking_ticks"),
    Tick("walk_controller", "the walk's part of a tick", "physics steps of the same tick", 0.2,
         "walking_ticks", "--controller"),
    # What the microphones hear is worked out beside the ticks; on two cores that costs them little.
    Tick("hearing_tick", "tick while speaking with open ears", "the same in silence", 1.2, "hearing_ticks", rounds=60),
    Tick("three_robots_tick", "tick of three robots in one world", ALONE, 3.6, "robots_ticks", rounds=800),
    Tick("three_robots_walking", "tick of three robots that walk", ALONE, 3.6, "robots_ticks", "--walking", rounds=800),
)  # fmt: skip
