"""Processes of the soak: the servers' side (ROS master, driver, servers), and the simulator that dies now and then."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy

from .machines import Machines

START_LIMIT = 90.0
STOP_LIMIT = 20.0


class NotReady(RuntimeError):
    """Something was not there in time."""


def master_uri(machines: Machines) -> str:
    """Address of the ROS master."""
    return f"http://{machines.here}:{machines.ros_port}"


def ros_environment(machines: Machines, folder: Path) -> dict[str, str]:
    """Environment of programs on the servers' machine; logs go to `folder`."""
    return {
        **os.environ,
        "ROS_MASTER_URI": master_uri(machines),
        "ROS_IP": machines.here,
        "ROS_HOME": str(folder / "ros_home"),
        "ROS_LOG_DIR": str(folder / "ros_log"),
    }


class Servers:
    """ROS master, driver and action servers, as `nao.launch` starts them; a context.

    Args:
        machines: Where they run.
        folder: Where their output goes.

    Attributes:
        logs: Folder of the logs of the nodes.
        screen: What roslaunch and the nodes print.
    """

    def __init__(self, machines: Machines, folder: Path) -> None:
        self._machines = machines
        self._folder = folder
        self.logs, self.screen = folder / "ros_log", folder / "roslaunch.log"
        self._processes: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Servers:
        """Start them; they need not be ready."""
        self._start("roscore", ["roscore", "-p", str(self._machines.ros_port)])
        deadline = time.monotonic() + START_LIMIT
        while not _listens(self._machines.here, self._machines.ros_port):
            if time.monotonic() > deadline:
                raise NotReady(f"the ROS master was not there within {START_LIMIT:g} s")
            time.sleep(0.1)
        records = self._folder / "records"
        arguments = [f"nao_ip:={self._machines.robot}", f"nao_port:={self._machines.nao_port}"]
        self._start("roslaunch", ["roslaunch", "nao_library", "nao.launch", *arguments, f"record_dir:={records}"])
        return self

    def __exit__(self, *_: Any) -> None:
        """End them."""
        for process in reversed(self._processes):
            process.send_signal(signal.SIGINT)
            try:
                process.wait(STOP_LIMIT)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    @property
    def running(self) -> bool:
        """Whether master and launch file still run."""
        return all(process.poll() is None for process in self._processes)

    def nodes(self) -> dict[str, int]:
        """Process ids of the nodes by name, as they tell them.

        Raises:
            OSError: A node does not answer.
        """
        master = ServerProxy(master_uri(self._machines))
        publishers, subscribers, services = master.getSystemState("/soak")[2]
        names = {n for kind in (publishers, subscribers, services) for _, users in kind for n in users}
        names = {n for n in names if n != "/rosout" and not n.startswith("/soak")}
        return {name: ServerProxy(master.lookupNode("/soak", name)[2]).getPid("/soak")[2] for name in sorted(names)}

    def _start(self, name: str, command: list[str]) -> None:
        log = (self._folder / f"{name}.log").open("wb")
        environment = ros_environment(self._machines, self._folder)
        self._processes.append(
            subprocess.Popen(command, env=environment, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        )


class Simulator:
    """The simulated robot on the other machine; a context.

    Args:
        machines: Where it runs.
        folder: Where its output goes.
        speed: Simulated seconds a second.
        seed: Of its sensors.

    Attributes:
        name: What it is called in figures.
        log: Its output.
        lives: How often it was started.
    """

    name = "simulator"

    def __init__(self, machines: Machines, folder: Path, speed: float, seed: int) -> None:
        self._machines = machines
        self._folder = folder
        self._speed = speed
        self._seed = seed
        self._process: subprocess.Popen[bytes] | None = None
        self.log = folder / "nao_sim.log"
        self.lives = 0

    def __enter__(self) -> Simulator:
        """Start it."""
        self.start()
        return self

    def __exit__(self, *_: Any) -> None:
        """End it."""
        self.kill()

    def start(self) -> None:
        """Start it; it may take a while until it answers."""
        self.lives += 1
        where = ["--listen", self._machines.robot, "--port", str(self._machines.nao_port)]
        command = [sys.executable, "-m", "nao_sim_bridge", *where, "--world", "lab", "--sensor-noise", "1"]
        command += ["--speed", str(self._speed), "--seed", str(self._seed + self.lives)]
        command += ["--record-dir", str(self._folder / "robot")]
        with self.log.open("ab") as log:
            self._process = subprocess.Popen(
                self._machines.on_robot(command), stdout=log, stderr=subprocess.STDOUT, start_new_session=True
            )

    def kill(self) -> None:
        """Kill it at once, with everything that it has started."""
        if self._process is not None:
            with suppress(ProcessLookupError):  # it may have ended by itself, which is told elsewhere
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
            self._process = None

    def tell_where_it_is(self) -> str:
        """Have it write into its log where each of its threads is; whether it takes connections."""
        os.kill(self.pid, signal.SIGUSR1)
        takes = _listens(self._machines.robot, self._machines.nao_port)
        return f"the simulator {'takes' if takes else 'does not take'} connections; its threads are in nao_sim.log"

    @property
    def pid(self) -> int:
        """Its process id.

        Raises:
            NotReady: It has ended by itself.
        """
        if self._process is None or self._process.poll() is not None:
            raise NotReady(f"the simulator ended by itself; see {self.log}")
        return self._process.pid


def _listens(address: str, port: int) -> bool:
    try:
        socket.create_connection((address, port), 1.0).close()
    except OSError:
        return False
    return True
