"""What plays behaviours and animations put together."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.behaviors.player import BehaviorPlayer
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.behaviors import animation_player, behavior_manager, frame_manager
from nao_sim_bridge.naoqi.behaviors.animation_player import ALAnimationPlayer
from nao_sim_bridge.naoqi.behaviors.behavior_manager import ALBehaviorManager
from nao_sim_bridge.naoqi.behaviors.frame_manager import ALFrameManager
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.body.posture import ALRobotPosture
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.sound.wiring import SpeechModules


class BehaviorModules:
    """ALBehaviorManager, ALAnimationPlayer and ALFrameManager of one robot."""

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
        return {
            behavior_manager.NAME: [self._manager],
            animation_player.NAME: [self._animations],
            frame_manager.NAME: [self._frames],
        }
