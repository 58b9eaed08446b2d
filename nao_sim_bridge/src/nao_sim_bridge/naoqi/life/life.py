"""The states of autonomous life, and the activity that has its focus. Simulation thread only, but for what it shows.

disabled     nothing by itself; where the simulator begins
solitary     the abilities work, activities of the nature "solitary" may have the focus
interactive  the same with an activity of the nature "interactive"
safeguard    something is wrong: no activities, no abilities until it is over
"""

from __future__ import annotations

import logging
from typing import Any, Callable

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.steps import Behavior
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.binding.arguments import one_of
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.life.abilities import Abilities
from nao_sim_bridge.naoqi.life.history import LifeRecord
from nao_sim_bridge.naoqi.memory.store import MemoryStore

log = logging.getLogger("nao_sim.life")

DISABLED, SOLITARY, INTERACTIVE, SAFEGUARD = STATES = ("disabled", "solitary", "interactive", "safeguard")
ALIVE = (SOLITARY, INTERACTIVE)
STATE, FOCUSED, COMPLETED, NEXT = (
    f"AutonomousLife/{event}" for event in ("State", "FocusedActivity", "CompletedActivity", "NextActivity")
)
# A torso that leans less than this, rad, is that of a robot that stands, crouches or sits.
UPRIGHT = 0.8
# What may happen to the activity that has had the focus when another one gets it.
STOP, STACK = 0, 1


class Life:
    """The life of one robot.

    Attributes:
        focused: Name of the activity that has the focus, empty when none has.
        stand_up: Has the robot stand up from wherever it is; its task ends with whether it stands.
        entered: Called with the state before, when there is a new one.
    """

    def __init__(
        self,
        simulation: Simulation,
        running: RunningBehaviors,
        memory: MemoryStore,
        abilities: Abilities,
        wake: Callable[[], Task],
        stand: Callable[[], Task],
    ) -> None:
        self.abilities = abilities
        self.record = LifeRecord(lambda: simulation.time)
        self.state = DISABLED
        self.focused = ""
        self.entered: list[Callable[[str], None]] = []
        self._simulation = simulation
        self._running = running
        self._memory = memory
        self._wake = wake
        self.stand_up = stand
        self._stacked: list[str] = []
        self._wanted: object | None = None
        for event in (STATE, FOCUSED, COMPLETED, NEXT):
            memory.declare_event(event, "ALAutonomousLife")
        memory.insert(STATE, DISABLED)
        running.ended.append(self._over)
        simulation.after_reset.append(self._after_reset)

    @property
    def upright(self) -> bool:
        """Whether the robot stands, crouches or sits."""
        roll, pitch, _ = self._simulation.snapshot.imu.angles
        return max(abs(roll), abs(pitch)) < UPRIGHT

    # --- states ---------------------------------------------------------------------------------------------------

    def set_state(self, state: str) -> Task:
        """Go to a state; the task ends when the robot is in it: it wakes up before it lives.

        A BadValue when there is no such state.
        """
        one_of(state, "state", STATES)
        done = self._simulation.task_ids.make("setState")
        wanted = self._wanted = object()
        if state not in ALIVE or self.state in ALIVE:
            self._enter(state)
            done.finish()
            return done

        def woken(_: Any) -> None:
            if self._wanted is wanted:
                self._enter(state)
            done.finish()

        # Who lies on the floor gets up first, who sits or stands stays where it is.
        begin = self._wake if self.upright else self.stand_up
        follow(begin(), woken, lambda error: done.finish(error=error))
        return done

    def alarm(self, reason: str, recover: Callable[[], Task] | None = None) -> None:
        """Something is wrong: go to safeguard and, when there is a way to recover, back after it."""
        if self.state == DISABLED:
            return
        log.warning("autonomous life goes to safeguard: %s", reason)
        self.set_state(SAFEGUARD)
        wanted = self._wanted
        if recover is None:
            return

        def recovered(answer: Any) -> None:
            if self._wanted is wanted and answer is not False:
                self._enter(SOLITARY)

        follow(recover(), recovered, lambda error: log.warning("autonomous life stays in safeguard: %s", error))

    def all_clear(self) -> None:
        if self.state == SAFEGUARD:
            self.set_state(SOLITARY)

    # --- activities -----------------------------------------------------------------------------------------------

    def switch_focus(self, behavior: Behavior, flag: int = STOP) -> None:
        """Give the focus to an activity.

        A NaoqiError when the robot does not live, or the behaviour is no activity; a BehaviorFailed when it cannot
        begin.
        """
        if self.state not in ALIVE:
            raise NaoqiError(f"the state is {self.state}: activities get the focus in {' and '.join(ALIVE)}")
        if behavior.nature not in ALIVE:
            raise NaoqiError(f"{behavior.name} has {behavior.nature!r}: activities are solitary or interactive")
        most = load_sizes().clients.stacked_activities
        if flag == STACK and len(self._stacked) >= most:
            raise NaoqiError(f"{most} activities wait for the focus, which is the most allowed: stopAll ends them")
        self._memory.raise_event(NEXT, behavior.name)
        before = self.focused
        self._leave_focus()
        if before and flag == STACK:
            self._stacked.append(before)
        elif flag == STOP:
            self._stacked.clear()
        self._focus(behavior)

    def stop_focus(self) -> None:
        """Stop the activity that has the focus; one that it had been stacked for goes on."""
        self._leave_focus()
        self._go_on()

    def stop_all(self) -> None:
        """Stop all activities, stacked ones too."""
        self._stacked.clear()
        self.stop_focus()

    def _enter(self, state: str) -> None:
        before, self.state = self.state, state
        if state not in ALIVE:
            self._stacked.clear()
            self._leave_focus()
        self.abilities.live(state in ALIVE)
        if state != before:
            self.record.entered(state, state in ALIVE)
            self._memory.raise_event(STATE, state)
            for call in self.entered:
                call(before)

    def _focus(self, behavior: Behavior) -> None:
        self.focused = behavior.name
        self.record.focused(behavior.name)
        self._enter(behavior.nature)
        self._memory.raise_event(FOCUSED, behavior.name)
        try:
            self._running.start(behavior)
        except Exception:
            self._leave_focus()
            self._go_on()
            raise

    def _leave_focus(self) -> None:
        name, self.focused = self.focused, ""
        if not name:
            return
        self.record.left(name, completed=False)
        if name in self._running.names:
            self._running.stop(name)
        self._memory.raise_event(FOCUSED, "")

    def _over(self, name: str, completed: bool) -> None:
        """A behaviour has ended by itself, or somebody has stopped it."""
        if name != self.focused:
            return
        self.focused = ""
        self.record.left(name, completed)
        if completed:
            self._memory.raise_event(COMPLETED, name)
        self._memory.raise_event(FOCUSED, "")
        self._go_on()

    def _go_on(self) -> None:
        """The focus is free: an activity that was stacked gets it, or the robot is alone again."""
        if self.state not in ALIVE:
            return
        while self._stacked:
            name = self._stacked.pop()
            if self._running.installed.knows(name):
                self._focus(self._running.installed.resolve(name))
                return
        self._enter(SOLITARY)

    def _after_reset(self) -> None:
        self._wanted = None
        self._stacked.clear()
        if self.state != DISABLED:
            self._enter(DISABLED)
        self.abilities.decide()


def follow(task: Task, then: Callable[[Any], None], failed: Callable[[Exception], None]) -> None:
    """Call `then(result)` at the end of a task, or of the one that it ends with, or `failed(error)`."""

    def settle(done: Task) -> None:
        if done.error is not None:
            failed(done.error)
        elif isinstance(done.value, Task):
            done.value.add_done_callback(settle)
        else:
            then(done.value)

    task.add_done_callback(settle)
