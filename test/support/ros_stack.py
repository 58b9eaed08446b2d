"""One running stack for all cases of the level ros: a master, simulator, driver and servers, watched for deaths."""

from __future__ import annotations

import os
import signal
import subprocess
from ctypes import CDLL
from pathlib import Path

import rospy

from nao_library_modules.ros.own_stack import OwnMaster, OwnStack, StackFailed
from nao_sim_bridge.testing import SimulatedRobot, StackNotReady, wait_until

SPEED = 2
PR_SET_PDEATHSIG = 1
LIMIT = 300.0
ATTEMPTS = 2
LINES = 20
"""Of what a stack has printed that does not start."""


def _die_with_parent():
    CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGINT)
    signal.signal(signal.SIGINT, signal.default_int_handler)


def start_program(*command, **options):
    """A program that gets Ctrl-C when this process ends, however it ends."""
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, preexec_fn=_die_with_parent, **options)


class RosStack:
    """A stack on a master of its own; this process is a node of that master.

    The master outlives the stack, so that a stack which a case has broken can be started again.

    Args:
        folder: For logs and everything else that ROS writes.
        arguments: Of whole_stack.launch.
    """

    def __init__(self, folder, **arguments):
        self.folder = folder
        self._arguments = {"speed": SPEED, "world": "empty", **arguments}
        self.broken = True
        self.stack = None
        self._failures = []
        self._starts = 0
        self._nodes = {}
        os.environ.update(ROS_HOME=str(folder / "home"), ROS_LOG_DIR=str(folder / "log"))
        for name in ("home", "log"):
            (folder / name).mkdir()
        self._master = OwnMaster(folder / "master.txt")
        os.environ["ROS_MASTER_URI"] = self._master.uri

    def ensure(self, world="empty"):
        """Start the stack, or start it again if a case has broken it or another world is wanted.

        Raises:
            RuntimeError: It does not start; whoever asks after two failures is not kept waiting.
        """
        if not self.broken and world == self._arguments["world"]:
            return
        if len(self._failures) >= ATTEMPTS:
            raise RuntimeError(f"the stack did not start {ATTEMPTS} times, at last: {self._failures[-1]}")
        self.rest()
        self._arguments["world"] = world
        self._starts += 1
        try:
            self._start()
        except (StackFailed, StackNotReady) as error:
            words = self.stack.log.read_text(errors="replace").splitlines()[-LINES:]
            self._failures.append(f"{error}\n" + "\n".join(words))
            raise RuntimeError(f"the stack did not start: {self._failures[-1]}") from error
        self.broken = False
        self._failures.clear()

    def _start(self):
        self._nodes = {}
        self.stack = OwnStack(
            self.folder / f"stack_{self._starts}.txt",
            {name: str(value) for name, value in self._arguments.items()},
            launch=("nao_library_tests", "whole_stack.launch"),
            master_uri=self._master.uri,
        )
        self.stack.wait_for_robot(LIMIT)
        os.environ["NAO_PORT"] = str(self.stack.nao_port)
        if not rospy.core.is_initialized():  # not before the stack has said whose time counts
            rospy.init_node(f"ros_tests_{os.getpid()}", disable_signals=True)
        self.robot = SimulatedRobot(limit=LIMIT)
        memory, keys = self.robot.module("ALMemory"), ["ALTextToSpeech/TextDone"]  # it has no value yet
        wait_until(lambda: memory.getListData(keys) == [True], LIMIT, "nao_walker's word, which no case should hear")

    def rest(self):
        """End it until it is needed again; its master stays."""
        if self.stack:
            self.stack.stop()
        os.environ.pop("NAO_PORT", None)
        self.broken = True

    @property
    def master_pid(self):
        """Process id of the ROS master."""
        return self._master.pid

    def deaths(self, respawned=()):
        """Names of the nodes that have ended since the stack was started, but for those that were to be respawned."""
        self._nodes.update(children(self.stack.pid))
        dead = {pid: name for pid, name in self._nodes.items() if not _alive(pid)}
        for pid in dead:
            del self._nodes[pid]
        return [name for name in dead.values() if name not in respawned]

    def close(self):
        rospy.signal_shutdown("the tests are over")
        self.rest()
        self._master.stop()


def children(parent):
    """Process id -> name of node, of all programs that a roslaunch has started."""
    found = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            status = (folder / "stat").read_text().rpartition(")")[2].split()
            words = (folder / "cmdline").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue  # it has just ended
        if int(status[1]) == parent:
            found[int(folder.name)] = next((w[8:] for w in words if w.startswith("__name:=")), words[0])
    return found


def _alive(pid):
    try:
        return (Path("/proc") / str(pid) / "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
