"""A ROS master that dies and comes back, or hangs for a while: all is found again, and what was under way goes on."""

import os
import signal
import subprocess
import sys
from collections import Counter

import pytest
from listening import listens
from named_port import named_port
from waits import hold

from nao_library_modules.processes.own_stack import OwnStack
from nao_sim_bridge.testing import wait_until

LIMIT = 60.0
SILENT = "the ROS master at {} does not answer"
"""What the watch says when it has noticed that."""
MASTER = """
import sys
from rosmaster import rosmaster_main
from rosmaster.master_api import ROSMasterHandler

answer = ROSMasterHandler.getParam

def told(self, caller, name):
    if name == "/":
        print("all read by", caller, flush=True)
    return answer(self, caller, name)

ROSMasterHandler.getParam = told
rosmaster_main(["rosmaster", "--core", "-p", sys.argv[1]])
"""
"""A master that tells who has read all that it knows."""
USER = """
import sys, time
import rospy
import actionlib
from nao_library_actions.msg import NaoBehaviorAction, NaoLedAction, NaoMotionAction, NaoTactileAction
sys.path.insert(0, sys.argv[1])
from goal_functions import behavior, led, motion, tactile

rospy.init_node("user", anonymous=True, disable_signals=True)

def client(name, action):
    made = actionlib.SimpleActionClient(name, action)
    assert made.wait_for_server(rospy.Duration(60)), name
    return made

def goal(action, function):
    made = action().action_goal.goal
    setattr(made, made.__slots__[0], [function])
    return made

for service in ("nao_sim/reset", "NaoMotion/describe", "NaoAudioOut/describe", "nao_controller/part_of_nao_driver"):
    rospy.wait_for_service(service, 60)
moves, touches = client("NaoMotion", NaoMotionAction), client("NaoTactile", NaoTactileAction)
runs = client("NaoBehavior", NaoBehaviorAction)

def done(client, action, function):
    client.send_goal(goal(action, function))
    assert client.wait_for_result(rospy.Duration(60)), function.function
    assert client.get_state() == 3, (function.function, client.get_goal_status_text())
    return client.get_result()
"""
LONG = """
done(touches, NaoTactileAction, tactile("onTouch", sensors=["chest"], behavior="hello"))
turn = motion("angleInterpolation", names=["HeadYaw"], angles=[0.5], times=[600.0], stiffness=1.0)
moves.send_goal(goal(NaoMotionAction, turn))
runs.send_goal(goal(NaoBehaviorAction, behavior("runBehavior", text="{help: A wait., do: [{wait: 600}]}")))
while moves.get_state() != 1 or runs.get_state() != 1:
    time.sleep(0.05)
print("under way", flush=True)
sys.stdin.readline()
for made in (moves, runs):
    made.cancel_goal()
    assert made.wait_for_result(rospy.Duration(60))
    assert made.get_state() == 2, (made.get_state(), made.get_goal_status_text())
print("went on until it was cancelled", flush=True)
"""
NEW = """
assert done(touches, NaoTactileAction, tactile("listOnTouch")).memList == ["hello"]
done(client("NaoLights", NaoLedAction), NaoLedAction, led("on", lights=["FaceLeds"]))
assert rospy.get_param("robot_description") and rospy.get_param("nao_walker/cmd_vel_timeout") == 0.5
print("all is back", flush=True)
"""


class Master:
    def __init__(self, folder):
        self.port = named_port()
        self._output = folder / "master.txt"
        self._readers = Counter()
        self.start()

    def start(self):
        with self._output.open("ab") as output:
            command = [sys.executable, "-c", MASTER, str(self.port)]
            self.process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL)
        wait_until(lambda: listens(self.port), LIMIT, "the ROS master")

    def wait_until_known(self):
        """Wait until each watch has read all that it knows, since this was last called."""
        before = self._readers or self._read()
        wait_until(lambda: all(self._read()[each] > before[each] for each in before), LIMIT, "watches that have read")
        self._readers = self._read()

    def _read(self):
        """How often each watch has read all."""
        return Counter(line for line in self._output.read_text().splitlines() if line.startswith("all read by"))

    def kill(self):
        self.process.kill()
        self.process.wait(LIMIT)

    def hang(self):
        hold(self.process.pid)

    def go_on(self):
        self.process.send_signal(signal.SIGCONT)


class User:
    """A program of a user's."""

    def __init__(self, program, errors):
        self._errors = errors
        support = os.path.join(os.path.dirname(__file__), "..", "support")
        command = [sys.executable, "-c", USER + program, support]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        with errors.open("ab") as output:
            self.process = subprocess.Popen(command, stderr=output, **pipes)

    def says(self, line):
        """Whether this is the next line that it prints; with what it failed of, if not."""
        said = self.process.stdout.readline()
        assert said == f"{line}\n", f"{said!r} in place of {line!r}: {self._errors.read_text()}"
        return True

    def go_on(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()

    def close(self):
        self.process.kill()
        self.process.communicate()


@pytest.fixture
def master(tmp_path, monkeypatch):
    for name in ("ROS_HOME", "ROS_LOG_DIR"):
        monkeypatch.setenv(name, str(tmp_path))
    made = Master(tmp_path)
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{made.port}")
    yield made
    made.go_on()
    made.kill()


@pytest.fixture
def user(tmp_path):
    """Starts a program of a user's."""
    started = []

    def start(program):
        started.append(User(program, tmp_path / "user.txt"))
        return started[-1]

    yield start
    for program in started:
        program.close()


def test_a_master_that_dies_or_hangs_knows_everybody_again(master, user, tmp_path):
    with OwnStack(tmp_path / "stack.txt", {}, master_uri=os.environ["ROS_MASTER_URI"]) as stack:
        stack.wait_for_robot()

        def noticed():
            """How often a watch has said that the master does not answer."""
            return stack.log.read_text(errors="replace").count(SILENT.format(stack.master_uri))

        long = user(LONG)
        assert long.says("under way")
        for leave, come in (master.kill, master.start), (master.hang, master.go_on):
            master.wait_until_known()
            silent = noticed()
            leave()
            wait_until(lambda silent=silent: noticed() > silent, LIMIT, "a watch that misses the master")
            come()
            assert user(NEW).says("all is back")
        long.go_on()
        assert long.says("went on until it was cancelled")
