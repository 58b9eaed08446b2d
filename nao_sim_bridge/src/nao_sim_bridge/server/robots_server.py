"""Several simulated robots in one world: one simulation, one thread, and a libqi server for each of them."""

from __future__ import annotations

import logging
import threading
from dataclasses import replace
from pathlib import Path
from typing import Callable

from nao_sim_bridge.base.closing import Step, close_all
from nao_sim_bridge.base.errors import BadValue, NotAllowed, SimulationStopped
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.core.simulation import Simulation, robots_in
from nao_sim_bridge.render.client import Renderer
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer, renderer_for, scene_in

HIGHEST_PORT = 65535
ANSWER_TIME = 0.5
"""How long who shuts a robot down has to be answered before it leaves the network, s of wall time."""
log = logging.getLogger("nao_sim.server")


class RobotsServer:
    """Simulated NAOs nao1, nao2... in one world, on ports that follow each other.

    Attributes:
        servers: One for each robot.
        runner: The thread of the world.
        ended: Set when all robots were shut down or the simulation failed.

    Args:
        options: How they are started. Each has a seed of its own, and a folder of its own name in `record_dir`.

    Raises:
        SimulationError: The places or the world cannot be used, or do not go together.
    """

    def __init__(self, options: ServerOptions) -> None:
        if options.port and options.port + options.robots - 1 > HIGHEST_PORT:
            raise BadValue("port", options.port, f"at most {HIGHEST_PORT + 1 - options.robots} for the first robot")
        if options.sound_card:
            raise BadValue("sound card", True, "False with more than one robot")
        self.ended = threading.Event()
        self._options = options
        simulations = _simulations(options, options.renderer)
        self.runner = SimulationRunner(simulations[0], options.speed, options.paused, on_end=self.ended.set)
        self.servers = tuple(
            SimulatorServer(_own_options(options, number), simulation, self.runner, self.factory_reset)
            for number, simulation in enumerate(simulations)
        )
        self._resetting = threading.Lock()
        self._lock = threading.Lock()
        self._left: list[SimulatorServer] = []

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(server.options.name for server in self.servers)

    def start(self) -> None:
        """Listen on all ports, register the modules of all robots, and let time pass.

        Raises:
            RuntimeError: An address cannot be had.
            SimulationError: A file for sound, or a sound of the world cannot be had.
        """
        for server in self.servers:
            server.prepare()
        self.runner.start()
        for server in self.servers:
            server.serve()
            threading.Thread(target=self._mind, args=(server,), name=server.options.name, daemon=True).start()

    def stop(self) -> None:
        """Leave the network and end the simulation."""
        close_all(*self.ending())

    def ending(self) -> list[Step]:
        """The steps of `stop`; the robots leave with the first call."""
        self.ended.set()
        leaving = [step for server in self.servers for step in self._leaving(server)]
        return [*leaving, self.runner.stop, *(step for server in self.servers for step in server.closing())]

    def factory_reset(self, world: str = "") -> None:
        """Begin anew with all robots; see `SimulatorServer.factory_reset`. Those that were shut down stay limp."""
        with self._resetting:
            self._begin_anew(world)

    def _begin_anew(self, world: str) -> None:
        before = self.servers[0].simulation.shared
        options = replace(self._options, scene=scene_in(self._options.scene, world))
        renderer = renderer_for(before.renderer, before.scene.world, options.scene.world)
        simulations = _simulations(options, renderer or options.renderer)

        def take() -> list[Callable[[], None]]:
            began = self.runner.take(simulations[0])
            for server, simulation in zip(self.servers, simulations):
                if server in self._left:
                    _go_limp(simulation)
            return [server.take(robot, began) for server, robot in zip(self.servers, robots)]

        try:
            robots = [server.modules_for(simulation) for server, simulation in zip(self.servers, simulations)]
            for robot in robots:
                robot.begin()
            close_former = self.runner.execute(take).result()
        except Exception:
            simulations[0].shared.close(keep_renderer=renderer is not None)
            raise
        for close in close_former:
            close()
        if renderer is None:
            before.renderer.close()

    def _mind(self, server: SimulatorServer) -> None:
        """Take a robot that was shut down off the network; it stays in the world without force."""
        server.ended.wait()
        if self.ended.wait(ANSWER_TIME):
            return
        log.info("%s was shut down", server.options.name)
        close_all(*self._leaving(server))
        try:
            server.runner.call(lambda: _go_limp(server.simulation))
        except SimulationStopped:
            return
        if len(self._left) == len(self.servers):
            self.ended.set()

    def _leaving(self, server: SimulatorServer) -> list[Step]:
        """Steps that take a robot off the network; none where that has been done."""
        with self._lock:
            if server in self._left:
                return []
            self._left.append(server)
        return server.leaving()


def open_server(options: ServerOptions) -> SimulatorServer | RobotsServer:
    """A simulator for one robot or several, not started yet."""
    return SimulatorServer(options) if options.robots == 1 else RobotsServer(options)


def _simulations(options: ServerOptions, renderer: str | Renderer) -> tuple[Simulation, ...]:
    """All robots, in a new world."""
    shared = SharedWorld(options.scene, renderer=renderer)
    simulations = robots_in(shared, options.scene, options.robots, options.places)
    _refuse_overlaps(shared, keep_renderer=isinstance(renderer, Renderer))
    return simulations


def _refuse_overlaps(shared: SharedWorld, keep_renderer: bool) -> None:
    """Refuse places inside things: they would hurl one of both away.

    Raises:
        NotAllowed: A robot is in something.
    """
    for number, robot in enumerate(shared.robots):
        for name, depth in robot.inside().items():
            shared.close(keep_renderer)
            raise NotAllowed(f"robot {number + 1} would be {depth:.3f} m inside {name!r}: choose other places")


def _own_options(options: ServerOptions, number: int) -> ServerOptions:
    """Options of one robot, counted from 0."""
    name = f"nao{number + 1}"
    return replace(
        options,
        name=name,
        port=options.port + number if options.port else 0,
        ports=options.ports[number : number + 1],
        gui=options.gui and number == 0,  # a window shows all of them
        record_dir=Path(options.record_dir) / name,
    )


def _go_limp(simulation: Simulation) -> None:
    simulation.end_tasks()
    simulation.sound.loudspeakers.stop_all()
    simulation.robot.joints.set_stiffness(dict.fromkeys(range(len(simulation.model.joints)), 0.0))
