"""Part of ALMotion: joints that follow timed Bezier curves, as timelines are exported."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.bezier import BezierCurve
from nao_sim_bridge.naoqi.motion.bezier_arguments import bezier_curve, bezier_key_points
from nao_sim_bridge.naoqi.motion.part import MotionPart


class Bezier(MotionPart):
    """Bezier interpolations."""

    def angleInterpolationBezier(self, names: Any, times: Any, points: Any) -> Task:
        return self._play("angleInterpolationBezier", names, times, points, True)

    def animation(self, names: Any, times: Any, points: Any, is_absolute: bool, supports: Any) -> Task:
        if supports:
            raise BadValue("supportSequence", supports, "an empty list: both feet stay on the ground")
        return self._play("animation", names, times, points, is_absolute)

    def _play(self, call: str, names: Any, times: Any, points: Any, is_absolute: bool) -> Task:
        indices = self._indices(names)
        key_points = bezier_key_points(len(indices), times, points)

        def curves(commands: Sequence[float]) -> dict[int, BezierCurve]:
            return {i: bezier_curve(commands[i], points, is_absolute) for i, points in zip(indices, key_points)}

        return self._follow(call, indices, curves)
