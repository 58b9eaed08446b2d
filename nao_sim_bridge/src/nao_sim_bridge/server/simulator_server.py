"""The simulated robot on the network: a simulation in its thread, and NAOqi's modules over libqi."""

from __future__ import annotations

import ctypes
import logging
import sys
import threading
from dataclasses import replace
from operator import attrgetter
from typing import Any, Callable, Sequence

from nao_sim_bridge.base.closing import Step, close_all
from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.base.record_dir import unused
from nao_sim_bridge.base.tasks import Task, WorkThreads
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Scene, Simulation
from nao_sim_bridge.naoqi.binding.arguments import number, vector
from nao_sim_bridge.naoqi.binding.binding import Service
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.log_manager import NAME as LOG_MANAGER
from nao_sim_bridge.naoqi.system.log_manager import LogManager
from nao_sim_bridge.naoqi.system.nao_simulation import NAME as NAO_SIMULATION
from nao_sim_bridge.naoqi.system.nao_simulation import NaoSimulation
from nao_sim_bridge.naoqi.system.system import ALSystem
from nao_sim_bridge.naoqi.system.time_zone import TimeZone
from nao_sim_bridge.render.client import Renderer
from nao_sim_bridge.server.broker import Broker
from nao_sim_bridge.server.files_control import FilesControl
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.pictures import Pictures
from nao_sim_bridge.server.robot_modules import RobotModules, Workers
from nao_sim_bridge.server.sound_outlets import SoundCard, SoundFile
from nao_sim_bridge.world.reader import world_names

MAX_PUSH = 60.0
# How long a thread that computes keeps Python's interpreter when another wants it, s. The simulation computes nearly
# all the time when it runs as fast as possible; Python's own 5 ms would be felt in every call.
SWITCH_INTERVAL = 0.0005
# glibc gives threads heaps of their own, up to eight a core, and keeps what they have held: with threads that come and
# go with clients, memory would grow for hours.
HEAPS, M_ARENA_MAX = 2, -8
FILM_LIMIT = 2.0
"""s of wall time that a film may take to be completed at the end of the program; see `Film.end`."""
READY = "NAOqiReady"
"""The event that clients know a robot by that has started, or started again."""
log = logging.getLogger("nao_sim.server")


class SimulatorServer:
    """One simulated NAO that answers on libqi.

    What the robot and its modules are is in a `RobotModules`, which a factory reset replaces; the network, the thread
    and the programs that work for it stay.

    Attributes:
        ended: Set when a client shut the robot down or the simulation failed.

    Args:
        simulation: A robot in a world that is there already; None for one of its own.
        runner: The thread of that world.
        factory_reset: Makes that world, the one of this name, and all its robots anew.
    """

    def __init__(
        self,
        options: ServerOptions,
        simulation: Simulation | None = None,
        runner: SimulationRunner | None = None,
        factory_reset: Callable[[str], None] | None = None,
    ) -> None:
        _share_heaps()
        self.options = options
        self.ended = threading.Event()
        simulation = simulation or _alone(options)
        self._shares_thread = runner is not None
        self._thread = runner or SimulationRunner(simulation, options.speed, options.paused, self.ended.set)
        self._make_world_anew = factory_reset or self._begin_anew
        self.broker = Broker()
        self._workers = Workers()
        self._robot = self.modules_for(simulation)
        self.file_access = FilesControl(lambda: self.files)
        self.pictures = Pictures(self._robot.runner)
        self._log = LogManager()
        self._services: dict[str, Service] = {}
        self._outlets: list[SoundFile | SoundCard] = []
        self._resetting = threading.Lock()
        self._resets = WorkThreads("factory reset")

    # --- the robot as it is now --------------------------------------------------------------------------------------

    @property
    def runner(self) -> SimulationRunner | RobotRunner:
        """The thread of the simulation; of several robots in a world each has its own view of it."""
        return self._robot.runner if self._shares_thread else self._thread

    simulation = property(attrgetter("_robot.simulation"), doc="See `RobotModules`, as the next.")
    memory = property(attrgetter("_robot.memory"))
    files = property(attrgetter("_robot.files"))
    speech = property(attrgetter("_robot.speech"))
    vision = property(attrgetter("_robot.vision"))
    sounds = property(attrgetter("_robot.sounds"))
    things = property(attrgetter("_robot.things"))
    hands = property(attrgetter("_robot.hands"))
    health = property(attrgetter("_robot.health"))
    film = property(attrgetter("_robot.film"))
    began = property(attrgetter("_robot.began"))
    sound_reader = property(attrgetter("_workers.sounds"), doc="What reads sound files.")

    @property
    def now(self) -> tuple[Snapshot, float]:
        """The last snapshot, and the simulated time since the start of the program, s: no reset takes that back."""
        robot = self._robot
        snapshot = robot.simulation.snapshot
        return snapshot, robot.began + snapshot.time

    def modules(self) -> dict[str, Sequence[Any]]:
        """NAOqi's modules by name: the objects that together have the methods of each."""
        return dict(self._robot.modules)

    # --- start and end -----------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Listen, register the modules and let time pass.

        A RuntimeError when the address cannot be had; a SimulationError when the sound card, the file for sound, or a
        sound of the world cannot be had.
        """
        self.prepare()
        self.runner.start()
        self.serve()

    def prepare(self) -> None:
        """First part of `start`, before time passes: listen, and have a look at every tick."""
        self._workers.voice.warm_up()
        self._robot.begin()
        self._open_outlets()
        sys.setswitchinterval(SWITCH_INTERVAL)
        port = self.options.ports[0] if self.options.ports else self.options.port
        self.broker.listen(self.options.address, port, lambda: not self.ended.is_set())
        self.broker.when_gone(lambda module: self._robot.client_gone(module))

    def serve(self) -> None:
        """Last part of `start`, when time passes: register the modules."""
        for name, parts in self._robot.modules.items():
            service = self._services[name] = Service(name, parts, self.broker)
            self.broker.register(name, service.object)
        self.broker.register(NAO_SIMULATION, NaoSimulation(self))
        self.broker.register(LOG_MANAGER, self._log)
        self.memory.raise_event(READY, None)
        if self.options.gui:
            self.pictures.open_window()
        log.info("simulated NAO listens on %s:%d", self.options.address, self.broker.port)

    def stop(self) -> None:
        """Leave the network and end the simulation."""
        close_all(*self.ending())

    def ending(self) -> list[Step]:
        """The steps of `stop`."""
        return [*self.leaving(), self.runner.stop, *self.closing()]

    def leaving(self) -> list[Step]:
        """First steps of `stop`: leave the network."""
        return [
            self.ended.set,
            self._workers.vision.close,  # first: who waits for an answer gets none
            *self._robot.leaving(FILM_LIMIT),
            self._workers.persons.close,
            self._log.close,
            self.broker.close,
        ]

    def closing(self) -> list[Step]:
        """Last steps of `stop`: end everything else that works for the robot."""
        return [
            *self._robot.closing(),
            *self._workers.closing(),
            self.pictures.close,
            self.file_access.close,
            *(outlet.close for outlet in self._outlets),
        ]

    def _open_outlets(self) -> None:
        if self.options.sound_card and self.options.speed != 1.0:
            raise BadValue("speed", self.options.speed, "1 with a sound card")
        if self.options.sound_file:
            try:
                path = self.files.to_keep(self.options.sound_file)
            except ValueError as error:
                raise BadValue("sound file", self.options.sound_file, f"a name inside {self.files.folder}") from error
            path = unused(path)  # what was said last time is not lost
            log.info("what the loudspeakers play goes to %s", path)
            self._outlets.append(SoundFile(self.simulation, path))
        if self.options.sound_card:
            self._outlets.append(SoundCard(self.simulation))

    # --- factory reset -----------------------------------------------------------------------------------------------

    def factory_reset(self, world: str = "") -> None:
        """Begin anew, at time 0, as a server that has just been started; with other robots, for all of them.

        Nothing is left of what clients have changed, but for modules of their own. Pending calls end as if they were
        killed, and files that modules of the robot have written are removed. What belongs to whoever runs the simulator
        stays: speed and pause, films, pictures, the file and the card for sound. Connections stay, and the event
        `NAOqiReady` says that the robot has started again. Blocking; not in the simulation thread.

        Args:
            world: Name of a world, or path of its file; empty for that of the start.

        Raises:
            SimulationError: The world cannot be used; everything stays as it is.
        """
        with self._resetting:
            self._make_world_anew(world)

    def factory_reset_task(self, world: str = "") -> Task:
        """As `factory_reset`, without waiting."""
        return self._resets.work_out("factoryReset", lambda: self.factory_reset(world))

    def modules_for(self, simulation: Simulation) -> RobotModules:
        """Modules for a robot at its start, which do nothing yet."""
        runner = RobotRunner(self._thread, simulation)
        return RobotModules(self.options, runner, self.broker, self._workers, self._system)

    def take(self, robot: RobotModules, began: float) -> Callable[[], None]:
        """Be another robot from now on; simulation thread, which has just taken its simulation.

        What it returns is to be called outside the thread: it closes what was left behind, but for what draws.
        """
        former, robot.began = self._robot, began
        former.runner.leave_behind()
        former.memory.close()
        self._robot = robot
        ends = [self._services[name].rebind(parts) for name, parts in robot.modules.items() if name in self._services]
        for outlet in self._outlets:
            outlet.follow(robot.simulation)
        former.files.forget()
        self.broker.drop_calls()
        robot.memory.raise_event(READY, None)

        def close_former() -> None:
            guarded = robot.simulation.shared.guard.call
            for step in former.leaving():
                guarded(step)
            former.runner.end()
            former.simulation.shared.close(keep_renderer=True)
            for end in ends:
                end()
            for step in former.closing():
                guarded(step)
            former.files.forget()  # what was completed meanwhile
            self._serve_again()
            self.pictures.follow(robot.runner)

        return close_former

    def _begin_anew(self, world: str) -> None:
        before = self.simulation.shared
        renderer = renderer_for(before.renderer, before.scene.world, world or self.options.scene.world)
        simulation = _alone(replace(self.options, scene=scene_in(self.options.scene, world)), renderer)
        try:
            robot = self.modules_for(simulation)
            robot.begin()
            close_former = self._thread.execute(lambda: self.take(robot, self._thread.take(simulation))).result()
        except Exception:
            simulation.shared.close(keep_renderer=renderer is not None)
            raise
        close_former()
        if renderer is None:
            before.renderer.close()

    def _serve_again(self) -> None:
        """Register the modules that a client has taken off the network."""
        for name, service in self._services.items():
            if not self.broker.serves(name):
                self.broker.register(name, service.object)

    # --- what only a simulator can do; for any thread, blocking until it is done -----------------------------------

    def reset(self) -> None:
        """Put all robots and the world to where they started; tasks are killed, time goes on."""
        self.reset_task().result()

    def vary(self, **changes: Any) -> None:
        """Change what the robot begins with from its next reset on, a factory reset as well; see `Simulation.vary`.

        Raises:
            NotAllowed: There are other robots in its world.
            BadValue: A number is not in its range.
        """
        if self._shares_thread:
            raise NotAllowed("only a robot that is alone in its world can begin with something else")
        scene = replace(self.options.scene, **changes)
        self.runner.call(lambda: self.simulation.vary(**changes))
        self.options = replace(self.options, scene=scene)

    def push(self, force: Sequence[float], duration: float, link: str) -> None:
        """Push a link with `force` (N, in world) for `duration` s of simulated time from now on."""
        newtons = tuple(vector(force, "force", 3, "[x, y, z] in N"))
        lasting = number(duration, "duration", 0.0, MAX_PUSH)
        self.runner.call(lambda: self.simulation.robot.push(newtons, lasting, link))

    def press(self, sensors: Sequence[str]) -> None:
        """Simulated fingers on these touch sensors and on no others."""
        self.runner.call(lambda: self.simulation.robot.press(sensors))

    def picture(self, view: str, width: int, height: int) -> bytes:
        """A PNG picture of the robot; see `Pictures.png`."""
        return self.pictures.png(view, width, height)

    def reset_task(self) -> Task:
        """As `reset`, without waiting."""
        self._thread.end_advances("a reset")
        return self.runner.execute(lambda: self.simulation.reset(), "reset")

    def reboot_task(self) -> Task:
        """Put this robot to where it started, without waiting; one that is alone in its world resets that, too."""
        return self.runner.execute(lambda: self.simulation.reboot(), "reboot")

    def _system(self, memory: MemoryStore, zone: TimeZone) -> ALSystem:
        icon = lambda size: self.pictures.png("face", size, size)  # noqa: E731
        return ALSystem(memory, self.reboot_task, self.ended.set, icon, self.options.name, zone)


def _share_heaps() -> None:
    """Have all threads of this process share a few heaps, where the C library is glibc."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(M_ARENA_MAX, HEAPS)


def scene_in(scene: Scene, world: str) -> Scene:
    """A scene in another world; an empty name is that of its own."""
    return replace(scene, world=world) if world else scene


def renderer_for(renderer: Renderer, drew: str, world: str) -> Renderer | None:
    """What has drawn a world if it can draw the other one; files may have changed meanwhile, those we ship have not."""
    return renderer if drew == world and world in world_names() else None


def _alone(options: ServerOptions, renderer: Renderer | None = None) -> Simulation:
    """A robot in a world of its own."""
    place = options.places[0] if options.places else None
    return Simulation(options.scene, renderer=renderer or options.renderer, place=place)
