"""Following paths: paths and courses, steering, a robot that is led along them, and poses and frames of messages."""

from __future__ import annotations

import dataclasses
import math
import time
from unittest.mock import Mock

import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import PoseStamped, Quaternion, TransformStamped
from nav_msgs.msg import Path

from nao_library_modules.core.errors import BadGoal, Preempted
from nao_library_modules.core.geometry import ORIGIN, Place, from_roll_pitch_yaw
from nao_library_modules.core.waiting import CancellationToken
from nao_library_modules.driver.joints import planar_frames
from nao_library_modules.driver.joints.planar_frames import (
    PlanarFrames,
    pose_stamped,
    read_path,
    read_place,
)
from nao_library_modules.driver.path_follower import path_walk as path_follower_legs
from nao_library_modules.driver.path_follower import path_walk as path_follower_walk
from nao_library_modules.driver.path_follower.path_courses import (
    FollowerSettings,
    PathCourse,
    TargetCourse,
    WalkPath,
    reached,
)
from nao_library_modules.driver.path_follower.path_walk import WalkTopics, lead, velocity
from naoqi.errors import NaoError

QUARTER, NAN = math.pi / 2, math.nan
SETTINGS, LIMITED = FollowerSettings(), FollowerSettings(max_vel_x=0.8, max_vel_y=0.4, max_vel_yaw=0.5)
WAYPOINTS = [Place(0.0, 0.0, 3.0), Place(1.0, 0.0, 3.0), Place(1.0, 1.0, 0.25)]
CORNER = WalkPath(WAYPOINTS)
SQUARE = WalkPath([Place(x, y, 0.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (0, 0))])


def refused(words, function, *arguments, error=NaoError):
    with pytest.raises(error, match=words):
        function(*arguments)


def test_length_places_and_headings_of_a_path():
    assert CORNER.length == pytest.approx(2.0)
    for along, place in ((-1.0, (0, 0, 0)), (0.25, (0.25, 0, 0)), (1.2, (1, 0.2, QUARTER)), (1.99, (1, 0.99, QUARTER))):
        assert CORNER.place_at(along) == pytest.approx(place)
    assert CORNER.place_at(2.0) == WAYPOINTS[-1]  # the last heading counts, the others follow the path
    assert (CORNER.direction_at(1.0), CORNER.direction_at(9.0)) == pytest.approx((QUARTER, QUARTER))
    doubled = WalkPath([WAYPOINTS[0], WAYPOINTS[0], WAYPOINTS[1], WAYPOINTS[1], WAYPOINTS[2]])
    assert [doubled.index_at(along) for along in (0.0, 0.9, 1.1, 2.0)] == [3, 3, 4, 4]
    assert doubled.length == pytest.approx(2.0)
    for robot, window, along, off in (
        ((0.5, 0.1), (0.8, 1.5), 0.8, math.hypot(0.3, 0.1)),
        ((1.2, 1.4), (0.0, 5.0), 2.0, math.hypot(0.2, 0.4)),
        ((0.95, 0.2), (0.0, 1.5), 1.2, 0.05),
    ):
        found = CORNER.nearest(Place(*robot, 0.0), *window)
        assert (found.along, found.off) == pytest.approx((along, off))
    assert CORNER.straight(0.1, 0.9, 0.01) and CORNER.straight(0.95, 1.0, 0.05) and not CORNER.straight(0.8, 1.2, 0.05)
    refused("1 pose", WalkPath, WAYPOINTS[:1], error=BadGoal)
    refused("3 poses at one", WalkPath, [WAYPOINTS[0]] * 3, error=BadGoal)


def test_where_it_aims():
    for robots, aim in (
        ([(0.0, 0.0, 0.0)], (0.3, 0.0, 0.0)),
        ([(0.0, 0.0, 0.0), (0.3, 0.01, 0.1)], (0.6, 0.0, 0.0)),  # straight: further ahead
        ([(0.2, 0.0, 0.5)], (0.3, 0.0, 0.0)),  # turned away
        ([(0.2, 0, 0), (0.5, 0, 0), (0.8, 0, 0)], (0.9, 0.0, 0.0)),  # before a corner
        ([(0.2, 0, 0), (0.5, 0, 0), (0.8, 0, 0), (0.95, 0, 0)], (1.0, 0.05, QUARTER)),
        ([(0.05, 0.02, 2.0)], (0.05, 0.0, 0.0)),  # turned far away: on the spot first
    ):
        course = PathCourse(CORNER, SETTINGS)
        assert [course.aim(Place(*robot)) for robot in robots][-1].place == pytest.approx(aim)


def test_velocities_along_a_way():
    for way, speeds in (
        ((2.0, 0.0, 0.0), (0.8, 0.0, 0.0)),
        ((0.1, 0.0, 0.0), (0.4, 0.0, 0.0)),  # slower near the end
        ((0.0, -0.2, 0.1), (0.0, -0.4, 0.5 * 0.1 / LIMITED.threshold_damp_yaw)),  # near by: to the target's heading
        ((-1.0, 0.1, 0.0), (0.0, 0.0, 0.5)),  # far away it turns its face first
        ((0.0, 0.0, -2.0), (0.0, 0.0, -0.5)),  # on the spot it only turns
    ):
        assert velocity(Place(*way), LIMITED) == pytest.approx(speeds)


def test_in_one_round_the_robot_does_not_get_past_its_target():
    for frequency, speed in ((0.0, 0.04 / 0.6), (1.0, 0.04 / 0.42)):  # m/s
        seldom = FollowerSettings(controller_frequency=0.5, threshold_damp_xy=0.01, max_vel_x=1.0, step_freq=frequency)
        ahead, _, turn = velocity(Place(0.05, 0.0, 0.05), seldom)
        assert ahead * speed * 2.0 == pytest.approx(0.05) and 0.0 < turn * 2.0 * 0.349 / 0.6 <= 0.05


def test_it_ends_at_the_last_waypoint_with_its_heading():
    course = PathCourse(CORNER, SETTINGS)
    on_the_way = [(0.2, 0, 0), (0.5, 0, 0), (0.8, 0, 0), (1, 0.1, QUARTER), (1, 0.3, QUARTER), (1, 0.7, QUARTER)]
    aims = [course.aim(Place(*robot)) for robot in on_the_way]
    assert [aim.index for aim in aims] == [1, 1, 1, 2, 2, 2] and not aims[2].final
    rests = [aim.rest for aim in aims[:3]]
    assert rests == sorted(rests, reverse=True) and rests[0] > rests[-1]
    aim = course.aim(Place(1.0, 0.95, QUARTER))
    assert aim.final and aim.place == WAYPOINTS[-1]
    assert aim.rest == pytest.approx(0.05 + 0.05 * (QUARTER - 0.25))


def test_a_path_that_begins_elsewhere_is_refused_and_where_it_comes_back_it_does_not_jump():
    far = Place(-0.5, 0.0, 0.0)
    words = r"too far from start of path, 0\.50 m: at most 0\.3 m"
    refused(words, PathCourse(CORNER, SETTINGS).aim, far, error=BadGoal)
    wide = PathCourse(CORNER, dataclasses.replace(SETTINGS, path_max_start_distance=1.0))
    assert wide.aim(far).place.x == pytest.approx(0.1)
    aim = PathCourse(SQUARE, SETTINGS).aim(Place(0.0, 0.02, 0.0))
    assert not aim.final and aim.place.x == pytest.approx(0.3) and aim.rest > 3.9
    assert reached(Place(0.03, 0.03, 0.08), SETTINGS)
    assert not reached(Place(0.06, 0.0, 0.0), SETTINGS) and not reached(Place(0.0, 0.0, -0.1), SETTINGS)


def test_names_of_parameters_are_those_of_the_settings_and_those_that_will_not_do_are_named():
    given = {"~target_distance_threshold": 0.02, "~use_vel_ctrl": True, "~controller_frequency": 20}
    read = FollowerSettings.read(lambda name, default: given.get(name, default))
    assert read == FollowerSettings(target_distance_threshold=0.02, use_vel_ctrl=True, controller_frequency=20)
    wrong = {"controller_frequency": 0, "max_vel_x": 1.5, "step_freq": 2.0, "use_vel_ctrl": 1, "straight_offset": NAN}
    for name, value in wrong.items():
        refused(f"~{name} is", lambda name=name, value=value: FollowerSettings(**{name: value}))


SPEED, TURN = 0.095, 0.83
BY_POSES = FollowerSettings()
BY_VELOCITIES = dataclasses.replace(BY_POSES, use_vel_ctrl=True)
BOTH = pytest.mark.parametrize("control", [BY_POSES, BY_VELOCITIES], ids=["poses", "velocities"])


class Point:
    """Legs, eyes and clock: a point that does as it is told. Waiting makes time pass.

    Attributes:
        able: What `prepare` raises otherwise.
        wall: x it cannot get beyond.
        cause: What has stopped it.
    """

    def __init__(self):
        self.place, self.time, self.able, self.wall, self.cause = ORIGIN, 0.0, None, math.inf, ""
        self.commands, self.stops, self.track = [], 0, [ORIGIN]
        self._goal, self._speed = None, (0.0, 0.0, 0.0)

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.time += duration
        x, y, yaw = (speed * duration for speed in self._speed)
        step = Place(SPEED * x, SPEED * y, TURN * yaw)
        if self._goal is not None:
            way = self._goal.seen_from(self.place)
            share = min(1.0, SPEED * duration / max(way.distance, 1e-9))
            step = Place(way.x * share, way.y * share, max(-TURN * duration, min(TURN * duration, way.yaw)))
            if share == 1.0 and step.yaw == way.yaw:
                self._goal = None
        place = self.place.then(step)
        self.place = place._replace(x=min(place.x, self.wall))
        self.track.append(self.place)
        return not interrupt.is_set()

    def prepare(self, interrupt):
        if self.able is not None:
            raise self.able

    def go_to(self, way):
        self.commands.append(way)
        self._goal, self._speed = self.place.then(way), (0.0, 0.0, 0.0)

    def go_at(self, *speed):
        self.commands.append(speed)
        self._goal, self._speed = None, speed

    def walking(self):
        return self._goal is not None or any(self._speed)

    def why_stopped(self):
        return self.cause

    def stop(self):
        self.stops += 1
        self._goal, self._speed = None, (0.0, 0.0, 0.0)


@pytest.fixture
def point(monkeypatch):
    # Its clock is faster than any: nothing has to rest in real time.
    monkeypatch.setattr(path_follower_walk, "FASTEST_ROUND", 0.0)
    monkeypatch.setattr(path_follower_walk, "WALL_GRACE", 0.0)
    return Point()


def walk(point, course, control, interrupt=None, report=lambda place, aim: None):
    lead(course, point, lambda: point.place, point, control, interrupt or CancellationToken(), report)


def target(*place):
    return TargetCourse(lambda: Place(*place))


@BOTH
@pytest.mark.parametrize("place", [(1.0, 0.3, 0.8), (-0.5, 0.0, 0.0), (0.0, 0.4, -2.0), (0, 0, 1.0)])
def test_a_target_is_reached_and_the_robot_stands(point, control, place):
    walk(point, target(*place), control)
    way = Place(*place).seen_from(point.place)
    assert way.distance < control.target_distance_threshold and abs(way.yaw) < control.target_angle_threshold
    assert not point.walking() and point.time < 40.0


def test_by_poses_it_is_told_once_and_walks_to_the_very_place_and_who_is_there_does_not_walk(point):
    walk(point, target(0.01, 0.0, 0.0), BY_POSES)
    assert point.commands == []
    walk(point, target(1.0, 0.3, 0.8), BY_POSES)
    assert point.commands == [Place(1.0, 0.3, 0.8)] and point.stops == 0
    assert point.place == pytest.approx((1.0, 0.3, 0.8))


def test_a_target_that_drifts_or_whose_walk_somebody_stopped_is_told_again(point):
    walk(point, TargetCourse(lambda: Place(1.0 + min(0.1, 0.01 * point.time), 0.0, 0.0)), BY_POSES)
    assert point.place.x == pytest.approx(1.1, abs=0.03)
    assert 3 <= len(point.commands) <= 6
    stopped = Point()
    stop_once = lambda place, aim: stopped.stop() if stopped.stops == 0 and stopped.time > 3.0 else None  # noqa: E731
    walk(stopped, target(1.0, 0.0, 0.0), BY_POSES, report=stop_once)
    assert stopped.place.x == pytest.approx(1.0) and len(stopped.commands) == 2


CURVE = WalkPath([Place(0.02 * i, 0.2 * math.sin(0.02 * i * 2 * math.pi), 0.0) for i in range(51)])


@BOTH
@pytest.mark.parametrize("path", [SQUARE, CURVE], ids=["square", "curve"])
def test_a_path_is_kept_to_from_its_beginning_to_its_end(point, control, path):
    indices = []
    walk(point, PathCourse(path, control), control, report=lambda place, aim: indices.append(aim.index))
    assert max(path.nearest(place, 0.0, path.length).off for place in point.track) < 0.08
    assert point.place.distance_to(path.waypoints[-1]) < control.target_distance_threshold
    assert indices == sorted(indices) and indices[-1] == len(path.waypoints) - 1
    assert len(set(indices)) > 0.8 * len(path.waypoints) - 1
    assert point.time > 0.9 * path.length / SPEED


@BOTH
def test_a_robot_that_does_not_get_there_says_why(point, control, monkeypatch):
    ahead, halfway = target(1.0, 0.0, 0.0), Point()

    def fall(place, aim):
        if halfway.time > 3.0:
            halfway.able = NaoError("the robot has fallen")
            halfway.go_at = halfway.go_to = lambda *command: None
            halfway.stop()

    point.wall = 0.5
    refused("no progress for 10 s, with 0.5. m still to go", walk, point, ahead, control)
    assert point.time < 20.0
    unable = Point()
    unable.able = NaoError("the legs are limp")
    refused("limp", walk, unable, ahead, control)
    assert unable.commands == []  # before it is told
    refused("fallen", walk, halfway, ahead, control, None, fall)
    assert halfway.time < 6.0
    careful = Point()

    def see(place, aim):
        if place.x > 0.4 and not careful.cause:
            careful.cause = "an obstacle 0.39 m ahead"
            careful.stop()

    refused("the robot stopped: an obstacle 0.39 m ahead", walk, careful, ahead, control, None, see)
    assert careful.place.x < 0.45


def test_who_has_arrived_and_ends_the_last_steps_slowly_is_not_stuck(point, monkeypatch):
    control = dataclasses.replace(BY_POSES, stuck_time=1.0)
    arrived = []
    monkeypatch.setattr(point, "walking", lambda: not arrived or point.time < arrived[0] + 2.5)
    report = lambda place, aim: arrived.append(point.time) if not arrived and aim.rest < 1e-3 else None  # noqa: E731
    walk(point, target(0.3, 0.0, 0.0), control, report=report)
    assert point.time > arrived[0] + 2.0


def test_an_interrupt_ends_it_and_leaves_the_legs_as_they_are(point):
    interrupt = CancellationToken()

    def trigger(place, aim):
        if point.time > 2.0:
            interrupt.trigger()

    refused("", walk, point, target(1.0, 0.0, 0.0), BY_POSES, interrupt, trigger, error=Preempted)
    assert point.stops == 0


NOW = rospy.Time(100)


def pose(x, y, frame="odom", yaw=None):
    message = PoseStamped()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    if yaw is not None:
        message.pose.orientation = Quaternion(*from_roll_pitch_yaw(0.0, 0.0, yaw))
    return message


def path(*poses, frame="odom"):
    message = Path(poses=list(poses))
    message.header.frame_id = frame
    return message


def test_of_a_path_the_last_heading_counts_and_without_one_that_of_the_path():
    places, frame = read_path(path(pose(0, 0), pose(1, 0), pose(1, 1, yaw=0.25)))
    place = read_place("goal", pose_stamped(Place(1.0, -2.0, 0.5), "/map", NOW))
    assert place[0] == pytest.approx((1.0, -2.0, 0.5)) and place[1] == "map"
    assert frame == "odom" and places[:2] == [Place(0, 0, 0), Place(1, 0, 0)]
    assert places[2] == pytest.approx((1, 1, 0.25))
    assert read_path(path(pose(0, 0), pose(1, 0), pose(1, 1), pose(1, 1)))[0][-1].yaw == pytest.approx(QUARTER)
    assert read_path(path(pose(0, 0, "map"), pose(1, 0, "map"), frame=""))[1] == "map"
    mixed = path(pose(0, 0, "odom"), pose(1, 0, "map"), frame="map")
    refused("path.poses.*all in the frame of the path, map", read_path, mixed, error=BadGoal)
    refused("frame_id", read_path, path(pose(0, 0, ""), frame=""), error=BadGoal)
    refused(r"goal\.header\.frame_id", read_place, "goal", pose(1.0, 0.0, frame="", yaw=0.0), error=BadGoal)
    refused(r"goal\.pose\.orientation.*rotation", read_place, "goal", pose(1.0, 0.0), error=BadGoal)
    refused(r"goal\.pose\.position\.x: nan", read_place, "goal", pose(NAN, 0.0, yaw=0.0), error=BadGoal)
    no_number = path(pose(0, 0), pose(math.nan, 0))
    refused(r"path\.poses\[1\]\.pose\.position\.x", read_path, no_number, error=BadGoal)


class Buffer(tf2_ros.BufferCore):
    """Frames that come from the test; nobody waits for more."""

    def lookup_transform(self, target, source, time, timeout):
        return self.lookup_transform_core(target, source, time)


@pytest.fixture
def frames(monkeypatch):
    """Frames: map - odom - base_link - CameraTop, which looks down, and odom - ball."""
    monkeypatch.setattr(planar_frames.rospy.Time, "now", lambda: rospy.Time(NOW.secs, 500_000_000))
    buffer = Buffer()

    def add(parent, child, x, y, z=0.0, pitch=0.0, yaw=0.0):
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = parent, NOW
        move, turn = transform.transform.translation, transform.transform.rotation
        move.x, move.y, move.z = x, y, z
        turn.x, turn.y, turn.z, turn.w = from_roll_pitch_yaw(0.0, pitch, yaw)
        buffer.set_transform(transform, "test")

    add("map", "odom", 10.0, 0.0)
    add("odom", "base_link", 1.0, 2.0, yaw=QUARTER)
    add("base_link", "CameraTop", 0.1, 0.0, 0.4, pitch=math.radians(60.0))
    add("odom", "ball", 3.0, 0.0)
    return PlanarFrames(buffer)


def test_frames_are_found_in_each_other_seen_from_above(frames):
    assert frames.locate("base_link", "map", 0.0) == pytest.approx((11.0, 2.0, QUARTER))
    assert frames.locate("CameraTop", "odom", 0.0) == pytest.approx((1.0, 2.1, QUARTER))
    inside = {frame: frames.inside(frame, "odom") for frame in ("base_link", "CameraTop", "odom", "ball", "map", "no")}
    assert inside == {"base_link": True, "CameraTop": True, "odom": True, "ball": True, "map": False, "no": False}


def test_a_pose_is_turned_before_it_is_laid_flat_and_a_late_one_counts_as_of_now(frames):
    ahead = pose(1.0, 0.0, "CameraTop", yaw=0.0)
    assert frames.place_in("odom", ahead, 0.0) == pytest.approx((1.0, 2.1 + math.cos(math.radians(60.0)), QUARTER))
    assert frames.place_in("base_link", pose(3.0, 0.0, yaw=0.0), 0.0) == pytest.approx((-2.0, -2.0, -QUARTER))
    refused("base_link cannot be found in odom", PlanarFrames(Buffer()).locate, "base_link", "odom", 0.0)
    late = pose(0.5, 0.0, "base_link", yaw=0.0)
    late.header.stamp = rospy.Time(NOW.secs + 50)
    assert frames.place_in("odom", late, 0.0) == pytest.approx((1.0, 2.5, QUARTER))


@pytest.mark.parametrize("use_velocities", [False, True])
def test_a_command_that_comes_after_the_stop_does_not_begin_the_walk_again(monkeypatch, use_velocities):
    monkeypatch.setattr(path_follower_legs, "LazyTopic", Mock())
    monkeypatch.setattr(path_follower_legs, "ON_ITS_WAY", 0.05)
    monkeypatch.setattr(time, "sleep", lambda seconds: [arrive(each) for each in on_their_way])
    walks, on_their_way, robot, node = [], [], Mock(), Mock()

    def arrive(command):
        on_their_way.remove(command)
        walks[:] = [True] if getattr(command, "x", 0.0) or getattr(command, "linear", ORIGIN).x else []

    def call(method, *_):
        return Mock(result=lambda timeout: bool(walks) if method == "moveIsActive" else None)

    robot.proxy.return_value.call_async = call
    node.publisher.return_value.publish = on_their_way.append
    node.caller.return_value = Mock(side_effect=walks.clear)
    legs = WalkTopics(robot, node, use_velocities)
    legs.go_at(1.0, 0.0, 0.0) if use_velocities else legs.go_to(Place(1.0, 0.0, 0.0))
    legs.stop()
    for command in list(on_their_way):
        arrive(command)
    assert not walks
