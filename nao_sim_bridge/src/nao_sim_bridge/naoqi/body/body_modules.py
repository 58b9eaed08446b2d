"""The modules about the robot's own body put together: battery, temperatures, diagnosis, model, pose, DCM."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.body import battery, body_temperature, dcm, diagnosis, robot_model, robot_pose
from nao_sim_bridge.naoqi.body.push_events import PushEvents
from nao_sim_bridge.naoqi.memory.store import MemoryStore


class BodyModules:
    """Modules that tell how the robot is, and what raises their events.

    Args:
        simulation: Whose body it is; touched in the simulation thread only.
        runner: That thread.
        memory: Where events go.
    """

    def __init__(self, simulation: Simulation, runner: SimulationRunner, memory: MemoryStore) -> None:
        self._simulation = simulation
        self._runner = runner
        self._battery = battery.BatteryEvents(memory)
        self._temperature = body_temperature.TemperatureEvents(simulation.model, simulation.settings.head, memory)
        self._diagnosis = diagnosis.DiagnosisResults(simulation, memory)
        self._pushes = PushEvents(simulation, memory)
        self._pose = robot_pose.PoseWatch(simulation.model)
        self._dcm = dcm.DCM(simulation, runner, memory)

    def begin(self) -> None:
        """Watch from now on; before time passes."""
        watches = (self._battery, self._temperature, self._diagnosis, self._pushes, self._pose)
        self._simulation.after_tick.extend(watches)

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name."""
        model, runner = self._simulation.model, self._runner
        return {
            battery.NAME: [battery.ALBattery(runner, self._battery)],
            body_temperature.NAME: [body_temperature.ALBodyTemperature(runner, self._temperature)],
            diagnosis.NAME: [diagnosis.ALDiagnosis(self._diagnosis)],
            robot_model.NAME: [robot_model.ALRobotModel(model.version)],
            robot_pose.NAME: [robot_pose.ALRobotPose(runner, self._pose)],
            dcm.NAME: [self._dcm],
        }
