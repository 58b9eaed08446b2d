"""All that one simulated robot is made of behind its network: built at the start, and anew by a factory reset."""

from __future__ import annotations

import logging
from functools import partial
from typing import TYPE_CHECKING, Any, Callable, Iterator, Sequence

from nao_sim_bridge.base.closing import Step
from nao_sim_bridge.base.config import sounds_directory
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.behaviors.installed import InstalledBehaviors
from nao_sim_bridge.behaviors.player import BehaviorPlayer
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.hearing.recogniser import SpareProcess
from nao_sim_bridge.naoqi import motion
from nao_sim_bridge.naoqi.behaviors import animation_player, behavior_manager, frame_manager
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.behaviors.surroundings import BehaviorSurroundings
from nao_sim_bridge.naoqi.binding.later import Later, later, made
from nao_sim_bridge.naoqi.binding.older import older_events
from nao_sim_bridge.naoqi.body import leds
from nao_sim_bridge.naoqi.body.body_modules import BodyModules
from nao_sim_bridge.naoqi.body.posture import ALRobotPosture
from nao_sim_bridge.naoqi.cameras import video_device
from nao_sim_bridge.naoqi.cameras.film_recorder import VideoRecorder
from nao_sim_bridge.naoqi.cameras.photographer import Photographer
from nao_sim_bridge.naoqi.cameras.photos_and_films import FILMS, PHOTOS, ALPhotoCapture, ALVideoRecorder
from nao_sim_bridge.naoqi.life.wiring import LifeModules
from nao_sim_bridge.naoqi.memory.live_keys import constants, live_keys
from nao_sim_bridge.naoqi.memory.memory import ALMemory
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.wake import AWAKE
from nao_sim_bridge.naoqi.motion.walking import Moves
from nao_sim_bridge.naoqi.sound.sound_extractors import DETECTION, LOCALIZATIONS, ALSoundDetection, SoundLocalization
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles
from nao_sim_bridge.naoqi.sound.wiring import AudioModules, SpeechModules
from nao_sim_bridge.naoqi.speech.recognition_engine import NAME as RECOGNITION
from nao_sim_bridge.naoqi.speech.speech_recognition import ALSpeechRecognition
from nao_sim_bridge.naoqi.system.system import ALSystem
from nao_sim_bridge.naoqi.system.time_zone import TimeZone
from nao_sim_bridge.naoqi.system.wiring import SystemModules
from nao_sim_bridge.naoqi.users.wiring import UserModules
from nao_sim_bridge.naoqi.vision.wiring import VisionModules
from nao_sim_bridge.server.film import END_LIMIT
from nao_sim_bridge.server.film_control import FilmControl
from nao_sim_bridge.server.robot_control import HandsControl, HealthControl
from nao_sim_bridge.server.things_control import ThingsControl
from nao_sim_bridge.server.world_sounds_control import WorldSoundsControl
from nao_sim_bridge.sound.files import SoundReader
from nao_sim_bridge.speech.studio import Studio
from nao_sim_bridge.vision.client import VisionProcess

if TYPE_CHECKING:
    from nao_sim_bridge.server.broker import Broker
    from nao_sim_bridge.server.options import ServerOptions

log = logging.getLogger("nao_sim.robot")


class Workers:
    """Programs and threads that work for a robot and know nothing of it; they take long to start."""

    def __init__(self) -> None:
        self.voice = Studio()
        self.persons = Studio()
        self.vision = VisionProcess()
        self.recogniser = SpareProcess()
        self.sounds = SoundReader()

    def closing(self) -> list[Step]:
        """Steps that end them."""
        return [one.close for one in (self.vision, self.persons, self.voice, self.recogniser, self.sounds)]


class RobotModules:
    """The modules of one robot at time 0, and what only a simulator can do to it.

    Attributes:
        runner: The thread of the simulation, as this robot has it.
        simulation: Of the runner; replaced by a factory reset, with everything else in here.
        began: What `SimulatorServer.now` says at time 0 of the simulation, s.
    """

    def __init__(
        self,
        options: ServerOptions,
        runner: RobotRunner,
        broker: Broker,
        workers: Workers,
        system: Callable[[MemoryStore, TimeZone], ALSystem],
    ) -> None:
        self.runner = runner
        self.simulation = simulation = runner.simulation
        self.began = 0.0
        self.memory = memory = MemoryStore(lambda: simulation.snapshot.time, simulation.shared.guard, older_events())
        self.files = files = ClientFiles(options.record_dir, [sounds_directory()])
        sounds = SoundFiles(files, workers.sounds)
        self._audio = AudioModules(runner, sounds, broker, memory, options.allow_private_streams)
        self.speech = SpeechModules(runner, memory, files, broker, workers.voice, self._audio.play_sound)
        posture = ALRobotPosture(runner, memory)
        library = self.speech.library
        surroundings = BehaviorSurroundings(runner, memory, self.speech.settings, lambda: self.recognition)
        player = BehaviorPlayer(
            simulation, self.speech.animator, library, self.speech.say, posture.goToPosture, surroundings
        )
        running = RunningBehaviors(player, InstalledBehaviors(library), memory)
        zone = TimeZone()
        self._life = LifeModules(runner, memory, broker, self.speech, posture, running, zone)
        self.recognition = ALSpeechRecognition(runner, memory, files, workers.recogniser)
        self.video = video_device.ALVideoDevice(simulation.cameras, files)
        self.vision = VisionModules(simulation, memory, files, workers.vision)
        cameras = simulation.cameras
        self._photographer = Photographer(cameras, PHOTOS)
        self._recorder = VideoRecorder(cameras, runner, FILMS)
        self.sounds = WorldSoundsControl(runner, sounds, workers.persons)
        self.things = ThingsControl(runner, files)
        self.hands = HandsControl(runner)
        self.film = FilmControl(runner, files, options.renderer)
        self.health = HealthControl(runner)
        self._body = BodyModules(runner, memory)
        of_robot = system(memory, zone)
        photos = lambda: ALPhotoCapture(self._photographer, files, cameras.tables)  # noqa: E731
        films = lambda: ALVideoRecorder(self._recorder, files, cameras.tables)  # noqa: E731
        manager = behavior_manager.ALBehaviorManager(running, runner, memory, files)
        system_modules = SystemModules(simulation, broker, files, memory, self.speech.say, manager)
        moves = Moves(memory)
        self._users = UserModules(simulation, memory, files, zone, self.vision.people)
        self.modules: dict[str, Sequence[Any]] = {
            "ALMemory": [ALMemory(memory, broker)],
            "ALLeds": leds.parts(runner),
            "ALMotion": motion.parts(runner, memory, moves),
            "ALRobotPosture": [posture],
            **self._audio.modules,
            **self.speech.modules,
            behavior_manager.NAME: [manager],
            animation_player.NAME: [animation_player.ALAnimationPlayer(running, runner)],
            frame_manager.NAME: [frame_manager.ALFrameManager(running, runner, files)],
            **self._life.modules,
            RECOGNITION: self.recognition.parts(),
            DETECTION: ALSoundDetection(simulation, memory).parts(),
            **{name: SoundLocalization(name, simulation, memory).parts() for name in LOCALIZATIONS},
            video_device.NAME: self.video.parts(),
            **self.vision.modules,
            PHOTOS: [photos()],
            FILMS: [films()],
            "ALVisionToolbox": later("naoqi.cameras.vision_toolbox:ALVisionToolbox", photos, films, cameras),
            **self._body.modules,
            "ALMotionRecorder": later("naoqi.motion.motion_recorder:ALMotionRecorder", runner),
            "ALNavigation": later("naoqi.navigation.navigation:ALNavigation", runner, memory, moves),
            "ALSentinel": later(
                "naoqi.system.sentinel:ALSentinel",
                memory,
                self._body.power,
                self._body.temperature,
                of_robot,
                self.speech.say,
            ),
            "ALSystem": [of_robot],
            **self._users.modules,
            **system_modules.modules,
        }

    def begin(self) -> None:
        """Have a look at every tick; before time passes. A SimulationError when a sound of the world cannot be had."""
        simulation, memory = self.simulation, self.memory
        if simulation is simulation.shared.robots[0]:
            self.sounds.begin()
        robot_leds = lambda: simulation.robot.leds.values  # noqa: E731
        memory.add_live(live_keys(self.runner, simulation.model, simulation.led_layout, robot_leds))
        for key, value in constants(simulation.scene.version).items():
            memory.insert(key, value)
        simulation.after_reset.append(lambda: memory.raise_event(AWAKE, False))
        self._body.begin()

    def client_gone(self, module: str) -> None:
        """A module of a client has left: what is subscribed under its name ends, in every module of the robot."""
        for name, parts in self.modules.items():
            for part in made(parts):
                if hasattr(part, "client_gone"):
                    try:
                        part.client_gone(module)
                    except Exception:
                        log.exception("%s does not let go of %s", name, module)

    def leaving(self, film_limit: float = END_LIMIT) -> list[Step]:
        """First steps of the end, while the simulation runs or has been left behind: complete what is under way."""
        return [
            self._life.close,
            *(part.close for parts in self._later() for part in parts.made if hasattr(part, "close")),
            *self._audio.closing(),
            *self.vision.closing(),  # before what has files to complete, and needs the pictures that are drawn
            self._photographer.close,  # before the film, whose last frames need not wait for the photos
            self._recorder.close,
            *self.video.closing(),
            partial(self.film.close, film_limit),  # what takes longest
        ]

    def closing(self) -> list[Step]:
        """Last steps of the end, when the simulation has ended."""
        return [self.speech.close, self.recognition.close, self._users.close]

    def _later(self) -> Iterator[Later]:
        """Modules that are made when they are first called."""
        return (parts for parts in self.modules.values() if isinstance(parts, Later))
