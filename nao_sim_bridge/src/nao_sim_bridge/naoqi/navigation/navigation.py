"""ALNavigation of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

import logging
import math
from typing import Any, Callable, NoReturn

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.move_config import gait_of
from nao_sim_bridge.naoqi.motion.walking import Moves
from nao_sim_bridge.naoqi.navigation.caution import Caution
from nao_sim_bridge.naoqi.navigation.navigator import Navigator
from nao_sim_bridge.naoqi.navigation.trajectory import read_trajectory
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.locomotion import Locomotion

log = logging.getLogger("nao_sim.navigation")

FARTHEST_GOAL = 3.0
"""Goals of navigateTo are nearer than this, m."""
MOST = 1e6
"""In m, rad and s: with more, sums would leave what numbers can be."""
NO_MAP = "a NAO has no laser or 3D camera to map its surroundings with, as a Pepper has; navigateTo goes by the sonars"
NO_ZONE = "the free zone is that of a Pepper's lasers and 3D camera; a NAO's sonars see ahead only, see ALSonar"


class ALNavigation:
    """Moves that end before what the sonars see ahead, and ways around it.

    `move`, `moveTo` and `moveToward` are ALMotion's but for the security distance, at which they end however slow they
    are; that is ALMotion's orthogonal one.
    """

    def __init__(self, runner: RobotRunner, memory: MemoryStore, moves: Moves) -> None:
        self._runner = runner
        self._moves = moves
        self._caution = Caution(runner.simulation, memory)
        self._navigator = Navigator(runner.simulation, memory, self._caution)

    # --- cautious moves -------------------------------------------------------------------------------------------

    def move(self, x: float, y: float, theta: float, config: Any = ()) -> Task:
        rate, gait = _three(x, y, theta), gait_of(config)
        return self._cautiously("move", lambda locomotion: locomotion.move(*rate, gait))

    def moveToward(self, x: float, y: float, theta: float, config: Any = ()) -> Task:
        shares = [number(value, name, -1.0, 1.0) for name, value in (("x", x), ("y", y), ("theta", theta))]
        gait = gait_of(config)
        return self._cautiously("moveToward", lambda locomotion: locomotion.move_toward(*shares, gait))

    def moveTo(self, x: float, y: float, theta: float, config: Any = ()) -> Task:
        """Ends when the robot stands there, or before an obstacle."""
        goal, gait = FootPose(*_three(x, y, theta)), gait_of(config)
        return self._cautiously("moveTo", lambda locomotion: locomotion.move_to([goal], gait).then(lambda _: None))

    def getSecurityDistance(self) -> float:
        return self._caution.distance

    def setSecurityDistance(self, distance: float) -> Task:
        checked = number(distance, "distance", 0.0, MOST)
        return self._runner.execute(lambda: setattr(self._caution, "distance", checked), "setSecurityDistance")

    # --- ways -----------------------------------------------------------------------------------------------------

    def navigateTo(self, x: float, y: float, *others: Any) -> Task | bool:
        """(x, y), then theta, a configuration, both or neither; answers whether the robot got there.

        As on a robot, a goal that is too far away is not gone to, and the log says so.
        """
        *before, last = others or (None,)
        is_config = bool(before) or isinstance(last, (list, tuple))
        theta, config = ((before or [None])[0], last) if is_config else (last, ())
        goal, gait = FootPose(*_three(x, y, theta or 0.0)), gait_of(config)
        if math.hypot(x, y) >= FARTHEST_GOAL:
            log.warning("navigateTo: (%g, %g) is not gone to, allowed is a place nearer than %g m", x, y, FARTHEST_GOAL)
            return False
        return self._go("navigateTo", lambda: self._navigator.go_to(goal, theta is not None, gait))

    def moveAlong(self, trajectory: Any) -> Task:
        """Answers True also when an obstacle has ended it."""
        stretches = read_trajectory(trajectory)
        return self._go("moveAlong", lambda: self._navigator.go_along(stretches, FeetGait()))

    def stopNavigateTo(self) -> Task:
        return self._runner.execute(self._navigator.stop, "stopNavigateTo")

    # --- what a NAO has no sensors for ----------------------------------------------------------------------------

    def _no_map(self, *_: Any) -> NoReturn:
        raise NaoqiError(NO_MAP)

    def _no_zone(self, *_: Any) -> NoReturn:
        raise NaoqiError(NO_ZONE)

    explore = startMapping = stopExploration = saveExploration = loadExploration = setDefaultExploration = _no_map
    getExplorationPath = getMetricalMap = getRobotPositionInMap = navigateToInMap = _no_map
    relocalizeInMap = relocalizeInMapWithHint = startLocalization = stopLocalization = _no_map
    getFreeZone = findFreeZone = startFreeZoneUpdate = stopAndComputeFreeZone = _no_zone

    # --- inside ---------------------------------------------------------------------------------------------------

    def _cautiously(self, call: str, command: Callable[[Locomotion], Any]) -> Task:
        def run() -> Any:
            self._navigator.stop()
            return self._caution.begin(command)

        return self._go(call, run, None)

    def _go(self, call: str, begin: Callable[[], Any], prevented: Any = False) -> Task:
        def run() -> Any:
            return self._moves.begin(self._locomotion, f"ALNavigation::{call}", lambda _: begin(), prevented)

        return self._runner.execute(run, call)

    @property
    def _locomotion(self) -> Locomotion:
        return self._runner.simulation.robot.locomotion


def _three(x: Any, y: Any, theta: Any) -> tuple[float, float, float]:
    x, y, theta = (number(value, name, -MOST, MOST) for value, name in ((x, "x"), (y, "y"), (theta, "theta")))
    return x, y, theta
