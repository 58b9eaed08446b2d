"""The robot dies, or falls silent, in the middle of a goal, and comes back: goals abort clearly, the node goes on."""

import signal

import rosgraph
import rosnode
import rospy
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticStatus
from mortal_simulator import PORT, LostRobotCase
from news import LIMIT, Reports

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_library_msgs.msg import LedFunction
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy

HALF = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5])
BRAIN0 = "Device/SubDeviceList/Head/Led/Front/Right/1/Actuator/Value"
LONG = LedFunction(function="fade", lights=["Brain0"], i_values=[0.0], duration=100.0)


class LostLights(LostRobotCase):
    def setUp(self):
        super().setUp()
        self.reports = Reports()
        self.kept(self.reports.subscriber)
        self.client = SimpleActionClient("NaoLights", NaoLedAction)
        self.assertTrue(self.client.wait_for_server(rospy.Duration(LIMIT)))
        self.wait_until_it_works()

    def play(self, *functions):
        return send(self.client, NaoLedGoal(list(functions)))

    def wait_until_it_works(self):
        wait_until(lambda: self.play(HALF).wait().state == GoalStatus.SUCCEEDED, LIMIT, "a goal that succeeds")
        self.wait_for_level(DiagnosticStatus.OK)

    def wait_for_the_fade(self):
        """Until the robot has begun to fade: the light is a little darker than HALF."""
        memory = ALProxy("ALMemory", "127.0.0.1", PORT)
        wait_until(lambda: 0.4 < memory.getData(BRAIN0) < 0.4999, LIMIT, "the fade")

    def wait_for_level(self, level):
        self.reports.wait_anew("NaoLights: NaoLights robot", lambda status: status.level == level)

    @staticmethod
    def node():
        return rosnode.get_api_uri(rosgraph.Master(rospy.get_name()), "/NaoLights")

    def test_robot_that_dies_or_falls_silent_and_comes_back(self):
        node = self.node()
        for stop in (signal.SIGKILL, signal.SIGSTOP):
            run = self.play(HALF, LONG)
            self.wait_for_the_fade()
            self.simulator.send_signal(stop)
            run.wait(LIMIT)
            self.assertEqual("silent" in run.text, stop == signal.SIGSTOP, run.text)
            self.assertEqual(run.state, GoalStatus.ABORTED, stop)
            # Of the waiting call and of the connection, whichever notices first says it.
            self.assertRegex(run.text, rf"function 2 \(fade\): .*127.0.0.1:{PORT}.*(connection broke|went away)")
            done, lost = run.result.results
            self.assertEqual((done.function, done.error, lost.function), ("setIntensity", "", "fade"))
            self.assertIn(lost.error, run.text)
            if stop == signal.SIGSTOP:  # the dead one is started again at once
                self.wait_for_level(DiagnosticStatus.ERROR)
            self.kill()
            self.start()
            self.wait_until_it_works()
        self.assertEqual(self.node(), node)
