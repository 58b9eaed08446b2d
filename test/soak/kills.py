#!/usr/bin/env python3
"""Kills each node in turn (kill -9) in the middle of what it does, and tells how soon all is well again.

For each kill: s until the robot is still, until the goal has ended for its client, and until the node's function and
all servers work. A report goes to the standard output, one line of JSON a kill and one at the end. Exit status 1 if a
limit was passed.
"""

import argparse
import json
import math
import os
import signal
import socket
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rospy

from nao_library_modules.core.process_owners import PEER, place
from nao_library_modules.ros.own_stack import OwnStack
from nao_sim_bridge.testing import SimulatedRobot, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from nao_soak.kill_scenes import ANSWER, PATIENCE, SCENES, SPEECH, WALK, process_of, rviz_goal, works  # noqa: E402

STILL, ENDED, WORKS = 1.0, 5.0, 5.0
"""Limits, s of wall time: the robot runs in real time."""
PERIOD, LEAST = 0.1, 0.004
"""s between two looks, and m and rad in it from which on the robot moves."""
STEP = 0.8
"""s after which a robot that walks has moved on, however slow a part of its step is."""
BEGUN = 0.05
"""m after which a robot walks."""
LAUNCH = ("nao_library_tests", "killed_stack.launch")
SIMULATOR = "/nao_sim"


class Robot:
    """What the robot does, seen past the nodes."""

    def __init__(self, port):
        self.port = port
        self.simulated = SimulatedRobot(limit=PATIENCE)
        self.motion = self.simulated.module("ALMotion")
        self.speech = self.simulated.module("ALMemory")

    def state(self, joints):
        return [*self.motion.getRobotPosition(True), *self.motion.getAngles(joints, True)]

    def speaks(self):
        status = self.speech.getData("ALTextToSpeech/Status")
        return isinstance(status, list) and status[1] not in ("done", "stopped")

    def still(self, what):
        """Whether it is still; what: joints beside its place, or its speech."""
        if what == SPEECH:
            return not self.speaks()
        before = self.state(what)
        time.sleep(PERIOD)
        return max(abs(a - b) for a, b in zip(before, self.state(what))) < LEAST

    def way(self):
        """m from where it stands when it is fresh."""
        return math.hypot(*self.motion.getRobotPosition(True)[:2])

    def last_moved(self, what):
        """s from now until it was seen moving last; None if it goes on."""
        began, moved = time.monotonic(), 0.0
        while time.monotonic() - began < moved + STEP:
            if moved > PATIENCE:
                return None
            now = time.monotonic() - began
            if not self.still(what):
                moved = now
        return round(moved, 2)

    def fresh(self):
        self.motion.killAll()
        self.simulated.reset()
        self.motion.wakeUp()
        wait_until(lambda: self.still("Body") and not self.speaks(), PATIENCE, "a robot that is still")


def pid_of(node):
    """Process of a node, of a part of the driver, or of a process of the simulator by the module that it runs.

    Raises:
        LookupError: There is none.
    """
    name = SIMULATOR if "." in node else process_of(node)
    pid = ServerProxy(rosgraph.Master("/kills").lookupNode(name)).getPid("/kills")[2]
    if name != SIMULATOR:
        return pid
    for task in Path(f"/proc/{pid}/task").iterdir():
        with suppress(OSError):  # a thread or a child that has just ended
            for child in (task / "children").read_text().split():
                if node.encode() in Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0"):
                    return int(child)
    raise LookupError(f"the simulator has no process that runs {node}")


def kill_watch(port):
    """Kill the process that stops what has lost its owner."""
    with socket.socket(socket.AF_UNIX) as line:
        line.connect(place(f"127.0.0.1:{port}"))
        pid, _, _ = PEER.unpack(line.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, PEER.size))
    os.kill(pid, signal.SIGKILL)


def since(began, condition, limit, period=0.02):
    """s until something is so; None if it is not within the limit."""
    while not condition():
        if time.monotonic() - began > limit:
            return None
        time.sleep(period)
    return round(time.monotonic() - began, 2)


def walks(robot):
    """Whether the robot walks to a goal of RViz, which nobody tells."""
    rviz_goal()
    walked = since(time.monotonic(), robot.motion.moveIsActive, ANSWER) is not None
    robot.motion.stopMove()
    return walked


def well(robot, node, dead, goal):
    """Whether a killed node is there again, what it does works, and so do all servers."""
    try:
        # A process of the simulator need not be there before it is needed.
        there = "." in node or pid_of(node) != dead
        return there and goal.again() and works(node) and (node != "naoqi_moveto" or walks(robot))
    except (OSError, rosgraph.MasterError, rospy.ROSException, rospy.ServiceException):
        return False


def kill(robot, scene):
    if scene.moves:
        robot.fresh()
    goal = scene.begin()
    begun = (lambda: robot.way() > BEGUN) if scene.moves == WALK else lambda: not robot.still(scene.moves)
    wait_until(lambda: goal.active() and (not scene.moves or begun()), PATIENCE, f"{scene.what} of {scene.node}")
    if scene.unwatched:
        kill_watch(robot.port)
    time.sleep(1.0)  # in the middle of it
    dead = pid_of(scene.node)
    os.kill(dead, signal.SIGKILL)
    began = time.monotonic()
    if scene.what == "cmd_vel":
        goal.stop()
    still = 0.0
    if scene.moves:
        still = robot.last_moved(scene.moves)
    ended = since(began, goal.over, PATIENCE)
    again = since(began, lambda: well(robot, scene.node, dead, goal), PATIENCE)
    goal.stop()
    return {"node": scene.node, "what": scene.what, "still": still, "ended": ended, "works": again}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=len(SCENES), help="how many (default: one of each kind)")
    parser.add_argument("--from", dest="first", type=int, default=0, help="number of the first kind")
    parser.add_argument("--output", type=Path, help="folder for the logs of the stack")
    options = parser.parse_args()
    folder = options.output or Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("ROS_HOME", "ROS_LOG_DIR"):
        os.environ[name] = str(folder / "ros")
    records = []
    with OwnStack(folder / "stack.txt", {"record_dir": str(folder / "records")}, launch=LAUNCH) as stack:
        stack.wait_for_robot()
        os.environ.update(ROS_MASTER_URI=stack.master_uri, NAO_PORT=str(stack.nao_port))
        rospy.init_node("kills", disable_signals=True)
        robot = Robot(stack.nao_port)
        wait_until(lambda: works(""), PATIENCE, "all servers")
        for number in range(options.kills):
            records.append(kill(robot, SCENES[(options.first + number) % len(SCENES)]))
            print(json.dumps(records[-1]), flush=True)
        rospy.signal_shutdown("it is over")
    limits = {"still": STILL, "ended": ENDED, "works": WORKS}
    worst = {name: max((PATIENCE if r[name] is None else r[name]) for r in records) for name in limits}
    nodes = len({record["node"] for record in records})
    print(json.dumps({"kills": len(records), "nodes": nodes, "worst": worst, "limits": limits}))
    return int(any(worst[name] > limit for name, limit in limits.items()))


if __name__ == "__main__":
    sys.exit(main())
