"""A robot for trials without ROS: goals end when a test says so, and time passes when it says so."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import Any

from nao_library_modules.studies.commands import Stopped
from nao_library_modules.studies.protocol_reader import read_protocol
from nao_library_modules.studies.robot_events import EventStream
from nao_library_modules.studies.studies import Studies
from nao_library_modules.studies.study_files import StudyFiles

LIMIT = 60.0
"""s of this computer that anything may take."""

PROTOCOL = """\
name: two_by_two
factors:
  voice: {levels: [low, high]}
  reply: {levels: {kind: {text: "Thanks, {participant}"}, plain: {text: Right}}}
phases:
  - phase: Begin
    only: first
    steps:
      - say: Hello
  - phase: Task
    steps:
      - {wait: touch, sensors: [head], label: head}
      - {wizard: "Was it fast, {participant}?", choices: ["yes", "no"], label: fast}
      - when: fast == no
        then:
          - say: Faster, please
      - say: "{text}"
"""


@dataclass
class PlayedRun:
    """A goal."""

    command: Any
    state: str = "active"
    text: str = ""
    result: dict[str, Any] = field(default_factory=dict)
    _callbacks: list[Any] = field(default_factory=list)

    @property
    def done(self) -> bool:
        return self.state != "active"

    def on_end(self, callback):
        if self.done:
            callback(self)
        else:
            self._callbacks.append(callback)

    def end(self, state="succeeded", text="", **result):
        self.state, self.text, self.result = state, text, result
        for callback in self._callbacks:
            callback(self)

    def cancel(self):
        self.end("preempted")


class PlayedRobot:
    """Goals that `plays` does not end at once wait in `runs`."""

    namespace = "/"

    def __init__(self, plays=("say",)):
        self.time, self.plays, self.runs = 100.0, plays, []
        self.stops = 0
        self.events = EventStream("/", self.now)
        self.sent = threading.Semaphore(0)
        self.timers = []

    def now(self):
        return self.time

    def stop(self, by=""):
        self.stops += 1
        self.events.add("stopped", "everything is told to stop", by)

    def send(self, command, by="", stops=None):
        if command.stops:
            return self.stop(by)
        if stops not in (None, self.stops):
            raise Stopped("everything was stopped")
        run = PlayedRun(command)
        self.runs.append(run)
        if command.chain[0][0] in self.plays:
            run.end()
        self.sent.release()
        return run

    def after(self, seconds, callback):
        timer = [self.time + seconds, callback]
        self.timers.append(timer)
        return lambda: timer in self.timers and self.timers.remove(timer)


class Trial:
    """A study with a robot that is played; each function waits until the trial is where it is to be."""

    def __init__(self, folder, robot=None, text=PROTOCOL):
        self.robot = robot or PlayedRobot()
        self.files = StudyFiles(folder)
        self.studies = Studies(self.files)
        self.protocol = read_protocol(text, "two.yaml")
        self.changed = threading.Condition()
        self.runner = None

    def begin(self, participant="P01"):
        self.runner = self.studies.begin(self.protocol, participant, self.robot, listener=self.tell)
        return self

    def resume(self, trial="two_by_two/P01-1"):
        self.runner = self.studies.resume(trial, self.robot, listener=self.tell)
        return self

    def tell(self, _):
        with self.changed:
            self.changed.notify_all()

    def until(self, holds):
        with self.changed:
            assert self.changed.wait_for(holds, LIMIT), self.runner.state

    def at(self, path, attempt=1):
        place = (path, attempt)
        self.until(lambda: self.runner.state.current and self.runner._place() == place)
        return self

    def begun(self, path, attempt=1):
        """Wait until a step has begun, also one in a `while`."""
        place = (path, attempt)
        self.until(lambda: any((each.path, each.attempt) == place for each in [*self.runner.state.outcomes]))

    def feel(self, sensor, stamp, touched=True):
        """Topics tell of a touch."""
        self.robot.events.add("touched", sensor, stamp=stamp, sensor=sensor, touched=touched)

    def goal(self, function, position=-1):
        """Wait for a goal of a function that goes on, and give it."""

        def found():
            return [run for run in self.robot.runs if run.command.chain[0][0] == function and not run.done]

        for _ in iter(lambda: bool(found()), True):
            assert self.robot.sent.acquire(timeout=LIMIT)
        return found()[position]

    def touch(self, seconds):
        """In the step that waits for it, once its goal is sent."""
        for _ in iter(lambda: self.robot.runs and self.robot.runs[-1].command.chain[0][0] == "waitForTouch", True):
            assert self.robot.sent.acquire(timeout=LIMIT)
        began = self.runner.outcome.began
        results = [{"onset": began + seconds}]
        self.robot.runs[-1].end(touched=["front head"], touch_times=[began + seconds], results=results)

    def play(self, choice="yes", seconds=0.7):
        self.at("2.1").touch(seconds)
        self.at("2.2").runner.choose(choice, "ann")
        return self.end()

    def end(self):
        assert self.runner.wait(LIMIT)
        return self.runner.state
