"""What a step of a trial waits for: the end of a goal, a touch, a word, a choice, a time, conditions.

The robot listens ahead: a word that is said before a trial waits for it is heard, unless the robot speaks meanwhile.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Callable

from naoqi.errors import NaoError

from ..core.nao_facts import names_of, sensors_of
from . import trial_log as told
from .commands import BEHAVIORS, SPEECH, RobotCommand, Stopped, call
from .protocol import (
    COUNTED,
    NOTHING,
    NOW,
    TIME_UP,
    ChoiceStep,
    CommandStep,
    PauseStep,
    ProtocolStep,
    SenseStep,
    UntilStep,
    WhileStep,
)
from .robot_events import TOUCHED, ConsoleEvent
from .schedule import is_inside, step_at, steps_in

CHOICE, RUN_ENDED, TIMER, HAPPENED = "choice", "run ended", "timer", "happened"
"""Messages to a trial: a choice of the wizard, the end of a goal, a time that is over, an event of the robot."""
EVENT_OF = {"touch": TOUCHED, "word": "heard", "face": "seen"}
"""Sense -> kind of the events that tell of it."""
STOP_LAG = 5.0
"""s of ROS time by which a stop of another program may be heard later than the end of the goal that it cancelled: who
stops is connected with one node after the other, which took more than 1 s on a busy computer."""
GOAL_LAG = 0.5
"""s of ROS time by which a goal may tell of a touch later than the topics: its onset is the better one."""
CANCELLED = ("preempted", "recalled")
"""States of a goal that somebody has cancelled."""
_TRUTHS = {"True": "true", "False": "false", "None": NOTHING}


@dataclass(frozen=True)
class StepEnd:
    """How a step ended."""

    outcome: str  # one of those of `trial_log`
    answer: str = ""
    stamp: float | None = None  # of the answer, ROS time, s
    error: str = ""
    on_error: str = ""  # what the failure of a step of the robot does
    touched: tuple[str, ...] = ()  # sensors of the touch that has answered
    finished: float | None = None  # when what the robot did was over, as its result tells: of speech the last sound


class Wait:
    """One thing that is waited for.

    Attributes:
        over: How it ended; None: it has not.

    Args:
        trial: The `TrialRunner`: sends goals, counts time, and knows what has happened.
        step: What is waited for.
        values: For texts and conditions.
        began: ROS time when the step began, s.
    """

    polls = False
    """Whether it is to be looked at again without any message."""

    def __init__(self, trial: Any, step: ProtocolStep, values: Mapping[str, Any], began: float) -> None:
        self.trial, self.step, self.values, self.began = trial, step, values, began
        self.over: StepEnd | None = None
        self._failed: tuple[StepEnd, object] | None = None  # its goal was cancelled; with the time to hear of a stop
        self._timers: list[Any] = []

    def begin(self) -> None:
        """Begin to wait. May raise what `RobotClient.send` does."""

    def take(self, what: str, about: Any) -> None:
        """A message has come."""
        if what == TIMER and self._failed is not None and about is self._failed[1]:
            self.over = self._failed[0]

    def look(self) -> None:
        """See whether it is over, without a message."""
        if self._failed is not None and self.over is None and self.trial.pausing:
            self.over = StepEnd(told.STOPPED, error=self._failed[0].error)

    def close(self) -> None:
        """Wait no longer."""
        for _, prevent in self._timers:
            prevent()

    def _fail(self, end: StepEnd, state: str) -> None:
        """The goal has failed, with a state of its own. One that somebody has cancelled may have been by a stop."""
        if state in CANCELLED:
            self._failed = (end, self._set_timer(STOP_LAG))
        else:
            self.over = end

    def _set_timer(self, seconds: float) -> object:
        token = object()
        self._timers.append((token, self.trial.after(seconds, token)))
        return token


class TimeWait(Wait):
    """A time. `outcome`, `answer`: when it is over."""

    def __init__(
        self, trial: Any, step: Any, values: Any, began: float, seconds: float, outcome: str, answer: str = ""
    ) -> None:
        super().__init__(trial, step, values, began)
        self._seconds, self._end = seconds, StepEnd(outcome, answer)

    def begin(self) -> None:
        self._token = self._set_timer(self._seconds)

    def take(self, what: str, about: Any) -> None:
        if what == TIMER and about is self._token:
            self.over = self._end


class CommandWait(Wait):
    """The robot does something."""

    step: CommandStep
    run: Any = None

    def begin(self) -> None:
        texts = {name: str(value) for name, value in self.values.items()}
        self.run = self.trial.send(self.step.command.filled(texts))
        if self.run is None:  # of a stop, which nothing is waited for
            self.over = StepEnd(told.DONE)

    def take(self, what: str, about: Any) -> None:
        super().take(what, about)
        if what == RUN_ENDED and about is self.run:
            if about.state != "succeeded":
                end = StepEnd(told.FAILED, error=about.text or about.state, on_error=self.step.on_error)
                self._fail(end, about.state)
            else:
                answer = _values_of(about.result) if self.step.asks else ""
                last = (about.result.get("results") or [{}])[-1]
                finished = _seconds(last.get("offset")) or _seconds(last.get("end"))
                self.over = StepEnd(told.DONE, answer, finished=finished, error=about.text)

    def close(self) -> None:
        super().close()
        _cancel(self.run)


class ChoiceWait(Wait):
    """The wizard chooses. `place`: path and attempt of the step."""

    place: tuple[str, int] = ("", 0)

    def take(self, what: str, about: Any) -> None:
        if what == CHOICE and about[0] == self.place:
            self.over = StepEnd(told.DONE, about[1], about[2])


class UntilWait(Wait):
    """Conditions, of counts that begin with the window."""

    step: UntilStep
    polls = True

    def begin(self) -> None:
        self._since = self.trial.since(self.step, self.began)

    def look(self) -> None:
        happened = self.trial.happenings.since
        now = self.trial.robot.now()
        live = {name: len(happened(kind, self._since)) for kind, name in COUNTED.items()}
        live["seconds"] = now - self.began
        if all(condition.holds({**self.values, **live}) for condition in self.step.conditions):
            self.over = StepEnd(told.DONE, "", now)


class SenseWait(Wait):
    """A touch, a word, a sound or a face. `path`: of the step."""

    step: SenseStep
    path = ""
    run: Any = None
    _felt: StepEnd | None = None  # a touch that the goal has not told of: it may have come before the server waited
    _token: object = None

    def begin(self) -> None:
        if self.step.sense == "touch":
            for event in self.trial.happenings.since(TOUCHED, self.trial.since(self.step, self.began)):
                if self._is_touch(event):
                    self.over = _felt(event)
                    return
        self.run = self.trial.ahead.take(self.path) if self.step.sense == "word" else None
        if self.run is None:
            self._send(self.step.timeout)
        elif self.run.done:
            self._ended(self.run)
        else:  # its goal has no time of its own
            self._token = self._set_timer(self.step.timeout)

    def _send(self, timeout: float) -> None:
        self.run = self.trial.send(command_of(self.step, timeout))

    def take(self, what: str, about: Any) -> None:
        super().take(what, about)
        if what == RUN_ENDED and about is self.run:
            self._ended(about)
        elif what == TIMER and about is self._token and about is not None:
            self.over = self._felt or StepEnd(told.TIMEOUT)
        elif what == HAPPENED and self._felt is None and about.stamp >= self.began and self._is_touch(about):
            self._felt = _felt(about)
            self._token = self._set_timer(GOAL_LAG)

    def close(self) -> None:
        super().close()
        _cancel(self.run)

    def _is_touch(self, event: ConsoleEvent) -> bool:
        wanted = self.step.sense == "touch" and event.kind == TOUCHED
        return wanted and event.data.get("sensor") in names_of(sensors_of(self.step.names))

    def _ended(self, run: Any) -> None:
        end = end_of(self.step, run)
        if self._felt is not None and end.outcome in (told.TIMEOUT, told.FAILED):
            end = self._felt
        elif end.touched and self.trial.happenings.goes_on(end.touched, end.stamp or self.trial.robot.now()):
            left = self.began + self.step.timeout - self.trial.robot.now()
            if left > 0.0:
                self._send(left)  # a hand that lay there already has moved
                return
            end = StepEnd(told.TIMEOUT)
        if end.outcome == told.FAILED:
            self._fail(end, run.state)
        else:
            self.over = end


def _felt(event: ConsoleEvent) -> StepEnd:
    """The end by a touch that topics tell of."""
    sensor = str(event.data["sensor"])
    return StepEnd(told.DONE, sensor, event.stamp, touched=(sensor,))


_KINDS: Mapping[type, type[Wait]] = {
    CommandStep: CommandWait,
    ChoiceStep: ChoiceWait,
    UntilStep: UntilWait,
    SenseStep: SenseWait,
}


def waits_of(
    trial: Any, step: ProtocolStep, values: Mapping[str, Any], place: tuple[str, int], began: float
) -> list[Wait]:
    """What ends a step; the first that is over does."""
    parts = step.waits if isinstance(step, WhileStep) else (step,)
    waits: list[Wait] = []
    for part in parts:
        if isinstance(part, PauseStep):
            answer = TIME_UP if part is not step else ""
            waits.append(TimeWait(trial, part, values, began, part.seconds, told.DONE, answer))
            continue
        wait = _KINDS[type(part)](trial, part, values, began)
        if isinstance(wait, ChoiceWait):
            wait.place = place
        elif isinstance(wait, SenseWait):
            wait.path = place[0]
        waits.append(wait)
    timeout = getattr(step, "timeout", 0.0)
    if timeout and not isinstance(step, SenseStep):  # the server of a sense has it itself
        waits.append(TimeWait(trial, step, values, began, timeout, told.TIMEOUT))
    return waits


def kinds_of(step: ProtocolStep) -> frozenset[str]:
    """Kinds of the events that a step waits for."""
    if isinstance(step, WhileStep):
        return frozenset(kind for each in step.waits for kind in kinds_of(each))
    if isinstance(step, SenseStep):
        return frozenset(filter(None, [EVENT_OF.get(step.sense)]))
    names = {name for condition in getattr(step, "conditions", ()) for name in condition.names()}
    return frozenset(kind for kind, name in COUNTED.items() if name in names)


def word_of(step: ProtocolStep) -> SenseStep | None:
    """The wait for a word in a step; None if there is none."""
    parts: Iterable[ProtocolStep] = step.waits if isinstance(step, WhileStep) else (step,)
    return next((each for each in parts if isinstance(each, SenseStep) and each.sense == "word"), None)


def server_of(step: ProtocolStep) -> str:
    """The server that a step needs; empty: none."""
    if isinstance(step, CommandStep):
        return step.command.server
    return command_of(step, 0.0).server if isinstance(step, SenseStep) else ""


def command_of(step: SenseStep, timeout: float) -> RobotCommand:
    """What a wait asks of the robot. `timeout`: s of ROS time."""
    names = list(step.names)
    confidence = {"confidence": step.confidence} if step.confidence else {}
    if step.sense == "touch":
        return call("NaoTactile", "waitForTouch", sensors=names, timeout=timeout)
    if step.sense == "word":
        return call("nao_audio_in", "listen", vocabulary=names, timeout=timeout, **confidence)
    if step.sense == "sound":
        return call("nao_audio_in", "detectSound", timeout=timeout, **confidence)
    name = {"str_param": names[0]} if names else {}
    return call("NaoVision", "detectFaces", timeout=timeout, **name, **confidence)


def end_of(step: SenseStep, run: Any) -> StepEnd:
    """How a wait ended whose goal has."""
    if run.state != "succeeded":
        return StepEnd(told.FAILED, error=run.text or run.state)
    result: Mapping[str, Any] = run.result
    parts = result.get("results") or [{}]
    answers = {
        "touch": lambda: list(result.get("touched") or []),
        "word": lambda: list(result.get("words") or [])[:1],
        "sound": lambda: ["sound"] if result.get("sounds") else [],
        "face": lambda: [each.get("name") or "face" for each in result.get("objects") or []][:1],
    }[step.sense]()
    if not answers:
        return StepEnd(told.TIMEOUT)
    onset = _seconds(parts[-1].get("onset")) or _seconds(parts[-1].get("end"))
    return StepEnd(told.DONE, ", ".join(answers), onset, touched=tuple(answers) if step.sense == "touch" else ())


def _values_of(result: Mapping[str, Any]) -> str:
    """What functions answered, the last one that did, as a protocol has values; `none` if none did."""
    answered = [list(part.get("values") or []) for part in result.get("results") or []]
    values = next((values for values in reversed(answered) if values), [])
    return ", ".join(_TRUTHS.get(value, value) for value in map(str, values)) or NOTHING


def _cancel(run: Any) -> None:
    if run is not None and not run.done:
        run.cancel()


def _seconds(value: Any) -> float | None:
    """A time of a result, in s; None where the robot does not tell it."""
    to_sec = getattr(value, "to_sec", None)
    seconds = to_sec() if to_sec is not None else value
    return float(seconds) if seconds else None


log = logging.getLogger(__name__)

EARS = (SPEECH, "nao_audio_in")
"""Servers that speak and listen: the robot does not listen ahead of their steps, it would hear itself."""
LIMIT = 3600.0
"""s for which the robot listens ahead."""


class ListeningAhead:
    """The goal that listens already.

    Args:
        trial: The `TrialRunner`.
        speaks: Whether a stored behaviour speaks or listens.
    """

    def __init__(self, trial: Any, speaks: Callable[[str], bool]) -> None:
        self._trial, self._speaks = trial, speaks
        self._path = ""  # of the wait that it is for
        self._run: Any = None

    def begin(self, path: str, step: ProtocolStep) -> None:
        """A step begins: listen from now on if a wait for a word comes and nothing before it is heard or listens."""
        if word_of(step) is not None or is_inside(path):
            return
        found = self._next(path, step)
        if found is None or found[0] != self._path:
            self.end()
        if found is None or self._run is not None:
            return
        try:
            self._path, self._run = found[0], self._trial.send(command_of(found[1], LIMIT))
        except Stopped:
            raise
        except NaoError as error:  # the wait itself fails with it
            log.info("the robot does not listen ahead: %s", error)

    def take(self, path: str) -> Any:
        """The goal that listens for the wait at a path, which has it from now on; None if none does."""
        run, wanted = self._run, self._path
        if run is None or wanted != path or (run.done and run.state != "succeeded"):
            self.end()
            return None
        self._run, self._path = None, ""
        return run

    def end(self) -> None:
        """Listen no longer."""
        if self._run is not None and not self._run.done:
            self._run.cancel()
        self._run, self._path = None, ""

    def _next(self, path: str, step: ProtocolStep) -> tuple[str, SenseStep] | None:
        """The wait for a word behind a step, with its path; None if a step before speaks or listens."""
        done = {outcome.label for outcome in self._trial.state.outcomes}
        behaviors: list[str] = []
        while not self._uses_ears(step, behaviors):
            path = self._trial.following(path)
            if not path:
                return None
            step = step_at(self._trial.protocol, path)
            word = word_of(step)
            if word is not None:
                later = word.since == NOW or (word.since and word.since not in done)
                return None if later or any(map(self._speaks, behaviors)) else (path, word)
        return None

    def _uses_ears(self, step: ProtocolStep, behaviors: list[str]) -> bool:
        """Whether a step speaks or listens; behaviours, which may, are added to a list."""
        if isinstance(step, CommandStep):
            command = step.command.filled({name: str(value) for name, value in self._trial.state.values.items()})
            if command.server == BEHAVIORS:
                behaviors += [str(fields.get("str_param", "")) for _, fields in command.chain]
            return command.stops or command.server in EARS
        parts, acts = (step.waits, steps_in(step.steps)) if isinstance(step, WhileStep) else ((step,), ())
        hears = any(isinstance(each, SenseStep) and each.sense == "sound" for each in parts)
        return hears or any(self._uses_ears(each, behaviors) for each in acts)
