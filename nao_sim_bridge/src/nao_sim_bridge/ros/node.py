"""The node `nao_sim`: reads parameters, builds server and ROS side, and spins."""

from __future__ import annotations

import http.client
import os
import signal
import socket
import sys
import threading
import xmlrpc.client
from typing import NoReturn

import rosgraph
import rospy

from nao_sim_bridge.base.closing import FAILED, REFUSED, close_all, exit_in_time, wait_for_end
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.ros.side import RosSide
from nao_sim_bridge.server.cli import parser, server_options
from nao_sim_bridge.server.robots_server import RobotsServer, open_server
from nao_sim_bridge.server.simulator_server import SimulatorServer

# Parameters of the node that stand for options of the command line; the command line wins.
VALUES = (
    "port listen speed world seed robot posture friction payload sensor_noise sensor_delay renderer record_dir "
    "sound_file publish_clock robots places"
).split()
SWITCHES = ("gui", "paused", "verbose", "sound_card", "charger", "allow_private_streams")
NAME = "nao_sim"
ANSWER_LIMIT = 2.0
"""s that a node which may run already has for each answer: one that was stopped has none."""
LAUNCHED = "__log:="
"""How an argument begins that roslaunch gives to its nodes, and nobody else does."""
OFF = "import signal; signal.signal(signal.SIGINT, signal.SIG_DFL); signal.pause()"


def main() -> int:
    """Run until ROS shuts down, a client shuts the robot down, or the simulation fails; returns the exit status.

    roslaunch starts a simulator that died again. One that was switched off (ALSystem.shutdown), or that cannot start
    again, would come back for ever: under roslaunch it stays as an idle process until the launch file ends. One that
    cannot start in the first place ends the launch file, and so does one whose name is taken on the master.
    """
    told = threading.Event()  # to end, by a signal or by ROS
    try:
        status = _run(told)
    except SystemExit as end:  # of argparse
        status = end.code
    except KeyboardInterrupt:  # before it listens to signals
        told.set()
        status = REFUSED
    if _launched() and status != FAILED and not told.is_set():
        if status and not _was_there():
            _end_launch("the simulator cannot start as it is told, see above")
        _stay_off()
    rospy.signal_shutdown("the simulator has ended")
    return status


def _launched() -> bool:
    return any(argument.startswith(LAUNCHED) for argument in sys.argv)


def _name() -> str:
    """Name of this node, also before there is one."""
    mappings = rosgraph.names.load_mappings(sys.argv)
    return rosgraph.names.resolve_name(mappings.get("__name", NAME), rosgraph.names.get_ros_namespace())


def _was_there() -> bool:
    """Whether a simulator of this name has run on the master."""
    try:
        return bool(rosgraph.Master(f"{_name()}_starting").hasParam(f"{_name()}/bound_port"))
    except (rosgraph.MasterError, OSError):
        return True


def _make_way(running: str) -> NoReturn:
    """End the launch file: its other nodes have taken the names of those of the simulator that runs, and its time."""
    master = rosgraph.Master(f"{running}_starting")
    clock = any(topic == "/clock" and running in nodes for topic, nodes in master.getSystemState()[0])
    master.setParam("/use_sim_time", clock)
    _end_launch("the nodes of the one before come back")


def _end_launch(reason: str) -> NoReturn:
    print(f"this launch file ends: {reason}", file=sys.stderr, flush=True)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(REFUSED))
    os.kill(os.getppid(), signal.SIGINT)
    while True:
        signal.pause()  # until roslaunch ends this process


def _stay_off() -> NoReturn:
    print("nao_sim is off until its launch file is started again", file=sys.stderr, flush=True)
    rospy.signal_shutdown("off")
    sys.stdout.flush()
    signal.alarm(0)
    for descriptor in map(int, os.listdir("/proc/self/fd")):  # no range: a process may have room for a billion
        if descriptor > 2:
            os.closerange(descriptor, descriptor + 1)
    os.execv(sys.executable, [sys.executable, "-c", OFF, "nao_sim is off"])  # noqa: S606  frees what it held


def _run(told: threading.Event) -> int:
    arguments = rospy.myargv(sys.argv)[1:]
    options = parser("rosrun nao_sim_bridge nao_sim")
    options.add_argument("--publish-clock", choices=("auto", "true", "false"), default="auto", help="publish /clock")
    parsed = options.parse_args(arguments)
    name = _name()
    if answers(name):
        print(
            f"a simulator {name} runs on this ROS master already: end it first, or start this one on another master "
            "(roslaunch -p PORT) or in a namespace, with another nao_port",
            file=sys.stderr,
        )
        if _launched():
            _make_way(name)
        return REFUSED
    rospy.init_node(NAME, disable_signals=True)  # the simulator ends before its node does
    try:
        parsed = options.parse_args([*_from_parameters(options), *arguments])
        server = open_server(server_options(parsed))
        _end_when_told(told, server.ended)
        server.start()
    except (SimulationError, RuntimeError) as error:
        rospy.logfatal("%s", error)
        return REFUSED
    wants_clock = {"auto": parsed.speed != 1.0, "true": True, "false": False}[parsed.publish_clock]
    # Before the services: who waits for these may ask for it.
    ros_side, ready = _ros_side(server, wants_clock)
    clock = "the simulated time" if rospy.get_param("/use_sim_time", False) else "the computer's"
    rospy.loginfo("%s, world %s, speed %g; ROS time is %s", ready, parsed.world, parsed.speed, clock)
    status = wait_for_end(server)
    exit_in_time()
    if status == FAILED:
        rospy.logfatal("the simulation has failed; see the log of the node")
    close_all(ros_side.close, *server.ending())
    return status


def _end_when_told(*events: threading.Event) -> None:
    def end(*_: object) -> None:
        for event in events:
            event.set()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)
    rospy.on_shutdown(end)


def answers(name: str) -> bool:
    """Whether there is a node of that name that answers."""
    before = socket.getdefaulttimeout()
    socket.setdefaulttimeout(ANSWER_LIMIT)
    try:
        uri = rosgraph.Master(f"{name}_starting").lookupNode(name)
        xmlrpc.client.ServerProxy(uri).getPid(name)
    except (rosgraph.MasterError, OSError, http.client.HTTPException, xmlrpc.client.Error):
        return False
    finally:
        socket.setdefaulttimeout(before)
    return True


def _ros_side(server: SimulatorServer | RobotsServer, wants_clock: bool) -> tuple[RosSide, str]:
    """The ROS side of one robot or several, and what to say of them; their ports are parameters then."""
    if isinstance(server, SimulatorServer):
        _tell_port("~bound_port", server.broker.port)
        return RosSide(server, wants_clock), f"simulated NAO ready on port {server.broker.port}"
    several = dict(zip(server.names, server.servers))
    for name, one in several.items():
        _tell_port(f"{name}/nao_sim/bound_port", one.broker.port)
    ports = ", ".join(f"{name} on port {one.broker.port}" for name, one in several.items())
    return RosSide(server.servers[0], wants_clock, several), f"simulated NAOs ready: {ports}"


def _tell_port(name: str, port: int) -> None:
    """Set a parameter; a ROS master that is away at this moment ends no robot."""
    try:
        rospy.set_param(name, port)
    except OSError as error:
        rospy.logwarn("the parameter %s is not set: the ROS master does not answer: %s", name, error)


def _from_parameters(options) -> list[str]:
    """Command line words for the node's private parameters that are set."""
    words: list[str] = []
    for name in VALUES:
        value = rospy.get_param(f"~{name}", None)
        if value is not None:
            # In one word: a value may begin with a minus sign.
            words.append(f"--{name.replace('_', '-')}={str(value).lower() if isinstance(value, bool) else value}")
    return words + [f"--{name.replace('_', '-')}" for name in SWITCHES if rospy.get_param(f"~{name}", False)]
