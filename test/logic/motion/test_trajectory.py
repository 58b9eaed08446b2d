"""Trajectories as clients of nao_robot send them, pose libraries of Choregraphe, and the motions of the library."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.files import config_file
from nao_library_modules.core.joint_trajectory import H25_BODY, check_range, expand_names, one_each, read_trajectory
from nao_library_modules.core.poses import BadPoseFile, read_poses
from nao_library_modules.motion.recorded_motion import MotionStore
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.model.model_reader import load_model

CHAINS = {"Body": ("HeadYaw", "HeadPitch", "LHand"), "Head": ("HeadYaw", "HeadPitch"), "LArm": ("LHand",)}


def point(time, positions, velocities=(), accelerations=()):
    return SimpleNamespace(
        time_from_start=time, positions=positions, velocities=velocities, accelerations=accelerations
    )


def read(names, *points, relative=False, chains=CHAINS):
    return read_trajectory(SimpleNamespace(joint_names=names, points=list(points)), chains, relative=relative)


def test_many_points_for_many_joints_or_one_value_for_all():
    frames = read(["Head"], point(1, [0.1, 0.2]), point(2.5, [0.3, 0.4]))
    times = [1.0, 2.5]
    assert frames.interpolation_arguments() == (list(CHAINS["Head"]), [[0.1, 0.3], [0.2, 0.4]], [times, times], True)
    assert (frames.duration, frames.targets) == (2.5, {"HeadYaw": 0.3, "HeadPitch": 0.4})
    assert set(read(["Body"], point(1.5, [1.0])).targets.values()) == {1.0}
    start = read(["HeadYaw"], point(0, [0.0]), point(1, [0.5]))  # where the robot is anyway
    assert (start.times, start.values) == ((1.0,), ((0.5,),))
    assert expand_names(["LArm", "HeadPitch"], CHAINS) == ("LHand", "HeadPitch")


def test_relative_values_are_told_to_the_robot_or_added_to_the_start():
    with pytest.raises(BadGoal, match=r"HeadPitch is to be 1.2: 0 to 1"):
        check_range(read(["Head"], point(1, [0.5, 1.2])), 0.0, 1.0)
    frames = read(["Head"], point(1, [0.1, -0.1]), relative=True)
    assert frames.interpolation_arguments()[-1] is False
    assert frames.absolute([1.0, 2.0]).values == ((1.1,), (1.9,))
    assert frames.absolute([1.0, 2.0]).interpolation_arguments()[-1] is True
    names, times, points = read(["HeadYaw"], point(1, [0.2], [0.3]), point(4, [0.6], [-0.1])).bezier_arguments()
    (_, _, (_, out, rise)), (_, (_, into, fall), _) = points[0]
    assert (names, times) == (["HeadYaw"], [[1.0, 4.0]]) and (out, rise) == pytest.approx((1.0, 0.3))
    assert (into, fall) == pytest.approx((-1.0, 0.1)), "time runs evenly; slopes are the velocities"


def test_accelerations_bend_the_way_between_points():
    frames = read(["HeadYaw"], point(0, [0.0], [0.0], [0.0]), point(2, [1.0], [0.0], [0.0]))
    assert frames.times == (0.5, 1.0, 1.5, 2.0)
    assert frames.values[0] == pytest.approx((0.103516, 0.5, 0.896484, 1.0), abs=1e-6), "of least jerk"
    assert frames.velocities[0] == pytest.approx((0.527344, 0.9375, 0.527344, 0.0), abs=1e-6)
    bent = read(["HeadYaw"], point(1, [0.0], [0.0], [2.0]), point(2, [1.0], [2.0], [2.0]))
    assert bent.values[0] == pytest.approx([t**2 for t in (0.0, 0.25, 0.5, 0.75, 1.0)]), "a constant acceleration"
    only = read(["HeadYaw"], point(2, [1.0], [0.0], [0.0]))
    with pytest.raises(ValueError, match="absolute"):
        only.bezier_arguments()
    assert only.absolute([0.0]) == frames, "also to a first or only point, from where the joint rests"
    further = read(["HeadYaw"], point(2, [0.5], [0.0], [0.0]), point(3, [0.5], [0.0], [0.0]), relative=True)
    assert further.absolute([0.5]).values[0][:4] == pytest.approx((0.551758, 0.75, 0.948242, 1.0), abs=1e-6)
    for points, text in (
        ([point(1, [0.0], (), [0.0])], "accelerations alone"),
        ([point(1, [0.0], [0.0], [0.0]), point(2, [0.0], [0.0])], "point 1 has no accelerations, others have"),
    ):
        with pytest.raises(BadGoal, match=text):
            read(["HeadYaw"], *points)


def test_a_pose_of_the_whole_h25_body_fits_a_robot_without_wrists_and_hands():
    without = [name for name in H25_BODY if not name.endswith(("Hand", "WristYaw"))]
    chains, pose = {"Body": without}, [float(i) for i in range(len(H25_BODY))]
    wanted = {name: float(H25_BODY.index(name)) for name in without}
    assert read(["Body"], point(1, pose), chains=chains).targets == wanted
    assert one_each(pose, ["Body"], chains, "joint_angles") == tuple(wanted.values())


@pytest.mark.parametrize(
    "names, points, field, words",
    [
        (["HeadJaw"], [point(1, [0.0])], "joint_names", "did you mean 'HeadYaw'"),
        (["Head", "HeadYaw"], [point(1, [0.0])], "joint_names", "named twice: HeadYaw"),
        (["Head"], [], "points", "no point"),
        (["Body"], [point(1, [0.0, 0.0])], "points[0].positions", "2 values for 3 joints"),
        (["HeadYaw"], [point(0, [0.0])], "points[0].time_from_start", "above 0 s"),
        (["HeadYaw"], [point(2, [0]), point(2, [1])], "points[1].time_from_start", "2 s after 2 s"),
        (["HeadYaw"], [point(1, [float("nan")])], "points[0].positions", "-100..100 rad"),
        (["HeadYaw"], [point(1, [0], [1]), point(2, [0])], "points[1].velocities", "point 1 has no"),
    ],
)
def test_what_is_wrong_is_named(names, points, field, words):
    with pytest.raises(BadGoal) as caught:
        read(names, *points)
    assert caught.value.field == f"trajectory.{field}" and words in str(caught.value)


# Pose libraries

NAMESPACE = ' xmlns="http://www.aldebaran-robotics.com/schema/choregraphe/position.xsd"'


def motors(**angles):
    return "".join(f"<Motor><name>{name}</name><value>{value}</value></Motor>" for name, value in angles.items())


NOD = motors(HeadPitch=0.5)


def position(name="Nod", version="2", content=NOD):
    return f"<position><version>{version}</version><name>{name}</name><Motors>{content}</Motors></position>"


@pytest.fixture
def poses(tmp_path):
    def poses(*positions, namespace=NAMESPACE):
        path = tmp_path / "library.xap"
        path.write_text(f'<?xml version="1.0" encoding="UTF-8" ?>\n<poses{namespace}>{"".join(positions)}</poses>')
        return read_poses(path)

    return poses


def test_version_2_is_in_radians_and_older_in_degrees(poses, tmp_path):
    found = poses(position(), position("Old", "1", motors(HeadYaw=90.0, LHand=0.25)))
    assert found == {"Nod": {"HeadPitch": 0.5}, "Old": {"HeadYaw": pytest.approx(math.pi / 2), "LHand": 0.25}}
    assert poses(position(), namespace="") == {"Nod": {"HeadPitch": 0.5}}
    library = read_poses(config_file("poses.xap"))
    assert set(library) == {"ArmsForward", "HandsOnHips"} and all(len(pose) >= 8 for pose in library.values())
    for positions, problem in (
        ((position(), position()), "two positions are called 'Nod'"), ((position(content=""),), "Nod: no motors"),
        ((position(content=motors(HeadYaw="nan")),), "HeadYaw has the value 'nan'"),
    ):  # fmt: skip
        with pytest.raises(BadPoseFile, match=problem):
            poses(*positions)
    with pytest.raises(BadPoseFile, match="No such file"):
        read_poses(tmp_path / "nothing.xap")


# What comes with the library

MOTIONS = sorted(path.stem for path in config_file("motions").glob("*.yaml"))
SHARE = 0.75
"""Of its top speed that a joint of a shipped motion may need."""


@pytest.fixture
def motions(tmp_path):
    return MotionStore(tmp_path, config_file("motions"))


@pytest.mark.parametrize("name", MOTIONS)
def test_joints_can_follow_a_motion(motions, name):
    motion, model = motions.load(name).key_frames(), load_model()
    for place, joint in enumerate(motion.joints):
        limits = model.joint(joint)
        curve = SmoothCurve(motion.times, [row[place] for row in motion.angles])
        low, high = curve.extremes
        assert limits.lower - 1e-4 <= low and high <= limits.upper + 1e-4, joint
        assert curve.peak_speed() <= SHARE * limits.max_velocity, joint


def test_shipped_motions_can_be_replayed_but_not_changed_and_those_of_the_user_stand_before_them(motions):
    assert motions.names() == []
    for change in (motions.delete, motions.require, lambda name: motions.rename(name, "mine")):
        with pytest.raises(BadGoal, match="'wave' comes with the library"):
            change("wave")
    with pytest.raises(BadGoal, match="did you mean 'wave'"):
        motions.load("wavy")
    shipped = motions.load("wave")
    motions.save("wave", shipped.faster(2.0))
    assert motions.load("wave").duration == pytest.approx(shipped.duration / 2.0) and motions.names() == ["wave"]
    motions.delete("wave")
    assert motions.load("wave") == shipped
