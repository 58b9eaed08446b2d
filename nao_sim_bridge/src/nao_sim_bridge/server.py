"""The simulated robot on the network: a simulation in its thread, and NAOqi's modules over libqi."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass, field

from nao_sim_bridge.broker import Broker
from nao_sim_bridge.services.binding import make_service
from nao_sim_bridge.services.leds import ALLeds
from nao_sim_bridge.services.live_keys import constants, live_keys
from nao_sim_bridge.services.memory import ALMemory
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.services.motion import ALMotion, AWAKE
from nao_sim_bridge.services.nao_simulation import NAME as NAO_SIMULATION
from nao_sim_bridge.services.nao_simulation import NaoSimulation
from nao_sim_bridge.services.system import ALSystem
from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Scene, Simulation

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
    """

    scene: Scene = field(default_factory=Scene)
    address: str = "127.0.0.1"
    port: int = 9559
    speed: float = 1.0
    paused: bool = False


class SimulatorServer:
    """One simulated NAO that answers on libqi.

    Attributes:
        simulation: Touched in the simulation thread only.
        runner: That thread.
        memory: What ALMemory keeps.
        broker: The libqi side.
        ended: Set when a client shut the robot down or the simulation failed.
    """

    def __init__(self, options: ServerOptions) -> None:
        self.options = options
        self.ended = threading.Event()
        self.simulation = Simulation(options.scene)
        self.runner = SimulationRunner(self.simulation, options.speed, options.paused)
        self.memory = MemoryStore(lambda: self.runner.snapshot.time)
        self.broker = Broker()

    def start(self) -> None:
        """Listen, register the modules and let time pass.

        Raises:
            RuntimeError: The address cannot be had.
        """
        self.broker.listen(self.options.address, self.options.port, lambda: not self.ended.is_set())
        robot_leds = lambda: self.simulation.robot.leds.values  # noqa: E731
        self.memory.add_live(live_keys(self.runner, self.simulation.model, self.simulation.led_layout, robot_leds))
        for key, value in constants(self.options.scene.version).items():
            self.memory.insert(key, value)
        self.runner.start()
        modules = {
            "ALMemory": ALMemory(self.memory, self.broker),
            "ALLeds": ALLeds(self.simulation, self.runner),
            "ALMotion": ALMotion(self.simulation, self.runner, self.memory),
            "ALSystem": ALSystem(self.memory, self._reboot, self.ended.set),
        }
        for name, module in modules.items():
            self.broker.register(name, make_service(name, module, self.broker))
        self.broker.register(NAO_SIMULATION, NaoSimulation(self.simulation, self.runner, self._after_reset))
        self.memory.raise_event("NAOqiReady", None)
        log.info("simulated NAO listens on %s:%d", self.options.address, self.broker.port)

    def stop(self) -> None:
        """Leave the network and end the simulation."""
        self.ended.set()
        self.broker.close()
        self.runner.stop()

    def _reboot(self):
        def reboot() -> None:
            self.simulation.reset()
            self._after_reset()

        return self.runner.execute(reboot, "reboot")

    def _after_reset(self) -> None:
        self.memory.raise_event(AWAKE, False)
