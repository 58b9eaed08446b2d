"""Runs a trial: its steps one after the other, in a thread of its own, whoever looks at it."""

from __future__ import annotations

import logging
import queue
import threading
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Callable

from naoqi.errors import NaoError

from ...nao.touch_names import names_of, sensors_of
from ..robots.commands import RobotCommand, call
from ..robots.errors import Stopped
from ..robots.events import ConsoleEvent
from . import state as told
from .conditions import filled
from .course import following, phase_of, rounds_of, step_at
from .errors import StudyError
from .log import PATIENCE, LogGap, TrialLog
from .protocol import (
    NOTHING,
    SKIP,
    STOP,
    ChoiceStep,
    CommandStep,
    PauseStep,
    ProtocolStep,
    SenseStep,
    StudyProtocol,
    UntilStep,
)
from .state import TRIAL, StepOutcome, TrialState

log = logging.getLogger(__name__)

NEXT, REPEAT, PAUSE, CONTINUE, ABORT, CHOICE = "next", "repeat", "pause", "continue", "abort", "choice"
_RUN_ENDED, _TIME_UP, _HAPPENED = "run ended", "time is up", "happened"
STOPPED = "stopped"
"""Kind of the event when everything was stopped."""
COUNTED = {"touched": "touches", "heard": "words", "seen": "faces"}
"""Kind of an event -> what conditions that are waited for call its count."""
GOAL_LAG = 0.5
"""s of ROS time by which a goal may tell of a touch later than the topics: its onset is the better one."""
LOOK_PERIOD = 0.1
"""s of this computer after which conditions are looked at again, whatever has happened; the log likewise."""
LOG_PATIENCE = 2.0
"""s for which steps are begun although the log cannot be written; then the trial waits before the next one."""
After = Callable[[float, Callable[[], None]], Callable[[], None]]
"""Has a function called once after so many s of ROS time; returns what prevents that."""


@dataclass(frozen=True)
class StepEnd:
    """How a step ended."""

    outcome: str  # one of `state`
    answer: str = ""
    stamp: float | None = None  # of the answer, ROS time, s
    error: str = ""


class TrialRunner:
    """A trial that runs on a robot.

    Its state is in `state`, which changes in the threads that add events to the robot; listeners are called there, too.
    All controls may be called from any thread, at any time: one that is about a step that is over does nothing.

    Args:
        protocol: What is done.
        robot: The `RobotClient`.
        trial_log: Opened.
        state: Of the log so far: new, or of a trial that is taken up.
        about: Of a new trial: what its first event holds; `trial`: its id, `values`: its values.
        after: Clock of the time-outs.
        recordings: Begins and ends recordings in the trial's thread: has `begin()` and `end()`.
        at_end: Called in the trial's thread when all is over.
        stops: Of the robot when the trial was asked for; None: as many as now.
    """

    def __init__(
        self,
        protocol: StudyProtocol,
        robot: Any,
        trial_log: TrialLog,
        state: TrialState,
        about: Mapping[str, Any],
        after: After,
        recordings: Any = None,
        at_end: Callable[[TrialRunner], None] = lambda _: None,
        stops: int | None = None,
    ) -> None:
        self.protocol, self.robot, self.state, self.log = protocol, robot, state, trial_log
        self.id: str = (state.about or about)["trial"]
        self._about, self._after, self._recordings, self._at_end = about, after, recordings, at_end
        self._inbox: queue.Queue[tuple[str, Any, str]] = queue.Queue()
        self._lock = threading.RLock()
        self._listeners: list[Callable[[TrialRunner], None]] = []
        # Stops of the robot when somebody last wanted it to move: after a further one no goal is sent.
        self._stops: int = robot.stops if stops is None else stops
        self.lost = 0
        """Events that are not in the log, of a trial that is over."""
        self._log_failed = 0.0  # ROS time since which the log cannot be written
        self._goes_on_without_log = False  # somebody said so
        self._pausing, self._was_held = False, state.status == told.HELD
        self._unsubscribe: Callable[[], None] = lambda: None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"trial {self.id}", daemon=True)

    def start(self, by: str = "") -> None:
        """Begin, or go on."""
        self.log.on_change = self._log_changed
        self._unsubscribe = self.robot.events.subscribe(self._take)
        if self.state.status:
            self.tell(told.TAKEN_UP, f"trial {self.id} is taken up again", by)
        else:
            self.tell(told.BEGAN, f"trial {self.id} begins", by, **self._about)
        self._thread.start()

    def on_change(self, listener: Callable[[TrialRunner], None]) -> Callable[[], None]:
        """Have a function called after each event, quickly; returns what ends that."""
        with self._lock:
            self._listeners.append(listener)

        def end() -> None:
            with self._lock:
                if listener in self._listeners:
                    self._listeners.remove(listener)

        return end

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until all is over, s of this computer; whether it is."""
        return self._over.wait(timeout)

    @property
    def step(self) -> ProtocolStep | None:
        """The step that runs, or that failed and is held."""
        outcome = self.outcome
        return step_at(self.protocol, outcome.path) if outcome is not None else None

    @property
    def outcome(self) -> StepOutcome | None:
        """The begin of the step that runs, or the end of the one that failed and is held."""
        with self._lock:
            held = self.state.status == told.HELD and self.state.outcomes
            return self.state.outcomes[-1] if held else self.state.current

    @property
    def trouble(self) -> str:
        """What is wrong with the log, or was until somebody has seen it; empty: nothing."""
        return self.log.trouble or self.state.trouble

    @property
    def title(self) -> str:
        """What the step that runs does, for people."""
        outcome = self.outcome
        return outcome.text if outcome is not None else ""

    def pause(self, by: str = "") -> None:
        """Wait: a step of the robot comes to its end, any other one is ended, and begins anew afterwards."""
        self._control(PAUSE, by)

    def go_on(self, by: str = "") -> None:
        """End a pause."""
        self._control(CONTINUE, by)

    def next(self, by: str = "") -> None:
        """End the step without its result, and go on with the next one."""
        self._control(NEXT, by)

    def repeat(self, by: str = "") -> None:
        """Begin the step anew; between steps the one that was the last."""
        self._control(REPEAT, by)

    def abort(self, by: str = "") -> None:
        """End the trial."""
        self._control(ABORT, by)

    def choose(self, choice: str, by: str = "") -> None:
        """Choose in a step of the wizard. Raises StudyError if the step that runs has no such choice."""
        step = self.step
        if not isinstance(step, ChoiceStep) or choice not in step.choices:
            raise StudyError(f"there is no choice {choice!r} at this moment")
        self._inbox.put((CHOICE, (self._place(), choice, self.robot.now()), by))

    def seen(self, by: str = "") -> None:
        """Somebody has seen what was wrong with the log; the log tells who."""
        if self.state.over:  # nothing more is logged
            self.state.trouble = ""
        elif self.state.trouble:
            self.tell(told.TROUBLE_SEEN, "the trouble with the log was seen", by)

    def note(self, text: str, by: str = "") -> None:
        """Write something down."""
        self.robot.events.add("note", text, by=by, trial=self.id)

    def deviation(self, text: str, by: str = "") -> None:
        """Mark that something was not as the protocol has it."""
        self.robot.events.add("deviation", text, by=by, trial=self.id, path=self._place()[0])

    def tell(self, what: str, text: str, by: str = "", **more: Any) -> None:
        """Add an event of the trial; its state follows."""
        self.robot.events.add(TRIAL, text, by=by, **{**more, "trial": self.id, "what": what})

    def _control(self, what: str, by: str) -> None:
        self._inbox.put((what, (self._place(), self.robot.stops), by))

    def _place(self) -> tuple[str, int]:
        """The step that runs and its attempt: what a control is about."""
        outcome = self.outcome
        return (outcome.path, outcome.attempt) if outcome is not None else ("", 0)

    def _take(self, event: ConsoleEvent) -> None:
        """Log an event of the robot; called in the thread that adds it."""
        own = event.data.get("trial") == self.id
        with self._lock:
            if self.state.over and not own:
                return
            logged = self.log.add(asdict(event))
            if own or event.kind not in (TRIAL, "note", "deviation"):
                self.state.apply(logged)
        if event.kind == STOPPED and threading.current_thread() is not self._thread:
            self._control(PAUSE, event.by)  # who stops the robot does not want its next step
        if event.kind in COUNTED:
            self._inbox.put((_HAPPENED, event, ""))
        self._notify()

    def _log_changed(self, gap: LogGap | None) -> None:
        """The log cannot be written, or could be again; called in its thread."""
        now = self.robot.now()
        if gap is None:
            self._log_failed = now
            log.warning("trial %s: %s", self.id, self.log.trouble)
            self._notify()
            return
        began = gap.stamp or self._log_failed or now
        self._log_failed, self._goes_on_without_log = 0.0, False
        text = f"the log could not be written for {gap.ended - gap.began:.1f} s ({gap.reason}): "
        text += f"{gap.events} events waited in memory, and were written then"
        times = {"began": began, "ended": now, "wall_began": round(gap.began, 3), "wall_ended": round(gap.ended, 3)}
        more = {"what": told.LOG_GAP, "events": gap.events, "path": self._place()[0]}
        self.robot.events.add("deviation", text, trial=self.id, **more, **times)

    def _notify(self) -> None:
        with self._lock:
            listeners = list(self._listeners)
        for listener in listeners:
            listener(self)

    def _run(self) -> None:
        try:
            self._do_all()
        finally:
            self._over.set()
            self._notify()  # behind that: who waits for changes is not left waiting

    def _do_all(self) -> None:
        outcome, text = told.ABORTED, ""
        try:
            if self._recordings is not None:
                self._recordings.begin(self)
            outcome = self._steps()
        except Exception as error:  # whatever it is: the recordings have to end, and the log
            log.exception("trial %s", self.id)
            text = f": {error}"
        try:
            if self._recordings is not None:
                self._recordings.end(self)
        except Exception as error:
            log.exception("recordings of trial %s", self.id)
            self.deviation(f"a recording could not be ended: {error}")
        self._wait_for_log("its end", at_end=True)
        self.tell(told.ENDED, f"trial {self.id} is {outcome}{text}", outcome=outcome)
        self.lost = self.log.close(0.0 if self.log.trouble else PATIENCE)
        self._unsubscribe()
        if self.lost:
            self.state.trouble = f"the last {self.lost} events of trial {self.id} are lost: they could not be written"
            log.error("%s", self.state.trouble)
        try:
            self._at_end(self)
        except Exception:
            log.exception("end of trial %s", self.id)

    def _steps(self) -> str:
        """Do all steps; how the trial ended."""
        path = self._unfinished() or self._following(self.state.path)
        while path:
            control, path = self._between(path)
            if control == ABORT:
                return told.ABORTED
            if not path:
                break
            end = self._do(path)
            if end.outcome == told.STOPPED:
                if not self._pausing:
                    return told.ABORTED
                continue  # it begins anew behind the pause
            if end.outcome == told.REPEATED:
                continue
            if end.outcome == told.FAILED:
                step = step_at(self.protocol, path)
                on_error = step.on_error if isinstance(step, CommandStep) else ""
                if on_error == STOP:
                    return told.ABORTED
                if on_error != SKIP:
                    control = self._hold(path, end.error)
                    if control == ABORT:
                        return told.ABORTED
                    if control == REPEAT:
                        continue
            path = self._following(path)
        return told.FINISHED

    def _unfinished(self) -> str:
        """The step at which a trial that is taken up was interrupted."""
        last = self.state.outcomes[-1] if self.state.outcomes else None
        if last is None or not (self._was_held or last.outcome in (told.STOPPED, told.REPEATED, "")):
            return ""
        return last.path

    def _following(self, path: str) -> str:
        with self._lock:
            return following(self.protocol, path, self.state.values)

    def _between(self, path: str) -> tuple[str, str]:
        """Follow the controls that came since the last step ended; a control and the step that is next."""
        while True:
            while not self._inbox.empty():
                what, _, _ = self._inbox.get()
                if what == ABORT:
                    return ABORT, path
                if what == PAUSE:
                    self._pausing = True
            if not self._pausing:
                if self._wait_for_log(f"step {path}" if path else "its end") == ABORT:
                    return ABORT, path
                if not self._pausing:
                    return "", path
            self.tell(told.PAUSED, "paused")
            control = self._until_control()
            self._pausing = False
            if control == ABORT:
                return control, path
            self.tell(told.CONTINUED, "goes on")
            if control == REPEAT:
                path = self.state.path or path
            elif control == NEXT:
                path = self._following(path) if path else ""

    def _wait_for_log(self, before: str, at_end: bool = False) -> str:
        """Wait while the log cannot be written, if it could not for `LOG_PATIENCE`, or it is to be closed.

        An abort ends that, before a step also who goes on. Returns `ABORT` or nothing.
        """
        control, waits = "", False
        while self.log.trouble and not control and (at_end or not self._goes_on_without_log):
            if not waits and self.log.blocked_for >= LOG_PATIENCE:
                waits = True
                otherwise = "Abort gives up what waits" if at_end else "Go on does not wait"
                self.tell(told.PAUSED, f"the trial waits before {before} until its log can be written. {otherwise}")
            if not waits and not at_end:
                break
            try:
                what, about, _ = self._inbox.get(timeout=LOOK_PERIOD)
            except queue.Empty:
                continue
            if what == PAUSE:
                self._pausing = True
            elif what in (NEXT, REPEAT, CONTINUE) and not at_end:
                self._goes_on_without_log, self._stops = True, about[1]
            elif what == ABORT and waits:
                control = ABORT
        if waits:
            self.tell(told.CONTINUED, "goes on")
        return control

    def _hold(self, path: str, error: str) -> str:
        """Wait for the wizard behind a step that failed."""
        self.tell(told.HELD, f"step {path} failed, and the trial waits: {error}", path=path, error=error)
        control = self._until_control()
        if control != ABORT:
            self.tell(told.CONTINUED, "goes on")
        return control

    def _until_control(self) -> str:
        while True:
            what, about, _ = self._inbox.get()
            if what in (NEXT, REPEAT, CONTINUE):
                self._stops = about[1]
                return what
            if what == ABORT:
                return what

    def _do(self, path: str) -> StepEnd:
        """Do a step; the events of its begin and its end."""
        step = step_at(self.protocol, path)
        attempt = self.state.attempts(path) + 1
        values = {**self.state.values, **rounds_of(self.protocol, path)}
        title = filled(step.text, values)
        begin = {"path": path, "phase": phase_of(self.protocol, path), "label": step.label, "step": step.kind}
        self.tell(told.STEP_BEGAN, f"step {path}: {title}", **begin, title=title, attempt=attempt)
        began = self.state.outcomes[-1].began
        try:
            end, by = self._execute(step, values, (path, attempt), began)
        except Stopped as error:  # before its goal was sent
            self._pausing = True
            end, by = StepEnd(told.STOPPED, error=str(error)), ""
        except NaoError as error:
            end, by = StepEnd(told.FAILED, error=str(error)), ""
        seconds = None if end.stamp is None else round(end.stamp - began, 4)
        answer = end.answer or (NOTHING if end.outcome in (told.TIMEOUT, told.SKIPPED) and step.label else "")
        text = (
            f"step {path}: {end.outcome}" + (f", {answer}" if answer else "") + (f": {end.error}" if end.error else "")
        )
        self.tell(
            told.STEP_ENDED,
            text,
            by,
            **begin,
            attempt=attempt,
            outcome=end.outcome,
            answer=answer,
            answered=end.stamp,
            seconds=seconds,
            error=end.error,
        )
        return end

    def _execute(
        self, step: ProtocolStep, values: Mapping[str, Any], place: tuple[str, int], began: float
    ) -> tuple[StepEnd, str]:
        """Do a step until it is over, or a control ends it; who did that."""
        run, prevent = None, lambda: None
        timeout = step.seconds if isinstance(step, PauseStep) else getattr(step, "timeout", 0.0)
        command = _command_of(step)
        if command is not None:
            texts = {name: str(value) for name, value in values.items()}
            wanted = command.filled(texts) if isinstance(step, CommandStep) else command
            run = self.robot.send(wanted, stops=self._stops)
            if run is None:  # of a stop, which nothing is waited for
                self._stops += 1
                return StepEnd(told.DONE), ""
            run.on_end(lambda ended: self._inbox.put((_RUN_ENDED, ended, "")))
        if timeout and not isinstance(step, SenseStep):  # the server of a sense has it itself
            prevent = self._after(timeout, lambda: self._inbox.put((_TIME_UP, place, "")))
        counts: Counter[str] = Counter()
        felt: StepEnd | None = None  # a touch that the goal has not told of: it may have come before the server waited
        try:
            while True:
                if isinstance(step, UntilStep) and self._holds(step, values, counts, began):
                    return StepEnd(told.DONE, "", self.robot.now()), ""
                try:
                    what, about, by = self._inbox.get(timeout=LOOK_PERIOD if isinstance(step, UntilStep) else None)
                except queue.Empty:  # time is a condition, too
                    continue
                if what == _RUN_ENDED and about is run:
                    end = _end_of(step, run)
                    return (felt if felt is not None and end.outcome == told.TIMEOUT else end), ""
                if what == _TIME_UP and about == place and felt is not None:
                    return felt, ""
                if what == _TIME_UP and about == place:
                    return StepEnd(told.DONE if isinstance(step, PauseStep) else told.TIMEOUT), ""
                if what == _HAPPENED:
                    new = about.stamp >= began and _counts(about)
                    counts[COUNTED[about.kind]] += new
                    if new and felt is None and _is_answer(step, about):
                        felt = StepEnd(told.DONE, str(about.data["sensor"]), about.stamp)
                        prevent = self._after(GOAL_LAG, lambda: self._inbox.put((_TIME_UP, place, "")))
                elif what == CHOICE and about[0] == place:
                    return StepEnd(told.DONE, about[1], about[2]), by
                elif what == ABORT:
                    self._pausing = False
                    return StepEnd(told.STOPPED), by
                elif what == PAUSE:
                    self._pausing = True
                    if not isinstance(step, CommandStep):
                        return StepEnd(told.STOPPED, error="paused"), by
                elif what == CONTINUE:
                    self._pausing, self._stops = False, about[1]
                elif what in (NEXT, REPEAT) and about[0] == place:
                    return StepEnd(told.SKIPPED if what == NEXT else told.REPEATED), by
        finally:
            prevent()
            if run is not None and not run.done:
                run.cancel()

    def _holds(self, step: UntilStep, values: Mapping[str, Any], counts: Mapping[str, int], began: float) -> bool:
        live = {name: counts.get(name, 0) for name in COUNTED.values()}
        live["seconds"] = self.robot.now() - began
        return all(condition.holds({**values, **live}) for condition in step.conditions)


def _counts(event: ConsoleEvent) -> bool:
    """Whether an event is a touch, a word or a face: neither the end of a touch, nor other things that are seen."""
    return event.data.get("touched", event.kind != "touched") and event.data.get("what", "face") == "face"


def _is_answer(step: ProtocolStep, event: ConsoleEvent) -> bool:
    """Whether an event is the touch that a step waits for."""
    if not isinstance(step, SenseStep) or step.sense != "touch" or event.kind != "touched":
        return False
    return event.data.get("sensor") in names_of(sensors_of(step.names))


def _command_of(step: ProtocolStep) -> RobotCommand | None:
    """What a step asks of the robot."""
    if isinstance(step, CommandStep):
        return step.command
    if not isinstance(step, SenseStep):
        return None
    names = list(step.names)
    if step.sense == "touch":
        return _sense("NaoTactile", "waitForTouch", step, sensors=names)
    if step.sense == "word":
        confidence = {"confidence": step.confidence} if step.confidence else {}
        return _sense("nao_audio_in", "listen", step, vocabulary=names, **confidence)
    name = {"str_param": names[0]} if names else {}
    return _sense("NaoVision", "detectFaces", step, **name)


def _sense(server: str, function: str, step: SenseStep, **fields: Any) -> RobotCommand:
    return call(server, function, **fields, timeout=step.timeout)


def _end_of(step: ProtocolStep, run: Any) -> StepEnd:
    """How a step ended whose goal has."""
    if run.state != "succeeded":
        return StepEnd(told.FAILED, error=run.text or run.state)
    if not isinstance(step, SenseStep):
        return StepEnd(told.DONE)
    result: Mapping[str, Any] = run.result
    answers = {
        "touch": lambda: list(result.get("touched") or []),
        "word": lambda: list(result.get("words") or [])[:1],
        "face": lambda: [each.get("name") or "face" for each in result.get("objects") or []][:1],
    }[step.sense]()
    if not answers:
        return StepEnd(told.TIMEOUT)
    parts = result.get("results") or [{}]
    return StepEnd(told.DONE, ", ".join(answers), _seconds(parts[-1].get("onset")) or _seconds(parts[-1].get("end")))


def _seconds(value: Any) -> float | None:
    """A time of a result, in s; None where the robot does not tell it."""
    to_sec = getattr(value, "to_sec", None)
    seconds = to_sec() if to_sec is not None else value
    return float(seconds) if seconds else None
