"""Goals that are over at once, for actionlib's own client, which loses ends that come too early."""

import os
import signal
import subprocess
import sys

import pytest

from nao_library_modules.ros.own_stack import OwnMaster

SERVER = """
import rospy
from actionlib.msg import TestAction, TestFeedback
from nao_library_modules.ros.action_server import PromptActionServer
rospy.init_node("server")
def carry_out(goal):
    server.publish_feedback(TestFeedback(goal.goal))
    rospy.sleep(goal.goal / 1000.0)
    server.set_succeeded()
server = PromptActionServer("short", TestAction, carry_out)
server.start()
rospy.spin()
"""
CLIENT = """
import sys
import time
import rospy
from actionlib import ActionClient, SimpleActionClient
from actionlib.msg import TestAction, TestGoal
from actionlib_msgs.msg import GoalStatusArray
rospy.init_node("client")
held, count, duration = float(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
send = ActionClient.send_goal
def send_and_wait(*arguments):
    handle = send(*arguments)
    time.sleep(held)  # only then SimpleActionClient notes which goal it is
    return handle
ActionClient.send_goal = send_and_wait
client, lengths = SimpleActionClient("short", TestAction), []
assert client.wait_for_server(rospy.Duration(60))
rospy.Subscriber("short/status", GoalStatusArray, lambda told: lengths.append(len(told.status_list)))
lost, red, told = 0, [], []
rospy.logerr = lambda text, *_: red.append(text)
for number in range(count):
    client.send_goal(TestGoal(duration), feedback_cb=lambda feedback: told.append(feedback.feedback))
    lost += not client.wait_for_result(rospy.Duration(5))
    assert lost <= count // 10, f"{lost} of {number + 1} lost"
assert len(red) <= count // 5, f"{len(red)} times news of a goal that the client does not track"
assert not duration or len(told) >= count * 0.9, f"feedback of {len(told)} goals of {count}"
assert 0 < max(lengths) < 60, f"{max(lengths)} goals in the status"
"""


LATE = """
import threading
import rospy
from actionlib.msg import TestActionGoal, TestActionResult
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
rospy.init_node("client")
over = threading.Event()
def look(message):
    if any(each.goal_id.id == "late" and each.status == GoalStatus.SUCCEEDED for each in message.status_list):
        over.set()
status = rospy.Subscriber("short/status", GoalStatusArray, look)
goal = TestActionGoal(goal_id=GoalID(id="late"))
goals = rospy.Publisher("short/goal", TestActionGoal, latch=True, queue_size=1)
goals.publish(goal)
assert over.wait(60)
assert rospy.wait_for_message("short/result", TestActionResult, 60).status.goal_id.id == "late"
"""


@pytest.fixture
def client(tmp_path):
    """Runs a program beside a server whose goals are over at once, and fails with what it wrote if it does."""
    with OwnMaster(tmp_path / "master.txt") as master:
        environment = {**os.environ, "ROS_MASTER_URI": master.uri, "ROS_LOG_DIR": str(tmp_path)}
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment}
        server = subprocess.Popen([sys.executable, "-c", SERVER], **quiet)

        def run(program, *words):
            arguments = {"env": environment, "capture_output": True, "text": True, "timeout": 900}
            done = subprocess.run([sys.executable, "-c", program, *words], **arguments)
            assert done.returncode == 0, done.stderr

        try:
            yield run
        finally:
            server.send_signal(signal.SIGINT)
            server.wait(60.0)


def test_their_ends_are_not_lost_and_the_status_stays_short(client):
    client(CLIENT, "0.002", "200", "0")


def test_what_is_told_at_their_begin_is_not_lost(client):
    client(CLIENT, "0.002", "30", "100")


@pytest.mark.parametrize("duration", ("0", "200"))
def test_nothing_is_lost_of_a_client_that_waits_for_a_processor(client, duration):
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2 * os.cpu_count())]
    try:
        client(CLIENT, "0.02", "20", duration)
    finally:
        for process in busy:
            process.kill()
            process.wait()


def test_who_listens_to_results_only_after_the_end_gets_its_own(client):
    client(LATE)
