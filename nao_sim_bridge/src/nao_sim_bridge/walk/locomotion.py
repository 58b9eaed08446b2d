"""Walking as a robot does it for whoever asks: begin, change on the way, end; what protects it; where it is.

A walk is a task of the motion engine that holds both legs from the first to the last tick. What callers wait for (a
place reached, steps made, a stop) are tasks of their own that it settles, see `waits`. Simulation thread only.
"""

from __future__ import annotations

from math import inf
from typing import Callable, Sequence, Tuple

from nao_sim_bridge.base.errors import MovePrevented, MoveRefused
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.reflexes import Reflexes
from nao_sim_bridge.control.balance.stability import Stability
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.arm_swing import ArmSwing
from nao_sim_bridge.walk.body import WalkingBody, foot_on_ground, frame_from, robot_on_ground
from nao_sim_bridge.walk.courses import STANDSTILL, Course, Rate, rate_limits
from nao_sim_bridge.walk.footstep_plan import FootstepPlan, steps_to_come
from nao_sim_bridge.walk.footsteps import FootPose, middle, side_by_side
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.plan import Phase
from nao_sim_bridge.walk.settings import load_walk_settings
from nao_sim_bridge.walk.steps_course import Placement, StepsCourse
from nao_sim_bridge.walk.target_course import TargetCourse
from nao_sim_bridge.walk.velocity_course import VelocityCourse
from nao_sim_bridge.walk.waits import WalkWaits
from nao_sim_bridge.walk.walk_guard import WalkGuard
from nao_sim_bridge.walk.walker import Readings, Walker

# Where in a step the foot that carries tells where the plan's frame lies in the world.
MIDDLE = 0.5
Velocity = Tuple[float, float, float]


class _LegCurve:
    """What the engine follows for one joint of a leg: the command of this tick."""

    def __init__(self, walk: Locomotion, index: int) -> None:
        self._walk = walk
        self._index = index

    @property
    def duration(self) -> float:
        return self._walk.job_duration

    def value(self, _: float) -> float:
        return self._walk.command(self._index)


class Locomotion:
    """Walks one robot.

    Attributes:
        arms: Swing of the arms.
        failures: Called when a move cannot begin or ends before time, with the cause, whether the walk had begun, and
            the place of the obstacle in the world of the robot's odometry, m, if one was the cause.
    """

    def __init__(
        self,
        model: RobotModel,
        settings: Settings,
        joints: JointCommands,
        motion: MotionEngine,
        stability: Stability,
        reflexes: Reflexes,
        task_ids: TaskIds,
        snapshot: Callable[[], Snapshot | None],
    ) -> None:
        self._gravity = settings.gravity_m_s2
        self._joints = joints
        self._motion = motion
        self._stability = stability
        self._waits = WalkWaits(task_ids, self._stop_course)
        self._snapshot = snapshot
        self._settings = load_walk_settings()
        self.body = WalkingBody(model)
        self._legs = sorted(i for side in (LEFT, RIGHT) for i in self.body.legs.indices[side])
        self._guard = WalkGuard(model, self._gravity, joints, self._legs, stability, reflexes)
        self.arms = ArmSwing(model, joints, self._settings, self._stride)
        self.failures: list[Callable[[str, bool, Vector3 | None], None]] = []
        self._job: Task | None = None
        self._walker: Walker | None = None
        self._course: Course | None = None
        self._to_begin = False
        self._hindered = False
        self._measured_step = False
        self._commands: dict[int, float] = {}
        self._obstructed = False

    # --- what callers ask for -------------------------------------------------------------------------------------

    @property
    def active(self) -> bool:
        """Whether a walk runs, from its begin until the robot stands again."""
        return self._job is not None

    @property
    def course(self) -> Course | None:
        """What the present walk follows: another one after each command, but for steps that are added."""
        return self._course

    @property
    def ending(self) -> bool:
        """Whether the robot makes the last steps of a walk, or none any more."""
        if self._walker is None or not self._walker.plan.walking:
            return not self._to_begin
        return isinstance(self._course, VelocityCourse) and self._course.ending

    @property
    def ahead(self) -> float:
        """How far the robot goes forward in a step, m; 0 when it does not walk."""
        return self._rate()[0] if self.active else 0.0

    def init(self) -> Task:
        """Take the stance that walks begin from."""
        if self.active:
            return self.until_finished()
        now = self._now()
        feet = [foot_on_ground(self.body, now.odometry, self._joints.commands, side) for side in (LEFT, RIGHT)]
        stands = side_by_side(feet[0], feet[1], self._settings.foot_separation)
        self._begin("moveInit", None if stands else self._ending(STANDSTILL))
        return self.until_finished("moveInit")

    def move(self, x: float, y: float, theta: float, gait: FeetGait) -> None:
        """Walk at a velocity, m/s, m/s, rad/s, until told otherwise; no velocity at all ends the walk.

        Raises:
            MoveRefused: The robot cannot walk now.
        """
        period = (gait.period(LEFT) + gait.period(RIGHT)) / 2.0
        self._go("move", (x * period, y * period, theta * period), gait)

    def move_toward(self, x: float, y: float, theta: float, gait: FeetGait) -> None:
        """Walk at shares -1..1 of the gait's largest velocities, until told otherwise.

        Raises:
            MoveRefused: The robot cannot walk now.
        """
        longest, aside, turn = rate_limits(gait, x >= 0.0)
        self._go("moveToward", (x * longest, y * aside, theta * turn), gait)

    def move_to(self, points: Sequence[FootPose], gait: FeetGait, time: float | None = None) -> Task:
        """Walk to the last of `points` through the others, all as seen from the robot now, in `time` s or more.

        Returns:
            Ends when the robot stands, with whether it is there.

        Raises:
            MoveRefused: The robot cannot walk now.
        """
        here = self.position(use_sensors=True)
        period = (gait.period(LEFT) + gait.period(RIGHT)) / 2.0
        course = TargetCourse(
            self._settings,
            gait,
            [here.moved(*point) for point in points],
            steps=1 if time is None else max(1, round(time / period)),
            rate=self._rate(),
        )
        course.begin_towards(here)
        return self._set_goal("moveTo", course)

    def set_steps(self, steps: Sequence[Placement], gait: FeetGait, clear: bool, on_the_clock: bool = False) -> Task:
        """Make planned steps, after those planned or instead; ends when the robot stands, with whether all are made.

        With `on_the_clock` the first period counts from the walk's begin, as in `StepsCourse.add`.

        Raises:
            MoveRefused: The robot cannot walk now.
        """
        course = self._course
        if self.active and isinstance(course, StepsCourse) and self._waits.goal is not None and not course.reached:
            course.add(steps, clear, on_the_clock)
            return self._waits.goal
        return self._set_goal("setFootSteps", StepsCourse(self._settings, gait, steps))

    def stop(self) -> Task:
        """End the walk as soon as both feet can stand; the task ends then."""
        self._stop_course()
        return self.until_finished("stopMove")

    def kill(self) -> None:
        """End the walk at once, with a foot in the air if it happens to be there."""
        if self._job is not None:
            self._job.kill()

    def until_finished(self, name: str = "waitUntilMoveIsFinished") -> Task:
        """A task that ends when no walk runs any more."""
        return self._waits.for_the_end(name, self.active)

    # --- where it is ----------------------------------------------------------------------------------------------

    def position(self, use_sensors: bool) -> FootPose:
        """The robot in the world of its odometry, by measured angles or by what the joints are told."""
        now = self._now()
        angles = now.positions if use_sensors else self._joints.commands
        return robot_on_ground(self.body, now.odometry, angles)

    def next_position(self) -> FootPose:
        """Where the robot will be after the steps that can no longer be changed."""
        walker = self._walker
        if walker is None or self._course is None or walker.plan.step is None:
            return self.position(use_sensors=False)
        return self._course.frame.moved(*walker.plan.robot)

    def velocity(self) -> Velocity:
        """Of the robot in its world, m/s, m/s, rad/s, as planned."""
        walker, course = self._walker, self._course
        if walker is None or course is None or walker.plan.step is None:
            return (0.0, 0.0, 0.0)
        plan, period = walker.plan, walker.plan.step.period
        x, y, yaw = plan.way if isinstance(course, StepsCourse) else course.rate
        heading = FootPose(0.0, 0.0, course.frame.yaw + plan.robot.yaw).moved(x / period, y / period)
        return (heading.x, heading.y, yaw / period)

    def steps(self) -> FootstepPlan:
        """Feet in the world, and the steps to come."""
        now = self._now()
        left, right = (foot_on_ground(self.body, now.odometry, now.positions, side) for side in (LEFT, RIGHT))
        plan = None if self._walker is None else self._walker.plan
        fixed, clearable = steps_to_come(plan, self._course, self._settings)
        return FootstepPlan(left, right, tuple(fixed), tuple(clearable))

    # --- the tick -------------------------------------------------------------------------------------------------

    @property
    def job_duration(self) -> float:
        """For the engine: whether the walk goes on."""
        walker = self._walker
        if walker is None:
            return 0.0 if self._hindered else inf
        return inf if walker.plan.phase is not Phase.STAND or self._to_begin else 0.0

    def command(self, index: int) -> float:
        """For the engine: where a joint of a leg is to be, rad."""
        return self._commands[index]

    def tick(self, dt: float) -> None:
        """Advance the walk, if any, before the joints get their commands."""
        walker, now, job = self._walker, self._snapshot(), self._job
        if walker is None or now is None or job is None:
            return
        try:
            self._advance(walker, now, dt)
        except Exception as error:
            self._motion.fail(job, error)

    def _advance(self, walker: Walker, now: Snapshot, dt: float) -> None:
        cause = self._guard.danger(now, dt)
        if cause:
            self._fail(cause, started=True)
            self.kill()
            return
        self._look_ahead(now)
        readings = Readings(now.positions, now.imu.angles[:2], now.imu.gyroscope[:2], now.foot_loads)
        self._place_frame(walker, now)
        self._commands = walker.tick(readings, self._joints.commands, dt)
        if self._course is not None:
            self._course.haste = walker.haste
        if walker.plan.phase is Phase.STAND and self._to_begin and self._course is not None:
            self._begin_course(walker, self._course, now)
            self._to_begin = False

    # --- inside ---------------------------------------------------------------------------------------------------

    def _now(self) -> Snapshot:
        now = self._snapshot()
        if now is None:
            raise MoveRefused("nothing was sensed yet")
        return now

    def _go(self, name: str, rate: Rate, gait: FeetGait) -> None:
        if not any(rate):
            self._stop_course()
            return
        if self.ending:
            self._require_way(rate[0])
        self._start(name, VelocityCourse(self._settings, gait, rate, self._rate()))

    def _require_way(self, ahead: float) -> None:
        """Begin no walk into an obstacle: one that begins is slow, and would come near before it ends, each time."""
        seen = self._guard.obstacle(self._now(), ahead)
        if seen is not None:
            self._fail(seen.cause, started=False, obstacle=seen.place)
            raise MovePrevented(seen.cause)

    def _set_goal(self, name: str, course: Course) -> Task:
        goal = self._waits.make_goal(name)
        self._start(name, course)
        self._waits.goal = goal
        return goal

    def _start(self, name: str, course: Course) -> None:
        if not self.active:
            self._begin(name, course)
            return
        self._waits.end_goal(False)
        self._change_course(course)

    def _stop_course(self) -> None:
        """End a walk, if any, on two feet; also when somebody has cancelled what it was for."""
        if not self.active:
            return
        self._waits.end_goal(False)
        if self._walker is None or not self._walker.plan.walking:
            self._to_begin = False  # it has not made a step yet, or makes none any more
            return
        self._change_course(self._ending(self._rate()))

    def _ending(self, rate: Rate) -> VelocityCourse:
        course = VelocityCourse(self._settings, FeetGait(), STANDSTILL, rate)
        course.end()
        return course

    def _change_course(self, course: Course) -> None:
        if self._course is not None:
            course.follow(self._course)
        self._course = course
        self._obstructed = False
        if self._walker is not None and self._walker.plan.walking:
            self._walker.plan.take_course(course)
        else:
            self._to_begin = True

    def _rate(self) -> Rate:
        return self._course.rate if self._course is not None else STANDSTILL

    def _begin(self, name: str, course: Course | None) -> None:
        cause = self._guard.hindrance(self._now())
        if cause:
            self._fail(cause, started=False)
            raise (MovePrevented if self._guard.too_soft else MoveRefused)(cause)
        self._course = course
        self._to_begin, self._hindered = course is not None, False
        self._obstructed = False
        self._guard.begin()
        self._job = self._motion.follow(name, self._legs, self._curves, noticed=False)
        self._job.add_done_callback(self._ended)

    def _curves(self, commands: Sequence[float]) -> dict[int, _LegCurve]:
        """Called when the legs are free; who had them may have taken the robot off its feet."""
        self._commands = {i: commands[i] for i in self._legs}
        cause = self._guard.hindrance(self._now())
        if cause:
            self._fail(cause, started=False)
            self._hindered = True
        else:
            self._walker = walker = Walker(self.body, self._settings, self._gravity, commands)
            self._stability.walk = lambda: walker.feedback.error
        return {i: _LegCurve(self, i) for i in self._legs}

    def _begin_course(self, walker: Walker, course: Course, now: Snapshot) -> None:
        """Make the first step from where both feet stand."""
        here = robot_on_ground(self.body, now.odometry, now.positions)
        feet = walker.plan.feet
        course.frame = frame_from(here, middle(feet[LEFT], feet[RIGHT]))
        course.begin_at(here)
        walker.plan.begin(course)

    def _place_frame(self, walker: Walker, now: Snapshot) -> None:
        """See where the plan's frame lies, once a step, when one foot stands alone and surely flat."""
        plan = walker.plan
        share = plan.swing_share
        if share < MIDDLE:
            self._measured_step = False
        elif not self._measured_step and self._course is not None:
            self._measured_step = True
            stands = foot_on_ground(self.body, now.odometry, now.positions, plan.support)
            self._course.frame = frame_from(stands, plan.feet[plan.support])

    def _ended(self, job: Task) -> None:
        if job.killed and self._stability.falls.falling:
            self._fail("the robot falls", started=True)
        by_itself = not job.killed and job.error is None
        reached = by_itself and self._course is not None and self._course.reached
        self._job = self._walker = self._course = None
        self._stability.walk = None
        self._waits.end_all(reached, job.error)

    def _look_ahead(self, now: Snapshot) -> None:
        """End a walk that leads into an obstacle which the sonars see."""
        if self._obstructed or self._course is None:
            return
        seen = self._guard.new_obstacle(now, self._course.rate[0])
        if seen is not None:
            self._fail(seen.cause, started=True, obstacle=seen.place)
            self._stop_course()
            self._obstructed = True

    def _fail(self, cause: str, started: bool, obstacle: Vector3 | None = None) -> None:
        for call in self.failures:
            call(cause, started, obstacle)

    def _stride(self) -> float | None:
        """How far the left foot is ahead of the right one, m; None when no walk runs."""
        walker = self._walker
        if walker is None:
            return None
        left, right = walker.plan.foot(LEFT).pose, walker.plan.foot(RIGHT).pose
        return left.seen_from(right).x
