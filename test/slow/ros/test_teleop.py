"""A gamepad and a keyboard control the robot: it walks while a stick or key is held, and stops when they go away."""

import os
import pty
import signal
import subprocess
import sys
import termios
import threading
import unittest

import rospkg
import rospy
from sensor_msgs.msg import Joy
from services import answer, service
from std_srvs.srv import Empty
from waits import PATIENCE

from nao_sim_bridge.testing import SimulatedRobot, wait_until

LIMIT = 60.0
NODE = rospkg.RosPack().get_path("nao_library_modules") + "/nodes/teleop_nao_keyboard"
AXIS_X, AXIS_HEAD_YAW, AXES = 3, 4, 6
CROUCH, INIT, ENABLE, HEAD, BUTTONS = 9, 0, 8, 5, 12
FLAGS = termios.ICANON | termios.ECHO


def joy(x=0.0, yaw=0.0, *pressed):
    message = Joy(axes=[0.0] * AXES, buttons=[int(n in pressed) for n in range(BUTTONS)])
    message.axes[AXIS_X], message.axes[AXIS_HEAD_YAW] = x, yaw
    return message


class Keyboard:
    """A person at a terminal with teleop_nao_keyboard in it."""

    def __init__(self):
        self.keys, self.program = pty.openpty()
        self.settings = termios.tcgetattr(self.program)[3] & FLAGS
        self._text = ""
        self._news = threading.Condition()
        self.node = subprocess.Popen([sys.executable, NODE], stdin=self.program, stdout=subprocess.PIPE, text=True)
        threading.Thread(target=self._read, daemon=True).start()
        self.wait_for("The robot walks while a key is held")

    def _read(self):
        for line in self.node.stdout:
            with self._news:
                self._text += line
                self._news.notify_all()

    def wait_for(self, text):
        with self._news:
            assert self._news.wait_for(lambda: text in self._text, 60.0), f"{text!r} is not in {self._text!r}"

    def type(self, keys):
        os.write(self.keys, keys.encode())

    def has_settings_back(self):
        return termios.tcgetattr(self.program)[3] & FLAGS == self.settings

    def close(self):
        self.node.kill()
        self.node.wait()
        os.close(self.keys)
        os.close(self.program)


class DriverTeleop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.motion = cls.robot.module("ALMotion")
        cls.joy = rospy.Publisher("joy", Joy, queue_size=10, tcp_nodelay=True)
        wait_until(lambda: cls.joy.get_num_connections() > 0, LIMIT, "teleop_nao_joy")
        cls.stop = service("stop_walk_srv", Empty)
        for name in ("body_stiffness/enable", "wakeup"):
            service(name, Empty)
        wait_until(lambda: answer(cls.stop) == "", LIMIT, "nao_walker and the robot")

    def setUp(self):
        self.stop()
        self.robot.reset()

    def forward(self):
        return self.robot.true_pose().position.x

    def height(self):
        return self.robot.true_pose().position.z

    def wait_for_walk(self, active=True):
        wait_until(lambda: self.motion.moveIsActive() is active, LIMIT, "a walk" if active else "the end of the walk")

    def press(self, button):
        self.joy.publish(joy())
        self.joy.publish(joy(0.0, 0.0, button))
        self.joy.publish(joy())

    # --- gamepad --------------------------------------------------------------------------------------------------

    def take_control(self):
        self.press(ENABLE)
        wait_until(lambda: min(self.motion.getStiffnesses("Body")) > 0.9, LIMIT, "stiff joints")
        self.addCleanup(self.press, ENABLE)

    def test_the_gamepad_stands_the_robot_up_walks_it_and_has_it_crouch(self):
        self.joy.publish(joy(1.0))  # without control nothing happens
        self.robot.advance(1.0)
        self.assertFalse(self.motion.moveIsActive())
        self.joy.publish(joy())
        self.take_control()
        self.press(INIT)
        wait_until(lambda: self.height() > 0.3, LIMIT, "a standing robot")
        wait_until(lambda: self.motion.getTaskList() == [], LIMIT, "the end of the pose")
        self.joy.publish(joy(0.6))  # once: the node repeats it
        wait_until(lambda: self.forward() > 0.1, LIMIT, "10 cm of walk")
        self.joy.publish(joy())
        self.wait_for_walk(active=False)
        self.press(CROUCH)
        wait_until(lambda: max(self.motion.getStiffnesses("Body")) < 0.1, LIMIT, "limp joints")
        self.assertLess(self.height(), 0.27)

    def test_the_gamepad_moves_the_head(self):
        self.take_control()
        yaw = lambda: self.motion.getAngles("HeadYaw", True)[0]  # noqa: E731
        self.joy.publish(joy(1.0, 0.3, HEAD))
        wait_until(lambda: abs(yaw() - 0.3 * 2.0943) < 0.05, LIMIT, "a turned head")
        self.assertFalse(self.motion.moveIsActive())
        self.joy.publish(joy())

    # --- keyboard -------------------------------------------------------------------------------------------------

    def keyboard(self):
        keyboard = Keyboard()
        self.addCleanup(keyboard.close)
        return keyboard

    def hold(self, keyboard, key, until, what):
        """Repeat a key, as a terminal does, until something has come about."""

        def there():
            keyboard.type(key)
            return until()

        wait_until(there, LIMIT, what)

    def test_the_keyboard_wakes_the_robot_and_walks_it_while_a_key_is_held(self):
        keyboard = self.keyboard()
        keyboard.type("m")
        keyboard.wait_for("the robot is awake")
        self.assertGreater(self.height(), 0.3)
        self.hold(keyboard, "\x1b[A", lambda: self.forward() > 0.1, "10 cm of walk")
        self.wait_for_walk(active=False)  # released
        keyboard.type("w")
        self.wait_for_walk()
        keyboard.type(" ")
        keyboard.wait_for("the robot stands")
        self.assertFalse(self.motion.moveIsActive())
        keyboard.type("3")
        keyboard.wait_for("crouch: succeeded")
        keyboard.type("x")
        self.assertEqual(keyboard.node.wait(LIMIT), 0)
        self.assertTrue(keyboard.has_settings_back())

    def test_ctrl_c_and_termination_stop_the_robot_and_give_the_terminal_back(self):
        self.motion.wakeUp()
        for number in (signal.SIGINT, signal.SIGTERM):
            keyboard = self.keyboard()
            self.hold(keyboard, "w", self.motion.moveIsActive, "a walk")
            keyboard.node.send_signal(number)
            self.assertEqual(keyboard.node.wait(LIMIT), 128 + number)
            self.assertTrue(keyboard.has_settings_back())
            self.wait_for_walk(active=False)

    def test_without_a_terminal_it_says_so(self):
        ended = subprocess.run(
            [sys.executable, NODE], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=PATIENCE
        )
        self.assertEqual(ended.returncode, 1)
        self.assertIn("keys need a terminal", ended.stderr)
