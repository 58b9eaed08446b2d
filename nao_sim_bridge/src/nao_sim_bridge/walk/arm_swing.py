"""Arms that swing against the legs while the robot walks, unless somebody else moves them."""

from __future__ import annotations

from typing import AbstractSet, Callable, Mapping, Sequence

from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.control.joints.engine import IdleMotion
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.gait import parameters
from nao_sim_bridge.walk.settings import WalkSettings

ARMS = ("LArm", "RArm")
# Around this posture arms swing; hands stay as they are.
POSTURE = "StandInit"


class ArmSwing:
    """Moves the shoulders of one robot's arms.

    Attributes:
        enabled: Name of each arm to whether it may swing.

    Args:
        stride: How far the left foot is ahead of the right one, m; None while the robot does not walk.
    """

    def __init__(
        self, model: RobotModel, joints: JointCommands, settings: WalkSettings, stride: Callable[[], float | None]
    ) -> None:
        self.enabled = dict.fromkeys(ARMS, True)
        self._joints = joints
        self._settings = settings
        self._stride = stride
        self._beneath: IdleMotion | None = None
        self._longest = parameters()["MaxStepX"].default
        home = posture(model, POSTURE)
        self._homes: Mapping[str, Mapping[int, float]] = {
            arm: {
                model.joint_index[name]: home[model.joint_index[name]]
                for name in model.chains[arm]
                if not model.joint(name).is_hand
            }
            for arm in ARMS
        }
        self._shoulders = {arm: model.joint_index[f"{arm[0]}ShoulderPitch"] for arm in ARMS}
        # Arm to where it joined the swing, and how far it has joined in, 0..1.
        self._from: dict[str, tuple[Sequence[float], float]] = {}

    @property
    def alone(self) -> bool:
        """Whether both arms do nothing but swing: there they come close to nothing."""
        return len(self._from) == len(ARMS) and all(joined >= 1.0 for _, joined in self._from.values())

    def over(self, others: IdleMotion | None) -> ArmSwing:
        """This swing, and beneath it what else moves idle joints."""
        self._beneath = others
        return self

    def wishes(self, busy: AbstractSet[int], dt: float) -> dict[int, float]:
        """Where arms go at a tick of `dt` s, rad by index; none of `busy`, which somebody else moves."""
        wanted: dict[int, float] = {}
        if self._beneath is not None:
            wanted.update(self._beneath.wishes(busy, dt))
        stride = self._stride()
        if stride is None:
            self._from.clear()
            return wanted
        for arm, home in self._homes.items():
            if not self.enabled[arm] or not busy.isdisjoint(home) or not self._stiff(home):
                self._from.pop(arm, None)
                continue
            begin, joined = self._from.get(arm, (self._joints.commands, 0.0))
            joined = min(joined + dt / self._settings.arm_ease, 1.0)
            self._from[arm] = (begin, joined)
            share = joined * joined * (3.0 - 2.0 * joined)
            wanted.update({i: begin[i] + share * (angle - begin[i]) for i, angle in home.items()})
            ahead = stride if arm == ARMS[0] else -stride
            wanted[self._shoulders[arm]] += share * self._settings.arm_swing * ahead / self._longest
        return wanted

    def _stiff(self, home: Mapping[int, float]) -> bool:
        stiffnesses = self._joints.stiffnesses
        return all(stiffnesses[i] for i in home)
