"""The robot is late, dies in the middle of what it does, and comes back: what was under way ends clearly, nodes go on.

One stack and one simulator for all cases: each finds a robot, kills it once or twice, and leaves one that works.
"""

import unittest

import rospy
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Pose2D
from lost_cameras import LostCameras
from lost_joints import LostJoints, trajectory
from lost_lights import HALF, LostLights
from lost_senses import CHARGE, ENDLESS, LostSenses
from lost_speech import LostSpeech
from lost_walker import LostWalker
from mortal_simulator import LIMIT, PORT
from news import Reports
from std_srvs.srv import Empty

from nao_library_actions.msg import (
    JointTrajectoryAction,
    NaoLedAction,
    NaoLedGoal,
    RunBehaviorAction,
    RunBehaviorGoal,
    SpeechWithFeedbackAction,
    SpeechWithFeedbackGoal,
)
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_library_msgs.srv import CmdPoseService, GetAudioMasterVolume, GetMemory, VisionMotionSensitivity
from nao_sim_bridge.testing import send

CASES = (LostCameras, LostLights, LostJoints, LostSenses, LostSpeech, LostWalker)
GOALS = (
    ("NaoLights", NaoLedAction, NaoLedGoal([HALF])),
    ("joint_trajectory", JointTrajectoryAction, trajectory("HeadYaw", 1.0, 0.5)),
    ("run_behavior", RunBehaviorAction, RunBehaviorGoal(ENDLESS)),
    ("speech_action", SpeechWithFeedbackAction, SpeechWithFeedbackGoal("Is anybody there?")),
)
CALLS = (
    ("nao_vision/landmark_detection/enable", Empty, ()),
    ("nao_vision/movement_detection_sensitivity", VisionMotionSensitivity, ()),
    ("nao_audio/get_master_volume", GetAudioMasterVolume, ()),
    ("cmd_pose_srv", CmdPoseService, (Pose2D(1.0, 0.0, 0.0),)),
)


class LateRobot(unittest.TestCase):
    def test_goals_and_calls_before_there_is_a_robot_fail_with_its_address(self):
        clients = [(SimpleActionClient(name, action), goal) for name, action, goal in GOALS]
        for client, _ in clients:
            self.assertTrue(client.wait_for_server(rospy.Duration(LIMIT)), client)
        runs = [send(client, goal) for client, goal in clients]  # at once: each waits for a robot that may be starting
        for name, kind, request in CALLS:
            rospy.wait_for_service(name, LIMIT)
            with self.assertRaisesRegex(rospy.ServiceException, f"127.0.0.1:{PORT}", msg=name):
                rospy.ServiceProxy(name, kind)(*request)
        rospy.wait_for_service("nao_memory/get", LIMIT)
        self.assertIn(str(PORT), rospy.ServiceProxy("nao_memory/get", GetMemory)(CHARGE).message)
        for run in runs:
            self.assertEqual(run.wait(LIMIT).state, GoalStatus.ABORTED, run.text)
            self.assertIn(str(PORT), run.text)
        reports = Reports()
        self.addCleanup(reports.subscriber.unregister)
        reports.wait("NaoLights: NaoLights robot", lambda status: status.level == DiagnosticStatus.ERROR)


def suite():
    """The late robot and the cameras, whose settings are to wait for it, come before there is one."""
    load = unittest.TestLoader().loadTestsFromTestCase
    return unittest.TestSuite(load(case) for case in (LateRobot, *CASES))
