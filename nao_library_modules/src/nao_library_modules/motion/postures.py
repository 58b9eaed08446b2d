"""Motion functions for predefined postures (ALRobotPosture)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import NaoError

from ..base.errors import BadGoal
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from .base import MotionBase
from .facts import BODY
from .plan import POSTURE_TIME, require_fraction

POSTURES = "ALRobotPosture"
# Fraction of the top speed where a message leaves it to us.
POSTURE_SPEED = 0.6
MOST_TRIES = 20


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
    """A posture that the robot knows, a fraction of speed."""
    name = str_param.strip()
    known = self.posture_names()
    if name not in known:
        raise BadGoal(
            "str_param",
            name,
            f"one of {', '.join(known)}",
            problem=f"there is no posture {name!r}{did_you_mean(name, known)}",
        )
    fraction = require_fraction("speed", speed, POSTURE_SPEED)
    body = list(self.plan.facts.chains[BODY])
    self.plan.require_fit_legs()
    self.plan.set_stiffness(dict.fromkeys(body, 1.0))
    self.plan.forget(body)
    self.plan.touch(body)
    self.plan.takes(POSTURE_TIME / fraction)
    self.plan.walk.stands(name)


def check_applied_posture(self: PostureFunctions, str_param: str, speed: float, stiffness: float) -> None:
    """A posture that the robot knows, a fraction of speed, stiff joints."""
    self.plan.require_stiff(list(self.plan.facts.chains[BODY]), stiffness)
    check_posture(self, str_param, speed)


def check_tries(_self: object, values: Sequence[float]) -> None:
    """A number of tries."""
    if len(values) != 1 or not 1 <= values[0] <= MOST_TRIES or values[0] != int(values[0]):
        raise BadGoal("values", list(values), f"one whole number from 1 to {MOST_TRIES}")


class PostureFunctions(MotionBase):
    """Functions of ALRobotPosture. Parameters are fields of MotionFunction."""

    _posture_names: tuple[int, list[str]] | None = None

    def posture_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "goToPosture": self.go_to_posture,
            "applyPosture": self.apply_posture,
            "getPosture": self.get_posture,
            "getPostureFamily": self.get_posture_family,
            "getPostureList": self.get_posture_list,
            "getPostureFamilyList": self.get_posture_family_list,
            "setMaxTryNumber": self.set_max_try_number,
        }

    def posture_names(self) -> list[str]:
        """Postures that the robot knows, asked once for each connection."""
        generation = self.robot.connection.generation
        if self._posture_names is None or self._posture_names[0] != generation:
            self._posture_names = (generation, list(self._postures("getPostureList")))
        return self._posture_names[1]

    @checked_by(check_posture)
    def go_to_posture(self, str_param: str, speed: float) -> None:
        """Go to a posture from wherever the robot is, getting up if need be; awake afterwards."""
        self._reach("goToPosture", str_param.strip(), speed)

    @checked_by(check_applied_posture)
    def apply_posture(self, str_param: str, speed: float, stiffness: float) -> None:
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

    @checked_by(check_tries)
    def set_max_try_number(self, values: Sequence[float]) -> None:
        """How often goToPosture tries before it gives up."""
        self._postures("setMaxTryNumber", int(values[0]))

    def _reach(self, method: str, posture: str, speed: float) -> None:
        if not self._postures(method, posture, speed or POSTURE_SPEED):
            raise PostureNotReached(posture, self.get_posture(), self.get_posture_family())

    def _postures(self, method: str, *args: Any) -> Any:
        return self.call(self.robot.proxy(POSTURES), method, *args)
