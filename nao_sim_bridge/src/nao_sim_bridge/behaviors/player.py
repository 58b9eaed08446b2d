"""Plays behaviours on one robot, several at a time. Simulation thread only."""

from __future__ import annotations

import itertools
import logging
from typing import Any, Callable, Iterable, Protocol, Sequence

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.diagram_run import DiagramRun, TimelineRun
from nao_sim_bridge.behaviors.run import BehaviorRun
from nao_sim_bridge.behaviors.steps import (
    Behavior,
    BehaviorFailed,
    Diagram,
    Gesture,
    GoToPosture,
    InTurn,
    Joints,
    JointWay,
    Language,
    Lights,
    Refused,
    Repeat,
    Say,
    Step,
    Text,
    Timeline,
    Together,
    Wait,
    words,
)
from nao_sim_bridge.body.led_animations import colored
from nao_sim_bridge.body.leds import LedKeyframe
from nao_sim_bridge.control.joints.bezier import BezierCurve, KeyPoint
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.speech.animations import AnimationLibrary
from nao_sim_bridge.speech.animator import Animator

log = logging.getLogger("nao_sim.behaviors")

# Times are sums of ticks: this close to a moment it has come, s.
ROUNDING = 1e-9
# Says a text, with gestures or without; goes to a posture at a share of the top speed. The tasks may end with further
# tasks, as commands do; the last one of a posture ends with whether it was reached.
Speak = Callable[[str, bool], Task]
GoTo = Callable[[str, float], Task]


class Surroundings(Protocol):
    """What boxes of Choregraphe need beside speech and postures."""

    def language(self) -> str:
        """In which the robot speaks, by its NAOqi name."""

    def set_language(self, name: str) -> None:
        """Speak and listen in another language; a SimulationError when the robot does not know it."""

    def listen(self, key: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        """Call `listener(value)` in the simulation thread at each event, until the function returned is called."""


class BehaviorPlayer:
    """Plays behaviours.

    What a behaviour has done to the LEDs ends with it: they show again what they showed before, but for those that
    somebody else has changed meanwhile. Joints stay where it has left them, gestures are brought back.
    """

    def __init__(
        self,
        simulation: Any,
        animator: Animator,
        library: AnimationLibrary,
        speak: Speak,
        go_to: GoTo,
        surroundings: Surroundings,
    ) -> None:
        self._simulation = simulation
        self._animator = animator
        self._library = library
        self._speak = speak
        self._go_to = go_to
        self._surroundings = surroundings
        self.listen = surroundings.listen
        self._runs: list[BehaviorRun] = []
        self._timers: list[tuple[float, Task]] = []
        simulation.after_tick.append(self._tick)
        simulation.after_reset.append(self.stop_all)

    def start(self, behavior: Behavior) -> Task:
        """Begin with a behaviour. Its task ends with it; killing it stops all that the behaviour does.

        Raises:
            BehaviorFailed: In the task: the text names the step that cannot be done and says why.
        """
        task = self._simulation.task_ids.make("behavior", on_kill=lambda _: run.stop())
        run = BehaviorRun(behavior, task, self._simulation.robot.leds)
        self._runs.append(run)
        task.add_done_callback(lambda _: self._runs.remove(run))
        whole = self._in_turn([behavior.step], run)
        whole.add_done_callback(lambda _: run.finish())
        return task

    def stop_all(self) -> None:
        for run in list(self._runs):
            run.task.kill()

    @property
    def time(self) -> float:
        """Of the simulation, s."""
        return self._simulation.time

    def begin(self, step: Step, run: BehaviorRun, text: str = "") -> Task:
        """Begin with a step of a diagram, which `text` is sent to; its task ends with it, an error ends `run`."""
        return self._in_turn([step], run, text)

    def text_of(self, text: Text) -> str:
        """A text in the language of the robot; empty when there is none in it."""
        texts = text.by_language
        return texts[""] if "" in texts else texts.get(self._surroundings.language(), "")

    # --- steps ----------------------------------------------------------------------------------------------------

    def _in_turn(self, steps: Iterable[Step], run: BehaviorRun, text: str = "") -> Task:
        """A task that ends when the steps have been done one after the other; never when the behaviour ends before."""
        left, whole = iter(steps), Task("steps", 0)

        def proceed(_: Task | None = None) -> None:
            while not run.over:
                step = next(left, None)
                if step is None:
                    whole.finish()
                    return
                try:
                    task = self._begin(step, run, text)
                except SimulationError as error:
                    run.fail(_failure(run.behavior, step, error))
                    return
                if not task.finished:
                    task.add_done_callback(proceed)
                    return

        proceed()
        return whole

    def _begin(self, step: Step, run: BehaviorRun, text: str = "") -> Task:
        """Begin with a step; its task ends with it."""
        if isinstance(step, Refused):
            raise SimulationError(step.reason)
        if isinstance(step, (Diagram, Timeline)):
            return self._choregraphe(step, run)
        if isinstance(step, Language):
            self._surroundings.set_language(step.name)
            return _ended()
        if isinstance(step, InTurn):
            return self._in_turn(step.steps, run)
        if isinstance(step, Repeat):
            endless = itertools.repeat(step.step)
            return self._in_turn(endless if step.times is None else itertools.islice(endless, step.times), run)
        if isinstance(step, Together):
            return _all_of([self._in_turn([branch], run) for branch in step.steps])
        if isinstance(step, Joints):
            return run.watch(self._move(step, run))
        if isinstance(step, Gesture):
            return self._gesture(step, run)
        if isinstance(step, Lights):
            return self._light(step, run)
        if isinstance(step, Wait):
            return run.watch(self._timer(step.duration))
        return self._command(step, run, text)

    def _choregraphe(self, step: Diagram | Timeline, run: BehaviorRun) -> Task:
        """A behaviour of Choregraphe; the signals that leave it go nowhere."""

        def told(done: Task) -> None:
            if done.value is None and not run.over:
                log.warning(
                    "behavior %s ends: nothing in it is left to happen. No signal has reached its onStopped, so on a "
                    "robot it would run until it is stopped",
                    run.behavior.name,
                )

        part = run.branch()
        if isinstance(step, Diagram):
            whole = DiagramRun(step, part, self, lambda port, text: None)
            whole.task.add_done_callback(told)
            whole.load(step.starts)
        else:
            whole = TimelineRun(step, part, self, lambda port, text: None)
            whole.task.add_done_callback(told)
            whole.start()
        return whole.task

    def _move(self, step: Joints, run: BehaviorRun) -> Task:
        """Joints without stiffness stay where they are, as on a robot; the others move."""
        robot = self._simulation.robot
        index = robot.model.joint_index
        ways = {index[name]: way for name, way in step.ways.items()}
        limp = [i for i in ways if robot.joints.stiffnesses[i] == 0.0]
        run.tell_limp(robot.model.joints[i].name for i in limp if not robot.model.joints[i].is_hand)
        ways = {i: way for i, way in ways.items() if i not in limp}
        if not ways:
            return self._timer(step.length)

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve | BezierCurve]:
            return {i: _curve(way, commands[i]) for i, way in ways.items()}

        return robot.motion.follow("behavior", ways, curves, noticed=False)

    def _gesture(self, step: Gesture, run: BehaviorRun) -> Task:
        animation = self._library.find(step.name, self._animator.posture)
        if animation is None:
            raise SimulationError("there is no such animation")
        run.tell_limp(self._animator.limp_joints(animation))
        task = self._animator.start(animation)
        # Another gesture of the same joints replaces it: the behaviour goes on.
        return run.watch(task, end=lambda: self._animator.stop(animation), needed=False)

    def _light(self, step: Lights, run: BehaviorRun) -> Task:
        layout, robot = self._simulation.led_layout, self._simulation.robot
        values = colored(layout, layout.devices_of(step.group), step.color)
        run.remember_lights(values)
        if step.duration == 0.0:
            robot.leds.set(values)
            return _ended()
        fade = robot.leds.animate("behavior", [LedKeyframe(step.duration, values)], robot.time)
        return run.watch_lights(fade, values)

    def _command(self, step: Say | GoToPosture, run: BehaviorRun, text: str) -> Task:
        if isinstance(step, Say):
            if step.given and not text.strip():
                return _ended()
            spoken = step.text + text if step.given else step.text
            return run.watch_command(self._speak(spoken, step.animated), lambda error: self._fail(run, step, error))

        def settled(error: Exception | None, reached: bool = True) -> None:
            self._fail(run, step, error or (None if reached else SimulationError("the robot did not get there")))

        return run.watch_command(self._go_to(step.name, step.speed), settled)

    def _fail(self, run: BehaviorRun, step: Step, error: Exception | None) -> None:
        if error is not None:
            run.fail(_failure(run.behavior, step, error))

    # --- time -----------------------------------------------------------------------------------------------------

    def _timer(self, duration: float) -> Task:
        task = self._simulation.task_ids.make("wait")
        self._timers.append((self._simulation.time + duration, task))
        return task

    def _tick(self, snapshot: Any) -> None:
        if not self._timers:
            return
        due = [task for time, task in self._timers if snapshot.time >= time - ROUNDING or task.finished]
        if due:
            self._timers = [entry for entry in self._timers if entry[1] not in due]
            for task in due:
                task.finish()


def _curve(way: JointWay, command: float) -> SmoothCurve | BezierCurve:
    if way.curved:
        return BezierCurve((KeyPoint(0.0, command), *way.points))
    return SmoothCurve((0.0, *(p.time for p in way.points)), (command, *(p.angle for p in way.points)))


def _all_of(tasks: Sequence[Task]) -> Task:
    """A task that ends when all have ended."""
    whole, left = Task("together", 0), len(tasks)

    def count(_: Task) -> None:
        nonlocal left
        left -= 1
        if not left:
            whole.finish()

    for task in tasks:
        task.add_done_callback(count)
    return whole


def _ended() -> Task:
    task = Task("step", 0)
    task.finish()
    return task


def _failure(behavior: Behavior, step: Step, error: Exception) -> BehaviorFailed:
    return BehaviorFailed(f"behavior {behavior.name}, {words(step)}: {error}")
