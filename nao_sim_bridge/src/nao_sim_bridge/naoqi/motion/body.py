"""Part of ALMotion: what joints there are, their limits, and the robot's make."""

from __future__ import annotations

from nao_sim_bridge.model.robot_model import joint_names
from nao_sim_bridge.naoqi.motion.part import MotionPart
from nao_sim_bridge.naoqi.motion.summary import summary_table


class Body(MotionPart):
    """Names, limits, configuration, summary."""

    def getBodyNames(self, name: str) -> list[str]:
        if name == "Chains":
            return list(self._model.chain_names)
        if name in self._model.chains:
            return list(self._model.chains[name])
        return joint_names(name, self._model)

    def getJointNames(self, name: str) -> list[str]:
        return self.getBodyNames(name)

    def getLimits(self, name: str) -> list[list[float]]:
        joints = [self._model.joint(n) for n in joint_names(name, self._model)]
        return [[j.lower, j.upper, j.max_velocity, j.max_torque] for j in joints]

    def getMotionCycleTime(self) -> int:
        return round(1000.0 * self._simulation.settings.tick_s)

    def getRobotConfig(self) -> list:
        version = {"V6": "VERSION_60", "V5": "VERSION_50"}[self._simulation.scene.version]
        values = {
            "Model Type": "naoH25",
            "Head Version": version,
            "Body Version": version,
            "Laser": False,
            "Extended Arms": True,
            "Number of Legs": 2,
            "Number of Arms": 2,
            "Number of Hands": 2,
        }
        return [list(values), list(values.values())]

    def getSummary(self) -> str:
        return summary_table(self._model, self._runner.snapshot)
