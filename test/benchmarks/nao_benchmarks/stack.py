"""What rows are measured on: started when a row first asks for it, shared by the rows, ended together."""

from __future__ import annotations

import os
import sys
import tempfile
from contextlib import ExitStack
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from .places import NODES, PROGRAMS
from .program import Program
from .simulator import Simulator

if TYPE_CHECKING:
    from .goals import GoalClient

START_LIMIT = 40.0
LIGHTS = "NaoLights"
BARE_SERVER = "bare_lights"
# s; a client must still find its goal in the list when the result takes longer than the state.
FORGET_AFTER = 0.2


class Stack:
    """ROS master, simulator and action servers of one run. Only the thread that measures uses it."""

    def __init__(self) -> None:
        self._started = ExitStack()
        self._ros = False

    def __enter__(self) -> Stack:
        return self

    def __exit__(self, *_: object) -> None:
        """End everything, the newest first."""
        self._started.close()

    @cached_property
    def simulator(self) -> Simulator:
        """A simulated robot in real time, as a robot would be: it has nothing to do."""
        return self._started.enter_context(Simulator.plain())

    def start_ros(self) -> None:
        """Start a ROS master of our own, unless it runs already; this process becomes a node of it."""
        if self._ros:
            return
        # Not above: rows that need no ROS run without it.
        from nao_library_modules.ros.own_stack import OwnMaster

        folder = Path(self._started.enter_context(tempfile.TemporaryDirectory()))
        os.environ["ROS_IP"] = "127.0.0.1"
        os.environ.pop("ROS_HOSTNAME", None)
        os.environ["ROS_MASTER_URI"] = self._started.enter_context(OwnMaster(folder / "master.log")).uri
        self._started.enter_context(Program("rosout", ["rosrun", "rosout", "rosout"]))
        import rospy

        rospy.init_node("benchmarks", disable_signals=True)
        self._started.callback(rospy.signal_shutdown, "the benchmarks are over")
        self._ros = True

    @cached_property
    def goal_clients(self) -> tuple[GoalClient, GoalClient]:
        """Clients of our server for the lights and of a bare one for the same action; neither waits for its client."""
        return self._goal_servers("busy")

    @cached_property
    def rare_goal_clients(self) -> tuple[GoalClient, GoalClient]:
        """Clients of two more such servers, for which every goal is like one that comes once in a while.

        With each change actionlib publishes the state of all goals that ended in the last 5 s. A benchmark
        makes hundreds in that time, a user a few; these servers forget them soon.
        """
        return self._goal_servers("rare", FORGET_AFTER)

    @cached_property
    def lights_client(self) -> GoalClient:
        """A client of our server for the lights, as users have it: no goal is over before its client has noted it."""
        return self._client_of(LIGHTS, "nao_lights")

    @cached_property
    def motion_client(self) -> GoalClient:
        """A client of our server for motion; the robot is awake."""
        self.simulator.wake_up()
        return self._client_of("NaoMotion", "nao_motion")

    @cached_property
    def audio_out_client(self) -> GoalClient:
        """A client of our server for sound."""
        return self._client_of("nao_audio_out", "nao_audio_out")

    def start_tactile(self) -> None:
        """Start the driver's node for touch."""
        self._start_node("nao_tactile")

    def start_behaviors(self, folder: str) -> tuple[GoalClient, GoalClient]:
        """Start the server for behaviours on a folder; clients of it, and of a server for lights beside it."""
        behaviors = self._client_of("NaoBehavior", "nao_behavior_server", f"_behavior_dir:={folder}")
        return behaviors, self.lights_client

    def _goal_servers(self, name: str, forget_after: float | None = None) -> tuple[GoalClient, GoalClient]:
        self.start_ros()
        import rospy

        ours, bare = f"/{name}/{LIGHTS}", f"/{name}/{BARE_SERVER}"
        if forget_after is not None:
            for server in (ours, bare):
                rospy.set_param(f"{server}/status_list_timeout", forget_after)
        remapping = f"__ns:=/{name}"
        self._start_node("nao_lights", remapping, "_soonest_end:=0")  # as a goal that takes longer is served
        self._start("bare server", [str(PROGRAMS / "bare_action_server.py"), BARE_SERVER, remapping])
        return self._connect(ours, LIGHTS), self._connect(bare, LIGHTS)

    def _client_of(self, server: str, node: str, *options: str) -> GoalClient:
        self._start_node(node, *options)
        return self._connect(server, server)

    def _connect(self, server: str, kind: str) -> GoalClient:
        from .goals import GoalClient  # not above: it needs the messages of the built workspace

        return GoalClient(server, kind, START_LIMIT)

    def _start_node(self, name: str, *options: str) -> None:
        """Start a node of ours that speaks to the simulator."""
        self.start_ros()
        self._start(name, [str(NODES / name), "--pip", "127.0.0.1", "--pport", str(self.simulator.port), *options])

    def _start(self, name: str, command: list[str]) -> None:
        self._started.enter_context(Program(name, [sys.executable, *command]))
