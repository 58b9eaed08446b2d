"""A TestCase on a running stack, for rostest and pytest alike."""

from __future__ import annotations

import unittest
from typing import Any, ClassVar

import rospy
from actionlib_msgs.msg import GoalStatus

from nao_sim_bridge.testing.goal_run import GoalRun, send
from nao_sim_bridge.testing.simulated_robot import SimulatedRobot
from nao_sim_bridge.testing.waits import LIMIT, wait_until


class RobotTestCase(unittest.TestCase):
    """Cases that each find robot and world at their start, with goals to one action server.

    Attributes:
        server: Name and type of the action server, None for a suite that sends no goals.
        robot: The simulated robot.
    """

    server: ClassVar[tuple[str, type] | None] = None
    robot: ClassVar[SimulatedRobot]
    client: ClassVar[Any]

    @classmethod
    def setUpClass(cls) -> None:
        """Wait for the robot and the server."""
        cls.robot = SimulatedRobot()
        if cls.server is not None:
            cls.client = cls.robot.action_client(*cls.server)

    def setUp(self) -> None:
        """Put robot and world to where they started."""
        self.robot.reset()

    def send(self, *functions: Any, **fields: Any) -> GoalRun:
        """Send a chain of function messages, and other fields of the goal, to the server and return at once."""
        goal = self.server[1]().action_goal.goal
        return send(self.client, type(goal)(list(functions), **fields))

    def play(self, *functions: Any, **fields: Any) -> GoalRun:
        """As `send`, and wait for the end, whatever it is."""
        return self.send(*functions, **fields).wait(LIMIT)

    def succeed(self, *functions: Any, **fields: Any) -> Any:
        """The result of a goal that succeeds."""
        return self.ends(self.play(*functions, **fields), GoalStatus.SUCCEEDED).result

    def refused(self, *functions: Any, **fields: Any) -> str:
        """The text of a goal that is aborted."""
        return self.ends(self.play(*functions, **fields), GoalStatus.ABORTED).text

    def ends(self, run: GoalRun, state: int) -> GoalRun:
        """The goal, which has to end in a state of actionlib_msgs/GoalStatus."""
        run.wait(LIMIT)
        self.assertEqual(run.state, state, run.text)
        return run

    def publisher(self, topic: str, kind: type) -> rospy.Publisher:
        """A publisher that somebody listens to, for the case."""
        publisher = rospy.Publisher(topic, kind, queue_size=10)
        self.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0, LIMIT, f"a subscriber of {topic}")
        return publisher
