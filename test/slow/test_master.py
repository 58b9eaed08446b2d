"""A ROS master that hangs or dies: nothing hangs with it, what is under way goes on, and the log says what to do."""

import os
import signal
import subprocess
import sys

import pytest
from listening import listens
from named_port import named_port
from waits import hold

from nao_library_modules.ros.own_stack import OwnStack
from nao_sim_bridge.testing import wait_until

LIMIT = 60.0
SILENT = "the ROS master at {} does not answer"
AGAIN = "the ROS master at {} answers again"
RESTARTED = "the ROS master at {} was started again and knows none of these nodes: end this launch and start it again"
CHECKS = 2
"""Nodes that look after the master: one of the driver, one of the servers."""
MASTER = "import sys; from rosmaster import rosmaster_main; rosmaster_main(['rosmaster', '--core', '-p', sys.argv[1]])"
USER = """
import sys, time
import rospy
import actionlib
from nao_library_actions.msg import NaoBehaviorAction, NaoLedAction, NaoMotionAction
sys.path.insert(0, sys.argv[1])
from goal_functions import behavior, led, motion

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
moves, runs = client("NaoMotion", NaoMotionAction), client("NaoBehavior", NaoBehaviorAction)

def done(client, action, function):
    client.send_goal(goal(action, function))
    assert client.wait_for_result(rospy.Duration(60)), function.function
    assert client.get_state() == 3, (function.function, client.get_goal_status_text())
    return client.get_result()
"""
LONG = """
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
done(client("NaoLights", NaoLedAction), NaoLedAction, led("on", lights=["FaceLeds"]))
assert rospy.get_param("robot_description") and rospy.get_param("nao_walker/cmd_vel_timeout") == 0.5
print("all is found", flush=True)
"""


class Master:
    def __init__(self, folder):
        self.port = named_port()
        self._output = folder / "master.txt"
        self.start()

    def start(self):
        with self._output.open("ab") as output:
            command = [sys.executable, "-c", MASTER, str(self.port)]
            self.process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL)
        wait_until(lambda: listens(self.port), LIMIT, "the ROS master")

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


def test_nothing_hangs_with_a_master_and_after_a_dead_one_the_stack_is_started_again(master, user, tmp_path):
    with OwnStack(tmp_path / "stack.txt", {}, master_uri=os.environ["ROS_MASTER_URI"]) as stack:
        stack.wait_for_robot()

        def told(text):
            return stack.log.read_text(errors="replace").count(text.format(stack.master_uri))

        long = user(LONG)
        assert long.says("under way")
        master.hang()
        wait_until(lambda: told(SILENT) >= CHECKS, LIMIT, "word of a master that hangs")
        master.go_on()
        assert user(NEW).says("all is found")
        wait_until(lambda: told(AGAIN) == told(SILENT), LIMIT, "word of a master that answers again")
        before = told(SILENT)
        master.kill()
        wait_until(lambda: told(SILENT) >= before + CHECKS, LIMIT, "word of a master that is gone")
        master.start()
        wait_until(lambda: told(RESTARTED) == CHECKS, LIMIT, "what to do now")
        long.go_on()
        assert long.says("went on until it was cancelled")
    assert "escalating to" not in stack.log.read_text(errors="replace")  # every node has ended by itself
    with OwnStack(tmp_path / "again.txt", {}, master_uri=stack.master_uri) as again:
        again.wait_for_robot()
        assert user(NEW).says("all is found")
