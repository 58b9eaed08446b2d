"""What all nodes do alike: arguments and parameters, log, spin, and the watch of process owners."""

from __future__ import annotations

import argparse
import logging
import os
import signal
import sys
import threading
import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

import rosgraph
import rospy
from actionlib_msgs.msg import GoalID
from std_srvs.srv import Empty

from naoqi.errors import NaoError
from naoqi.limits import DEFAULT_TIMING, SERVER_PATIENCE, Timing

from ..core.fields import limit, number_parameter
from ..core.process_owners import GOAL, SERVICE, OwnerLine, OwnerWatch, Stops
from ..core.processes import exit_in_time
from ..core.robot import require_start_patience
from .goal_client import GoalTracker
from .master_api import GONE, Api, MasterCheck, Refused, node_runs
from .server_node import forward_logs

log = logging.getLogger(__name__)

QUEUE = 20
"""Cancelled goals of an action that a server which is found late still gets."""


class GoalCanceller(rospy.SubscribeListener):
    """Cancels goals of others. Any thread.

    ROS API:
        Publishes `ACTION/cancel` (actionlib_msgs/GoalID) of the actions whose clients have died.
    """

    def __init__(self) -> None:
        super().__init__()
        self._lock = threading.Lock()
        self._publishers: dict[str, rospy.Publisher] = {}
        self._cancelled: dict[str, deque[str]] = defaultdict(partial(deque, maxlen=QUEUE))

    def cancel(self, topic: str, goal: str) -> None:
        """Cancel a goal; a server that is not connected yet gets the cancellation when it is.

        A server that is connected to another publisher of this process causes no `peer_subscribe`: it gets it at once.
        """
        with self._lock:
            self._cancelled[topic].append(goal)
            publisher = self._publishers.get(topic)
            if publisher is None:
                publisher = rospy.Publisher(topic, GoalID, subscriber_listener=self, queue_size=QUEUE)
                self._publishers[topic] = publisher
        publisher.publish(GoalID(id=goal))

    def peer_subscribe(self, topic_name: str, _publish: Any, peer_publish: Any) -> None:
        for goal in tuple(self._cancelled[topic_name]):
            peer_publish(GoalID(id=goal))


def call_for(service: str, node: str) -> None:
    """Call a service without arguments in the name of a node that has died.

    Raises NaoError if nobody offers it, or it failed.
    """
    try:
        rospy.ServiceProxy(service, Empty, headers={"callerid": node})()
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise NaoError(f"{service} failed: {error}") from error


def _call_in_thread(service: str, node: str) -> None:
    """Call it without waiting: to stop a walk takes a second, and the next thing is to be stopped meanwhile."""

    def call() -> None:
        try:
            call_for(service, node)
        except NaoError as error:
            log.error("what %s has left may go on: %s", node, error)

    threading.Thread(target=call, name=service, daemon=True).start()


def watch_owners(robot: Any) -> None:
    stops = Stops(robot, {GOAL: GoalCanceller().cancel, SERVICE: _call_in_thread})
    watch = OwnerWatch(robot.address, stops.stop)
    rospy.on_shutdown(watch.close)


DEFAULT_IP = "127.0.0.1"
DEFAULT_PORT = 9559
BOUND_PORT = "nao_sim/bound_port"
"""Parameter: where a simulator tells its port."""
PORT_PERIOD = 0.2
"""s between two looks at it: a dozen nodes look while the simulator starts."""
TOLD_AFTER = 10.0
"""s of waiting after which that is in the log."""
FORWARDED_LOGGERS = ("naoqi", "nao_library_modules")
LAUNCHED = "__log:="
"""How an argument begins that roslaunch gives to its nodes, and nobody else does."""
NAME_PERIOD = 1.0
"""s between two looks whether the node's name is free."""
REPLACED = "replaced"
"""Private parameter of a node: programs that had its name until another node took it."""
SERVER = "NaoLights"
"""Whose parameters tell which robot the nodes of a namespace are for."""


def robot_parser(description: str) -> argparse.ArgumentParser:
    """A parser with the options that every node has.

    An option that is not given is None, so that the node's parameter can take its place.
    """
    parser = argparse.ArgumentParser(
        description=description,
        epilog="The private parameters ~pip and ~pport stand in for options that are not given, and NAO_IP "
        "and NAO_PORT of the environment for these. "
        "Names and parameters are set with ROS remappings: name:=other, _parameter:=value.",
    )
    parser.add_argument("--pip", metavar="IP", help=f"address of the robot (default NAO_IP, else {DEFAULT_IP})")
    parser.add_argument(
        "--pport",
        metavar="PORT",
        type=int,
        help=f"port of its NAOqi (default NAO_PORT, else {DEFAULT_PORT}); 0: that of the simulator in the namespace",
    )
    return parser


def robot_address(options: argparse.Namespace, get_param: Callable[[str, Any], Any]) -> tuple[str, int]:
    """Address and port of the robot: command line, then parameter, then environment (NAO_IP, NAO_PORT), then default.

    `options`: what `robot_parser` gave. `get_param`: gives a parameter by name, or the default given with it. Raises
    NaoError if the port is no port.

    Port 0 is the port that the simulator in this namespace has: it is waited for.
    """
    ip = options.pip if options.pip is not None else get_param("~pip", os.environ.get("NAO_IP") or DEFAULT_IP)
    port = options.pport if options.pport is not None else get_param("~pport", _usual_port())
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port < 65536:
        raise NaoError(f"port {port!r} is no port: 1..65535, or 0 for that of the simulator in this namespace")
    return str(ip), port or simulator_port()


def simulator_port(pause: Callable[[float], None] = rospy.rostime.wallsleep) -> int:
    """Port of the simulator in this namespace, or the nearest one above; waits until the simulator has told it.

    The program ends if the node is told to end before.
    """
    began, told = time.monotonic(), False
    while not rospy.is_shutdown():
        try:
            name = rospy.search_param(BOUND_PORT)
            port = rospy.get_param(name, 0) if name else 0
        except (OSError, rospy.ROSException):  # no master at this moment
            port = 0
        if port:
            return int(port)
        if not told and time.monotonic() - began > TOLD_AFTER:
            rospy.logwarn("waiting for the port of the simulator, parameter %s: nao_sim is not ready yet", BOUND_PORT)
            told = True
        pause(PORT_PERIOD)
    sys.exit(0)


def _usual_port() -> Any:
    """The port of the environment; its text as it is where that is no number."""
    text = os.environ.get("NAO_PORT") or str(DEFAULT_PORT)
    return int(text) if text.isdecimal() else text


def launch_path(value: Any) -> tuple[str, str] | None:
    """`(package, launchfile)` from a parameter: "package launchfile", a list of the two, or nothing.

    Raises NaoError if it is something else.
    """
    words = value.split() if isinstance(value, str) else value
    if not words:
        return None
    if isinstance(words, list) and len(words) == 2 and all(isinstance(word, str) for word in words):
        return words[0], words[1]
    raise NaoError(f"~launchpath {value!r}: it is 'package launchfile'")


def run_module(
    module: Callable[..., Any],
    name: str,
    description: str,
    argv: Sequence[str] | None = None,
    parameters: Mapping[str, Any] | None = None,
    watches: bool = False,
) -> int:
    """Start a module as a node and keep it until the node ends; see `NodeProcess`.

    Args:
        name: Default name of the node.
        description: What `--help` says.
        argv: Arguments, those of the process by default.
        parameters: Name -> default of further private parameters, which the module takes by name.
        watches: Whether the node stops what nodes that have died left going, and says when the ROS master is gone; for
            nodes that set nothing going themselves.

    Returns:
        Exit status.

    ROS API:
        Parameters `~pip`, `~pport`: the robot. `~autostart`, `~launchpath` ("package launchfile"): launch
        file to start with the module. `~start_patience`: s from the start for which goals wait for a robot that
        has never been reached (default 30). `patience`: see `take_patience`.
    """
    process = NodeProcess(name, description, argv)
    try:
        ip, port = robot_address(process.options, rospy.get_param)
        with being_made(name):
            made = module(
                ip,
                port,
                autostart=bool(rospy.get_param("~autostart", False)),
                launchpath=launch_path(rospy.get_param("~launchpath", "")),
                **{name: rospy.get_param(f"~{name}", default) for name, default in (parameters or {}).items()},
                **_start_patience(),
            )
        take_patience(made.robot)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    own_as_node(made.robot, watches)
    process.spin()
    return 0


class NodeProcess:
    """This process as a node: it ends in time, and its log has what the libraries log.

    The master shuts a node down whose name another one takes, such as a server of a user's in place of a launched one.
    A process that roslaunch started notes that in a parameter of that name, and ends; started again, the same program
    waits until no other node has the name. So the user's server that was killed has the name again when it comes back.

    Attributes:
        options: What `robot_parser` gives for the arguments.
    """

    def __init__(self, name: str, description: str, argv: Sequence[str] | None) -> None:
        self.options = robot_parser(description).parse_args(rospy.myargv(argv)[1:])
        # Before rospy's own hook, which hangs where Ctrl-C comes while the node talks to the master.
        rospy.core.add_preshutdown_hook(self._on_shutdown)
        with being_made(name):
            wait_for_name(launched_name(name))
            rospy.init_node(name)
        forward_logs(*FORWARDED_LOGGERS)

    def spin(self) -> None:
        """Wait until the node has ended. Main thread."""
        name, own = rospy.get_name(), rospy.get_node_uri()
        rospy.spin()
        if launched_name(name) and node_runs(name, but=own):
            # Not to /rosout: the topics are closed.
            text = f"another node took the name {name}: this one is started again when that one has ended"
            print(text, file=sys.stderr, flush=True)
            note_replaced(name)

    def _on_shutdown(self, _reason: str) -> None:
        exit_in_time()


def launched_name(name: str) -> str:
    """Full name of the node that this process is for roslaunch, `name` by default; empty: it was started otherwise."""
    if not any(argument.startswith(LAUNCHED) for argument in sys.argv):
        return ""
    called = rosgraph.names.load_mappings(sys.argv).get("__name", name)
    return rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(), called)


def note_replaced(name: str) -> None:
    """Note for the next start of this program that another node took its name."""
    master = Api(rosgraph.get_master_uri(), name)
    with suppress(Refused, *GONE):
        master.ask("setParam", f"{name}/{REPLACED}", sorted({*_replaced(name), sys.argv[0]}))


def wait_for_name(name: str) -> None:
    """Wait until no other node has this full name, if one took it from this program before. Ctrl-C ends the process."""
    replaced = _replaced(name) if name else []
    if sys.argv[0] not in replaced:
        return
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)
    while node_runs(name):
        time.sleep(NAME_PERIOD)
    replaced.remove(sys.argv[0])
    with suppress(Refused, *GONE):
        Api(rosgraph.get_master_uri(), name).ask("setParam", f"{name}/{REPLACED}", replaced)


def _replaced(name: str) -> list[str]:
    try:
        return list(Api(rosgraph.get_master_uri(), name).ask("getParam", f"{name}/{REPLACED}"))
    except (Refused, *GONE):
        return []


@contextmanager
def being_made(name: str) -> Iterator[None]:
    """End the process in a word where something fails for the one reason that the node is ended meanwhile."""
    try:
        yield
    except Exception as error:
        if not rospy.core.is_shutdown_requested():
            raise
        raise SystemExit(f"{name}: the node was ended while it was being made ({error})") from None


def own_as_node(robot: Any, watches: bool) -> None:
    """Own what is set going under the name of this node.

    `robot`: its proxies and connection. `watches`: as `run_module` takes it.
    """
    own_goals(robot.owners)
    if watches:
        watch_owners(robot)
        rospy.on_shutdown(MasterCheck(rosgraph.get_master_uri(), rospy.get_name()).close)


def own_goals(owners: OwnerLine) -> None:
    """Own the goals that this process sends, under the name of its node: they are cancelled if it dies."""
    owners.name = rospy.get_name()
    GoalTracker.owners = owners


def end_in_time() -> None:
    """See that this process ends soon after its node."""
    rospy.core.add_preshutdown_hook(lambda _: exit_in_time())


def robot_beside(name: str, default: Any) -> Any:
    """`~pip` or `~pport` of this node; else that of the servers in its namespace, else the default."""
    return rospy.get_param(name, rospy.get_param(name.replace("~", f"{SERVER}/"), default))


def take_patience(robot: Any) -> None:
    """Take over the parameter `patience`: s that the robot may be silent before it is lost (default 10).

    That of the node itself counts, else the nearest of the namespaces around it. Raises NaoError if it is no such time.
    """
    name = rospy.search_param("patience")
    if name is not None:
        patience = number_parameter(name, rospy.get_param(name), limit("patience"))
        robot.connection.timing = Timing(patience=patience)
    elif robot.connection.timing is DEFAULT_TIMING:  # nobody has said anything else
        robot.connection.timing = Timing(patience=SERVER_PATIENCE)


def _start_patience() -> dict[str, float]:
    """The parameter, where it is set: a module may have been written without it."""
    name = "start_patience"
    return {name: require_start_patience(rospy.get_param(f"~{name}"))} if rospy.has_param(f"~{name}") else {}
