"""The modules about the robot's own body, put together: how it is, and what it feels."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.body import (
    battery,
    body_temperature,
    dcm,
    diagnosis,
    motion_events,
    posture,
    robot_model,
    sensors,
    sonar,
    tactile_gesture,
    touch,
)
from nao_sim_bridge.naoqi.memory.store import MemoryStore


class BodyModules:
    """Modules that tell how the robot is, and what raises their events."""

    def __init__(self, simulation: Simulation, runner: SimulationRunner, memory: MemoryStore) -> None:
        self._simulation = simulation
        self._memory = memory
        self._touch = touch.ALTouch(simulation.model, memory)
        self._gestures = tactile_gesture.ALTactileGesture(memory)
        self._sensors = sensors.ALSensors(runner, memory)
        self._sonar = sonar.ALSonar(simulation, runner, memory)
        self._battery = battery.ALBattery(runner, memory)
        self._temperature = body_temperature.ALBodyTemperature(simulation, runner, memory)
        self._diagnosis = diagnosis.ALDiagnosis(simulation, memory)
        self._pushes = motion_events.PushEvents(simulation, memory)
        self._pose = posture.ALRobotPose(runner, simulation.model)
        self._dcm = dcm.DCM(simulation, runner, memory)

    def begin(self) -> None:
        """Look at the robot after each tick from now on; before time passes."""
        simulation, memory = self._simulation, self._memory
        memory.add_live(sonar.sonar_keys(self._sonar))
        simulation.after_tick += [
            posture.PostureEvents(simulation.model, memory),
            motion_events.FallEvents(simulation, memory),
            touch.FootEvents(memory),
            self._touch,
            self._gestures,
            self._sensors,
            self._sonar,
            motion_events.DiagnosisEvents(simulation, memory),
            self._battery,
            self._temperature,
            self._diagnosis,
            self._pushes,
            self._pose,
        ]
        simulation.after_reset.append(self._touch.forget)

    def modules(self) -> dict[str, list[Any]]:
        """The objects that together have the methods of each module."""
        return {
            touch.TOUCH: [self._touch],
            tactile_gesture.NAME: [self._gestures],
            touch.CHEST: [touch.EventsOnly()],
            touch.FEET: [touch.EventsOnly()],
            sensors.NAME: self._sensors.parts(),
            sonar.NAME: self._sonar.parts(),
            battery.NAME: [self._battery],
            body_temperature.NAME: [self._temperature],
            diagnosis.NAME: [self._diagnosis],
            robot_model.NAME: [robot_model.ALRobotModel(self._simulation.model.version)],
            posture.POSE: [self._pose],
            dcm.NAME: [self._dcm],
        }
