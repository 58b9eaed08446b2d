"""ALTracker of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.frames import TORSO
from nao_sim_bridge.naoqi.binding.arguments import known, number, one_of, whole_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.motion.arguments import space_of
from nao_sim_bridge.naoqi.motion.move_config import gait_list, gait_of
from nao_sim_bridge.naoqi.tracker.targets import TARGETS, Parameters
from nao_sim_bridge.naoqi.tracker.tracking import DEFAULT_DISTANCE, DEFAULT_TIMEOUT, Tracking
from nao_sim_bridge.tracking.approach import Relative
from nao_sim_bridge.tracking.follower import EFFECTORS, Mode

DEFAULT_VELOCITY, DEFAULT_ACCELERATION, DEFAULT_SEARCH = 3.0, 15.0, 0.3
MODES = {mode.value: mode for mode in Mode}
FASTEST_PERIOD, SLOWEST_PERIOD = 1, 60000


class ALTracker:
    """ALTracker as the simulated robot offers it: what is about targets and how they are followed.

    Velocity and acceleration are those of the head, rad/s and rad/s2. Landmarks give the robot's position when their
    places are known, see `Looking`.
    """

    def __init__(self, tracking: Tracking, runner: RobotRunner) -> None:
        self._tracking = tracking
        self._follower = tracking.follower
        self._runner = runner
        self._registered: dict[str, Parameters] = {}
        self._move_config: list = gait_list("Default")

    # --- targets --------------------------------------------------------------------------------------------------

    def registerTarget(self, target: str, parameters: Any) -> None:
        self._registered[target] = TARGETS[_known(target)].parameters(parameters)

    def unregisterTarget(self, target: str) -> None:
        self.unregisterTargets([target])

    def unregisterTargets(self, targets: list[str]) -> None:
        for target in targets:
            self._check_registered(target)
            if target == self._tracking.active:
                raise NaoqiError(f"{target} is being tracked, call stopTracker before")
        for target in targets:
            self._registered.pop(target, None)

    def unregisterAllTargets(self) -> None:
        self._registered = {n: p for n, p in self._registered.items() if n == self._tracking.active}

    def getRegisteredTargets(self) -> list[str]:
        return list(self._registered)

    def getSupportedTargets(self) -> list[str]:
        return list(TARGETS)

    def track(self, target: str) -> Task:
        self._check_registered(target)
        parameters = self._registered[target]
        return self._runner.execute(lambda: self._tracking.start(target, parameters), "track")

    def trackEvent(self, event: str) -> Task:
        """The event has a place as `read_place` says: NAOqi's layouts, or [x, y, z] in FRAME_ROBOT, m."""
        if not event:
            raise BadValue("pEventName", event, "the name of an event")
        return self._runner.execute(lambda: self._tracking.start_event(event), "trackEvent")

    def stopTracker(self) -> Task:
        return self._runner.execute(self._tracking.stop, "stopTracker")

    def isActive(self) -> bool:
        return bool(self._tracking.active)

    def getActiveTarget(self) -> str:
        return self._tracking.active

    def isTargetLost(self) -> bool:
        return self._tracking.lost

    def isNewTargetDetected(self) -> bool:
        return self._tracking.new

    def getTargetPosition(self, frame: int = TORSO) -> list[float]:
        """Empty when the target is lost."""
        return self._tracking.place_in(space_of(frame))

    # --- how ------------------------------------------------------------------------------------------------------

    def getAvailableModes(self) -> list[str]:
        return list(MODES)

    def getMode(self) -> str:
        return self._follower.mode.value

    def setMode(self, mode: str) -> Task:
        one_of(mode, "pMode", MODES)
        return self._runner.execute(lambda: setattr(self._follower, "mode", MODES[mode]), "setMode")

    def getEffector(self) -> str:
        return self._follower.effector

    def setEffector(self, effector: str) -> None:
        self._follower.effector = one_of(effector, "pEffector", EFFECTORS)

    def getRelativePosition(self) -> list[float]:
        relative = self._follower.approach.relative
        return [relative.x, relative.y, relative.yaw, *relative.tolerances]

    def setRelativePosition(self, target: Any) -> None:
        """[x, y, wz, tolerance of x, of y, of wz], m and rad: of the robot as seen from the target."""
        listed = list(target) if isinstance(target, (list, tuple)) else []
        if len(listed) == 1 and isinstance(listed[0], (list, tuple)):
            listed = list(listed[0])  # documented as a list of one list, too
        if len(listed) not in (3, 6):
            raise BadValue("target", target, "[x, y, wz] or [x, y, wz, tolerance x, y, wz]")
        x, y, yaw, *tolerances = (number(v, "target", -10.0, 10.0) for v in listed)
        for tolerance in tolerances:
            number(tolerance, "tolerance", 0.01, 10.0)
        given = tuple(tolerances) or Relative().tolerances
        self._follower.approach.relative = Relative(x, y, yaw, given)

    def getMoveConfig(self) -> list:
        return self._move_config

    def setMoveConfig(self, config: Any) -> None:
        self._follower.approach.gait = gait_of(config)
        given = dict(config)
        self._move_config = [[name, given.get(name, value)] for name, value in gait_list("Default")]

    def getTimeOut(self) -> int:
        return round(1000.0 * self._tracking.timeout)

    def setTimeOut(self, milliseconds: int) -> None:
        self._tracking.timeout = number(milliseconds, "pTimeMs", 0.0, 3.6e6) / 1000.0

    def getMaximumDistanceDetection(self) -> float:
        return self._tracking.max_distance

    def setMaximumDistanceDetection(self, distance: float) -> None:
        self._tracking.max_distance = number(distance, "pMaxDistance", 0.0, 100.0)

    def getMaximumVelocity(self) -> float:
        return self._follower.velocity

    def setMaximumVelocity(self, velocity: float) -> None:
        self._follower.velocity = number(velocity, "pVelocity", 0.01, 10.0)

    def getMaximumAcceleration(self) -> float:
        return self._follower.head.acceleration

    def setMaximumAcceleration(self, acceleration: float) -> None:
        self._follower.head.acceleration = number(acceleration, "pAcceleration", 0.01, 1000.0)

    def getExtractorPeriod(self, target: str) -> int:
        return self._tracking.periods[_known(target)]

    def setExtractorPeriod(self, target: str, period: int) -> Task:
        checked, name = whole_number(period, "pPeriod", FASTEST_PERIOD, SLOWEST_PERIOD), _known(target)
        return self._runner.execute(lambda: self._tracking.set_period(name, checked), "setExtractorPeriod")

    def isSearchEnabled(self) -> bool:
        return self._tracking.searches

    def toggleSearch(self, search: bool) -> None:
        self._tracking.searches = bool(search)

    def getSearchFractionMaxSpeed(self) -> float:
        return self._follower.search_share

    def setSearchFractionMaxSpeed(self, fraction: float) -> None:
        self._follower.search_share = number(fraction, "pFractionMaxSpeed", 0.01, 1.0)

    def initialize(self) -> Task:
        """All parameters as they were at the start; nothing is tracked, nothing is registered."""

        def reset() -> None:
            self._tracking.stop()
            self._tracking.timeout, self._tracking.max_distance = DEFAULT_TIMEOUT, DEFAULT_DISTANCE
            self._tracking.searches = False
            self._tracking.periods.update({name: target.period for name, target in TARGETS.items()})
            follower = self._follower
            follower.mode, follower.effector = Mode.HEAD, "None"
            follower.velocity, follower.head.acceleration = DEFAULT_VELOCITY, DEFAULT_ACCELERATION
            follower.search_share = DEFAULT_SEARCH
            follower.approach.relative, follower.approach.gait = Relative(), gait_of()
            self._registered.clear()
            self._move_config = gait_list("Default")

        return self._runner.execute(reset, "initialize")

    def removeEffector(self, effector: str) -> None:
        if one_of(effector, "pEffector", EFFECTORS) == self.getEffector():
            self._follower.effector = "None"

    # --- older names ----------------------------------------------------------------------------------------------

    addTarget = registerTarget
    removeTarget = unregisterTarget
    removeTargets = unregisterTargets
    removeAllTargets = unregisterAllTargets
    getManagedTargets = getRegisteredTargets
    getTargetNames = getSupportedTargets
    addEffector = setEffector

    def _check_registered(self, target: str) -> None:
        if _known(target) not in self._registered:
            registered = ", ".join(self._registered) or "none"
            raise NaoqiError(f"{target} is not registered, call registerTarget before; registered is {registered}")


def _known(target: str) -> str:
    return known(target, "target", TARGETS)
