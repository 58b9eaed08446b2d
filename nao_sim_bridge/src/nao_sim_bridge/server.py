"""The simulated robot on the network: a simulation in its thread, and NAOqi's modules over libqi."""

from __future__ import annotations

import logging
import sys
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Sequence

from nao_sim_bridge.broker import Broker
from nao_sim_bridge.film_control import FilmControl
from nao_sim_bridge.hands_control import HandsControl
from nao_sim_bridge.health_control import HealthControl
from nao_sim_bridge.paths import sounds_directory
from nao_sim_bridge.pictures import Pictures
from nao_sim_bridge.record_dir import DEFAULT_RECORD_DIR, ClientFiles, unused
from nao_sim_bridge.services import motion
from nao_sim_bridge.services.arguments import number, numbers
from nao_sim_bridge.services.audio import sound_detection, sound_localization
from nao_sim_bridge.services.audio.speech_recognition import RecognitionModule
from nao_sim_bridge.services.audio.speech_wiring import SpeechModules
from nao_sim_bridge.services.audio.wiring import AudioModules
from nao_sim_bridge.services.behaviors.wiring import BehaviorModules
from nao_sim_bridge.services.binding import make_service
from nao_sim_bridge.services.body_modules import BodyModules
from nao_sim_bridge.services.diagnosis_events import DiagnosisEvents
from nao_sim_bridge.services.fall_events import FallEvents
from nao_sim_bridge.services.leds import ALLeds
from nao_sim_bridge.services.life.wiring import LifeModules
from nao_sim_bridge.services.live_keys import constants, live_keys
from nao_sim_bridge.services.memory import ALMemory
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.services.motion.wake import AWAKE
from nao_sim_bridge.services.nao_simulation import NAME as NAO_SIMULATION
from nao_sim_bridge.services.nao_simulation import NaoSimulation
from nao_sim_bridge.services.posture import ALRobotPosture
from nao_sim_bridge.services.posture_events import PostureEvents
from nao_sim_bridge.services.senses_wiring import SenseModules
from nao_sim_bridge.services.system import ALSystem
from nao_sim_bridge.services.time_zone import TimeZone
from nao_sim_bridge.services.vision import video_device
from nao_sim_bridge.services.vision.photo_capture_wiring import PictureModules
from nao_sim_bridge.services.vision.wiring import VisionModules
from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.places import RobotPlace
from nao_sim_bridge.sim.robot_runner import RobotRunner
from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Scene, Simulation
from nao_sim_bridge.sim.tasks import Task
from nao_sim_bridge.sound_outlets import SoundCard, SoundFile
from nao_sim_bridge.things_control import ThingsControl
from nao_sim_bridge.world_sounds_control import WorldSoundsControl

MAX_PUSH = 60.0
# How long a thread that computes keeps Python's interpreter when another wants it, s. The simulation computes nearly
# all the time when it runs as fast as possible; Python's own 5 ms would be felt in every call.
SWITCH_INTERVAL = 0.0005
log = logging.getLogger("nao_sim.server")


@dataclass(frozen=True)
class ServerOptions:
    """How a simulated robot is started.

    Attributes:
        scene: World, robot version, posture, seed.
        address: Network address to listen on.
        port: Port; 0 takes a free one.
        speed: Simulated seconds per wall second, infinity for as fast as possible.
        paused: Start without time passing.
        gui: Show the robot in a window.
        record_dir: Folder for files of clients; "~" stands for the home of the user.
        sound_file: Name in `record_dir` of a WAV for everything that the loudspeakers play; empty for none.
        sound_card: Let it be heard on this computer, too; only at speed 1.
        renderer: What draws: "auto", "opengl" or "builtin"; see `Renderer`.
        name: What the robot is called.
        robots: How many there are in the world; with more than one the port is that of the first.
        places: Where they stand; empty for where the world says, or else the usual places.
    """

    scene: Scene = field(default_factory=Scene)
    address: str = "127.0.0.1"
    port: int = 9559
    speed: float = 1.0
    paused: bool = False
    gui: bool = False
    record_dir: Path = DEFAULT_RECORD_DIR
    sound_file: str = ""
    sound_card: bool = False
    renderer: str = "auto"
    name: str = "nao"
    robots: int = 1
    places: tuple[RobotPlace, ...] = ()


class SimulatorServer:
    """One simulated NAO that answers on libqi.

    Attributes:
        simulation: Touched in the simulation thread only.
        runner: That thread.
        memory: What ALMemory keeps.
        broker: The libqi side.
        pictures: Drawings of the robot.
        files: Where clients may have files written to and read from.
        speech: The robot's voice.
        vision: What it recognises in its pictures.
        sounds: Sounds of the world.
        things: Things of the world.
        hands: What touches the robot.
        health: Charger, temperatures, broken devices.
        film: Films of the robot.
        ended: Set when a client shut the robot down or the simulation failed.

    Args:
        options: How it is started.
        simulation: A robot in a world that is there already; None for one of its own.
        runner: Its view of the thread of that world.
    """

    def __init__(
        self, options: ServerOptions, simulation: Simulation | None = None, runner: RobotRunner | None = None
    ) -> None:
        self.options = options
        self.ended = threading.Event()
        self.simulation = simulation or _alone(options)
        self.runner = runner or SimulationRunner(self.simulation, options.speed, options.paused, self.ended.set)
        self.memory = MemoryStore(lambda: self.runner.snapshot.time)
        self.broker = Broker()
        self.pictures = Pictures(self.simulation, self.runner)
        self.files = ClientFiles(options.record_dir, [sounds_directory()])
        self._audio = AudioModules(self.simulation, self.runner, self.files, self.broker)
        self.speech = SpeechModules(self.simulation, self.runner, self.memory, self.files, self.broker)
        self._posture = ALRobotPosture(self.simulation, self.runner, self.memory)
        self._behaviors = BehaviorModules(
            self.simulation, self.runner, self.memory, self.files, self.speech, self._posture
        )
        self._zone = TimeZone()
        self._life = LifeModules(
            self.simulation,
            self.runner,
            self.memory,
            self.broker,
            self.speech,
            self._posture,
            self._behaviors.running,
            self._zone,
        )
        self._recognition = RecognitionModule(self.simulation, self.runner, self.memory, self.files)
        self._video = video_device.VideoDevice(self.simulation.cameras, self.files)
        self.vision = VisionModules(self.simulation, self.memory, self.files)
        self._pictures_taken = PictureModules(self.simulation, self.runner, self.files)
        self._senses = SenseModules(self.simulation, self.runner, self.memory)
        self.sounds = WorldSoundsControl(self.simulation, self.runner, self.files)
        self.things = ThingsControl(self.simulation, self.runner, self.files)
        self.hands = HandsControl(self.simulation, self.runner)
        self.film = FilmControl(self.simulation, self.runner, self.files, options.renderer)
        self.health = HealthControl(self.simulation, self.runner)
        self._body = BodyModules(self.simulation, self.runner, self.memory)
        self._outlets: list[SoundFile | SoundCard] = []

    def start(self) -> None:
        """Listen, register the modules and let time pass.

        Raises:
            RuntimeError: The address cannot be had.
            SimulationError: The sound card, the file for sound, or a sound of the world cannot be had.
        """
        self.prepare()
        self.runner.start()
        self.serve()

    def prepare(self) -> None:
        """First part of `start`, before time passes: listen, and have a look at every tick."""
        self.speech.begin()
        if self.simulation is self.simulation.shared.robots[0]:
            self.sounds.begin()
        self._open_outlets()
        sys.setswitchinterval(SWITCH_INTERVAL)
        self.broker.listen(self.options.address, self.options.port, lambda: not self.ended.is_set())
        self.broker.when_gone(self._video.client_gone)
        robot_leds = lambda: self.simulation.robot.leds.values  # noqa: E731
        self.memory.add_live(live_keys(self.runner, self.simulation.model, self.simulation.led_layout, robot_leds))
        for key, value in constants(self.options.scene.version).items():
            self.memory.insert(key, value)
        self.simulation.after_reset.append(lambda: self.memory.raise_event(AWAKE, False))
        self.simulation.after_tick.append(PostureEvents(self.simulation.model, self.memory))
        self.simulation.after_tick.append(FallEvents(self.simulation, self.memory))
        self._senses.begin()
        self.simulation.after_tick.append(DiagnosisEvents(self.simulation, self.memory))
        self._body.begin()

    def serve(self) -> None:
        """Last part of `start`, when time passes: register the modules."""
        for name, parts in self.modules().items():
            self.broker.register(name, make_service(name, parts, self.broker))
        self.broker.register(NAO_SIMULATION, NaoSimulation(self))
        self.memory.raise_event("NAOqiReady", None)
        if self.options.gui:
            self.pictures.open_window()
        log.info("simulated NAO listens on %s:%d", self.options.address, self.broker.port)

    def modules(self) -> dict[str, list[Any]]:
        """NAOqi's modules by name: the objects that together have the methods of each."""
        return {
            "ALMemory": [ALMemory(self.memory, self.broker)],
            "ALLeds": [ALLeds(self.simulation, self.runner)],
            "ALMotion": motion.parts(self.simulation, self.runner, self.memory),
            "ALRobotPosture": [self._posture],
            **self._audio.modules(),
            **self.speech.modules(),
            **self._behaviors.modules(),
            **self._life.modules(),
            **self._recognition.modules(),
            sound_detection.NAME: sound_detection.parts(self.simulation, self.memory),
            **{name: sound_localization.parts(name, self.simulation, self.memory) for name in sound_localization.NAMES},
            video_device.NAME: self._video.parts(),
            **self.vision.modules(),
            **self._pictures_taken.modules(),
            **self._senses.modules(),
            **self._body.modules(),
            "ALSystem": [
                ALSystem(self.memory, self.reboot_task, self.ended.set, self._icon, self.options.name, self._zone)
            ],
        }

    def stop(self) -> None:
        """Leave the network and end the simulation."""
        self.leave()
        self.runner.stop()
        self.close()

    def leave(self) -> None:
        """First part of `stop`: leave the network."""
        self.ended.set()
        self.film.close()
        self._audio.close()
        self.vision.close()  # before what has files to complete, and needs the pictures that are drawn
        self._pictures_taken.close()
        self._video.close()
        self.sounds.close()
        self.broker.close()

    def close(self) -> None:
        """Last part of `stop`: end everything else that works for the robot."""
        self.speech.close()
        self._recognition.close()
        self.pictures.close()
        for outlet in self._outlets:
            outlet.close()

    def _open_outlets(self) -> None:
        if self.options.sound_card and self.options.speed != 1.0:
            raise BadValue("speed", self.options.speed, "1 with a sound card")
        if self.options.sound_file:
            try:
                path = self.files.to_write(self.options.sound_file)
            except ValueError as error:
                raise BadValue("sound file", self.options.sound_file, f"a name inside {self.files.folder}") from error
            path = unused(path)  # what was said last time is not lost
            log.info("what the loudspeakers play goes to %s", path)
            self._outlets.append(SoundFile(self.simulation, path))
        if self.options.sound_card:
            self._outlets.append(SoundCard(self.simulation))

    # --- what only a simulator can do; for any thread, blocking until it is done -----------------------------------

    def reset(self) -> None:
        """Put all robots and the world to where they started; tasks are killed, time goes on."""
        self.reset_task().result()

    def push(self, force: Sequence[float], duration: float, link: str) -> None:
        """Push a link with `force` (N, in world) for `duration` s of simulated time from now on."""
        vector = tuple(numbers(force, "force"))
        if len(vector) != 3:
            raise BadValue("force", force, "[x, y, z] in N")
        lasting = number(duration, "duration", 0.0, MAX_PUSH)
        self.runner.call(lambda: self.simulation.robot.push(vector, lasting, link))

    def press(self, sensors: Sequence[str]) -> None:
        """Simulated fingers on these touch sensors and on no others."""
        self.runner.call(lambda: self.simulation.robot.press(sensors))

    def picture(self, view: str, width: int, height: int) -> bytes:
        """A PNG picture of the robot; see `Pictures.png`."""
        return self.pictures.png(view, width, height)

    def _icon(self, size: int) -> bytes:
        return self.pictures.png("face", size, size)

    def reset_task(self) -> Task:
        """As `reset`, without waiting."""
        return self.runner.execute(self.simulation.reset, "reset")

    def reboot_task(self) -> Task:
        """Put this robot to where it started, without waiting; one that is alone in its world resets that, too."""
        return self.runner.execute(self.simulation.reboot, "reboot")


def _alone(options: ServerOptions) -> Simulation:
    """A robot in a world of its own."""
    place = options.places[0] if options.places else None
    return Simulation(options.scene, renderer=options.renderer, place=place)
