"""Parts of ALMotion about walking: at a velocity or to a place, its end, the arms meanwhile, where the robot is."""

from __future__ import annotations

import logging
from typing import Any, Callable, Iterable, Sequence

from nao_sim_bridge.base.errors import BadValue, MovePrevented
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import known, number, vector
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.arguments import require_rising
from nao_sim_bridge.naoqi.motion.move_config import frequency_share, gait_list, gait_of, gait_of_feet
from nao_sim_bridge.naoqi.motion.part import MotionPart
from nao_sim_bridge.walk.footstep_plan import SIDES, FootstepPlan
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.locomotion import Locomotion
from nao_sim_bridge.walk.steps_course import Placement

log = logging.getLogger("nao_sim.walk")

FAILED = "ALMotion/MoveFailed"
NOT_STARTED, STOPPED = 0, 1
ARM_GROUPS = {"LArm": ("LArm",), "RArm": ("RArm",), "Arms": ("LArm", "RArm")}
# Shares of a speed may be beyond 1 by this: rounding of single precision.
ROUNDING = 1e-6
# No place is farther away, and no velocity higher, in m, rad and s: with more, sums would leave what numbers can be.
MOST = 1e6


class Moves:
    """Begins moves of a robot, one object for all modules that do. Simulation thread only.

    Those that fail raise `ALMotion/MoveFailed`: [cause, 0 not started or 1 stopped on the way, place of an obstacle or
    None]. As on a robot, legs that are too soft and obstacles prevent a move without an error: the log warns, once
    until one begins.
    """

    def __init__(self, memory: MemoryStore) -> None:
        self._memory = memory
        self._warned = False
        memory.declare_event(FAILED, "ALMotion")

    def begin(self, locomotion: Locomotion, call: str, command: Callable[[Locomotion], Any], prevented: Any) -> Any:
        """What a command of the robot's locomotion answers, or `prevented` when it was prevented."""
        self.watch(locomotion)
        try:
            answer = command(locomotion)
        except MovePrevented as error:
            if not self._warned:  # a program may call again and again
                self._warned = True
                log.warning("%s does not move the robot: %s", call, error)
            return prevented
        self._warned = self._warned and not locomotion.active
        return answer

    def watch(self, locomotion: Locomotion) -> None:
        """Tell of the failures of this one; more than once is as good as once."""
        if self._tell not in locomotion.failures:
            locomotion.failures.append(self._tell)

    def _tell(self, cause: str, started: bool, obstacle: Sequence[float] | None) -> None:
        place = None if obstacle is None else list(obstacle)
        self._memory.raise_event(FAILED, [cause, STOPPED if started else NOT_STARTED, place])


class Walking(MotionPart):
    """Moves. Those at a velocity return at once; those to a place return when the robot stands there, or elsewhere.

    When one is prevented, moveTo answers False.
    """

    def __init__(self, runner: RobotRunner, moves: Moves) -> None:
        super().__init__(runner)
        self._moves = moves

    def moveInit(self) -> Task:
        return self._walk("moveInit", lambda locomotion: locomotion.init())

    def move(self, x: float, y: float, theta: float, config: Any = ()) -> Task:
        rate, gait = _three(x, y, theta), gait_of(config)
        return self._walk("move", lambda locomotion: locomotion.move(*rate, gait))

    def moveToward(self, x: float, y: float, theta: float, config: Any = ()) -> Task:
        return self._toward("moveToward", x, y, theta, gait_of(config))

    def setWalkTargetVelocity(self, x: float, y: float, theta: float, frequency: float, *configs: Any) -> Task:
        share = frequency_share(frequency, "frequency")
        gait = gait_of_feet(*configs, share) if len(configs) == 2 else gait_of(*configs, frequency=share)
        return self._toward("setWalkTargetVelocity", x, y, theta, gait)

    def moveTo(self, *arguments: Any) -> Task:
        """Answers whether the robot got there: False when it was stopped, or sent elsewhere, on the way."""
        return self._to("moveTo", arguments)

    def stopMove(self) -> Task:
        """Answers when both feet are on the ground."""
        return self._walk("stopMove", lambda locomotion: locomotion.stop().then(lambda _: True))

    def killMove(self) -> Task:
        return self._walk("killMove", lambda locomotion: locomotion.kill())

    def waitUntilMoveIsFinished(self) -> Task:
        return self._walk("waitUntilMoveIsFinished", lambda locomotion: locomotion.until_finished())

    def moveIsActive(self) -> bool:
        return self._robot.walking

    # --- configuration --------------------------------------------------------------------------------------------

    def getMoveConfig(self, which: str) -> list:
        return gait_list(which)

    def getMoveArmsEnabled(self, chain: str) -> bool:
        arms, enabled = ARM_GROUPS[known(chain, "arm or group", ARM_GROUPS)], self._robot.locomotion.arms.enabled
        return all(enabled[arm] for arm in arms)

    def setMoveArmsEnabled(self, left: bool, right: bool) -> Task:
        wanted = dict(zip(ARM_GROUPS["Arms"], (bool(left), bool(right))))
        return self._walk("setMoveArmsEnabled", lambda locomotion: locomotion.arms.enabled.update(wanted))

    # --- steps of one foot after the other, each placed beside the other foot; what legs cannot do is clipped ---------

    def setFootSteps(self, legs: list[str], steps: Any, times: list[float], clear: bool) -> Task:
        """Each time, s from the first step's begin, is that of a landing.

        On the way, times that go on from those before count from the begin of the first step of all, others from that
        of the first new one.
        """
        placed = _placed(legs, steps)
        # A foot that steps twice in a row needs a step of the other one in between, and no time is given for that.
        if any(one == next_ for (one, _), (next_, _) in zip(placed, placed[1:])):
            raise BadValue("legName", legs, "LLeg and RLeg in turns")
        landings = vector(times, "timeList", len(placed), f"as many as steps: {len(placed)} here")
        require_rising(landings, "timeList", times)
        steps = _placements(placed, [b - a for a, b in zip([0.0, *landings], landings)])

        def start(locomotion: Locomotion) -> None:
            locomotion.set_steps(steps, FeetGait(), bool(clear), on_the_clock=True)

        return self._walk("setFootSteps", start)

    def setFootStepsWithSpeed(self, legs: list[str], steps: Any, fractions: list[float], clear: bool) -> Task:
        """One fraction of the top frequency for all steps, or one for each."""
        placed, gait = _placed(legs, steps), FeetGait()
        each = fractions * len(placed) if len(fractions) == 1 else fractions
        shares = vector(each, "fractionMaxSpeed", len(placed), f"as many as steps: {len(placed)} here", 0.0, 1.0)
        steps = _placements(placed, [gait.of(side).period(share) for (side, _), share in zip(placed, shares)])
        begin = lambda locomotion: locomotion.set_steps(steps, gait, bool(clear)).then(lambda _: None)  # noqa: E731
        return self._walk("setFootStepsWithSpeed", begin)

    def getFootSteps(self) -> Task:
        return self._walk("getFootSteps", lambda locomotion: _as_list(locomotion.steps()))

    # --- poses [x, y, theta] and velocities of the robot on the ground, in FRAME_WORLD ------------------------------

    def getRobotPosition(self, use_sensors: bool) -> Task:
        return self._read("getRobotPosition", lambda locomotion: locomotion.position(bool(use_sensors)))

    def getNextRobotPosition(self) -> Task:
        return self._read("getNextRobotPosition", lambda locomotion: locomotion.next_position())

    def getRobotVelocity(self) -> Task:
        return self._read("getRobotVelocity", lambda locomotion: locomotion.velocity())

    # --- older names ----------------------------------------------------------------------------------------------

    walkInit = moveInit
    stopWalk = stopMove
    killWalk = killMove
    waitUntilWalkIsFinished = waitUntilMoveIsFinished
    walkIsActive = moveIsActive
    getFootGaitConfig = getMoveConfig
    setWalkArmsEnabled = setMoveArmsEnabled

    def walkTo(self, *arguments: Any) -> Task:
        return self._to("walkTo", arguments)

    def getWalkArmsEnabled(self) -> list[bool]:
        enabled = self._robot.locomotion.arms.enabled
        return [enabled[arm] for arm in ARM_GROUPS["Arms"]]

    def _walk(self, call: str, command: Callable[[Locomotion], Any], prevented: Any = None) -> Task:
        """Run a command of the robot's locomotion in the simulation thread; the answer of one that is `prevented`."""

        def begin() -> Any:
            return self._moves.begin(self._robot.locomotion, f"ALMotion::{call}", command, prevented)

        return self._runner.execute(begin, call)

    def _read(self, call: str, reading: Callable[[Locomotion], Iterable[float]]) -> Task:
        # Between two ticks: plan, commands and sensors are of one moment there.
        return self._runner.execute(lambda: list(reading(self._robot.locomotion)), call)

    def _toward(self, call: str, x: float, y: float, theta: float, gait: FeetGait) -> Task:
        shares = tuple(_share(value, name, -1.0) for name, value in (("x", x), ("y", y), ("theta", theta)))
        return self._walk(call, lambda locomotion: locomotion.move_toward(*shares, gait))

    def _to(self, call: str, arguments: tuple[Any, ...]) -> Task:
        points, time, config = _destination(arguments)
        gait = gait_of(config)
        return self._walk(call, lambda locomotion: locomotion.move_to(points, gait, time).then(bool), False)


def _destination(arguments: tuple[Any, ...]) -> tuple[list[FootPose], float | None, Any]:
    """Poses to go through as seen from the robot, time to take (s) and configuration, from the arguments of moveTo.

    These are x, y, theta and then a time, a configuration, both or neither; or control points, with a configuration
    or without.
    """
    if len(arguments) < 3:
        return _control_points(arguments[0]), None, arguments[1] if len(arguments) == 2 else ()
    points = [FootPose(*_three(*arguments[:3]))]
    time, config = None, ()
    for extra in arguments[3:]:
        if isinstance(extra, (list, tuple)):
            config = extra
        else:
            time = number(extra, "time", 0.0)
    return points, time, config


def _control_points(points: Any) -> list[FootPose]:
    allowed = "a list of at least one [x, y, theta], in m, m, rad"
    if not isinstance(points, (list, tuple)) or not points:
        raise BadValue("controlPoint", points, allowed)
    require_few("controlPoint", len(points), "places")
    if any(not isinstance(point, (list, tuple)) or len(point) != 3 for point in points):
        raise BadValue("controlPoint", points, allowed)
    return [FootPose(*_three(*point)) for point in points]


def _three(x: Any, y: Any, theta: Any) -> tuple[float, float, float]:
    x, y, theta = (number(v, name, -MOST, MOST) for v, name in ((x, "x"), (y, "y"), (theta, "theta")))
    return x, y, theta


def _share(value: Any, field: str, least: float) -> float:
    checked = number(value, field)
    if not least - ROUNDING <= checked <= 1.0 + ROUNDING:
        raise BadValue(field, value, f"{least:g} to 1")
    return min(max(checked, least), 1.0)


def _placed(legs: Any, steps: Any) -> list[tuple[int, FootPose]]:
    """Side and place of each step.

    A BadValue when a leg has another name, a step other numbers, there is not one step for each leg, or too many are.
    """
    if isinstance(steps, (list, tuple)):
        require_few("footSteps", len(steps), "steps")
    if not isinstance(legs, (list, tuple)) or not legs or any(leg not in SIDES for leg in legs):
        raise BadValue("legName", legs, f"a list of {' and '.join(SIDES)}, at least one")
    if not isinstance(steps, (list, tuple)) or len(steps) != len(legs):
        raise BadValue("footSteps", steps, f"as many steps [x, y, theta] as legs: {len(legs)} here")
    placed = []
    for position, (leg, step) in enumerate(zip(legs, steps)):
        three = vector(step, f"footSteps[{position}]", 3, "x, y in m, theta in rad, from the other foot")
        placed.append((SIDES[leg], FootPose(*three)))
    return placed


def _placements(placed: Iterable[tuple[int, FootPose]], periods: Iterable[float]) -> list[Placement]:
    return [Placement(side, beside, period) for (side, beside), period in zip(placed, periods)]


def _as_list(plan: FootstepPlan) -> list:
    """Poses of the feet in FRAME_WORLD, steps that nothing can change any more, steps after them."""
    parts = ([[step.leg, step.time, list(step.placement)] for step in part] for part in (plan.fixed, plan.clearable))
    return [[list(plan.left), list(plan.right)], *parts]
