"""The node `nao_sim`: reads parameters, builds server and ROS side, and spins."""

from __future__ import annotations

import sys

import rospy

from nao_sim_bridge.cli import parser, server_options
from nao_sim_bridge.robots_server import RobotsServer, open_server
from nao_sim_bridge.ros_side import RosSide
from nao_sim_bridge.server import SimulatorServer
from nao_sim_bridge.sim.errors import SimulationError

# Parameters of the node that stand for options of the command line; the command line wins.
VALUES = (
    "port",
    "listen",
    "speed",
    "world",
    "seed",
    "robot",
    "posture",
    "friction",
    "payload",
    "sensor_noise",
    "sensor_delay",
    "renderer",
    "record_dir",
    "sound_file",
    "publish_clock",
    "robots",
    "places",
)
SWITCHES = ("gui", "paused", "verbose", "sound_card", "charger")


def main() -> int:
    """Run until ROS shuts down, a client shuts the robot down, or the simulation fails; returns the exit status."""
    arguments = rospy.myargv(sys.argv)[1:]
    options = parser("rosrun nao_sim_bridge nao_sim")
    options.add_argument("--publish-clock", choices=("auto", "true", "false"), default="auto", help="publish /clock")
    parsed = options.parse_args(arguments)
    rospy.init_node("nao_sim", disable_signals=False)
    try:
        parsed = options.parse_args([*_from_parameters(options), *arguments])
        server = open_server(server_options(parsed))
        rospy.on_shutdown(server.ended.set)
        server.start()
    except (SimulationError, RuntimeError) as error:
        rospy.logfatal("%s", error)
        return 1
    wants_clock = {"auto": parsed.speed != 1.0, "true": True, "false": False}[parsed.publish_clock]
    # Before the services: who waits for these may ask for it.
    ros_side, ready = _ros_side(server, wants_clock)
    rospy.loginfo("%s, world %s, speed %g", ready, parsed.world, parsed.speed)
    failed = False
    while not server.ended.wait(0.5):
        failed = not server.runner.running
        if failed:
            rospy.logfatal("the simulation has failed; see the log above")
            break
    ros_side.close()
    server.stop()
    return int(failed)


def _ros_side(server: SimulatorServer | RobotsServer, wants_clock: bool) -> tuple[RosSide, str]:
    """The ROS side of one robot or several, and what to say of them; their ports are parameters then."""
    if isinstance(server, SimulatorServer):
        rospy.set_param("~bound_port", server.broker.port)
        return RosSide(server, wants_clock), f"simulated NAO ready on port {server.broker.port}"
    several = dict(zip(server.names, server.servers))
    for name, one in several.items():
        rospy.set_param(f"{name}/nao_sim/bound_port", one.broker.port)
    ports = ", ".join(f"{name} on port {one.broker.port}" for name, one in several.items())
    return RosSide(server.servers[0], wants_clock, several), f"simulated NAOs ready: {ports}"


def _from_parameters(options) -> list[str]:
    """Command line words for the node's private parameters that are set."""
    words: list[str] = []
    for name in VALUES:
        value = rospy.get_param(f"~{name}", None)
        if value is not None:
            # In one word: a value may begin with a minus sign.
            words.append(f"--{name.replace('_', '-')}={str(value).lower() if isinstance(value, bool) else value}")
    return words + [f"--{name.replace('_', '-')}" for name in SWITCHES if rospy.get_param(f"~{name}", False)]
