"""For rostest suites against the simulated NAO: wait for the stack, reset the world, move time, read the robot.

A suite includes `test_stack.launch` of the package `nao_library` in its `.test` file; its cases are those of a
`RobotTestCase`, or use `SimulatedRobot`. Nothing here waits for a time: waits end when what a test needs is there, or
with a clear error.
"""

from nao_sim_bridge.testing.goal_run import GoalRun, send
from nao_sim_bridge.testing.robot_test_case import RobotTestCase
from nao_sim_bridge.testing.simulated_robot import SimulatedRobot
from nao_sim_bridge.testing.waits import StackNotReady, wait_until

__all__ = ["GoalRun", "RobotTestCase", "SimulatedRobot", "StackNotReady", "send", "wait_until"]
