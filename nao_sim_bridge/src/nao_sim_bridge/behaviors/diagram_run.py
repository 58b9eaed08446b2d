"""Diagrams and timelines of Choregraphe while they are played: signals go from box to box. Simulation thread only."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any, Callable, Iterable, Protocol, Tuple

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.run import BehaviorRun
from nao_sim_bridge.behaviors.steps import (
    Act,
    BehaviorFailed,
    Box,
    Diagram,
    KeyFrame,
    Link,
    Step,
    Text,
    Timeline,
    Wait,
)

MOST_SIGNALS, MOST_RUNNING = 10_000, 200
"""Signals of a diagram at one moment, and boxes of it that run at the same time."""
# Takes a signal: the output of a box, and the text that is sent.
Emit = Callable[[str, str], None]


class Stage(Protocol):
    """What a diagram is played with."""

    def begin(self, step: Step, run: BehaviorRun, text: str = "") -> Task:
        """Begin with a step; its task ends with it. `text` is what the box before has sent; an error is `run`'s."""

    def text_of(self, text: Text) -> str:
        """A text in the language of the robot."""

    def listen(self, key: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        """Call `listener(value)` at each event of ALMemory, until the function that is returned is called."""

    @property
    def time(self) -> float:
        """Of the simulation, s."""


@dataclass(frozen=True)
class End:
    """How a diagram or a timeline has ended: the outputs that send a signal, and the text that is sent."""

    ports: Tuple[str, ...]
    text: str = ""


@dataclass(eq=False)
class _Running:
    run: BehaviorRun
    inside: DiagramRun | None = None


class _Played:
    """What diagrams and timelines share."""

    def __init__(self, name: str, run: BehaviorRun, stage: Stage, emit: Emit) -> None:
        self.task = Task(name, 0)
        self._run = run
        self._stage = stage
        self._emit = emit

    @property
    def _over(self) -> bool:
        return self.task.finished or self._run.over


class DiagramRun(_Played):
    """A diagram that is played.

    Attributes:
        task: Ends with an `End` when a signal reaches an output that ends the diagram; with None when it is stopped, or
            when nothing is left to happen: on a robot the diagram would stay until it is stopped.
    """

    def __init__(self, diagram: Diagram, run: BehaviorRun, stage: Stage, emit: Emit) -> None:
        super().__init__("diagram", run, stage, emit)
        self._diagram = diagram
        self._running: dict[int, list[_Running]] = {}
        self._begun: set[int] = set()
        self._signals: deque[tuple[Link, str]] = deque()
        self._sending = False
        self._moment, self._count = -1.0, 0
        self._silences: list[Callable[[], None]] = []
        run.task.add_done_callback(lambda _: self._end(None))

    def load(self, ports: Iterable[str] = (), text: str = "", again: bool = False) -> DiagramRun:
        """Begin, and take the signals of these inputs; with `again` it was loaded before."""
        diagram = self._diagram
        for key, links in diagram.events.items():
            try:
                silence = self._stage.listen(key, lambda value, links=links: self._send(links, str(value)))
            except SimulationError as error:
                self._run.fail(BehaviorFailed(f"behavior {self._run.behavior.name}, input of {key}: {error}"))
                return self
            self._silences.append(silence)
        if not again:
            self._signals.extend((link, "") for link in diagram.loaded)
        self._send([link for port in ports for link in diagram.links.get(port, ())], text)
        return self

    def receive(self, port: str, text: str) -> None:
        """Take the signal of an input."""
        self._send(self._diagram.links.get(port, ()), text)

    # --- signals ------------------------------------------------------------------------------------------------------

    def _send(self, links: Iterable[Link], text: str = "") -> None:
        self._signals.extend((link, text) for link in links)
        if self._sending or self._over:
            return
        self._sending = True
        try:
            while self._signals and not self._over and not self._too_many():
                self._deliver(*self._signals.popleft())
        finally:
            self._sending = False
        if not self._over and not self._running and not self._silences:
            self._end(None)

    def _too_many(self) -> bool:
        """Whether signals go round without end or begin ever more, which fails the behaviour."""
        now = self._stage.time
        self._moment, self._count = now, self._count + 1 if now == self._moment else 1
        if self._count <= MOST_SIGNALS and sum(map(len, self._running.values())) <= MOST_RUNNING:
            return False
        name = self._diagram.boxes[self._signals[0][0].box].name
        self._run.fail(
            BehaviorFailed(
                f"behavior {self._run.behavior.name}: at box {name!r} signals go round without end; allowed are "
                f"{MOST_SIGNALS} at one moment and {MOST_RUNNING} boxes at a time"
            )
        )
        return True

    def _deliver(self, link: Link, text: str) -> None:
        if link.act is Act.OUT:
            if link.port in self._diagram.ends:
                self._end(End((link.port,), text))
            else:
                self._emit(link.port, text)
            return
        box, running = self._diagram.boxes[link.box], self._running.get(link.box, [])
        if link.act is Act.STOP:
            if running:
                self._stop(link.box)
                self._sent_by(box, box.stopped)
        elif running and running[0].inside is not None:
            running[0].inside.receive(link.port, text)
        elif box.step is not None and (link.act is Act.START or link.box in self._begun):
            if box.restarts:
                self._stop(link.box)
            self._begin(link, box, text)

    def _sent_by(self, box: Box, ports: Iterable[str], text: str = "") -> None:
        self._send([link for port in ports for link in box.links.get(port, ())], text)

    # --- boxes --------------------------------------------------------------------------------------------------------

    def _begin(self, link: Link, box: Box, text: str) -> None:
        number, step = link.box, box.step
        self._begun.add(number)
        if isinstance(step, Text):
            self._sent_by(box, box.done, self._stage.text_of(step))
            return
        takes_failure = any(box.links.get(port) for port in box.failed)
        part = self._run.branch((lambda: over(End(box.failed))) if takes_failure else None)
        running = _Running(part)
        self._running.setdefault(number, []).append(running)

        def over(end: End | None) -> None:
            here = self._running.get(number, [])
            if running not in here:
                return  # it was stopped
            here.remove(running)
            if not here:
                del self._running[number]
            part.finish()
            self._sent_by(box, () if end is None else end.ports, "" if end is None else end.text)

        def emit(port: str, sent: str) -> None:
            self._sent_by(box, (port,), sent)

        if isinstance(step, Diagram):
            running.inside = DiagramRun(step, part, self._stage, emit)
            running.inside.task.add_done_callback(lambda done: over(done.value))
            running.inside.load((link.port,), text, again=link.act is Act.PASS)
        elif isinstance(step, Timeline):
            timeline = TimelineRun(step, part, self._stage, emit)
            timeline.task.add_done_callback(lambda done: over(done.value))
            timeline.start()
        else:
            self._stage.begin(step, part, text).add_done_callback(lambda _: None if part.over else over(End(box.done)))

    def _stop(self, number: int) -> None:
        self._begun.discard(number)
        for running in self._running.pop(number, []):
            running.run.finish()

    # --- ends ---------------------------------------------------------------------------------------------------------

    def _end(self, end: End | None) -> None:
        silences, self._silences = self._silences, []
        for silence in silences:
            silence()
        self._signals.clear()
        for number in list(self._running):
            self._stop(number)
        self.task.finish(end)


class TimelineRun(_Played):
    """A timeline that is played.

    Attributes:
        task: Ends with an `End` when the timeline has come to its end; with None as a diagram's.
    """

    def __init__(self, timeline: Timeline, run: BehaviorRun, stage: Stage, emit: Emit) -> None:
        super().__init__("timeline", run, stage, emit)
        self._timeline = timeline
        self._layers: dict[int, BehaviorRun] = {}
        self._left = 1

    def start(self) -> None:
        timeline = self._timeline
        if timeline.joints is not None:
            self._count(self._stage.begin(timeline.joints, self._run))
        for frame in timeline.frames:
            self._after(frame.begin, lambda frame=frame: self._load(frame))
        if timeline.end is not None:
            self._after(timeline.end, lambda: self._end(End(timeline.ends)))
        self._one_less()

    def _after(self, delay: float, do: Callable[[], None]) -> None:
        def now(_: Task | None = None) -> None:
            if not self._over:
                do()

        if delay <= 0.0:
            now()
            return
        timer = self._stage.begin(Wait(delay), self._run)
        timer.add_done_callback(now)
        self._count(timer)

    def _load(self, frame: KeyFrame) -> None:
        before = self._layers.get(frame.layer)
        if before is not None:
            before.finish()
        self._layers[frame.layer] = part = self._run.branch()
        diagram = DiagramRun(frame.diagram, part, self._stage, self._emit)

        def unloaded(done: Task) -> None:
            if done.value is not None and not self._over:
                self._end(done.value)
            else:
                part.finish()

        diagram.task.add_done_callback(unloaded)
        self._count(diagram.task)
        diagram.load()

    def _count(self, task: Task) -> None:
        self._left += 1
        task.add_done_callback(lambda _: self._one_less())

    def _one_less(self) -> None:
        self._left -= 1
        if not self._left and not self._over:
            self._end(End(self._timeline.ends) if self._timeline.concludes else None)

    def _end(self, end: End | None) -> None:
        self._run.stop()
        self.task.finish(end)
