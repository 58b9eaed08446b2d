"""The simulator below roslaunch, which starts it again whenever it ends: when that is of use, and when it is not.

Imports nothing heavy: a simulator that cannot even be imported is counted as well.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from typing import NoReturn

import rosgraph

from nao_sim_bridge.base.closing import REFUSED

NAME = "nao_sim"
LAUNCHED = "__log:="
"""How an argument begins that roslaunch gives to its nodes, and nobody else does."""
STARTS = "starts"
"""Private parameter: how often it was started since it was ready last. nao_sim.launch sets it to 0."""
TRIES = 3
"""How often one is started that ends before it is ready, without saying why: it may come up all the same."""
OFF = "import signal; signal.signal(signal.SIGINT, signal.SIG_DFL); signal.pause()"


def launched() -> bool:
    return any(argument.startswith(LAUNCHED) for argument in sys.argv)


def node_name() -> str:
    """Name of this node, also before there is one."""
    mappings = rosgraph.names.load_mappings(sys.argv)
    return rosgraph.names.resolve_name(mappings.get("__name", NAME), rosgraph.names.get_ros_namespace())


def count_start() -> None:
    """Count this start, and end the launch file if too many have ended before they were ready."""
    if not launched():
        return
    name = node_name()
    with suppress(OSError):  # a master that is away: it goes on without
        try:
            starts = int(_master().getParam(f"{name}/{STARTS}"))
        except rosgraph.MasterError:
            return  # a launch file that does not ask for it
        if starts >= TRIES:
            end_launch(f"the simulator has ended {starts} times before it was ready, see above")
        _master().setParam(f"{name}/{STARTS}", starts + 1)


def note_ready() -> None:
    """Count no start before this one."""
    if launched():
        with suppress(OSError):  # a master that is away at this moment ends no robot
            _master().setParam(f"{node_name()}/{STARTS}", 0)


def make_way(reason: str) -> NoReturn:
    """End the launch file: its other nodes have taken the names of those of the simulator that runs, and its time."""
    running, master = node_name(), _master()
    clock = any(topic == "/clock" and running in nodes for topic, nodes in master.getSystemState()[0])
    master.setParam("/use_sim_time", clock)
    end_launch(f"{reason}; the nodes of the one before come back")


def end_launch(reason: str) -> NoReturn:
    """End all that was launched with this node; in the terminal, and in the log, is why."""
    # As rospy prints it: there may be no node yet.
    print(f"[FATAL] [{node_name()}]: {reason}", file=sys.stderr)
    print("this launch file ends", file=sys.stderr, flush=True)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(REFUSED))
    os.kill(os.getppid(), signal.SIGINT)
    while True:
        signal.pause()  # until roslaunch ends this process


def stay_off() -> NoReturn:
    """Be an idle process: a robot that was switched off would be switched on again."""
    print("nao_sim is off until its launch file is started again", file=sys.stderr, flush=True)
    sys.stdout.flush()
    signal.alarm(0)
    for descriptor in map(int, os.listdir("/proc/self/fd")):  # no range: a process may have room for a billion
        if descriptor > 2:
            os.closerange(descriptor, descriptor + 1)
    os.execv(sys.executable, [sys.executable, "-c", OFF, "nao_sim is off"])  # noqa: S606  frees what it held


def _master() -> rosgraph.Master:
    return rosgraph.Master(f"{node_name()}_starting")
