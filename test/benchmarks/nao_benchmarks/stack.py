"""What rows are measured on: started when a row first asks for it, shared by the rows, ended together."""

from __future__ import annotations

import os
import socket
import sys
from contextlib import ExitStack
from functools import cached_property
from typing import TYPE_CHECKING

from .places import LIGHTS_NODE, PROGRAMS
from .program import Program
from .simulator import Simulator

if TYPE_CHECKING:
    from .goals import GoalClient

START_LIMIT = 40.0
OUR_SERVER = "NaoLights"
BARE_SERVER = "bare_lights"
# s; a client must still find its goal in the list when the result takes longer than the state.
STATUS_LIST_TIMEOUT = 0.2


class Stack:
    """ROS master, simulator and action servers of one run. Only the thread that measures uses it."""

    def __init__(self) -> None:
        self._started = ExitStack()

    def __enter__(self) -> Stack:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End everything, the newest first."""
        self._started.close()

    @cached_property
    def simulator(self) -> Simulator:
        """A simulated robot in real time, as a robot would be: it has nothing to do."""
        return self._started.enter_context(Simulator.plain())

    @cached_property
    def master(self) -> str:
        """Address of a ROS master of our own; this process is a node of it from then on."""
        port = _free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        core = self._started.enter_context(Program("roscore", ["roscore", "-p", str(port)]))
        core.wait_for(r"started core service \[/rosout\]", START_LIMIT)
        import rospy  # not above: rows that need no ROS run without it

        rospy.init_node("benchmarks", disable_signals=True)
        self._started.callback(rospy.signal_shutdown, "the benchmarks are over")
        return os.environ["ROS_MASTER_URI"]

    @cached_property
    def goal_clients(self) -> tuple[GoalClient, GoalClient]:
        """Clients of our server for the lights and of a bare server for the same action, as they come."""
        return self._goal_servers("busy")

    @cached_property
    def rare_goal_clients(self) -> tuple[GoalClient, GoalClient]:
        """Clients of two more such servers, for which every goal is like one that comes once in a while.

        With each change actionlib publishes the state of all goals that ended in the last 5 s. A benchmark makes
        hundreds in that time, a user a few; these servers forget them soon.
        """
        return self._goal_servers("rare", STATUS_LIST_TIMEOUT)

    def _goal_servers(self, namespace: str, status_list_timeout: float | None = None) -> tuple[GoalClient, GoalClient]:
        assert self.master
        import rospy

        from .goals import GoalClient  # not above: it needs the messages of the built workspace

        ours, bare = f"/{namespace}/{OUR_SERVER}", f"/{namespace}/{BARE_SERVER}"
        if status_list_timeout is not None:
            for server in (ours, bare):
                rospy.set_param(f"{server}/status_list_timeout", status_list_timeout)
        robot = ["--pip", "127.0.0.1", "--pport", str(self.simulator.port)]
        remapping = f"__ns:=/{namespace}"
        self._start("nao_lights", [str(LIGHTS_NODE), *robot, remapping])
        self._start("bare server", [str(PROGRAMS / "bare_action_server.py"), BARE_SERVER, remapping])
        return GoalClient(ours, START_LIMIT), GoalClient(bare, START_LIMIT)

    def _start(self, name: str, command: list[str]) -> Program:
        return self._started.enter_context(Program(name, [sys.executable, *command]))


def _free_port() -> int:
    """A TCP port of the loopback interface that nobody uses at the moment."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
