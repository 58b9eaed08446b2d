"""What plays behaviours and animations put together."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.behaviors.player import BehaviorPlayer
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.behaviors.animation_player import NAME as ANIMATION_PLAYER
from nao_sim_bridge.naoqi.behaviors.animation_player import ALAnimationPlayer
from nao_sim_bridge.naoqi.behaviors.behavior_manager import NAME as BEHAVIOR_MANAGER
from nao_sim_bridge.naoqi.behaviors.behavior_manager import ALBehaviorManager
from nao_sim_bridge.naoqi.behaviors.frame_manager import NAME as FRAME_MANAGER
from nao_sim_bridge.naoqi.behaviors.frame_manager import ALFrameManager
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.body.posture import ALRobotPosture
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.sound.speech_wiring import SpeechModules


class BehaviorModules:
    """ALBehaviorManager, ALAnimationPlayer and ALFrameManager of one robot.

    Attributes:
        running: Starts and stops behaviours.

    Args:
        simulation: Whose robot it is.
        runner: Its thread.
        memory: Where events go.
        files: Where clients have files to install.
        speech: The robot's voice and gestures.
        posture: Takes the robot to postures.
    """

    def __init__(
        self,
        simulation: Simulation,
        runner: SimulationRunner,
        memory: MemoryStore,
        files: ClientFiles,
        speech: SpeechModules,
        posture: ALRobotPosture,
    ) -> None:
        player = BehaviorPlayer(simulation, speech.animator, speech.library, speech.say, posture.goToPosture)
        self.running = RunningBehaviors(player, InstalledBehaviors(speech.library), memory)
        self._manager = ALBehaviorManager(self.running, runner, memory, files)
        self._animations = ALAnimationPlayer(self.running, simulation, runner)
        self._frames = ALFrameManager(self.running, runner, files)

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `Service` wants them."""
        return {
            BEHAVIOR_MANAGER: [self._manager],
            ANIMATION_PLAYER: [self._animations],
            FRAME_MANAGER: [self._frames],
        }
