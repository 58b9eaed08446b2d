"""ALSonar of the simulated robot: sonars that fire while somebody is subscribed, and their events."""

from __future__ import annotations

import re
import statistics
from collections import deque
from contextlib import suppress
from typing import Any, Callable, Deque, Dict, Mapping, Tuple

from nao_sim_bridge.base.errors import ConfigError, SimulationStopped
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.sensors.sonar import NO_ECHO
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.memory.extractor import Extractor, Subscription
from nao_sim_bridge.naoqi.memory.live_keys import FILE, key_prefix, key_tables
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALSonar"
SIDES = ("Left", "Right")
DETECTED = tuple(f"Sonar{side}Detected" for side in SIDES)
NOTHING = tuple(f"Sonar{side}NothingDetected" for side in SIDES)
THRESHOLD = 0.5
"""What is nearer is detected, m."""
NOT_MEASURED = 0.0
"""What ALMemory has before the first shot, m; NAOqi calls it an error of the sensor."""
PRESENT = 0.2
"""A real NAO knows of what is nearer only that it is there, m."""
RESOLUTION = 100
"""Steps in a metre."""
ACTUATOR_IDLE, ACTUATOR_PERIODIC = 0.0, 68.0
"""Commands of the device: one shot; two captures, all the time."""
DEFAULT = Subscription(period=100)
FILTERED = 5
"""Readings of which the median is taken."""
MOST_ECHOES = 10

Echoes = Tuple[float, ...]


class ALSonar:
    """ALSonar as the simulated robot offers it, beside an extractor; called after every tick, in the simulation thread.

    They fire for subscribers of ALSonar or of its events, and for ALMotion while the robot walks. Else the keys of
    ALMemory keep what was measured last.
    """

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._simulation = runner.simulation
        self._runner = runner
        self._memory = memory
        self._subscribed = False
        self._period = DEFAULT.period / 1000.0
        self._due = 0.0
        self._measured: Any = None
        self._fresh = False
        self._echoes: Tuple[Echoes, Echoes] = ((), ())
        self._history: Tuple[Deque[float], Deque[float]] = (deque(maxlen=FILTERED), deque(maxlen=FILTERED))
        self._filtered = [NOT_MEASURED, NOT_MEASURED]
        self.firing = False

    def getFilteredValues(self) -> list[float]:
        """[right, left], m: medians of the last readings."""
        return list(self._filtered)

    def parts(self) -> list[Any]:
        keys, events = [f"Device/SubDeviceList/US/{side}/Sensor/Value" for side in SIDES], [*DETECTED, *NOTHING]
        work = (self._start, self._stop)
        return [self, Extractor(NAME, self._memory, *work, events, keys, DEFAULT, self._changed, by_events=True)]

    def _start(self) -> Task:
        """Somebody is subscribed; ends with the first shot, so that who looks next sees no old values."""
        return self._runner.execute(self._subscribe, "subscribe")

    def _stop(self) -> None:
        """Nobody is subscribed any more."""
        with suppress(SimulationStopped):  # then nothing fires, either
            self._runner.execute(self._unsubscribe, "unsubscribe")

    def _changed(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Somebody wants events at another pace."""
        period = min((subscription.period for subscription in subscriptions.values()), default=DEFAULT.period)
        self._period = period / 1000.0

    def echoes(self, side: int) -> Echoes:
        """Distances that a side has measured last, m, nearest first; empty before the first shot."""
        return self._echoes[side]

    def __call__(self, snapshot: Snapshot) -> None:
        if not (self._subscribed or self._simulation.robot.walking):
            self.firing = False
            return
        if not self.firing:
            self._shoot()
        elif snapshot.echoes is not self._measured:
            self._take(snapshot)
        if self._subscribed and self._fresh and snapshot.time >= self._due - 1e-9:
            self._due = snapshot.time + self._period
            for side, echoes in enumerate(self._echoes):
                event = DETECTED[side] if echoes[0] < THRESHOLD else NOTHING[side]
                self._memory.raise_event(event, echoes[0])

    # Who is subscribed is decided between ticks: no tick sees a subscriber who has not got a shot.

    def _subscribe(self) -> None:
        self._subscribed = True
        self._shoot()  # also while they fire: what they told last may be older than the subscription

    def _unsubscribe(self) -> None:
        self._subscribed = False
        self.firing = self.firing and self._simulation.robot.walking

    def _shoot(self) -> None:
        """Do not wait for the next shot but fire."""
        now = self._simulation.robot.shoot_sonars()
        if now is None:
            return
        if not self.firing:
            for history in self._history:
                history.clear()
        self.firing = True
        self._take(now)
        self._fresh = False  # events begin with the next shot, at their pace

    def _take(self, snapshot: Snapshot) -> None:
        self._measured, self._fresh = snapshot.echoes, True  # not `sonars`: broken ones have new values at each tick
        self._echoes = (_told(snapshot, 0), _told(snapshot, 1))
        for history, echoes in zip(self._history, self._echoes):
            history.append(echoes[0])
        self._filtered = [statistics.median(history) for history in reversed(self._history)]


def _told(snapshot: Snapshot, side: int) -> Echoes:
    """What a side reports: steps of a centimetre, and nothing below what it can tell apart."""
    echoes = snapshot.echoes[side] or (snapshot.sonars[side],)
    return tuple(round(max(echo, PRESENT) * RESOLUTION) / RESOLUTION for echo in echoes[:MOST_ECHOES])


def sonar_keys(sonar: ALSonar) -> Dict[str, Callable[[], float]]:
    """ALMemory's keys of the sonars: key -> function without arguments that reads its present value.

    A ConfigError when the file names a key that nothing can read.
    """
    return {key_prefix() + key: _reader(key, sonar) for key in key_tables()["devices"]["sonar"]["keys"]}


def _reader(key: str, sonar: ALSonar) -> Callable[[], float]:
    if key == "US/Actuator/Value":
        return lambda: ACTUATOR_PERIODIC if sonar.firing else ACTUATOR_IDLE
    if key == "US/Sensor/Value":
        return lambda: min(_echo(sonar, side, 0) for side in range(len(SIDES)))
    match = re.fullmatch(r"US/(Left|Right)/Sensor/Value(\d?)", key)
    if match is None:
        raise ConfigError(FILE, f"nothing in the simulation can read {key!r}")
    side, number = SIDES.index(match[1]), int(match[2] or 0)
    return lambda: _echo(sonar, side, number)


def _echo(sonar: ALSonar, side: int, number: int) -> float:
    echoes = sonar.echoes(side)
    if not echoes:
        return NOT_MEASURED
    return echoes[number] if number < len(echoes) else NO_ECHO
