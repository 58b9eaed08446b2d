"""The modules about the robot's own body, put together: how it is, and what it feels."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.robot_runner import RobotRunner
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
    """Modules that tell how the robot is, and what raises their events.

    Attributes:
        power: ALBattery.
        temperature: ALBodyTemperature.
    """

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._simulation = simulation = runner.simulation
        self._memory = memory
        self._touch = touch.ALTouch(simulation.model, memory)
        self._sonar = sonar.ALSonar(runner, memory)
        gestures, stiffness = tactile_gesture.ALTactileGesture(memory), sensors.ALSensors(runner, memory)
        self.power = battery.ALBattery(runner, memory)
        self.temperature = body_temperature.ALBodyTemperature(runner, memory)
        failures = diagnosis.ALDiagnosis(simulation, memory)
        pose = posture.ALRobotPose(runner)
        self._watchers = [
            posture.PostureEvents(simulation.model, memory),
            motion_events.FallEvents(simulation, memory),
            touch.FootEvents(memory),
            self._touch,
            gestures,
            stiffness,
            self._sonar,
            motion_events.DiagnosisEvents(simulation, memory),
            self.power,
            self.temperature,
            failures,
            motion_events.PushEvents(simulation, memory),
            pose,
        ]
        self.modules: dict[str, list[Any]] = {
            touch.TOUCH: [self._touch],
            tactile_gesture.NAME: [gestures],
            touch.CHEST: [touch.EventsOnly()],
            touch.FEET: [touch.EventsOnly()],
            sensors.NAME: stiffness.parts(),
            sonar.NAME: self._sonar.parts(),
            battery.NAME: [self.power],
            body_temperature.NAME: [self.temperature],
            diagnosis.NAME: [failures],
            robot_model.NAME: [robot_model.ALRobotModel(simulation.model.version)],
            posture.POSE: [pose],
            dcm.NAME: [dcm.DCM(runner, memory)],
        }

    def begin(self) -> None:
        """Look at the robot after each tick from now on; before time passes."""
        self._memory.add_live(sonar.sonar_keys(self._sonar))
        self._simulation.after_tick += self._watchers
        self._simulation.after_reset.append(self._touch.forget)
