"""The robot dies and comes back: what its senses say begins again, once, and everybody is told meanwhile."""

import rospy
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticStatus
from mortal_simulator import LIMIT, PORT, LostRobotCase
from news import News, Reports
from sensor_msgs.msg import Range

from nao_library_actions.msg import BlinkAction, BlinkGoal, RunBehaviorAction, RunBehaviorGoal
from nao_library_modules.ros.goal_client import SimpleActionClient
from nao_library_msgs.msg import ConnectionState, FloatStamped, TactileTouch
from nao_sim_bridge.testing import send, wait_until
from naoqi import ALProxy

FRONT, CHARGE = "FrontTactilTouched", "Device/SubDeviceList/Battery/Charge/Sensor/Value"
ENDLESS = "nao_library/breathe"


class LostSenses(LostRobotCase):
    def setUp(self):
        super().setUp()
        self.news = News()
        self.states, self.touches, self.events, self.charges, self.ranges = [], [], [], [], []
        self.reports = Reports()
        self.kept(self.reports.subscriber)
        for topic, kind, take in (
            ("connection", ConnectionState, self.states.append),
            ("tactile_touch", TactileTouch, lambda message: self.touches.append(message.state)),
            (f"nao_memory/{FRONT}", FloatStamped, lambda message: self.events.append(message.data)),
            (f"nao_memory/{CHARGE}", FloatStamped, self.charges.append),
            ("nao_robot/sonar/left", Range, self.ranges.append),
        ):
            self.kept(self.news.subscribe(topic, kind, take))
        self.behaviors = SimpleActionClient("run_behavior", RunBehaviorAction)
        self.blink = SimpleActionClient("blink", BlinkAction)
        for client in (self.behaviors, self.blink):
            self.assertTrue(client.wait_for_server(rospy.Duration(LIMIT)))

    def wait_for_level(self, name, level):
        self.reports.wait(name, lambda status: status.level == level)

    def press(self, *sensors):
        ALProxy("NaoSimulation", "127.0.0.1", PORT).press(list(sensors))

    def wait_until_it_works(self):
        self.news.wait(lambda: self.states and self.states[-1].state == ConnectionState.CONNECTED, "a connection")
        for name in ("nao_tactile: touch", "nao_memory: memory", "nao_joint: HeadYaw"):
            self.wait_for_level(name, DiagnosticStatus.OK)
        for values in (self.charges, self.ranges):
            count = len(values)
            self.news.wait(lambda count=count, values=values: len(values) > count, "readings")
        self.news.wait(lambda: self.events[-1:] == [0.0], "how the head's sensor stands")
        self.touches.clear()
        self.events.clear()
        self.press("Head/Touch/Front")
        self.news.wait(lambda: self.touches and self.events, "a touch")
        self.press()
        self.news.wait(lambda: len(self.touches) == len(self.events) == 2, "the end of the touch")
        self.assertEqual((self.touches, self.events), ([1, 0], [1.0, 0.0]))

    def test_robot_that_dies_and_comes_back(self):
        self.wait_until_it_works()
        for _ in range(2):
            self.die_in_the_middle()
            self.start()
            self.wait_until_it_works()

    def die_in_the_middle(self):
        motion = ALProxy("ALMotion", "127.0.0.1", PORT)
        motion.wakeUp()
        behavior = send(self.behaviors, RunBehaviorGoal(ENDLESS))
        manager = ALProxy("ALBehaviorManager", "127.0.0.1", PORT)
        wait_until(lambda: manager.isBehaviorRunning(ENDLESS), LIMIT, ENDLESS)
        blinking = BlinkGoal(blink_duration=rospy.Duration(0.2), blink_rate_mean=0.2)
        blinking.colors.append(blinking.bg_color)
        blinks = send(self.blink, blinking)
        wait_until(lambda: blinks.feedback and manager.ping(), LIMIT, "blinks")
        self.events.clear()
        self.kill()
        for run in (behavior, blinks):
            self.assertEqual(run.wait(LIMIT).state, GoalStatus.ABORTED)
            self.assertIn(f"127.0.0.1:{PORT}", run.text)
        self.news.wait(lambda: self.states[-1].state == ConnectionState.LOST, "the loss")
        self.assertTrue(self.states[-1].last_error)
        self.wait_for_level("nao_joint: HeadYaw", DiagnosticStatus.STALE)
        for name in ("nao_tactile: touch", "nao_sonar: sonars", "nao_memory: memory"):
            self.wait_for_level(name, DiagnosticStatus.ERROR)
