"""Motion functions for predefined postures (ALRobotPosture)."""

from __future__ import annotations

from typing import Any

from naoqi.errors import NaoError

from ..base.errors import BadGoal
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from .base import MotionBase
from .facts import BODY
from .fields import POSTURE_SPEED, Posture, PostureSpeed, Stiffness, Tries
from .plan import POSTURE_TIME

POSTURES = "ALRobotPosture"


class PostureNotReached(NaoError):  # noqa: N818  named like the errors of the proxy layer
    """The robot gave up on its way to a posture.

    Attributes:
        posture: Where it should go.
        now: The posture it is in.
        family: The family of that.
    """

    def __init__(self, posture: str, now: str, family: str) -> None:
        """Compose the text."""
        super().__init__(f"the robot did not reach {posture}: it is in posture {now} of the family {family}")
        self.posture = posture
        self.now = now
        self.family = family


def check_posture(self: PostureFunctions, str_param: str, speed: float) -> None:
    """A posture that the robot knows."""
    name = str_param.strip()
    known = self.posture_names()
    if name not in known:
        raise BadGoal(
            "str_param",
            name,
            f"one of {', '.join(known)}",
            problem=f"there is no posture {name!r}{did_you_mean(name, known)}",
        )
    body = list(self.plan.facts.chains[BODY])
    self.plan.require_fit_legs()
    self.plan.set_stiffness(dict.fromkeys(body, 1.0))
    self.plan.forget(body)
    self.plan.touch(body)
    self.plan.takes(POSTURE_TIME / (speed or POSTURE_SPEED))
    self.plan.walk.stands(name)


def check_applied_posture(self: PostureFunctions, str_param: str, speed: float, stiffness: float) -> None:
    """A posture that the robot knows, stiff joints."""
    self.plan.require_stiff(list(self.plan.facts.chains[BODY]), stiffness)
    check_posture(self, str_param, speed)


class PostureFunctions(MotionBase):
    """Functions of ALRobotPosture. Parameters are fields of MotionFunction."""

    _posture_names: tuple[int, list[str]] | None = None

    def posture_names(self) -> list[str]:
        """Postures that the robot knows, asked once for each connection."""
        generation = self.robot.connection.generation
        if self._posture_names is None or self._posture_names[0] != generation:
            self._posture_names = (generation, list(self._postures("getPostureList")))
        return self._posture_names[1]

    @checked_by(check_posture)
    def go_to_posture(self, str_param: Posture, speed: PostureSpeed) -> None:
        """Go to a posture from wherever the robot is, getting up if need be; awake afterwards."""
        self._reach("goToPosture", str_param.strip(), speed)

    @checked_by(check_applied_posture)
    def apply_posture(self, str_param: Posture, speed: PostureSpeed, stiffness: Stiffness) -> None:
        """Take the angles of a posture straight away; the robot may fall."""
        self.stiffen(list(self.access.facts.chains[BODY]), stiffness)
        self._reach("applyPosture", str_param.strip(), speed)

    def get_posture(self) -> str:
        """Name of the posture that the robot is in, or Unknown."""
        return str(self._postures("getPosture"))

    def get_posture_family(self) -> str:
        """Family of the posture that the robot is in: Standing, Sitting, LyingBelly, ..."""
        return str(self._postures("getPostureFamily"))

    def get_posture_list(self) -> list[str]:
        """Postures that goToPosture knows."""
        return self.posture_names()

    def get_posture_family_list(self) -> list[str]:
        """Families that getPostureFamily tells apart."""
        return list(self._postures("getPostureFamilyList"))

    def set_max_try_number(self, values: Tries) -> None:
        """How often goToPosture tries before it gives up."""
        self._postures("setMaxTryNumber", int(values[0]))

    def _reach(self, method: str, posture: str, speed: float) -> None:
        if not self._postures(method, posture, speed or POSTURE_SPEED):
            raise PostureNotReached(posture, self.get_posture(), self.get_posture_family())

    def _postures(self, method: str, *args: Any) -> Any:
        return self.call(self.robot.proxy(POSTURES), method, *args)

    functions = {
        "goToPosture": go_to_posture,
        "applyPosture": apply_posture,
        "getPosture": get_posture,
        "getPostureFamily": get_posture_family,
        "getPostureList": get_posture_list,
        "getPostureFamilyList": get_posture_family_list,
        "setMaxTryNumber": set_max_try_number,
    }
