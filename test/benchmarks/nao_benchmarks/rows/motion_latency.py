"""How soon a joint moves when it is told to, and how soon it stops when the goal is cancelled."""

from __future__ import annotations

import time
from typing import Any, Callable

from ..errors import BenchmarkError
from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample

ROUNDS = 40
JOINT = "HeadYaw"
COMMAND = f"Device/SubDeviceList/{JOINT}/Position/Actuator/Value"
# Fraction of the top speed: some 0.7 rad/s, so that every tick shows, and no swing ends before it is looked at.
SPEED = 0.08
SWING, SWING_TIME = 1.0, 3.0
# A command that has not changed for this time, s, stands still: several ticks.
STILL = 0.06
LIMIT = 10.0
# Of the simulated robot, s.
TICK = 1.0 / 120.0


class Watch:
    """Watches the command of one joint over a connection of its own, as fast as the robot answers."""

    def __init__(self, stack: Stack) -> None:
        self._memory = stack.simulator.session.service("ALMemory")

    def command(self) -> float:
        """What the joint is told, rad."""
        return float(self._memory.getData(COMMAND))

    def first_change(self, since: float) -> float:
        """Time from `since` (perf_counter) until the command changes, s.

        Raises:
            BenchmarkError: If it does not.
        """
        before = self.command()
        while time.perf_counter() - since < LIMIT:
            if self.command() != before:
                return time.perf_counter() - since
        raise BenchmarkError(f"{JOINT} did not begin to move within {LIMIT:g} s")

    def last_change(self, since: float) -> float:
        """Time from `since` until the command changed for the last time, s.

        Raises:
            BenchmarkError: If it does not stop.
        """
        before, changed = self.command(), since
        while time.perf_counter() - since < LIMIT:
            now = self.command()
            if now != before:
                before, changed = now, time.perf_counter()
            elif time.perf_counter() - max(changed, since) > STILL:
                return changed - since
        raise BenchmarkError(f"{JOINT} did not stop within {LIMIT:g} s")


def in_turns(ours: Callable[[float], float], bare: Callable[[float], float]) -> Figures:
    """Compare two ways to do something with a swing of the head; each is given the end of the swing, rad."""
    samples: tuple[list[float], list[float]] = ([], [])
    for turn in range(2 * ROUNDS):
        which = turn % 2
        target = SWING if (turn // 2) % 2 == 0 else -SWING
        samples[which].append((ours, bare)[which](target if which == 0 else -target))
    return Figures.compared(Sample(tuple(samples[0])), Sample(tuple(samples[1])), scale=1e3)


class MotionStart(Row):
    """From sending a goal for NaoMotion to the first tick in which the joint is told to move."""

    name = "motion_start"
    subject = "goal setAngles of NaoMotion, to the first motion"
    against = "bare qi call, to the first motion"
    unit = "ms"
    bound = at_most(3.0)

    def measure(self, stack: Stack) -> Figures:
        """Start swings in turns through our server and over bare libqi; each is stopped at once."""
        client = stack.motion_client
        watch, motion = Watch(stack), stack.simulator.session.service("ALMotion")

        def begin(start: Callable[[], Any]) -> float:
            motion.setAngles(JOINT, watch.command(), 1.0)
            watch.last_change(time.perf_counter())
            began = time.perf_counter()
            start()
            return watch.first_change(began)

        def ours(target: float) -> float:
            fields = {"names": [JOINT], "angles": [target], "speed": SPEED}
            return begin(lambda: client.send(client.goal("setAngles", fields)))

        def bare(target: float) -> float:
            return begin(lambda: motion.setAngles(JOINT, target, SPEED, _async=True))

        return in_turns(ours, bare)


class MotionStop(Row):
    """From cancelling a goal for NaoMotion to the last tick in which the joint moves."""

    name = "motion_stop"
    subject = "cancelled goal of NaoMotion, to standstill"
    against = "a tick of the robot"
    unit = "ms"
    bound = at_most(2.0)

    def measure(self, stack: Stack) -> Figures:
        """Stop swings through our server; a stop over bare libqi is within the tick, nothing to compare with."""
        client = stack.motion_client
        watch = Watch(stack)
        times = []
        for turn in range(ROUNDS):
            fields = {"names": [JOINT], "angles": [SWING if turn % 2 == 0 else -SWING], "times": [SWING_TIME]}
            handle = client.send(client.goal("angleInterpolation", fields))
            watch.first_change(time.perf_counter())
            began = time.perf_counter()
            handle.cancel()
            times.append(watch.last_change(began))
        return Figures.compared(Sample(tuple(times)), Sample((TICK,)), scale=1e3)
