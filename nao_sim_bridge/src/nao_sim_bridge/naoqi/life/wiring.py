"""Autonomous life, awareness and tracking put together: they share the robot's head."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.binding.background import ModuleCalls
from nao_sim_bridge.naoqi.body.posture import ALRobotPosture
from nao_sim_bridge.naoqi.life import abilities as ability_names
from nao_sim_bridge.naoqi.life import autonomous_life, autonomous_moves, awareness
from nao_sim_bridge.naoqi.life.abilities import Abilities, Ability
from nao_sim_bridge.naoqi.life.autonomous_life import ALAutonomousLife
from nao_sim_bridge.naoqi.life.autonomous_moves import ALAutonomousMoves
from nao_sim_bridge.naoqi.life.awareness import Awareness
from nao_sim_bridge.naoqi.life.basic_awareness import ALBasicAwareness
from nao_sim_bridge.naoqi.life.blinking import Blinking
from nao_sim_bridge.naoqi.life.launchpad import Launchpad
from nao_sim_bridge.naoqi.life.life import Life
from nao_sim_bridge.naoqi.life.movements import BackgroundMovement, ListeningMovement, SpeakingMovement
from nao_sim_bridge.naoqi.life.safeguards import Safeguards
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import Wake
from nao_sim_bridge.naoqi.sound.speech_wiring import SpeechModules
from nao_sim_bridge.naoqi.system.time_zone import TimeZone
from nao_sim_bridge.naoqi.tracker import tracking
from nao_sim_bridge.naoqi.tracker.looking import Looking
from nao_sim_bridge.naoqi.tracker.tracker import ALTracker
from nao_sim_bridge.naoqi.tracker.tracking import Tracking

STAND, STAND_SPEED = "Stand", 0.8


class LifeModules:
    """ALAutonomousLife, ALAutonomousMoves, ALBasicAwareness and ALTracker of one robot.

    Args:
        simulation: Whose robot it is.
        runner: Its thread.
        memory: Where events come from and go to.
        broker: Finds the modules that see and hear.
        speech: The robot's voice and gestures.
        posture: Takes the robot to postures.
        running: Starts and stops behaviours.
        zone: What the robot's clock shows.
    """

    def __init__(
        self,
        simulation: Simulation,
        runner: SimulationRunner,
        memory: MemoryStore,
        broker: Any,
        speech: SpeechModules,
        posture: ALRobotPosture,
        running: RunningBehaviors,
        zone: TimeZone,
    ) -> None:
        self._calls = ModuleCalls(broker, released=lambda: simulation.wake())
        simulation.holds.append(self._calls.holds)
        wake = Wake(simulation, runner, memory)
        self._tracking = Tracking(simulation, runner, memory, self._calls)
        self._awareness = Awareness(simulation, runner, memory, self._calls, lambda: bool(self._tracking.active))
        background = BackgroundMovement(simulation)
        listening = ListeningMovement(simulation, runner, memory, speech.animator)
        speaking = SpeakingMovement(speech.speaker, speech.animator, speech.library, simulation.scene.seed)
        blinking = Blinking(simulation)
        self._life = Life(
            simulation,
            running,
            memory,
            Abilities(
                {
                    ability_names.BLINKING: Ability(blinking.start, blinking.stop),
                    ability_names.BACKGROUND: Ability(background.start, background.stop),
                    ability_names.AWARENESS: Ability(lambda: self._be_aware(True), lambda: self._be_aware(False)),
                    ability_names.LISTENING: Ability(listening.start, listening.stop),
                    ability_names.SPEAKING: Ability(speaking.start, speaking.stop),
                }
            ),
            wake.wakeUp,
            lambda: posture.goToPosture(STAND, STAND_SPEED),
        )
        launchpad = Launchpad(simulation, self._life, memory, lambda: self._awareness.human, zone)
        safeguards = Safeguards(self._life, runner, memory, wake.rest)
        self._modules: dict[str, list[Any]] = {
            autonomous_life.NAME: [
                ALAutonomousLife(self._life, safeguards, launchpad, running.installed, self._awareness.stimuli, runner)
            ],
            autonomous_moves.NAME: [ALAutonomousMoves(background, listening, runner)],
            awareness.NAME: [ALBasicAwareness(self._awareness, runner)],
            tracking.NAME: [ALTracker(self._tracking, runner), Looking(self._tracking, simulation, runner)],
        }

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `Service` wants them."""
        return dict(self._modules)

    def close(self) -> None:
        """Ask nothing of other modules any more; blocking."""
        self._calls.close()

    def _be_aware(self, aware: bool) -> None:
        self._awareness.enabled = aware
        self._awareness.update()
