"""Part of ALMotion: how hard the motors hold."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.model.robot_model import joint_names
from nao_sim_bridge.naoqi.binding.arguments import number, per_item
from nao_sim_bridge.naoqi.motion.arguments import key_frames
from nao_sim_bridge.naoqi.motion.part import MotionPart


class Stiffness(MotionPart):
    """Stiffness of joints, at once and over time."""

    def getStiffnesses(self, names: Any) -> list[float]:
        stiffnesses = self._robot.joints.stiffnesses
        return [stiffnesses[self._model.joint_index[n]] for n in joint_names(names, self._model)]

    def setStiffnesses(self, names: Any, stiffnesses: Any) -> Task:
        indices = self._indices(names)
        values = dict(zip(indices, per_item(stiffnesses, len(indices), "stiffnesses", 0.0, 1.0)))

        def stiffen() -> None:
            self._hold_limp(indices)
            self._robot.motion.set_stiffness_now(values)

        return self._runner.execute(stiffen, "setStiffnesses")

    def stiffnessInterpolation(self, names: Any, stiffnesses: Any, times: Any) -> Task:
        indices = self._indices(names)
        frames = key_frames(len(indices), stiffnesses, times, "stiffnessLists")
        for _, values in frames:
            for value in values:
                number(value, "stiffnessLists", 0.0, 1.0)

        def curves(now: Sequence[float]) -> dict[int, SmoothCurve]:
            return {i: SmoothCurve((0.0, *at), (now[i], *values)) for i, (at, values) in zip(indices, frames)}

        def start() -> Task:
            self._hold_limp(indices)
            return self._robot.motion.stiffen("stiffnessInterpolation", indices, curves)

        return self._runner.execute(start, "stiffnessInterpolation")
