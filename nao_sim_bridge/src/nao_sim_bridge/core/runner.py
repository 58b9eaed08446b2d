"""The one thread that owns a simulation: it runs commands, ticks, and keeps pace with the wall clock.

Other threads never touch the simulation. They hand in commands with `execute` (run between two ticks, at once when
the thread is only waiting for the next tick to be due) and read `snapshot`.
"""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import deque
from dataclasses import dataclass
from typing import Any, Callable

from nao_sim_bridge.base.closing import CLOSE_LIMIT
from nao_sim_bridge.base.errors import BadValue, SimulationStopped, TaskKilled
from nao_sim_bridge.base.limits import kind
from nao_sim_bridge.base.tasks import Task, TaskIds, stopped_error
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation

log = logging.getLogger("nao_sim.runner")

# When the machine cannot keep the pace, this much lag (s of wall time) is made up for; the rest is given up.
MAX_LAG = 0.1
# What a tick that is late leaves to others, in parts of the time it took: the speed gives way before they starve.
YIELDED = 0.25
FASTEST = math.inf
# How soon to look again at what time waits for when nobody said that it is ready, s of wall time.
HOLD_LOOK = 0.005
# The longest wait for a tick before its time is worked out again, s of wall time: the system takes no wait of years.
LONGEST_WAIT = 60.0


class SimulationRunner:
    """Runs a simulation in its own thread; `take` gives it another one, as if the first had never been.

    Attributes:
        failed: Whether the thread has ended because the simulation failed.

    Args:
        simulation: What to run, with all robots of its world; from `start` on they belong to the thread.
        speed: Simulated seconds per wall second; `FASTEST` (infinity) for as fast as possible.
        paused: Start without time passing.
        on_end: Called in the thread when it has ended, by `stop` or because the simulation failed.
    """

    def __init__(
        self,
        simulation: Simulation,
        speed: float = 1.0,
        paused: bool = False,
        on_end: Callable[[], None] = lambda: None,
    ) -> None:
        self._simulation = simulation
        self._run_now = (simulation, 0)  # with the ticks of those before it, in one reference
        self._speed = _checked_speed(speed)
        self._paused = paused
        self._on_end = on_end
        self._ids = TaskIds()
        self._commands: deque[tuple[Task, Callable[[], Any]]] = deque()
        self._advances: deque[_Advance] = deque()  # changed under `_wake`
        self._wake = threading.Condition()
        self._ticked = threading.Condition()
        self._stopping = False
        self.failed = False
        self._pace_wall = 0.0
        self._pace_time = 0.0
        self._connect(simulation)
        self._thread = threading.Thread(target=self._run, name="simulation", daemon=True)

    # --- from any thread ------------------------------------------------------------------------------------------

    @property
    def snapshot(self) -> Snapshot:
        """What the robot sensed at the last tick."""
        return self._simulation.snapshot

    @property
    def ticks(self) -> int:
        """Ticks since the start of the thread, of all simulations that it has run; it never goes back."""
        simulation, before = self._run_now
        return before + simulation.snapshot.tick

    @property
    def speed(self) -> float:
        """Simulated seconds per wall second that are asked for."""
        return self._speed

    @property
    def paused(self) -> bool:
        """True while time stands still but for `advance`."""
        return self._paused

    @property
    def running(self) -> bool:
        """True from `start` until the thread has ended."""
        return self._thread.is_alive()

    def start(self) -> None:
        self._thread.start()

    def stop(self, timeout: float = CLOSE_LIMIT) -> None:
        """End the thread, wait for it (wall time, s) and free the simulation; everybody who waits gets an error."""
        with self._wake:
            self._stopping = True
            self._wake.notify()
        if self._thread.is_alive() and threading.current_thread() is not self._thread:
            self._thread.join(timeout)

    def execute(self, command: Callable[[], Any], name: str = "command") -> Task:
        """Run `command()` in the simulation thread; the task ends with what it returns or raises."""
        task = self._ids.make(name)
        with self._wake:
            if self._stopping:
                raise stopped_error()
            self._commands.append((task, command))
            self._wake.notify()
        return task

    def call(self, command: Callable[[], Any], timeout: float = 5.0) -> Any:
        """Run `command()` in the simulation thread and wait for its result (wall time, s)."""
        return self.execute(command).result(timeout)

    def set_speed(self, speed: float) -> None:
        """Change the pace; see `speed` of the constructor."""
        speed = _checked_speed(speed)
        with self._wake:
            self._speed = speed
            self._restart_pace()
            self._wake.notify()

    def pause(self) -> None:
        """Let time stand still; commands are still taken. What `advance` has begun before ends."""
        with self._wake:
            self._paused = True
            self.end_advances("a pause")

    def resume(self) -> None:
        """Let time pass again."""
        with self._wake:
            self._paused = False
            self._restart_pace()
            self._wake.notify()

    def advance(self, seconds: float) -> Task:
        """Let `seconds` of simulated time pass as fast as possible; the task ends with the snapshot after it.

        It fails when a pause or a reset comes before that time is over.
        """
        if not (seconds >= 0.0 and kind("time").fits(seconds)):
            raise BadValue("seconds", seconds, f"0 or more, finite, {kind('time').highest:g} s at most")
        ticks = round(seconds / self._simulation.settings.tick_s)
        with self._wake:
            if self._stopping:
                raise stopped_error()
            named = self._ids.make("advance")
            task = Task(named.name, named.task_id, self._drop_advance, self._kill_later, self._simulation.shared.guard)
            self._advances.append(_Advance(task, seconds, ticks, ticks))
            self._wake.notify()
        return task

    def end_advances(self, by: str) -> None:
        """Let what `advance` has begun fail, with the words for what has ended it."""
        with self._wake:
            ended, self._advances = self._advances, deque()
            if not ended or self._stopping:
                return
            self._restart_pace()
            tick_s = self._simulation.settings.tick_s

            def fail() -> None:
                for one in ended:
                    passed = (one.ticks - one.left) * tick_s
                    one.task.finish(
                        error=TaskKilled(f"was ended by {by} after {passed:g} of {one.seconds:g} s of simulated time")
                    )

            self._commands.append((self._ids.make("end of advances"), fail))
            self._wake.notify()

    def wait_for_tick(self, after: int, timeout: float) -> Snapshot | None:
        """The first snapshot at which `ticks` is above `after`, None when none came within `timeout` (wall time, s)."""
        with self._ticked:
            if not self._ticked.wait_for(lambda: self.ticks > after or self._stopping, timeout):
                return None
        return self.snapshot if self.ticks > after else None

    def _notify(self) -> None:
        with self._wake:
            self._wake.notify()

    def _drop_advance(self, task: Task) -> None:
        with self._wake:
            self._advances = deque(one for one in self._advances if one.task is not task)
            self._restart_pace()

    def _kill_later(self, task: Task) -> None:
        with self._wake:
            if not self._stopping:  # else the end of the simulation ends the task
                self._commands.append((self._ids.make("kill"), task.kill))
                self._wake.notify()

    def _connect(self, simulation: Simulation) -> None:
        simulation.task_ids.ask = self._kill_later
        simulation.shared.wake = self._notify

    # --- in the simulation thread ---------------------------------------------------------------------------------

    def take(self, simulation: Simulation) -> float:
        """Run another simulation from now on; pace and pause stay, what `advance` has begun ends.

        Returns:
            How much time the ones before have had in all, s.
        """
        before = self.ticks
        self.end_advances("a reset")
        self._connect(simulation)
        self._simulation = simulation
        self._run_now = (simulation, before)
        self._ids = TaskIds()
        with self._wake:
            self._restart_pace()
        return before * simulation.settings.tick_s

    def _run(self) -> None:
        error: Exception = SimulationStopped("the simulation has stopped")
        try:
            with self._wake:
                self._restart_pace()
            while self._next_work():
                pass
        except Exception as failure:
            self.failed = True
            log.exception("the simulation failed at tick %d", self._simulation.ticks)
            error = SimulationStopped(f"the simulation failed: {failure}")
        with self._wake:
            self._stopping = True
            waiting = [task for task, _ in self._commands] + [one.task for one in self._advances]
        for task in waiting:
            task.finish(error=error)
        self._simulation.shared.guard.call(self._simulation.close)
        with self._ticked:
            self._ticked.notify_all()
        self._on_end()

    def _next_work(self) -> bool:
        """Wait for a command or a tick that is due and do it. Returns False when it is time to stop."""
        with self._wake:
            delay = self._delay()
            late = self._simulation.shared.late = delay <= 0.0
            while not (self._stopping or self._commands or delay <= 0.0):
                self._wake.wait(None if delay == math.inf else min(delay, LONGEST_WAIT))
                delay = self._delay()
            if self._stopping:
                return False
        while self._commands:
            task, command = self._commands.popleft()
            task.finish_with(command)
        with self._wake:
            due = self._delay() <= 0.0
        began = time.monotonic()
        if due:
            self._tick()
        if late:
            self._yield(time.monotonic() - began)
        return True

    def _yield(self, spent: float) -> None:
        """Let others have the interpreter after a tick that was late and took `spent` s, and at a speed the processor.

        As fast as possible means with all there is; only the interpreter is left to threads that wait for it.
        """
        if self._advances or self._speed == FASTEST:
            time.sleep(0.0)
            return
        with self._wake:
            if not (self._stopping or self._commands):
                self._wake.wait(YIELDED * spent)

    def _tick(self) -> None:
        snapshot = self._simulation.tick()
        with self._ticked:
            self._ticked.notify_all()
        if self._advances:
            self._count_down(snapshot)

    def _count_down(self, snapshot: Snapshot) -> None:
        """One tick less to go for the first of what `advance` has begun, if any; it is over when none is left."""
        with self._wake:
            if not self._advances:
                return
            first = self._advances[0]
            first.left -= 1
            if first.left > 0:
                return
            self._advances.popleft()
            if not self._advances:
                self._restart_pace()
        first.task.finish(snapshot)

    def _delay(self) -> float:
        """Wall time in s until the next tick is due; infinite while time stands still."""
        if self._advances:
            if self._advances[0].left == 0:
                self._count_down(self.snapshot)
                return self._delay()
            return self._hold()
        if self._paused:
            return math.inf
        if self._speed == FASTEST:
            return self._hold()
        ahead = self._simulation.time + self._simulation.settings.tick_s - self._pace_time
        delay = self._pace_wall + ahead / self._speed - time.monotonic()
        if delay < -MAX_LAG:
            self._restart_pace()
        if self._speed > 1.0 and delay <= 0.0:
            return self._hold()
        return delay

    def _hold(self) -> float:
        """As `_delay` for time that runs faster than the wall clock and is due: it waits for slower work."""
        return HOLD_LOOK if self._simulation.shared.holds() else 0.0

    def _restart_pace(self) -> None:
        self._pace_wall = time.monotonic()
        self._pace_time = self._simulation.time


@dataclass
class _Advance:
    """Time that somebody has asked for.

    Attributes:
        task: Ends when it has passed.
        seconds: How much it was.
        ticks: The same in ticks.
        left: How many of them are to come.
    """

    task: Task
    seconds: float
    ticks: int
    left: int


def _checked_speed(speed: float) -> float:
    pace = kind("pace")
    if not (speed > 0.0 and pace.fits(speed)):
        allowed = f"{pace.smallest:g} to {pace.highest:g}, above 0; infinity for as fast as possible"
        raise BadValue("speed", speed, allowed)
    return float(speed)
