"""Runs a trial: its steps one after the other, in a thread of its own, whoever looks at it."""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Callable

from naoqi.errors import NaoError

from ..core.waiting import Listeners
from . import trial_log as told
from .commands import RobotCommand, Stopped
from .protocol import (
    COUNTED,
    NOTHING,
    NOW,
    SKIP,
    STOP,
    ChoiceStep,
    CommandStep,
    PauseStep,
    ProtocolStep,
    SenseStep,
    StudyError,
    StudyProtocol,
    UntilStep,
    WhileStep,
    filled,
)
from .robot_events import TOUCHED, ConsoleEvent, Happenings
from .schedule import first_inside, following, phase_of, rounds_of, step_at
from .step_waits import CHOICE, HAPPENED, RUN_ENDED, TIMER, ListeningAhead, StepEnd, TimeWait, Wait, kinds_of, waits_of
from .trial_log import PATIENCE, TRIAL, LogGap, StepOutcome, TrialLog, TrialState

log = logging.getLogger(__name__)

NEXT, REPEAT, PAUSE, CONTINUE, ABORT = "next", "repeat", "pause", "continue", "abort"
STOPPED = "stopped"
"""Kind of the event when everything was stopped."""
LOOK_PERIOD = 0.1
"""s of this computer after which conditions are looked at again, whatever has happened; the log likewise."""
LOG_PATIENCE = 2.0
"""s for which steps are begun although the log cannot be written; then the trial waits before the next one."""
ROUND_TIME = 0.5
"""s of ROS time that a round of a `while` lasts at least: steps that are over at once do not flood robot and log."""
After = Callable[[float, Callable[[], None]], Callable[[], None]]
"""Has a function called once after so many s of ROS time; returns what prevents that."""


@dataclass
class _Frame:
    """A step that runs: of a `while` and the step in it there are two, the outer one first."""

    step: ProtocolStep | None
    place: tuple[str, int]
    waits: list[Wait] = field(default_factory=list)
    end: StepEnd | None = None
    by: str = ""  # who has ended it

    @property
    def over(self) -> StepEnd | None:
        """How it ended; None: it has not."""
        return self.end or next((wait.over for wait in self.waits if wait.over is not None), None)


class TrialRunner:
    """A trial that runs on a robot.

    Its state is in `state`, which changes in the threads that add events to the robot; listeners are called there, too.
    All controls may be called from any thread, at any time: one that is about a step that is over does nothing.

    Args:
        protocol: What is done.
        robot: The `RobotClient`.
        trial_log: Opened.
        state: Of the log so far: new, or of a trial that is resumed.
        about: Of a new trial: what its first event holds; `trial`: its id, `values`: its values.
        after: Clock of the time-outs.
        recordings: Begins and ends recordings in the trial's thread: has `begin()` and `end()`.
        at_end: Called in the trial's thread when all is over.
        stops: Of the robot when the trial was asked for; None: as many as now.
        speaks: Whether a stored behaviour speaks: the robot does not listen ahead then, it would hear itself.
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
        speaks: Callable[[str], bool] = lambda name: True,
    ) -> None:
        self.protocol, self.robot, self.state, self.log = protocol, robot, state, trial_log
        self.id: str = (state.about or about)["trial"]
        self._about, self._after, self._recordings, self._at_end = about, after, recordings, at_end
        self._frames: list[_Frame] = []  # steps that run, from outside
        self.happenings = Happenings(robot.now())
        self.ahead = ListeningAhead(self, speaks)
        self._inbox: queue.Queue[tuple[str, Any, str]] = queue.Queue()
        self._lock = threading.RLock()
        self._listeners = Listeners()
        # Stops of the robot when somebody last wanted it to move: after a further one no goal is sent.
        self._stops: int = robot.stops if stops is None else stops
        self.pauses = 0
        """How often it has begun to wait because it was paused, or stopped."""
        self.lost = 0
        """Events that are not in the log, of a trial that is over."""
        self._log_failed = 0.0  # ROS time since which the log cannot be written
        self._goes_on_without_log = False  # somebody said so
        self._pausing, self._was_held = False, state.status == told.HELD
        self._unsubscribe: Callable[[], None] = lambda: None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"trial {self.id}", daemon=True)

    def start(self, by: str = "") -> None:
        """Start, or resume."""
        self.log.on_change = self._log_changed
        self._unsubscribe = self.robot.events.subscribe(self._take)
        if self.state.status:
            self.tell(told.RESUMED, f"trial {self.id} is resumed", by)
        else:
            self.tell(told.BEGAN, f"trial {self.id} starts", by, **self._about)
        self._thread.start()

    def on_change(self, listener: Callable[[TrialRunner], None]) -> Callable[[], None]:
        """Have a function called after each event, quickly; returns what ends that."""
        return self._listeners.add(listener)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until all is over, s of this computer; whether it is."""
        return self._over.wait(timeout)

    @property
    def step(self) -> ProtocolStep | None:
        """The step that runs, or that failed and is held; of a `while` and the step in it the `while`."""
        outcome = self.outcome
        return step_at(self.protocol, outcome.path) if outcome is not None else None

    @property
    def outcome(self) -> StepOutcome | None:
        """The begin of the step that runs, or the end of the one that failed and is held."""
        with self._lock:
            return self.state.last if self.state.status == told.HELD else self.state.current

    @property
    def trouble(self) -> str:
        """What is wrong with the log, or was until somebody has seen it; empty: nothing."""
        return self.log.trouble or self.state.trouble

    @property
    def pausing(self) -> bool:
        """Whether it was paused, or stopped, and nobody has continued it; it may still come to that."""
        return self._pausing

    @property
    def title(self) -> str:
        """What the step that runs does, for people."""
        outcome = self.outcome
        return outcome.text if outcome is not None else ""

    def pause(self, by: str = "") -> None:
        """Wait: a step of the robot comes to its end, any other one is ended, and restarts afterwards."""
        self._control(PAUSE, by)

    def go_on(self, by: str = "") -> None:
        """End a pause."""
        self._control(CONTINUE, by)

    def next(self, by: str = "") -> None:
        """End the step without its result, and go on with the next one."""
        self._control(NEXT, by)

    def repeat(self, by: str = "") -> None:
        """Restart the step; between steps the one that was the last."""
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
        if self.happenings.take(event):
            self._inbox.put((HAPPENED, event, ""))
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
        for listener in self._listeners:
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
        self.ahead.end()
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
        path = self._unfinished() or self.following(self.state.path)
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
                continue  # it restarts after the pause
            if end.outcome == told.REPEATED:
                continue
            if end.outcome == told.FAILED:
                if end.on_error == STOP:
                    return told.ABORTED
                if end.on_error != SKIP:
                    control = self._hold(path, end.error)
                    if control == ABORT:
                        return told.ABORTED
                    if control == REPEAT:
                        continue
            path = self.following(path)
        return told.FINISHED

    def _unfinished(self) -> str:
        """The step at which a trial that is resumed was interrupted."""
        last = self.state.last
        if last is None or not (self._was_held or last.outcome in (told.STOPPED, told.REPEATED, "")):
            return ""
        return last.path

    def following(self, path: str) -> str:
        """Path of the step behind another one, by the values of this moment; empty: none."""
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
            self.ahead.end()
            self.pauses += 1
            self.tell(told.PAUSED, "paused")
            control = self._until_control()
            self._pausing = False
            self.happenings.forget(COUNTED, self.robot.now())  # what happened meanwhile is no answer
            if control == ABORT:
                return control, path
            self.tell(told.CONTINUED, "continues")
            if control == REPEAT:
                path = self.state.path or path
            elif control == NEXT:
                path = self.following(path) if path else ""

    def _wait_for_log(self, before: str, at_end: bool = False) -> str:
        """Wait while the log cannot be written, if it could not for `LOG_PATIENCE`, or it is to be closed.

        An abort ends that, before a step also who continues. Returns `ABORT` or nothing.
        """
        control, waits = "", False
        while self.log.trouble and not control and (at_end or not self._goes_on_without_log):
            if not waits and self.log.blocked_for >= LOG_PATIENCE:
                waits = True
                otherwise = "Abort gives up what waits" if at_end else "Continue does not wait"
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
            self.tell(told.CONTINUED, "continues")
        return control

    def _hold(self, path: str, error: str) -> str:
        """Wait for the wizard behind a step that failed."""
        self.tell(told.HELD, f"step {path} failed, and the trial waits: {error}", path=path, error=error)
        control = self._until_control()
        if control != ABORT:
            self.tell(told.CONTINUED, "continues")
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
        rounds = rounds_of(self.protocol, path, self.state.values)
        values = {**self.state.values, **rounds}
        if isinstance(step, (PauseStep, WhileStep)):
            step = step.drawn(path, values)
        title = filled(step.text, values)
        begin = {"path": path, "phase": phase_of(self.protocol, path), "label": step.label, "step": step.kind}
        more = {"seconds": step.seconds} if isinstance(step, PauseStep) else {}
        self.tell(
            told.STEP_BEGAN, f"step {path}: {title}", **begin, title=title, attempt=attempt, rounds=rounds, **more
        )
        began = self.state.outcomes[-1].began or 0.0
        zero = self._zero(step, began)
        try:
            end, by = self._execute(step, values, (path, attempt), began)
        except Stopped as error:  # before its goal was sent
            self._pausing = True
            end, by = StepEnd(told.STOPPED, error=str(error)), ""
        except NaoError as error:
            on_error = step.on_error if isinstance(step, CommandStep) else ""
            end, by = StepEnd(told.FAILED, error=str(error), on_error=on_error), ""
        self._take_answer(step, end)
        seconds = None if end.stamp is None else round(end.stamp - zero, 4)
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
            finished=end.finished,
            error=end.error,
        )
        return end

    def _execute(
        self, step: ProtocolStep, values: Mapping[str, Any], place: tuple[str, int], began: float
    ) -> tuple[StepEnd, str]:
        """Do a step until it is over, or a control ends it; who did that."""
        self.ahead.begin(place[0], step)
        frame = _Frame(step, place, waits_of(self, step, values, place, began))
        self._frames.append(frame)
        try:
            for wait in frame.waits:
                wait.begin()
                if wait.over is not None:
                    break
            if isinstance(step, WhileStep):
                self._rounds(step, place[0], frame)
            self._wait_for_end()
            return frame.over or StepEnd(told.CUT), frame.by
        finally:
            self._frames.pop()
            for wait in frame.waits:
                wait.close()

    def _rounds(self, step: WhileStep, path: str, frame: _Frame) -> None:
        """Do the steps of a `while`, round for round, until it is over."""
        number = 0
        while frame.over is None and (not step.rounds or number < step.rounds):
            number += 1
            next_round = self.robot.now() + ROUND_TIME
            inner = first_inside(self.protocol, path, number, self.state.values)
            if not inner:
                return
            while inner and frame.over is None:
                end = self._do(inner)
                self._take_messages()
                if end.outcome == told.FAILED and end.on_error != SKIP and frame.over is None:
                    frame.end = replace(end, error=f"step {inner}: {end.error}")
                elif end.outcome == told.STOPPED and frame.over is None:
                    frame.end = StepEnd(told.STOPPED, error=end.error)
                inner = self.following(inner)
            rest = next_round - self.robot.now()
            if frame.over is None and rest > 0.0:
                pause = TimeWait(self, step, {}, 0.0, rest, told.DONE)
                self._frames.append(_Frame(None, ("", 0), [pause]))
                try:
                    pause.begin()
                    self._wait_for_end()
                finally:
                    self._frames.pop()
                    pause.close()

    def _wait_for_end(self) -> None:
        """Wait until one of the steps that run is over."""
        while True:
            for wait in [wait for frame in self._frames for wait in frame.waits]:
                if wait.over is None:
                    wait.look()
            if any(frame.over for frame in self._frames):
                return
            polls = any(wait.polls for frame in self._frames for wait in frame.waits)
            try:
                self._take_message(*self._inbox.get(timeout=LOOK_PERIOD if polls else None))
            except queue.Empty:  # time is a condition, too
                continue

    def _take_messages(self) -> None:
        """Take the messages that have come."""
        while not self._inbox.empty():
            self._take_message(*self._inbox.get())

    def _take_message(self, what: str, about: Any, by: str) -> None:
        """Have a message end what it ends. A control is about the outermost step."""
        for frame in self._frames:
            for wait in frame.waits:
                if frame.over is None:
                    wait.take(what, about)
                    if wait.over is not None:
                        frame.by = by
        frame = self._frames[0]
        if what == PAUSE:
            self._pausing = True
        elif what == CONTINUE:
            self._pausing, self._stops = False, about[1]
        elif what == ABORT:
            self._pausing = False
        if frame.over is not None:
            return
        if what == ABORT:
            frame.end, frame.by = StepEnd(told.STOPPED), by
        elif what == PAUSE and not isinstance(frame.step, CommandStep):
            frame.end, frame.by = StepEnd(told.STOPPED, error="paused"), by
        elif what in (NEXT, REPEAT) and about[0] == frame.place:
            frame.end, frame.by = StepEnd(told.SKIPPED if what == NEXT else told.REPEATED), by

    # What waits ask for

    def send(self, command: RobotCommand) -> Any:
        """Send a goal, whose end is a message; None for a stop. Raises what `RobotClient.send` does."""
        run = self.robot.send(command, stops=self._stops)
        if run is None:
            self._stops += 1
            return None
        run.on_end(lambda ended: self._inbox.put((RUN_ENDED, ended, "")))
        return run

    def after(self, seconds: float, token: object) -> Callable[[], None]:
        """Have a message come after so many s of ROS time; returns what prevents that."""
        return self._after(seconds, lambda: self._inbox.put((TIMER, token, "")))

    def since(self, step: SenseStep | UntilStep, began: float) -> float:
        """ROS time from which on what happens answers a step, s, unless a wait before it has taken it."""
        named = self._named(step.since)
        return began if step.since == NOW else named.began or 0.0 if named is not None else 0.0

    def _zero(self, step: ProtocolStep, began: float) -> float:
        """ROS time from which the reaction time of a step counts: its begin, or the end of the step that it names."""
        parts = step.waits if isinstance(step, WhileStep) else (step,)
        named = next(filter(None, (self._named(getattr(each, "since", "")) for each in parts)), None)
        return began if named is None else named.finished or named.ended or began

    def _named(self, label: str) -> StepOutcome | None:
        """How the newest step with a label was done; None if none was, or there is none."""
        if not label or label == NOW:
            return None
        return next((each for each in reversed(self.state.outcomes) if each.label == label), None)

    def _take_answer(self, step: ProtocolStep, end: StepEnd) -> None:
        """What has answered a wait, and what was before it, is no answer of the next one."""
        kinds = kinds_of(step)
        if TOUCHED in kinds and end.touched and end.stamp is not None:
            self.happenings.answered(end.touched, end.stamp)
            kinds -= {TOUCHED}
        self.happenings.forget(kinds, self.robot.now())
