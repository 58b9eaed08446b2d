"""The simulated robot of a test: its modules, its world, its time, and what can be seen of it."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import Any, Iterable, Iterator, Mapping, Sequence

import actionlib
import qi
import roslib.message
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose, Vector3
from std_srvs.srv import Empty

from nao_library_msgs.srv import AdvanceTime, GetTruepose, PressSensors, PushRobot, ResetWorld, TakePicture, VaryScene
from nao_sim_bridge.server.broker import QUIET_LIBQI
from nao_sim_bridge.testing.goal_run import send
from nao_sim_bridge.testing.waits import LIMIT, wait_for_service, wait_until

CLOCK_DELAY = 0.2
"""Simulated s that a server which is ready may be behind."""
DEVICE = "Device/SubDeviceList/{}/Actuator/Value"


class SimulatedRobot:
    """The simulated robot of a test.

    Args:
        namespace: Namespace the simulator runs in, "" for that of the test; of one of several robots in a world its
            own, "/nao2".
        limit: Longest wall time to wait for the simulator, s.
        world: Namespace of the simulator that it shares with others; None when it has one for itself.

    Raises:
        StackNotReady: The simulator is not there in time.
    """

    def __init__(self, namespace: str = "", limit: float = LIMIT, world: str | None = None) -> None:
        self.namespace = namespace.rstrip("/")
        self._world = self.namespace if world is None else world.rstrip("/")
        self._advance = self._world_service("nao_sim/advance", AdvanceTime, limit)
        self._push = self._service("nao_sim/push", PushRobot, limit)
        self._press = self._service("nao_sim/press", PressSensors, limit)
        self._picture = self._service("nao_sim/picture", TakePicture, limit)
        self._reset = self._world_service("nao_sim/reset", Empty, limit)
        self._factory_reset = self._world_service("nao_sim/factory_reset", Empty, limit)
        self._reset_world = self._world_service("nao_sim/reset_world", ResetWorld, limit)
        self._vary = self._world_service("nao_sim/vary", VaryScene, limit)
        self._pause = self._world_service("nao_sim/pause", Empty, limit)
        self._resume = self._world_service("nao_sim/resume", Empty, limit)
        self._true_pose = self._service("get_truepose", GetTruepose, limit)
        self._session: Any = None

    # --- the stack ------------------------------------------------------------------------------------------------

    def action_client(self, name: str, action: type, limit: float = LIMIT) -> actionlib.SimpleActionClient:
        """A client of a module of this robot that is connected to it and ready for goals.

        A server that has just started may know the time of some seconds ago only: that is waited for as well.

        Raises:
            StackNotReady: The server is not there, or does not reach the robot, within `limit` s of wall time each.
        """
        client = actionlib.SimpleActionClient(self._name(name), action)
        wait_until(lambda: client.wait_for_server(rospy.Duration(0.01)), limit, f"action server {self._name(name)}")
        ping = _ping_goal(action)

        def ready() -> bool:
            run = send(client, ping)
            run.wait(limit)
            return run.state == GoalStatus.SUCCEEDED and run.server_time >= run.sent - CLOCK_DELAY

        wait_until(ready, limit, f"connection of {self._name(name)} to the robot")
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

    def factory_reset(self, world: str = "") -> None:
        """Begin anew, as a simulator that has just been started; simulated time goes on in ROS and is 0 over NAOqi.

        The robot has started again, so that modules and drivers connect to it anew: goals that run end.

        Args:
            world: Name of a world, or path of its file, in `record_dir` or beside that of the start; empty for that.

        Raises:
            ValueError: The world cannot be used; everything stays as it is.
        """
        if not world:
            self._factory_reset()
            return
        _succeeded(self._reset_world(world))

    def vary(self, seed: int = 0, payload: float = 0.0, noise: float = 0.0, delay: float = 0.0) -> None:
        """What the robot begins with from its next reset on; it has to be alone in its world.

        Args:
            seed: Of all random numbers.
            payload: kg that the torso carries besides its own.
            noise: Errors of the sensors: 0 none, 1 as those of a real robot.
            delay: How late sensors arrive, s.

        Raises:
            ValueError: A number is not in its range, or there are other robots; everything stays as it is.
        """
        answer = self._vary(seed, payload, noise, delay)
        if not answer.success:
            raise ValueError(answer.message)

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
        It begins when this node's time is that of the simulation.

        Args:
            speed: Simulated seconds per wall second, 0 for as fast as possible.
        """
        simulation = self.module("NaoSimulation")
        before = simulation.speed()
        simulation.setSpeed(speed)
        try:
            now = self.advance(0.0)
            wait_until(lambda: rospy.get_time() >= now, LIMIT, f"{now} s on /clock")
            yield
        finally:
            simulation.setSpeed(before)

    def push(self, force: Sequence[float], seconds: float, link: str = "torso") -> None:
        """Push a link with `force` (x, y, z in N, in world) for a while."""
        _succeeded(self._push(link, Vector3(*force), rospy.Duration.from_sec(seconds)))

    def press(self, sensors: Iterable[str]) -> None:
        """Simulated fingers on these touch sensors and on no others."""
        _succeeded(self._press(list(sensors)))

    # --- looking --------------------------------------------------------------------------------------------------

    def picture(self, view: str = "three_quarter", file: str = "picture.png") -> Path:
        """Take a picture; returns where it is."""
        return Path(_succeeded(self._picture(view, 0, 0, file)).path)

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

    def wait_for_leds(self, wanted: Mapping[str, float], limit: float = LIMIT) -> None:
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

    def _world_service(self, name: str, kind: type, limit: float) -> rospy.ServiceProxy:
        return wait_for_service(f"{self._world}/{name}" if self._world or self.namespace else name, kind, limit)

    def _service(self, name: str, kind: type, limit: float) -> rospy.ServiceProxy:
        return wait_for_service(self._name(name), kind, limit)


def _succeeded(answer: Any) -> Any:
    if not answer.success:
        raise ValueError(answer.message)
    return answer


def _ping_goal(action: type) -> Any:
    """A goal with the function `ping`, which every module has."""
    goal = action().action_goal.goal
    kind = roslib.message.get_message_class(goal._slot_types[0].rstrip("[]"))
    return type(goal)([kind(function="ping")])
