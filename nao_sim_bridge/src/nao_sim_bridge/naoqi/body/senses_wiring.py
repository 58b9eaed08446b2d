"""ALTouch, ALTactileGesture, ALChestButton, ALFsr, ALSensors and ALSonar, put together."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.body import sensors, sonar, tactile_gesture, touch, touch_events
from nao_sim_bridge.naoqi.body.foot_events import FootEvents
from nao_sim_bridge.naoqi.memory.store import MemoryStore


class SenseModules:
    """What feels, and what the sonars see.

    Args:
        simulation: Of the robot.
        runner: Its thread.
        memory: Where events and keys go.
    """

    def __init__(self, simulation: Simulation, runner: SimulationRunner, memory: MemoryStore) -> None:
        self._simulation = simulation
        self._runner = runner
        self._memory = memory
        self._touch = touch_events.TouchEvents(simulation.model, memory)
        self._gestures = tactile_gesture.TactileGestures(memory)
        self._stiffness = sensors.StiffnessEvents(memory)
        self._sonar = sonar.Sonar(simulation, runner, memory)

    def begin(self) -> None:
        """Look at the robot after each tick from now on."""
        self._memory.add_live(sonar.sonar_keys(self._sonar))
        self._simulation.after_tick += [
            FootEvents(self._memory),
            self._touch,
            self._gestures,
            self._stiffness,
            self._sonar,
        ]
        self._simulation.after_reset.append(self._touch.forget)

    def modules(self) -> dict[str, list[Any]]:
        """The objects that together have the methods of each module."""
        return {
            touch_events.TOUCH: [touch.ALTouch(self._touch)],
            tactile_gesture.NAME: [tactile_gesture.ALTactileGesture(self._gestures)],
            touch_events.CHEST: [touch.EventsOnly()],
            "ALFsr": [touch.EventsOnly()],
            sensors.NAME: sensors.parts(self._stiffness, self._runner, self._memory),
            sonar.NAME: sonar.parts(self._sonar, self._memory),
        }
