"""Motion functions for stiffness, waking up and resting."""

from __future__ import annotations

from collections.abc import Sequence

from ..base.errors import BadGoal
from ..base.field_checks import KEY_FRAMES, require_length
from ..functions.chain import checked_by
from .body import BodyPart
from .facts import BODY, one_each
from .fields import Joints, KeyStiffnesses, Stiffnesses, Times
from .plan import POSTURE_TIME


class StiffnessFunctions(BodyPart):
    def _check_wake_up(self) -> None:
        self.body.plan.require_fit_legs()
        self.body.plan.change_posture(POSTURE_TIME)

    @checked_by(_check_wake_up)
    def wake_up(self) -> None:
        """Switch the motors on; a robot on its feet stands up."""
        self.motion("wakeUp")

    def _check_rest(self) -> None:
        plan = self.body.plan
        plan.change_posture(POSTURE_TIME)
        plan.stiffnesses.update(dict.fromkeys(plan.facts.chains[BODY], 0.0))

    @checked_by(_check_rest)
    def rest(self) -> None:
        """Go to a safe posture and switch the motors off."""
        self.motion("rest")

    def robot_is_wake_up(self) -> bool:
        """Whether the robot is awake."""
        return bool(self.motion("robotIsWakeUp"))

    def _check_stiffnesses(self, names: Sequence[str], angles: Sequence[float]) -> None:
        joints = self.body.joints(names)
        self.body.plan.stiffnesses.update(zip(joints, one_each(angles, joints, "angles")))

    @checked_by(_check_stiffnesses)
    def set_stiffnesses(self, names: Joints, angles: Stiffnesses) -> None:
        """Make joints and chains stiff (1) or limp (0) at once."""
        joints = self.body.joints(names)
        self.motion("setStiffnesses", joints, one_each(angles, joints, "angles"))

    def _check_names(self, names: Sequence[str]) -> None:
        self.body.joints(names)

    @checked_by(_check_names)
    def get_stiffnesses(self, names: Joints) -> list[float]:
        """Stiffnesses of joints and chains, 0..1."""
        return list(self.motion("getStiffnesses", self.body.joints(names)))

    def _check_interpolation(self, names: Sequence[str], angles: Sequence[float], times: Sequence[float]) -> None:
        if len(angles) != len(times):
            raise BadGoal("angles", list(angles), f"{len(times)}, one a time, the same for all joints")
        joints = self.body.joints(names)
        require_length("times", len(times) * len(joints), KEY_FRAMES)
        self.body.plan.stiffnesses.update(dict.fromkeys(joints, angles[-1]))
        self.body.plan.takes(times[-1])

    @checked_by(_check_interpolation)
    def stiffness_interpolation(self, names: Joints, angles: KeyStiffnesses, times: Times) -> None:
        """Change stiffness along key values at given times, and wait for the end."""
        joints = self.body.joints(names)
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
