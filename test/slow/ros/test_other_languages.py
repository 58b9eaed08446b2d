"""A client in C++: catkin's generators make its messages of the same definitions."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rospkg
from examples_fixture import EXAMPLES
from waits import PATIENCE

from nao_sim_bridge.testing import SimulatedRobot

ACTIONS = "nao_library_actions"
ENDS = ("Goal", "Result", "Feedback", "ActionGoal", "ActionResult", "ActionFeedback", "Action")


class OtherLanguages(unittest.TestCase):
    def test_a_client_in_cpp_moves_the_head(self):
        robot, find = SimulatedRobot(), rospkg.RosPack().get_path
        robot.module("ALMotion").wakeUp()
        messages = next(Path(sys.prefix).parent.glob(f".ws/devel/share/{ACTIONS}/msg"))
        packages = ("std_msgs", "trajectory_msgs", "sensor_msgs", "geometry_msgs", "actionlib_msgs")
        known = [f"-I{ACTIONS}:{messages}", *(f"-I{name}:{find(name)}/msg" for name in packages)]
        with tempfile.TemporaryDirectory() as folder:
            for end in ENDS:
                source = messages / f"JointTrajectory{end}.msg"
                generator = [sys.executable, "/usr/lib/gencpp/gen_cpp.py", str(source), *known]
                options = ["-p", ACTIONS, "-o", f"{folder}/{ACTIONS}", "-e", find("gencpp")]
                subprocess.run([*generator, *options], check=True)
            program = f"{folder}/turn_head"
            libraries = "-lactionlib -lroscpp -lrosconsole -lroscpp_serialization -lrostime -lboost_thread -lpthread"
            subprocess.run(
                ["g++", "-O0", f"-I{folder}", str(EXAMPLES / "turn_head.cpp"), "-o", program, *libraries.split()],
                check=True,
            )
            done = subprocess.run(
                [program], timeout=PATIENCE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
            )
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertRegex(done.stdout, r"HeadYaw is 0\.(49|50|51) rad")
