"""One robot of a `NaoSim`: what it senses, what it does, and what happens to it."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Iterator, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.readings import FALLEN, FootForces, Pose
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Imu, Snapshot
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.library.session import Session
from nao_sim_bridge.model.robot_model import joint_names

if TYPE_CHECKING:
    from nao_sim_bridge.walk.footsteps import FootPose

LONGEST = 600.0
"""s of simulated time that a call waits for what it has begun, if nobody says otherwise."""


class JointValues(Mapping[str, float]):
    """One number for each joint: by name, or all of them with `np.asarray`, in the order of the body."""

    __slots__ = ("_index", "_values")

    def __init__(self, index: Mapping[str, int], values: Sequence[float]) -> None:
        self._index = index
        self._values = values

    def __getitem__(self, name: str) -> float:
        try:
            return self._values[self._index[name]]
        except KeyError:
            raise KeyError(f"no joint {name!r} (there are: {', '.join(self._index)})") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self._values, dtype=dtype or float)

    def __repr__(self) -> str:
        return "{" + ", ".join(f"{name}: {value:.4g}" for name, value in self.items()) + "}"


@dataclass(frozen=True)
class Feet:
    """What presses on the feet.

    Attributes:
        left: The four sensors of the left foot, their sum and their centre of pressure in the frame of that foot.
        right: The same of the right foot.
        center_of_pressure: x and y in m of both feet together, on the floor half way between them, x where the robot
            looks; (0, 0) without load.
    """

    left: FootForces
    right: FootForces
    center_of_pressure: tuple[float, float]


class Motion:
    """Something that a robot does while time passes."""

    def __init__(self, session: Session, task: Task) -> None:
        self._session = session
        self._task = task

    def __bool__(self) -> bool:
        """Refuse `if nao.walk_to(...)`, which would hold wherever the robot got."""
        raise TypeError(
            "a Motion is neither true nor false: `result` tells what came of it, `done` whether it has ended"
        )

    @property
    def done(self) -> bool:
        """Whether it has ended, in whatever way."""
        return self._task.finished

    @property
    def result(self) -> Any:
        """What came of it: of `walk_to` and `go_to_posture` whether the robot is there; None while it goes on.

        Raises:
            SimulationError: What ended it.
        """
        return self._task.result(0.0) if self.done else None

    def wait(self, longest: float = LONGEST) -> Any:
        """Let time pass until it ends, and return its result.

        Args:
            longest: s of simulated time.

        Raises:
            TimeoutError: It has not ended by then; it goes on.
            SimulationError: What ended it.
        """
        self._session.advance_until(lambda: self._task.finished, longest, self._task.name)
        return self._task.result(0.0)

    def cancel(self) -> None:
        """End it; the joints stay where they are, and a walk comes to a stand within two steps."""
        self._session.do(self._task.kill)


class HeadCamera:
    """A camera in the robot's head.

    Args:
        nao: Whose.
        index: 0 top, 1 bottom.
    """

    def __init__(self, nao: Nao, index: int) -> None:
        self._nao = nao
        self._index = index

    def picture(self, width: int = 320, height: int = 240) -> np.ndarray:
        """What it sees now, as (height, width, 3) uint8 RGB; time stands still meanwhile.

        Exposure, white balance and noise are those of the real sensor, see docs/cameras.md.

        Raises:
            BadValue: The camera has no such resolution; the error names those it has.
            RenderError: It cannot be drawn.
        """
        return self._nao._take_picture(self._index, width, height)

    def project(self, points: Any, width: int = 320, height: int = 240) -> np.ndarray:
        """Where points of the world are in its picture, by the robot's true pose.

        Args:
            points: (n, 3), m, in the world's frame, as `NaoSim.things` has them.
            width: Pixels of the picture.
            height: Pixels of the picture.

        Returns:
            (n, 2) column and row, in pixels from the upper left corner; the middle of the first pixel is (0.5, 0.5).
            A point beside the picture has a place beside it, one behind the camera NaN.

        Raises:
            BadValue: `points` is no such array, or the camera has no such resolution.
        """
        try:
            places = np.asarray(points, dtype=float)
        except (TypeError, ValueError):
            places = np.empty(0)
        if places.ndim != 2 or places.shape[1] != 3 or not np.isfinite(places).all():
            raise BadValue("points", points, "an array (n, 3) of finite numbers, m")
        return self._nao._project(self._index, places, width, height)


class Nao:
    """One robot of a `NaoSim`.

    Attributes:
        joint_names: (26,) in the order of the body.
    """

    def __init__(self, session: Session, number: int) -> None:
        self._session = session
        self._number = number
        self.joint_names = tuple(joint.name for joint in self._simulation.model.joints)
        self._index = {name: index for index, name in enumerate(self.joint_names)}

    @property
    def _simulation(self) -> Simulation:
        return self._session.simulations[self._number]

    @property
    def robot(self) -> SimulatedRobot:
        """The robot inside, for what this class has no words for; touch it while nothing is served."""
        return self._simulation.robot

    # --- what it senses ---------------------------------------------------------------------------------------------

    @property
    def snapshot(self) -> Snapshot:
        """All that was sensed at the last tick."""
        return self._simulation.snapshot

    @property
    def angles(self) -> JointValues:
        """Measured, rad; hands 0 to 1."""
        return JointValues(self._index, self.snapshot.positions)

    @property
    def velocities(self) -> JointValues:
        """Measured, rad/s."""
        return JointValues(self._index, self.snapshot.velocities)

    @property
    def torques(self) -> JointValues:
        """Of the motors behind their gears, N m."""
        return JointValues(self._index, self.snapshot.torques)

    @property
    def temperatures(self) -> JointValues:
        """Of the motors, degC."""
        return JointValues(self._index, self.snapshot.temperatures)

    @property
    def stiffnesses(self) -> JointValues:
        """Share of the full torque, 0 to 1."""
        return JointValues(self._index, self.snapshot.stiffnesses)

    @property
    def commands(self) -> JointValues:
        """Where the joints are told to be, rad."""
        return JointValues(self._index, self.snapshot.commands)

    @property
    def imu(self) -> Imu:
        """Accelerometer (m/s2) and gyroscope (rad/s) in the torso's frame, and its roll, pitch and yaw (rad)."""
        return self.snapshot.imu

    @property
    def pose_torso_in_world(self) -> Pose:
        """The true pose of the torso: position in m, orientation as a quaternion (x, y, z, w)."""
        return self.snapshot.torso

    @property
    def pose_on_ground(self) -> FootPose:
        """x, y in m and yaw in rad of the point half way between the feet, in world."""
        from nao_sim_bridge.walk.body import robot_on_ground  # with all of the walk, which few need

        now = self.snapshot
        return robot_on_ground(self.robot.locomotion.body, now.torso, now.positions)

    @property
    def feet(self) -> Feet:
        """What presses on the feet."""
        from nao_sim_bridge.walk.body import foot_on_ground, robot_on_ground  # as above

        now, body = self.snapshot, self.robot.locomotion.body
        here = robot_on_ground(body, now.torso, now.positions)
        forces = now.left_foot, now.right_foot
        load = x = y = 0.0
        for side, foot in enumerate(forces):
            pose = foot_on_ground(body, now.torso, now.positions, (1, -1)[side]).moved(*foot.center_of_pressure)
            point = pose.seen_from(here)
            load, x, y = load + foot.total, x + foot.total * point.x, y + foot.total * point.y
        center = (x / load, y / load) if load > 0.0 else (0.0, 0.0)
        return Feet(*forces, center)

    @property
    def touched(self) -> frozenset:
        """Names of touch sensors, bumpers and buttons that something presses."""
        return self.snapshot.touched

    @property
    def sonars(self) -> tuple[float, float]:
        """Distances of the first echoes left and right, m."""
        return self.snapshot.sonars

    @property
    def lean(self) -> float:
        """Angle between the torso and upright, truly, in rad: 0 stands straight, pi is head down."""
        return self.snapshot.torso.lean

    @property
    def fallen(self) -> bool:
        """Whether the torso leans by more than 1 rad: it lies, or is about to."""
        return self.lean > FALLEN

    def camera(self, name: str = "top") -> HeadCamera:
        """A camera of the head, "top" or "bottom".

        Raises:
            UnknownName: It has no such camera.
        """
        names = ("top", "bottom")
        if name not in names:
            raise UnknownName("camera", name, names)
        return HeadCamera(self, names.index(name))

    # --- what it does -----------------------------------------------------------------------------------------------

    def set_angles(self, names: str | Sequence[str], angles: float | Sequence[float], speed: float = 1.0) -> None:
        """Send joints to angles from now on; newer targets replace older ones, time passes in `step`.

        Args:
            names: A joint, a chain ("LArm", "Body"), or a list of both.
            angles: rad, one for all or one each; what is beyond a limit stops there.
            speed: Share of the top speed of each joint, above 0 to 1.

        Raises:
            UnknownName: There is no such joint.
            BadValue: Numbers do not fit.
        """
        indices = self._indices(names)
        _check_speed(speed)
        values = _each(angles, len(indices), "angles")
        joints = self._simulation.model.joints
        speeds = {index: speed * joints[index].max_velocity for index in indices}
        self.let_go()
        self._session.do(lambda: self.robot.motion.set_targets(dict(zip(indices, values)), speeds))

    def move_angles(
        self,
        names: str | Sequence[str],
        angles: float | Sequence[float],
        duration: float,
        wait: bool = True,
    ) -> Motion:
        """Move joints smoothly to angles within a time.

        Args:
            names: As for `set_angles`.
            angles: As for `set_angles`.
            duration: s.
            wait: Let time pass until they are there.

        Raises:
            UnknownName: There is no such joint.
            BadValue: Numbers do not fit.
        """
        indices = self._indices(names)
        goals = dict(zip(indices, _each(angles, len(indices), "angles")))
        if not 0.0 < duration < LONGEST:
            raise BadValue("duration", duration, f"above 0, below {LONGEST:g} s")

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
            return {i: SmoothCurve((0.0, duration), (commands[i], goal)) for i, goal in goals.items()}

        return self._begin(lambda: self.robot.motion.follow("move_angles", indices, curves), wait)

    def set_stiffness(self, names: str | Sequence[str], stiffness: float | Sequence[float]) -> None:
        """Let joints have this share of their torque, 0 (limp) to 1, one for all or one each, at once.

        Raises:
            UnknownName: There is no such joint.
            BadValue: Numbers do not fit.
        """
        indices = self._indices(names)
        shares = _each(stiffness, len(indices), "stiffness")
        if not all(0.0 <= share <= 1.0 for share in shares):
            raise BadValue("stiffness", stiffness, "0 to 1")

        def stiffen() -> None:
            joints = self.robot.joints
            joints.hold(self.snapshot.positions, [i for i in indices if joints.stiffnesses[i] == 0.0])
            self.robot.motion.set_stiffness_now(dict(zip(indices, shares)))

        self._session.do(stiffen)

    def go_to_posture(self, name: str, speed: float = 0.8, wait: bool = True) -> Motion:
        """Go to one of NAOqi's postures ("Stand", "Sit", "LyingBack"...), over others if need be; getting up included.

        The `result` of the motion is whether it got there.

        Args:
            name: Of the posture.
            speed: Share of the top speed, above 0 to 1.
            wait: Let time pass until it is there.

        Raises:
            UnknownName: There is no such posture.
            BadValue: The speed is out of range.
        """
        from nao_sim_bridge.core.posture_change import PostureChange  # who never gets up needs nothing of it
        from nao_sim_bridge.core.posture_moves import load_moves
        from nao_sim_bridge.model.postures import load_postures

        if name not in load_postures().by_name:
            raise UnknownName("posture", name, load_postures().by_name)
        _check_speed(speed)

        def go() -> Task:
            return PostureChange(self.robot, lambda: self.snapshot, name, speed, 3, load_moves()).start()

        return self._begin(go, wait)

    def wake_up(self, wait: bool = True) -> Motion:
        """Stiffen all joints, and stand up when on the feet."""
        from nao_sim_bridge.core import sequences  # it begins awake

        return self._begin(lambda: sequences.wake_up(self.robot, lambda: self.snapshot, lambda: None), wait)

    def rest(self, wait: bool = True) -> Motion:
        """Crouch when on the feet, lean on the hands when seated, and let all joints go limp."""
        from nao_sim_bridge.core import posture_change  # it begins awake

        return self._begin(lambda: posture_change.rest(self.robot, lambda: self.snapshot, lambda: None), wait)

    def walk_to(self, x: float, y: float = 0.0, theta: float = 0.0, wait: bool = True) -> Motion:
        """Walk to a pose as seen from the robot now; the `result` of the motion is whether it is there.

        Args:
            x: Ahead, m.
            y: To the left, m.
            theta: To the left, rad.
            wait: Let time pass until it stands.

        Raises:
            SimulationError: It cannot walk now: limp, lying, or not on its feet.
        """
        from nao_sim_bridge.walk.footsteps import FootPose  # as for `pose_on_ground`
        from nao_sim_bridge.walk.gait import FeetGait

        goal = FootPose(*finite_numbers("pose", (x, y, theta)))
        return self._begin(lambda: self.robot.locomotion.move_to([goal], FeetGait()), wait)

    def walk(self, x: float, y: float = 0.0, theta: float = 0.0) -> None:
        """Walk at a velocity, m/s, m/s and rad/s, until told otherwise; time passes in `step`. All 0: stop.

        The gait goes up to about 0.09 m/s ahead, 0.06 m/s aside and 0.8 rad/s; of what is more it does as much.

        Raises:
            SimulationError: It cannot walk now.
        """
        from nao_sim_bridge.walk.gait import FeetGait  # as for `pose_on_ground`

        rate = finite_numbers("velocity", (x, y, theta))
        self.let_go()
        self._session.do(lambda: self.robot.locomotion.move(*rate, FeetGait()))

    def stop(self, wait: bool = True) -> Motion:
        """End a walk as soon as both feet can stand."""
        return self._begin(lambda: self.robot.locomotion.stop(), wait)

    def drive(self, values: Sequence[float], mode: str = "position", ticks: int = 1) -> None:
        """Drive all joints directly, past everything that ALMotion does, and let time pass.

        The sensors look once, at the end; that makes it the fast way for learning. The next call that moves the robot
        otherwise, or `let_go`, gives the joints back to ALMotion's control, where they are then.

        Args:
            values: (26,) in the order of `joint_names`: rad, rad/s or N m.
            mode: "position" (full torque, no limit but that of the motors' speed), "velocity" (at most the torque of
                the motors) or "torque" (cut at what the motors give; gears without friction).
            ticks: How many pass.

        Raises:
            UnknownName: There is no such mode.
            BadValue: There are not 26 finite values, or less than one tick is to pass.
        """
        if len(values) != len(self.joint_names):
            raise BadValue("values", f"{len(values)} of them", f"{len(self.joint_names)}, one for each joint")
        if ticks < 1:
            raise BadValue("ticks", ticks, "1 or more")
        self._session.drive(self.robot, mode, values, ticks)

    def let_go(self) -> None:
        """End `drive`: the joints stay where they are, and do what other calls want again."""
        self._session.do(lambda: self.robot.let_go())

    # --- what happens to it ---------------------------------------------------------------------------------------

    def push(self, link: str = "Torso", force: Sequence[float] = (0.0, 0.0, 0.0), duration: float = 0.1) -> None:
        """Push a link at its centre of mass from now on; pushes at the same time add up.

        Args:
            link: "Torso", or the name of a link of the URDF, for example "l_ankle".
            force: N, in world.
            duration: s.

        Raises:
            UnknownName: There is no such link.
            BadValue: Numbers do not fit.
        """
        x, y, z = finite_numbers("force", force, 3)
        if not 0.0 < duration < LONGEST:
            raise BadValue("duration", duration, f"above 0, below {LONGEST:g} s")
        self._session.do(lambda: self.robot.push((x, y, z), duration, "torso" if link == "Torso" else link))

    def touch(self, *sensors: str) -> None:
        """Simulated fingers on these touch sensors ("Head/Touch/Front"...) and on no others, from now on.

        Raises:
            UnknownName: There is no such sensor.
        """
        self._session.do(lambda: self.robot.press(sensors))

    def protect(self, on: bool) -> None:
        """Switch what ALMotion does on its own on or off, until the next reset.

        Collision avoidance of the arms, slowing down before obstacles, saving torque, putting hot motors to rest,
        balance and the fall manager.

        Raises:
            BadValue: `on` is neither True nor False.
        """
        if not isinstance(on, (bool, np.bool_)):
            raise BadValue("on", on, "True or False")

        def switch() -> None:
            robot = self.robot
            guards = robot.reflexes.self_collision, robot.reflexes.external_collision
            for guard, parts in zip(guards, (("LArm", "RArm"), ("Move", "LArm", "RArm"))):
                (guard.enabled.update if on else guard.enabled.difference_update)(parts)
            robot.reflexes.smart_stiffness.enabled = robot.reflexes.diagnosis_enabled = on
            robot.stability.balance.enabled = robot.stability.falls.enabled = on

        self._session.do(switch)

    # --- inside -------------------------------------------------------------------------------------------------------

    def _indices(self, names: str | Sequence[str]) -> list[int]:
        model = self._simulation.model
        return [model.joint_index[name] for name in joint_names(names, model)]

    def _begin(self, start: Callable[[], Task], wait: bool) -> Motion:
        self.let_go()
        motion = Motion(self._session, self._session.do(start))
        if wait:
            motion.wait()
        return motion

    def _take_picture(self, camera: int, width: int, height: int) -> np.ndarray:
        return self._simulation.cameras.picture(self.snapshot, camera, width, height)

    def _project(self, camera: int, points: np.ndarray, width: int, height: int) -> np.ndarray:
        return self._simulation.cameras.project(self.snapshot, camera, points, width, height)


def _check_speed(speed: float) -> None:
    if not 0.0 < speed <= 1.0:
        raise BadValue("speed", speed, "above 0 to 1")


def _each(values: float | Sequence[float], count: int, name: str) -> list[float]:
    """One number for each of `count`, from one for all or one each."""
    try:
        numbers = np.ravel(np.asarray(values, dtype=float)).tolist()
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) == 1:
        numbers *= count
    if len(numbers) != count or not all(np.isfinite(numbers)):
        raise BadValue(name, values, f"one finite number, or {count}")
    return numbers


def whole_number(name: str, value: Any) -> int:
    """A value as an int.

    Raises:
        BadValue: It is no whole number.
    """
    try:
        return operator.index(value)
    except TypeError:
        raise BadValue(name, value, "a whole number") from None


def finite_numbers(name: str, values: Sequence[float], *counts: int) -> tuple[float, ...]:
    """Values as floats; as many as one of `counts`, if there are any.

    Raises:
        BadValue: Their number is another one, or one of them is no finite number.
    """
    allowed = " or ".join(map(str, counts)) + " finite numbers" if counts else "finite numbers"
    try:
        numbers = tuple(float(value) for value in values)
    except (TypeError, ValueError):
        raise BadValue(name, values, allowed) from None
    if (counts and len(numbers) not in counts) or not all(np.isfinite(numbers)):
        raise BadValue(name, values, allowed)
    return numbers
