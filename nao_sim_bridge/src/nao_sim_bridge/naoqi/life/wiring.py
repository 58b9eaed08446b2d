"""Autonomous life, awareness and tracking put together: they share the robot's head."""

from __future__ import annotations

from typing import Any, Sequence

from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.binding.background import ModuleCalls
from nao_sim_bridge.naoqi.binding.later import Later, later
from nao_sim_bridge.naoqi.body.posture import ALRobotPosture
from nao_sim_bridge.naoqi.life import abilities as ability_names
from nao_sim_bridge.naoqi.life import autonomous_life, awareness, movements
from nao_sim_bridge.naoqi.life.abilities import Abilities
from nao_sim_bridge.naoqi.life.autonomous_life import ALAutonomousLife
from nao_sim_bridge.naoqi.life.awareness import Awareness
from nao_sim_bridge.naoqi.life.basic_awareness import ALBasicAwareness
from nao_sim_bridge.naoqi.life.launchpad import Launchpad
from nao_sim_bridge.naoqi.life.life import Life
from nao_sim_bridge.naoqi.life.movements import (
    ALAutonomousMoves,
    BackgroundMovement,
    Blinking,
    ListeningMovement,
    SpeakingMovement,
)
from nao_sim_bridge.naoqi.life.safeguards import Safeguards
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import Wake
from nao_sim_bridge.naoqi.sound.wiring import SpeechModules
from nao_sim_bridge.naoqi.system.time_zone import TimeZone
from nao_sim_bridge.naoqi.tracker import tracking
from nao_sim_bridge.naoqi.tracker.looking import Looking
from nao_sim_bridge.naoqi.tracker.tracker import ALTracker
from nao_sim_bridge.naoqi.tracker.tracking import Tracking

STAND, STAND_SPEED = "Stand", 0.8
OLDER_TRACKERS = {"ALRedBallTracker": ("RedBall", 0.06), "ALFaceTracker": ("Face", 0.15)}
"""The target of each module, and its size where a client does not say it, m."""


class LifeModules:
    """ALAutonomousLife, its abilities' modules, ALAutonomousMoves, ALTracker and the older trackers of one robot."""

    def __init__(
        self,
        runner: RobotRunner,
        memory: MemoryStore,
        broker: Any,
        speech: SpeechModules,
        posture: ALRobotPosture,
        running: RunningBehaviors,
        zone: TimeZone,
    ) -> None:
        simulation = runner.simulation
        self._calls = ModuleCalls(broker, released=lambda: simulation.wake())
        simulation.holds.append(self._calls.holds)
        wake = Wake(runner, memory)
        self._tracking = Tracking(runner, memory, self._calls)
        self._awareness = Awareness(runner, memory, self._calls, lambda: bool(self._tracking.active))
        background = BackgroundMovement(simulation)
        listening = ListeningMovement(runner, memory, speech.animator)
        speaking = SpeakingMovement(
            speech.speaker, speech.animator, speech.library, speech.body_language, simulation.scene.seed
        )
        abilities = Abilities(
            {
                ability_names.BLINKING: Blinking(simulation).switch,
                ability_names.BACKGROUND: background.switch,
                ability_names.AWARENESS: self._be_aware,
                ability_names.LISTENING: listening.switch,
                ability_names.SPEAKING: speaking.switch,
            }
        )
        self._life = Life(
            simulation,
            running,
            memory,
            abilities,
            wake.wakeUp,
            lambda: posture.goToPosture(STAND, STAND_SPEED),
        )
        launchpad = Launchpad(simulation, self._life, memory, lambda: self._awareness.human, zone)
        safeguards = Safeguards(self._life, runner, memory, wake.rest)
        tracker = ALTracker(self._tracking, runner)

        def ability(kind: str, *arguments: Any) -> Later:
            return later(f"naoqi.life.ability_modules:{kind}", abilities, runner, *arguments)

        def older_tracker(target: str, size: float) -> Later:
            return later("naoqi.tracker.older_trackers:OlderTracker", target, size, tracker)

        self.modules: dict[str, Sequence[Any]] = {
            autonomous_life.NAME: [
                ALAutonomousLife(self._life, running.installed, self._awareness.stimuli, runner),
                self._life.record,
                self._life.abilities,
                launchpad,
                safeguards,
            ],
            movements.NAME: [ALAutonomousMoves(background, listening, runner)],
            "ALAutonomousBlinking": ability("AbilityModule", ability_names.BLINKING),
            "ALBackgroundMovement": ability("MovementModule", ability_names.BACKGROUND, background),
            "ALListeningMovement": ability("MovementModule", ability_names.LISTENING, listening),
            "ALSpeakingMovement": ability("ALSpeakingMovement", speaking, speech.body_language, speech.library),
            awareness.NAME: [ALBasicAwareness(self._awareness, runner)],
            tracking.NAME: [tracker, Looking(self._tracking, runner)],
            **{module: older_tracker(*target) for module, target in OLDER_TRACKERS.items()},
        }

    def close(self) -> None:
        """Ask nothing of other modules any more; blocking."""
        self._calls.close()

    def _be_aware(self, aware: bool) -> None:
        self._awareness.enabled = aware
        self._awareness.update()
