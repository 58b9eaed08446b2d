"""The node `nao_sim`: reads parameters, builds server and ROS side, and spins."""

from __future__ import annotations

import http.client
import signal
import socket
import sys
import threading
import xmlrpc.client
from dataclasses import replace
from typing import NoReturn

import rosgraph
import rospy

from nao_sim_bridge.base.closing import FAILED, REFUSED, close_all, exit_in_time, wait_for_end
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.ros.bound_ports import ports_before
from nao_sim_bridge.ros.launched import NAME, end_launch, launched, make_way, node_name, note_ready, stay_off
from nao_sim_bridge.ros.side import RosSide
from nao_sim_bridge.server.cli import parser, server_options, tell_ports
from nao_sim_bridge.server.robots_server import RobotsServer, open_server
from nao_sim_bridge.server.simulator_server import SimulatorServer

# Parameters of the node that stand for options of the command line; the command line wins.
VALUES = (
    "port listen speed world seed robot posture friction payload sensor_noise sensor_delay renderer record_dir "
    "sound_file publish_clock robots places"
).split()
SWITCHES = ("gui", "paused", "verbose", "sound_card", "charger", "allow_private_streams")
ANSWER_LIMIT = 2.0
"""s that a node which may run already has for each answer: one that was stopped has none."""
RUNS = (
    "a simulator {} runs on this ROS master already: end it first, or start this one on another master "
    "(roslaunch -p PORT) or in a namespace, with another nao_port"
)


def main() -> int:
    """Run until ROS shuts down, a client shuts the robot down, or the simulation fails; returns the exit status.

    roslaunch starts a simulator again that was killed or has failed. One that was switched off (ALSystem.shutdown)
    would come back as well: under roslaunch it stays as an idle process until the launch file ends. One that cannot
    start ends the launch file, and so does one whose name is taken on the master.
    """
    told = threading.Event()  # to end, by a signal or by ROS
    status = REFUSED
    try:
        status = _run(told)
    except KeyboardInterrupt:  # before it listens to signals
        told.set()
    except (SimulationError, RuntimeError) as error:
        if launched() and not told.is_set():
            end_launch(str(error))
        print(f"{NAME}: {error}", file=sys.stderr)
    if launched() and status == 0 and not told.is_set():
        rospy.signal_shutdown("off")
        stay_off()
    rospy.signal_shutdown("the simulator has ended")
    return status


def _run(told: threading.Event) -> int:
    arguments = rospy.myargv(sys.argv)[1:]
    options = parser("rosrun nao_sim_bridge nao_sim")
    options.add_argument("--publish-clock", choices=("auto", "true", "false"), default="auto", help="publish /clock")
    options.error = _refuse  # type: ignore[method-assign]
    options.parse_args(arguments)
    if answers(node_name()):
        problem = RUNS.format(node_name())
        if launched():
            make_way(problem)
        raise SimulationError(problem)
    rospy.init_node(NAME, disable_signals=True)  # the simulator ends before its node does
    parsed = options.parse_args([*_from_parameters(), *arguments])
    chosen = server_options(parsed)
    if chosen.port == 0 and launched():
        chosen = replace(chosen, ports=ports_before(chosen.robots))
    server = open_server(chosen)
    _end_when_told(told, server.ended)
    server.start()
    tell_ports(server, parsed.port_file)
    wants_clock = {"auto": parsed.speed != 1.0, "true": True, "false": False}[parsed.publish_clock]
    # Before the services: who waits for these may ask for it.
    ros_side, ready = _ros_side(server, wants_clock)
    note_ready()
    clock = "the simulated time" if rospy.get_param("/use_sim_time", False) else "the computer's"
    rospy.loginfo("%s, world %s, speed %g; ROS time is %s", ready, parsed.world, parsed.speed, clock)
    status = wait_for_end(server)
    exit_in_time()
    if status == FAILED:
        rospy.logfatal("the simulation has failed; see the log of the node")
    close_all(ros_side.close, *server.ending())
    return status


def _refuse(problem: str) -> NoReturn:
    raise SimulationError(problem)


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
        return RosSide(server, wants_clock), f"simulated NAO ready on port {server.broker.port}"
    several = dict(zip(server.names, server.servers))
    ports = ", ".join(f"{name} on port {one.broker.port}" for name, one in several.items())
    return RosSide(server.servers[0], wants_clock, several), f"simulated NAOs ready: {ports}"


def _from_parameters() -> list[str]:
    """Command line words for the node's private parameters that are set."""
    words: list[str] = []
    for name in VALUES:
        value = rospy.get_param(f"~{name}", None)
        if value is not None:
            # In one word: a value may begin with a minus sign.
            words.append(f"--{name.replace('_', '-')}={str(value).lower() if isinstance(value, bool) else value}")
    return words + [f"--{name.replace('_', '-')}" for name in SWITCHES if rospy.get_param(f"~{name}", False)]
