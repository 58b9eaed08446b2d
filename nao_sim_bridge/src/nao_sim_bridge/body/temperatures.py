"""Which devices of the robot are hot, and how badly, from the temperatures of a snapshot. Without state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping, Tuple

from nao_sim_bridge.base.settings import HeadSettings
from nao_sim_bridge.body import faults
from nao_sim_bridge.body.sensors.heat import AT_LIMIT, CRITICAL, HOT, NORMAL, VERY_HOT, heat_status
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.robot_model import RobotModel

HEAD, BATTERY = "Head", "Battery"
# Severity of a motor's failure by its status.
SEVERITY = {AT_LIMIT: faults.NEGLIGIBLE, VERY_HOT: faults.SERIOUS, CRITICAL: faults.CRITICAL}
CHAINS = ("Head", "LArm", "LLeg", "RLeg", "RArm")


@dataclass(frozen=True)
class Hot:
    """Hot devices.

    Attributes:
        devices: Device to status, 1 (at limit) to 3 (critical); joints by their names, `Head`, `Battery`.
        joints: Those that are joints, in the order of the body.
        severity: Of the worst motor, 0..2.
        chains: The chains with motors of that severity.
    """

    devices: Mapping[str, int]
    joints: Tuple[str, ...]
    severity: int
    chains: Tuple[str, ...]

    @property
    def status(self) -> Tuple[int, Tuple[str, ...]]:
        """Worst status, and who has it; 0 and nobody when nothing is hot."""
        worst = max(self.devices.values(), default=NORMAL)
        return worst, tuple(name for name, status in self.devices.items() if status == worst)


NOTHING_HOT = Hot({}, (), faults.NEGLIGIBLE, ())


def hot_devices(model: RobotModel, limits: HeadSettings, snapshot: Snapshot) -> Hot:
    """What is hot now; `limits` are those of the computer in the head."""
    head, hot_battery = snapshot.head_temperature, snapshot.battery.hot
    if max(snapshot.temperatures) < HOT[0] and head < limits.hot_c and not hot_battery:
        return NOTHING_HOT
    joints = {
        joint.name: status
        for joint, status in zip(model.joints, map(heat_status, snapshot.temperatures))
        if status != NORMAL
    }
    devices = dict(joints)
    if head >= limits.hot_c:
        devices[HEAD] = CRITICAL if head >= limits.critical_c else AT_LIMIT
    if hot_battery:
        devices[BATTERY] = AT_LIMIT
    if not joints:
        return Hot(devices, (), faults.NEGLIGIBLE, ())
    worst = max(joints.values())
    chains = [name for name in CHAINS if any(joints.get(joint) == worst for joint in model.chains[name])]
    return Hot(devices, tuple(joints), SEVERITY[worst], tuple(chains))
