"""Motion functions for predefined postures (ALRobotPosture)."""

from __future__ import annotations

from typing import Any

from naoqi.errors import NaoError

from ..base.field_checks import require_known
from ..base.once_per_connection import OncePerConnection
from ..functions.chain import checked_by
from .body import POSTURES, BodyPart, RobotBody
from .facts import BODY
from .fields import POSTURE_SPEED, Posture, PostureSpeed, Stiffness, Tries
from .plan import POSTURE_TIME


class PostureFunctions(BodyPart):
    def __init__(self, body: RobotBody, robot: Any) -> None:
        super().__init__(body)
        self._known = OncePerConnection(robot, lambda: list(body.call(POSTURES, "getPostureList")))

    def _check_posture(self, str_param: str, speed: float) -> None:
        name = require_known("str_param", str_param, self._known(), "posture")
        self.body.plan.require_fit_legs()
        self.body.plan.change_posture(POSTURE_TIME / (speed or POSTURE_SPEED), name)

    def _check_applied(self, str_param: str, speed: float, stiffness: float) -> None:
        self.body.plan.require_stiff(list(self.body.facts.chains[BODY]), stiffness)
        self._check_posture(str_param, speed)

    @checked_by(_check_posture)
    def go_to_posture(self, str_param: Posture, speed: PostureSpeed) -> None:
        """Go to a posture from wherever the robot is, getting up if need be; awake afterwards."""
        self._reach("goToPosture", str_param.strip(), speed)

    @checked_by(_check_applied)
    def apply_posture(self, str_param: Posture, speed: PostureSpeed, stiffness: Stiffness) -> None:
        """Take the angles of a posture straight away; the robot may fall."""
        self.body.stiffen(list(self.body.facts.chains[BODY]), stiffness)
        self._reach("applyPosture", str_param.strip(), speed)

    def get_posture(self) -> str:
        """Name of the posture that the robot is in, or Unknown."""
        return str(self._postures("getPosture"))

    def get_posture_family(self) -> str:
        """Family of the posture that the robot is in: Standing, Sitting, LyingBelly, ..."""
        return str(self._postures("getPostureFamily"))

    def get_posture_list(self) -> list[str]:
        """Postures that goToPosture knows."""
        return self._known()

    def get_posture_family_list(self) -> list[str]:
        """Families that getPostureFamily tells apart."""
        return list(self._postures("getPostureFamilyList"))

    def set_max_try_number(self, values: Tries) -> None:
        """How often goToPosture tries before it gives up."""
        self._postures("setMaxTryNumber", int(values[0]))

    def _reach(self, method: str, posture: str, speed: float) -> None:
        if not self._postures(method, posture, speed or POSTURE_SPEED):
            now, family = self.get_posture(), self.get_posture_family()
            raise NaoError(f"the robot did not reach {posture}: it is in posture {now} of the family {family}")

    def _postures(self, method: str, *args: Any) -> Any:
        return self.body.call(POSTURES, method, *args)

    functions = {
        "goToPosture": go_to_posture,
        "applyPosture": apply_posture,
        "getPosture": get_posture,
        "getPostureFamily": get_posture_family,
        "getPostureList": get_posture_list,
        "getPostureFamilyList": get_posture_family_list,
        "setMaxTryNumber": set_max_try_number,
    }
