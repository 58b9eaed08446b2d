"""Goals that are over at once, through actionlib's own client, which loses ends that come too early."""

import os
import signal
import subprocess
import sys

from nao_library_modules.processes.own_master import OwnMaster

SERVER = """
import rospy
from actionlib.msg import TestAction
from nao_library_modules.ros.action_server import PromptActionServer
rospy.init_node("server")
server = PromptActionServer("short", TestAction, lambda goal: server.set_succeeded())
server.start()
rospy.spin()
"""
CLIENT = """
import time
import rospy
from actionlib import ActionClient, SimpleActionClient
from actionlib.msg import TestAction, TestGoal
from actionlib_msgs.msg import GoalStatusArray
rospy.init_node("client")
send = ActionClient.send_goal
def send_and_wait(*arguments):
    handle = send(*arguments)
    time.sleep(0.002)  # only then SimpleActionClient notes which goal it is
    return handle
ActionClient.send_goal = send_and_wait
client, lengths = SimpleActionClient("short", TestAction), []
assert client.wait_for_server(rospy.Duration(60))
rospy.Subscriber("short/status", GoalStatusArray, lambda told: lengths.append(len(told.status_list)))
lost, red = 0, []
rospy.logerr = lambda text, *_: red.append(text)
for number in range(200):
    client.send_goal(TestGoal())
    lost += not client.wait_for_result(rospy.Duration(5))
    assert lost <= 20, f"{lost} of {number + 1} lost"
assert len(red) <= 40, f"{len(red)} times news of a goal that the client does not track"
assert 0 < max(lengths) < 20, f"{max(lengths)} goals in the status"
"""


def test_their_ends_are_not_lost_and_the_status_stays_short(tmp_path):
    with OwnMaster(tmp_path / "master.txt") as master:
        environment = {**os.environ, "ROS_MASTER_URI": master.uri, "ROS_LOG_DIR": str(tmp_path)}
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": environment}
        server = subprocess.Popen([sys.executable, "-c", SERVER], **quiet)
        try:
            done = subprocess.run(
                [sys.executable, "-c", CLIENT], env=environment, capture_output=True, text=True, timeout=900
            )
            assert done.returncode == 0, done.stderr
        finally:
            server.send_signal(signal.SIGINT)
            server.wait(60.0)
