"""What of a command cannot be done as it was asked: said once for each command, with joint, wish and limit."""

from __future__ import annotations

import logging
from typing import Any, Iterable, Mapping

from nao_sim_bridge.body.joint_commands import JointCommands

log = logging.getLogger("nao_sim.motion")

# Wishes beyond a limit or a speed by less than this, rad or a share, are rounding.
SLIGHT = 1e-4


class Notices:
    """Looks at what is asked of joints before they start.

    Attributes:
        enabled: Whether what it finds is a warning; else it goes to the log as information.
    """

    def __init__(self, joints: JointCommands) -> None:
        self._joints = joints
        self.enabled = True
        # Limp joints that were told of since somebody last moved them with stiffness.
        self._limp: set[int] = set()

    def check_targets(self, name: str, targets: Mapping[int, float]) -> None:
        """Look at angles (rad by joint index) that a call sends joints to."""
        self._tell(name, self._stay(targets))
        self._tell(name, self._beyond({i: (angle, angle) for i, angle in targets.items()}, targets))

    def check_curves(self, name: str, curves: Mapping[int, Any]) -> None:
        """Look at the curves of a task; those without extremes come from who knows the limits."""
        self._tell(name, self._stay(curves))
        known = {i: curve for i, curve in curves.items() if hasattr(curve, "extremes")}
        ends = {i: curve.value(curve.duration) for i, curve in known.items()}
        self._tell(name, self._beyond({i: curve.extremes for i, curve in known.items()}, ends))
        self._tell(name, self._too_fast(known))

    def _stay(self, indices: Iterable[int]) -> Iterable[str]:
        """Joints without stiffness, which stay where they are; hands are held by their gears, and switched off."""
        joints, moved = self._joints, set(indices)
        limp = {i for i in moved if joints.stiffnesses[i] == 0.0 and not joints.names[i].endswith("Hand")}
        new = sorted(limp - self._limp)
        self._limp = self._limp - moved | limp
        if new:
            names = ", ".join(joints.names[i] for i in new[:3]) + ("..." if len(new) > 3 else "")
            yield f"no stiffness in {names}: wakeUp or setStiffnesses comes first"

    def _beyond(self, ranges: Mapping[int, tuple[float, float]], ends: Mapping[int, float]) -> Iterable[str]:
        """Joints that leave their limits on the way, or those that other joints leave them at the end."""
        joints = self._joints
        for index, wishes in ranges.items():
            lower, upper = joints.limits_alone(index)
            by = joints.coupled_by(index)
            if by is not None and min(wishes) >= lower - SLIGHT and max(wishes) <= upper + SLIGHT:
                lower, upper = joints.limits_beside(index, ends.get(by, joints.commands[by]))
                wishes = (ends[index], ends[index])
            if wishes[0] < lower - SLIGHT:
                yield f"{joints.names[index]} {wishes[0]:.3f} is below {lower:.3f}"
            if wishes[1] > upper + SLIGHT:
                yield f"{joints.names[index]} {wishes[1]:.3f} is above {upper:.3f}"

    def _too_fast(self, curves: Mapping[int, Any]) -> Iterable[str]:
        for index, curve in curves.items():
            peak, top = curve.peak_speed(), self._joints.top_speed(index)
            if peak > top * (1.0 + SLIGHT):
                least = curve.duration * peak / top
                yield (
                    f"{self._joints.names[index]} would need {peak:.2f} rad/s and has {top:.2f}, "
                    f"the motion takes {least:.2f} s at least"
                )

    def _tell(self, name: str, found: Iterable[str]) -> None:
        text = "; ".join(found)
        if text:
            log.log(logging.WARNING if self.enabled else logging.INFO, "%s: %s", name, text)
