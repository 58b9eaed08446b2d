"""For rostest suites against the simulated NAO: wait for the stack, reset the world, move time, read the robot.

A suite includes `test_stack.launch` of the package `nao_library` in its `.test` file and uses `SimulatedRobot` in its
Python file. Nothing here waits by sleeping: waits end with a message of the robot, or with a clear error.
"""

from __future__ import annotations

import threading
import time
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence

import actionlib
import qi
import roslib.message
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose, Vector3
from std_srvs.srv import Empty

from nao_library_msgs.srv import AdvanceTime, GetTruepose, PressSensors, PushRobot, TakePicture
from nao_sim_bridge.broker import QUIET_LIBQI

DEVICE = "Device/SubDeviceList/{}/Actuator/Value"


class StackNotReady(RuntimeError):
    """Something that a test needs is not there; the text names it."""


class GoalRun:
    """A goal that was sent, and what came back so far.

    It stands on actionlib's ActionClient: SimpleActionClient loses the end of a goal that is over before its
    `send_goal` has returned, which a test of quick goals meets now and then.

    Attributes:
        feedback: (simulated time in s, feedback message) of each feedback.
        sent: Simulated time at which the goal was sent, s.

    Args:
        client: Client of a server that is there.
        goal: The goal message.
    """

    def __init__(self, client: actionlib.SimpleActionClient, goal: Any) -> None:
        self.feedback: list[tuple[float, Any]] = []
        self.sent = rospy.get_time()
        self._news = threading.Condition()
        self._end: tuple[Any, float] | None = None
        self._handle = client.action_client.send_goal(goal, self._on_transition, self._on_feedback)

    @property
    def state(self) -> int:
        """Terminal state (actionlib_msgs/GoalStatus); only after `wait`."""
        return self._handle.get_terminal_state()

    @property
    def text(self) -> str:
        """Text of the end state."""
        return self._handle.get_goal_status_text()

    @property
    def result(self) -> Any:
        """Result message; only after `wait`."""
        return self._ended()[0]

    @property
    def ended(self) -> float:
        """Simulated time at which the result came, s; only after `wait`."""
        return self._ended()[1]

    def cancel(self) -> None:
        """Ask the server to end the goal."""
        self._handle.cancel()

    def wait(self, limit: float = 30.0) -> GoalRun:
        """Wait for the end, at most `limit` s of wall time.

        Raises:
            StackNotReady: There is no result in time.
        """
        self._wait(lambda: self._end is not None, limit, "result of the goal")
        return self

    def wait_for_function(self, index: int, limit: float = 30.0) -> GoalRun:
        """Wait until function `index` (from 0) of the chain begins, at most `limit` s of wall time.

        The end of a goal and its feedback come on different topics: when the end is there first, its result tells.

        Raises:
            StackNotReady: It has not begun in time, or the goal ended before.
        """

        def begun() -> bool:
            if any(feedback.index >= index for _, feedback in self.feedback):
                return True
            return self._end is not None and (self.state == GoalStatus.SUCCEEDED or len(self.result.results) > index)

        self._wait(lambda: begun() or self._end is not None, limit, f"feedback of function {index}")
        if not begun():
            state = GoalStatus.to_string(self.state)
            raise StackNotReady(f"the goal ended before function {index} began: {state} {self.text}")
        return self

    def _ended(self) -> tuple[Any, float]:
        if self._end is None:
            raise StackNotReady("the goal has not ended yet: call wait() first")
        return self._end

    def _wait(self, condition: Callable[[], bool], limit: float, what: str) -> None:
        with self._news:
            if not self._news.wait_for(condition, limit):
                raise StackNotReady(f"not there within {limit:g} s: {what}")

    def _on_feedback(self, _handle: Any, feedback: Any) -> None:
        with self._news:
            self.feedback.append((rospy.get_time(), feedback))
            self._news.notify_all()

    def _on_transition(self, handle: Any) -> None:
        if handle.get_comm_state() == actionlib.CommState.DONE:
            with self._news:
                self._end = (handle.get_result(), rospy.get_time())
                self._news.notify_all()


def send(client: actionlib.SimpleActionClient, goal: Any) -> GoalRun:
    """Send a goal and return at once."""
    return GoalRun(client, goal)


class SimulatedRobot:
    """The simulated robot of a test.

    Args:
        namespace: Namespace the simulator runs in, "" for that of the test.
        limit: Longest wall time to wait for the simulator, s.

    Raises:
        StackNotReady: The simulator is not there in time.
    """

    def __init__(self, namespace: str = "", limit: float = 30.0) -> None:
        self.namespace = namespace.rstrip("/")
        self._advance = self._service("nao_sim/advance", AdvanceTime, limit)
        self._push = self._service("nao_sim/push", PushRobot, limit)
        self._press = self._service("nao_sim/press", PressSensors, limit)
        self._picture = self._service("nao_sim/picture", TakePicture, limit)
        self._reset = self._service("nao_sim/reset", Empty, limit)
        self._pause = self._service("nao_sim/pause", Empty, limit)
        self._resume = self._service("nao_sim/resume", Empty, limit)
        self._true_pose = self._service("get_truepose", GetTruepose, limit)
        self._session: Any = None

    # --- the stack ------------------------------------------------------------------------------------------------

    def action_client(self, name: str, action: type, limit: float = 30.0) -> actionlib.SimpleActionClient:
        """A client of a module of this robot that is connected to it and ready for goals.

        Raises:
            StackNotReady: The server is not there, or does not reach the robot, within `limit` s of wall time each.
        """
        client = actionlib.SimpleActionClient(self._name(name), action)
        wait_until(lambda: client.wait_for_server(rospy.Duration(0.01)), limit, f"action server {self._name(name)}")
        ping = _ping_goal(action)
        wait_until(
            lambda: send(client, ping).wait(limit).state == GoalStatus.SUCCEEDED,
            limit,
            f"connection of {self._name(name)} to the robot",
        )
        return client

    @property
    def port(self) -> int:
        """Port of the robot's NAOqi."""
        return int(rospy.get_param(self._name("nao_sim/bound_port")))

    def module(self, name: str) -> Any:
        """A NAOqi module of the robot, for example "ALMemory", straight over libqi."""
        if self._session is None or not self._session.isConnected():
            qi.logging.setFilters(QUIET_LIBQI)
            self._session = qi.Session()
            self._session.connect(f"tcp://127.0.0.1:{self.port}")
        return self._session.service(name)

    # --- world and time -------------------------------------------------------------------------------------------

    def reset(self) -> None:
        """Put robot and world to where they started; simulated time goes on.

        Calls that run on the robot end, as after NAOqi's `killAll`. Goals go on with their next function: end them
        before.
        """
        self._reset()

    def advance(self, seconds: float) -> float:
        """Let simulated time pass as fast as possible; returns the time after it, s."""
        return self._advance(rospy.Duration.from_sec(seconds)).now.to_sec()

    def pause(self) -> None:
        """Let time stand still; calls are still answered."""
        self._pause()

    def resume(self) -> None:
        """Let time pass again."""
        self._resume()

    @contextmanager
    def at_speed(self, speed: float) -> Iterator[None]:
        """Let time pass at another speed for a while: below 1 where a test measures time.

        What the machine does meanwhile delays a message by wall time; the slower the simulation, the less that counts.

        Args:
            speed: Simulated seconds per wall second, 0 for as fast as possible.
        """
        simulation = self.module("NaoSimulation")
        before = simulation.speed()
        simulation.setSpeed(speed)
        try:
            yield
        finally:
            simulation.setSpeed(before)

    def push(self, force: Sequence[float], seconds: float, link: str = "torso") -> None:
        """Push a link with `force` (x, y, z in N, in world) for a while."""
        answer = self._push(link, Vector3(*force), rospy.Duration.from_sec(seconds))
        if not answer.success:
            raise ValueError(answer.message)

    def press(self, sensors: Iterable[str]) -> None:
        """Simulated fingers on these touch sensors and on no others."""
        answer = self._press(list(sensors))
        if not answer.success:
            raise ValueError(answer.message)

    # --- looking --------------------------------------------------------------------------------------------------

    def picture(self, view: str = "three_quarter", file: str = "picture.png") -> Path:
        """Take a picture; returns where it is."""
        answer = self._picture(view, 0, 0, file)
        if not answer.success:
            raise ValueError(answer.message)
        return Path(answer.path)

    def true_pose(self) -> Pose:
        """Where the torso really is, in world: position in m, orientation as a quaternion."""
        return self._true_pose().pose.pose.pose

    def value(self, key: str) -> Any:
        """What ALMemory has under a key."""
        return self.module("ALMemory").getData(key)

    def led(self, device: str) -> float:
        """Intensity 0..1 of an LED device, for example "Head/Led/Front/Right/1"."""
        return self.value(DEVICE.format(device))

    def leds(self, devices: Iterable[str]) -> dict[str, float]:
        """Intensities of several LED devices, read at once."""
        devices = list(devices)
        values = self.module("ALMemory").getListData([DEVICE.format(device) for device in devices])
        return dict(zip(devices, values))

    def wait_for_leds(self, wanted: Mapping[str, float], limit: float = 10.0) -> None:
        """Wait until LED devices have these intensities.

        Raises:
            StackNotReady: They have not within `limit` s of wall time; the text names the first that has not.
        """
        wrong = ""

        def right() -> bool:
            nonlocal wrong
            found = self.leds(wanted)
            wrong = next((f"{n} is {found[n]}, not {v}" for n, v in wanted.items() if abs(found[n] - v) > 0.02), "")
            return not wrong

        wait_until(right, limit, lambda: f"LEDs: {wrong}")

    # --- inside ---------------------------------------------------------------------------------------------------

    def _name(self, name: str) -> str:
        return f"{self.namespace}/{name}" if self.namespace else name

    def _service(self, name: str, kind: type, limit: float) -> rospy.ServiceProxy:
        name = self._name(name)
        wait_until(lambda: _service_there(name), limit, f"service {name}; is the simulator in the launch file?")
        return rospy.ServiceProxy(name, kind)


def _ping_goal(action: type) -> Any:
    """A goal with the function `ping`, which every module has."""
    goal = action().action_goal.goal
    kind = roslib.message.get_message_class(goal._slot_types[0].rstrip("[]"))
    return type(goal)([kind(function="ping")])


def wait_until(condition: Callable[[], bool], limit: float, what: str | Callable[[], str]) -> None:
    """Ask again and again until `condition()` holds; it should itself take a moment, as a call to the robot does.

    Raises:
        StackNotReady: It does not hold within `limit` s of wall time.
    """
    give_up = time.monotonic() + limit
    while not condition():
        if time.monotonic() > give_up or rospy.is_shutdown():
            text = what if isinstance(what, str) else what()
            raise StackNotReady(f"not there within {limit:g} s: {text}")


def _service_there(name: str) -> bool:
    try:
        rospy.wait_for_service(name, timeout=0.2)
    except rospy.ROSException:
        return False
    return True
