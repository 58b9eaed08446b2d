"""The stack under the names of the paper's and the thesis' texts: everything is found there, and nothing elsewhere."""

import os
import signal
import subprocess
import sys

from nao_library_modules.processes.own_master import OwnMaster

CLIENT = """
import actionlib, rospy
from actionlib_msgs.msg import GoalStatus
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
import nao_library_actions.msg as a
from move_base_msgs.msg import MoveBaseAction
from nao_library_msgs.msg import AudioOutFunction, MotionFunction
from nao_sim_bridge.testing import SimulatedRobot, send
rospy.init_node("client")
robot = SimulatedRobot()
kinds = {"NaoAudioOut": a.NaoAudioOutAction, "NaoAudioIn": a.NaoAudioInAction, "NaoMotion": a.NaoMotionAction,
         "jointTrajectory": a.JointTrajectoryAction, "jointAngles": a.JointAnglesWithSpeedAction,
         "jointStiffness": a.JointTrajectoryAction, "bodyPose": a.BodyPoseAction, "walkTarget": MoveBaseAction}
clients = {name: actionlib.SimpleActionClient(name, kind) for name, kind in kinds.items()}
for name, client in clients.items():
    assert client.wait_for_server(rospy.Duration(60)), name
robot.module("ALMotion").wakeUp()
point = JointTrajectoryPoint(positions=[0.3], time_from_start=rospy.Duration(0.5))
head = a.JointTrajectoryGoal(JointTrajectory(joint_names=["HeadYaw"], points=[point]), 0)
for name, goal in (("NaoAudioOut", a.NaoAudioOutGoal([AudioOutFunction(function="say", str_param="Hello")])),
                   ("jointTrajectory", head),
                   ("NaoMotion", a.NaoMotionGoal([MotionFunction(function="setAngles", names=["HeadYaw"],
                    angles=[0.1], speed=0.2, stiffness=1.0)]))):
    run = send(clients[name], goal).wait(60.0)
    assert run.state == GoalStatus.SUCCEEDED, (name, run.text)
topics = {topic for topic, _ in rospy.get_published_topics()}
assert "/jointTrajectory/result" in topics and "/joint_trajectory/result" not in topics, sorted(topics)
assert "/nao_audio_out/result" not in topics and rospy.wait_for_service("NaoAudioOut/describe", 10.0) is None
"""


def test_the_stack_has_the_names_of_the_documents(tmp_path):
    folders = dict.fromkeys(("ROS_HOME", "ROS_LOG_DIR"), str(tmp_path))
    names = ["document_names.launch", "file:=nao_sim.launch", "nao_port:=0"]
    with OwnMaster(tmp_path / "master.txt") as master:
        environment = {**os.environ, **folders, "ROS_MASTER_URI": master.uri}
        launch = subprocess.Popen(["roslaunch", "nao_library", *names], env=environment)
        try:
            done = subprocess.run(
                [sys.executable, "-c", CLIENT], env=environment, timeout=120.0, capture_output=True, text=True
            )
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(60.0)
    assert done.returncode == 0, done.stderr
