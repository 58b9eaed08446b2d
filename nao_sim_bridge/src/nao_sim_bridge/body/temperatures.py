"""Which devices of the robot are hot, how badly, and the torque that their boards leave hot motors. Without state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping, Sequence, Tuple

from nao_sim_bridge.base.settings import HeadSettings
from nao_sim_bridge.body import faults
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.robot_model import RobotModel

# Motor temperatures in degC from which the status is 1 (at limit), 2 (very hot) and 3 (critical).
HOT = (68.0, 74.0, 80.0)
NORMAL, AT_LIMIT, VERY_HOT, CRITICAL = range(4)
# Share of the torque that is left at each status: a very hot motor loses more than 30 %, a critical one all of it.
SHARES = (1.0, 1.0, 0.65, 0.0)
# Severity of a motor's failure by its status.
SEVERITY = {AT_LIMIT: faults.NEGLIGIBLE, VERY_HOT: faults.SERIOUS, CRITICAL: faults.CRITICAL}
HEAD, BATTERY = "Head", "Battery"
CHAINS = ("Head", "LArm", "LLeg", "RLeg", "RArm")


def heat_status(celsius: float) -> int:
    """Status of a motor at this temperature, 0 (regular) to 3 (critical)."""
    return sum(celsius >= limit for limit in HOT)


def heat_shares(temperatures: Sequence[float]) -> tuple[float, ...]:
    """Share of the torque that each motor has left; empty while all of them have it all."""
    if max(temperatures) < HOT[VERY_HOT - 1]:
        return ()
    return tuple(SHARES[heat_status(celsius)] for celsius in temperatures)


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
