"""Motion functions for stiffness, waking up and resting."""

from __future__ import annotations

from collections.abc import Sequence

from ..base.errors import BadGoal
from ..base.field_checks import KEY_FRAMES, require_length
from ..functions.chain import checked_by
from .base import MotionBase
from .facts import BODY, one_each
from .fields import Joints, KeyStiffnesses, Stiffnesses, Times
from .plan import POSTURE_TIME


def check_stiffnesses(self: MotionBase, names: Sequence[str], angles: Sequence[float]) -> None:
    """Known joints, stiffnesses for all or one each."""
    joints = self.plan.facts.joints(names)
    self.plan.set_stiffness(dict(zip(joints, one_each(angles, joints, "angles"))))


def check_stiffness_interpolation(
    self: MotionBase, names: Sequence[str], angles: Sequence[float], times: Sequence[float]
) -> None:
    """Known joints, one stiffness a time."""
    if len(angles) != len(times):
        raise BadGoal("angles", list(angles), f"{len(times)}, one a time, the same for all joints")
    joints = self.plan.facts.joints(names)
    require_length("times", len(times) * len(joints), KEY_FRAMES)
    self.plan.set_stiffness(dict.fromkeys(joints, angles[-1]))
    self.plan.takes(times[-1])


def check_stiffness_names(self: MotionBase, names: Sequence[str]) -> None:
    """Known joints, at least one."""
    self.plan.facts.joints(names)


def check_wake_up(self: MotionBase) -> None:
    """A robot that is fit; everything is stiff afterwards."""
    self.plan.require_fit_legs()
    _check_stand(self)


def _check_stand(self: MotionBase) -> None:
    body = list(self.plan.facts.chains[BODY])
    self.plan.set_stiffness(dict.fromkeys(body, 1.0))
    self.plan.forget(body)
    self.plan.touch(body)
    self.plan.takes(POSTURE_TIME)
    self.plan.walk.stands()


def check_rest(self: MotionBase) -> None:
    """Everything is limp afterwards."""
    _check_stand(self)
    self.plan.set_stiffness(dict.fromkeys(self.plan.facts.chains[BODY], 0.0))


class StiffnessFunctions(MotionBase):
    """Functions of ALMotion for stiffness. Parameters are fields of MotionFunction."""

    @checked_by(check_wake_up)
    def wake_up(self) -> None:
        """Switch the motors on; a robot on its feet stands up."""
        self.motion("wakeUp")

    @checked_by(check_rest)
    def rest(self) -> None:
        """Go to a safe posture and switch the motors off."""
        self.motion("rest")

    def robot_is_wake_up(self) -> bool:
        """Whether the robot is awake."""
        return bool(self.motion("robotIsWakeUp"))

    @checked_by(check_stiffnesses)
    def set_stiffnesses(self, names: Joints, angles: Stiffnesses) -> None:
        """Make joints and chains stiff (1) or limp (0) at once."""
        joints = self.joints(names)
        self.motion("setStiffnesses", joints, one_each(angles, joints, "angles"))

    @checked_by(check_stiffness_names)
    def get_stiffnesses(self, names: Joints) -> list[float]:
        """Stiffnesses of joints and chains, 0..1."""
        return list(self.motion("getStiffnesses", self.joints(names)))

    @checked_by(check_stiffness_interpolation)
    def stiffness_interpolation(self, names: Joints, angles: KeyStiffnesses, times: Times) -> None:
        """Change stiffness along key values at given times, and wait for the end."""
        joints = self.joints(names)
        count = len(joints)
        self.motion("stiffnessInterpolation", joints, [list(angles)] * count, [list(times)] * count)

    functions = {
        "wakeUp": wake_up,
        "rest": rest,
        "robotIsWakeUp": robot_is_wake_up,
        "setStiffnesses": set_stiffnesses,
        "getStiffnesses": get_stiffnesses,
        "stiffnessInterpolation": stiffness_interpolation,
    }
