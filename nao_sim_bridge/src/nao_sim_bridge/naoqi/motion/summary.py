"""The table that ALMotion.getSummary prints."""

from __future__ import annotations

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.robot_model import RobotModel


def summary_table(model: RobotModel, snapshot: Snapshot) -> str:
    """One line a joint: name, stiffness, command and sensor angle (rad)."""
    head = "---------------------- Model ---------------------------"
    lines = [head, "       JointName   Stiffness     Command      Sensor"]
    for i, joint in enumerate(model.joints):
        lines.append(
            f"{joint.name:>16}    {snapshot.stiffnesses[i]:8.6f}   {snapshot.commands[i]:9.6f}   "
            f"{snapshot.positions[i]:9.6f}"
        )
    return "\n".join([*lines, "-" * len(head), ""])
