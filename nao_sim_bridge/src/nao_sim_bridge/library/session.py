"""How time passes for a `NaoSim`: in the calls that let it, beside a window, or in the thread of a server."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Callable, Sequence, TypeVar

from nao_sim_bridge.base.errors import NotAllowed, TaskKilled
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.world.places import RobotPlace

if TYPE_CHECKING:
    from nao_sim_bridge.render.client import Viewer
    from nao_sim_bridge.server.simulator_server import SimulatorServer

T = TypeVar("T")
ENDLESS = float("inf")
LOOK = 1.0
"""How soon to see whether a simulation has ended that lets no time pass, s of wall time."""


class Session:
    """The simulations of a `NaoSim`, and what lets time pass in them.

    As long as nobody is served, everything happens in the thread that calls. A server has a thread of its own, to which
    commands go, and other simulations after a factory reset.

    Args:
        simulations: All robots of a world, in the order of their numbers.
        gui: Show the world in a window; time then passes no faster than the clock on the wall.
    """

    def __init__(self, simulations: Sequence[Simulation], gui: bool = False) -> None:
        self._own = tuple(simulations)
        self._gui = gui
        self._server: SimulatorServer | None = None
        self._window: Viewer | None = None
        self._due = 0.0
        if gui:
            from nao_sim_bridge.render.client import Viewer  # nobody else needs a window

            scene = self._own[0].scene
            self._window = Viewer(scene.world, scene.version).start()

    @property
    def served(self) -> bool:
        """Whether programs for NAOqi work with the robot."""
        return self._server is not None

    @property
    def simulations(self) -> tuple[Simulation, ...]:
        """The robots as they are now: after a factory reset they are others."""
        return self._own if self._server is None else (self._server.simulation,)

    @property
    def shared(self) -> SharedWorld:
        """The world that they are in now."""
        return self.simulations[0].shared

    @property
    def tick_s(self) -> float:
        """Length of a tick, s."""
        return self._own[0].settings.tick_s

    def do(self, command: Callable[[], T]) -> T:
        """Run a command where the simulation runs."""
        return command() if self._server is None else self._server.runner.call(command)

    # --- time -------------------------------------------------------------------------------------------------------

    def advance(self, ticks: int) -> None:
        """Let time pass.

        Raises:
            SimulationStopped: The thread of the server has ended.
        """
        by_itself = self._server is not None and not self._server.runner.paused
        if by_itself or not self._gui:
            self._pass(ticks)
            return
        for _ in range(ticks):
            self._pass(1)
            self._show(1)

    def advance_until(self, over: Callable[[], bool], longest: float, what: str) -> None:
        """Let time pass, tick by tick, until something is over.

        Raises:
            TimeoutError: It is not within `longest` s of simulated time; the error names `what`.
        """
        end = self.simulations[0].time + longest
        while not over():
            if self.simulations[0].time > end:
                raise TimeoutError(f"{what} has not ended within {longest:g} s of simulated time")
            self.advance(1)

    def drive(self, robot: SimulatedRobot, mode: str, values: Sequence[float], ticks: int) -> None:
        """Drive the joints of one robot directly while time passes; see `Nao.drive`."""
        if self._server is not None:
            raise NotAllowed("a robot that is served is driven by its NAOqi alone")
        robot.drive(mode, values)
        if not all(simulation.robot.driven for simulation in self._own):
            self.advance(ticks)
            return
        self.shared.leap(ticks)
        if self._gui:
            self._show(ticks)

    def _pass(self, ticks: int) -> None:
        if self._server is not None:
            self._wait_for_server(ticks)
            return
        tick = self.shared.tick
        for _ in range(ticks):
            tick()

    def _wait_for_server(self, ticks: int) -> None:
        """Have the server's thread let time pass, or wait as long as it does so by itself."""
        runner = self._server.runner
        end = runner.ticks + ticks
        while runner.ticks < end:
            if runner.paused:
                try:
                    runner.advance((end - runner.ticks) * self.tick_s).result()
                except TaskKilled:  # by a reset or a pause of a client; the rest of the time passes after it
                    continue
            elif runner.wait_for_tick(end - 1, LOOK) is None and not runner.running:
                raise TaskKilled("the simulation has ended")

    def _show(self, ticks: int) -> None:
        """Show what is now; returns when the clock on the wall is where simulated time is after `ticks` more."""
        if self._window is not None:
            self._window.show(self.simulations[0].render_state())
        now = time.monotonic()
        self._due = max(self._due + ticks * self.tick_s, now)
        time.sleep(self._due - now)

    # --- NAOqi ------------------------------------------------------------------------------------------------------

    def serve(self, port: int, address: str, speed: float | None, places: Sequence[RobotPlace] = ()) -> str:
        """Let programs for NAOqi work with the robot; see `NaoSim.serve`.

        `places`: where it stands after a factory reset; empty for where the world says.
        """
        if self._server is not None:
            raise NotAllowed("this robot is served already")
        if len(self._own) > 1:
            raise NotAllowed("only a robot that is alone in its world is served; see nao_robots.launch for several")
        from nao_sim_bridge.server.options import ServerOptions
        from nao_sim_bridge.server.simulator_server import SimulatorServer  # the wheel qi, and all modules

        (simulation,) = self._own
        pace = ENDLESS if speed is None else speed
        options = ServerOptions(simulation.scene, address, port, pace, speed is None, self._gui, places=tuple(places))
        server = SimulatorServer(options, simulation)
        try:
            server.start()
        except Exception:
            server.stop()
            raise
        self._server = server
        if self._window is not None:
            self._window.close()  # that of the server follows it
            self._window = None
        return f"tcp://{address}:{server.broker.port}"

    def close(self) -> None:
        """Free the engine, and end the network and the programs that work for it."""
        if self._window is not None:
            self._window.close()
        if self._server is not None:
            self._server.stop()
        else:
            self.shared.close()
