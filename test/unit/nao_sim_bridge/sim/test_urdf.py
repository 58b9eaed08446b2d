"""Both URDF texts against the tables, in PyBullet and as XML."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pybullet
import pytest

from nao_sim_bridge.paths import data_root, urdf_file
from nao_sim_bridge.sim.appearance import load_appearance
from nao_sim_bridge.sim.collision import LOAD_FLAGS, apart, read_collision_shapes
from nao_sim_bridge.sim.kinematics import center_of_mass, link_transforms, quaternion_matrix
from nao_sim_bridge.sim.leds_layout import load_leds
from nao_sim_bridge.sim.model import VERSIONS, load_model
from nao_sim_bridge.sim.postures import load_postures, posture
from nao_sim_bridge.sim.urdf import full_urdf, mesh_files, physics_urdf

FRAMES_OF_CLIENTS = """
base_link torso Head gaze l_sole r_sole l_ankle r_ankle l_wrist r_wrist l_gripper r_gripper CameraTop_frame
CameraTop_optical_frame CameraBottom_frame CameraBottom_optical_frame LSonar_frame RSonar_frame LFsrFL_frame
LFsrFR_frame LFsrRL_frame LFsrRR_frame RFsrFL_frame RFsrFR_frame RFsrRL_frame RFsrRR_frame
ImuTorsoAccelerometer_frame ImuTorsoGyrometer_frame HeadTouchFront_frame HeadTouchMiddle_frame HeadTouchRear_frame
LFootBumperLeft_frame LFootBumperRight_frame RFootBumperLeft_frame RFootBumperRight_frame LHandTouchBack_frame
LHandTouchLeft_frame LHandTouchRight_frame RHandTouchBack_frame RHandTouchLeft_frame RHandTouchRight_frame
MicroFrontCenter_frame MicroRearCenter_frame MicroSurroundLeft_frame MicroSurroundRight_frame ChestButton_frame
LInfraRed_frame RInfraRed_frame
""".split()


class Loaded:
    """A URDF in a PyBullet world of its own."""

    def __init__(self, text, folder):
        path = folder / "robot.urdf"
        path.write_text(text)
        self.client = pybullet.connect(pybullet.DIRECT)
        self.body = pybullet.loadURDF(str(path), flags=LOAD_FLAGS, physicsClientId=self.client)
        infos = [
            pybullet.getJointInfo(self.body, i, physicsClientId=self.client)
            for i in range(pybullet.getNumJoints(self.body, physicsClientId=self.client))
        ]
        self.joints = {info[1].decode(): info for info in infos}
        self.links = {info[12].decode(): info[0] for info in infos}

    def keep_apart(self, pairs):
        for first, second in pairs:
            indices = self.links.get(first, -1), self.links.get(second, -1)
            pybullet.setCollisionFilterPair(self.body, self.body, *indices, 0, physicsClientId=self.client)

    def dynamics(self, link):
        return pybullet.getDynamicsInfo(self.body, link, physicsClientId=self.client)

    def put(self, name, angle):
        pybullet.resetJointState(self.body, self.joints[name][0], angle, physicsClientId=self.client)

    def pose(self, model, name):
        for joint, value in zip(model.joints, posture(model, name)):
            self.put(joint.name, (value - 1.0) * model.simulated_hand.travel if joint.is_hand else value)

    def self_contacts(self):
        pybullet.performCollisionDetection(physicsClientId=self.client)
        points = pybullet.getContactPoints(self.body, self.body, physicsClientId=self.client)
        names = {index: name for name, index in self.links.items()}
        return [(names.get(p[3], "torso"), names.get(p[4], "torso")) for p in points if p[8] < 0.0]

    def center_of_mass(self):
        base = pybullet.getBasePositionAndOrientation(self.body, physicsClientId=self.client)[0]
        moment, mass = np.multiply(self.dynamics(-1)[0], base), self.dynamics(-1)[0]
        for index in self.links.values():
            state = pybullet.getLinkState(self.body, index, True, True, physicsClientId=self.client)
            moment, mass = moment + np.multiply(self.dynamics(index)[0], state[0]), mass + self.dynamics(index)[0]
        return moment / mass

    def torso_position(self):
        base, orientation = pybullet.getBasePositionAndOrientation(self.body, physicsClientId=self.client)
        offset, turn = self.dynamics(-1)[3:5]
        return pybullet.multiplyTransforms(base, orientation, *pybullet.invertTransform(offset, turn))[0]


@pytest.fixture
def physics(tmp_path):
    loaded = Loaded(physics_urdf(load_model()), tmp_path)
    loaded.keep_apart(apart(load_model()))
    yield loaded
    pybullet.disconnect(physicsClientId=loaded.client)


def test_physics_has_26_joints_with_limits_and_motors(physics):
    model = load_model()
    assert set(physics.joints) == {joint.name for joint in model.joints}
    for joint in model.joints:
        info = physics.joints[joint.name]
        scale = model.simulated_hand.travel if joint.is_hand else 1.0
        lower, upper = (-scale, 0.0) if joint.is_hand else (joint.lower, joint.upper)
        assert info[8:12] == pytest.approx((lower, upper, joint.max_torque, joint.max_velocity * scale))


@pytest.mark.parametrize("version", VERSIONS)
def test_physics_weighs_what_the_tables_say(version, tmp_path):
    model = load_model(version)
    loaded = Loaded(physics_urdf(model), tmp_path)
    masses = [loaded.dynamics(link)[0] for link in (-1, *loaded.links.values())]
    pybullet.disconnect(physicsClientId=loaded.client)
    assert sum(masses) == pytest.approx(model.total_mass, abs=1e-9)


def test_center_of_mass_in_the_engine_is_that_of_the_tables(physics):
    model = load_model()
    angles = list(posture(model, "Crouch"))
    physics.pose(model, "Crouch")
    for hand in ("LHand", "RHand"):
        # The finger body meets the tables where the tables have it: open.
        physics.put(hand, 0.0)
    offset = physics.center_of_mass() - physics.torso_position()
    assert offset == pytest.approx(center_of_mass(model, angles), abs=1e-6)


def test_inertias_in_the_engine_are_those_of_the_tables(physics):
    model = load_model()
    hands = {joint.parent_link for joint in model.joints if joint.is_hand}
    for link in model.links:
        if link.name in hands:
            continue
        index = physics.links.get(link.alt_name, -1)
        _, _, diagonal, position, orientation = physics.dynamics(index)[:5]
        turn = quaternion_matrix(orientation)
        assert turn @ np.diag(diagonal) @ turn.T == pytest.approx(link.inertia, abs=2e-8), link.name
        assert position == pytest.approx(link.com, abs=1e-9)


def test_links_of_the_engine_are_where_the_kinematics_say(physics):
    model = load_model()
    physics.pose(model, "Sit")
    torso = np.array(physics.torso_position())
    for name, pose in link_transforms(model, posture(model, "Sit")).items():
        if name == "Torso":
            continue
        index = physics.links[model.link(name).alt_name]
        state = pybullet.getLinkState(physics.body, index, 0, 1, physicsClientId=physics.client)
        assert np.array(state[4]) - torso == pytest.approx(pose[:3, 3], abs=1e-5), name
        assert quaternion_matrix(state[5]) == pytest.approx(pose[:3, :3], abs=1e-5), name


def test_closing_the_hand_moves_the_fingers_towards_the_thumb(physics):
    heights = []
    for angle in (0.0, -load_model().simulated_hand.travel):
        physics.put("LHand", angle)
        index = physics.links["LFingers"]
        state = pybullet.getLinkState(physics.body, index, 0, 1, physicsClientId=physics.client)
        heights.append(state[0][2])
    assert heights[1] < heights[0] - 0.01


@pytest.mark.parametrize("name", sorted(load_postures().by_name))
def test_no_posture_touches_itself(physics, name):
    physics.pose(load_model(), name)
    assert physics.self_contacts() == []


def test_limbs_that_meet_do_touch(physics):
    for side, sign in (("L", 1.0), ("R", -1.0)):
        physics.put(f"{side}ShoulderRoll", -0.3 * sign)
        physics.put(f"{side}ElbowRoll", -0.6 * sign)
    assert ("l_wrist", "r_wrist") in {tuple(sorted(pair)) for pair in physics.self_contacts()}


def test_a_forearm_touches_the_belly(physics):
    for name, angle in (("ShoulderPitch", 1.5), ("ElbowYaw", 0.0), ("ElbowRoll", -1.5)):
        physics.put(f"L{name}", angle)
    touching = {tuple(sorted(pair)) for pair in physics.self_contacts()}
    assert touching & {("l_wrist", "torso"), ("LForeArm", "torso"), ("LFingers", "torso")}


def test_pairs_that_stay_apart_are_pairs_of_links(physics):
    pairs = list(apart(load_model()))
    names = {"torso", *physics.links}
    assert all(first in names and second in names for first, second in pairs)
    known = {frozenset(pair) for pair in pairs}
    assert frozenset(("torso", "Neck")) in known and frozenset(("torso", "LTibia")) in known
    assert frozenset(("torso", "l_wrist")) not in known and frozenset(("LTibia", "RTibia")) not in known


def sole_points():
    """Corners of boxes and lowest points of spheres that lie in the plane of the left sole."""
    model = load_model()
    points = []
    for shape in read_collision_shapes(model)["LAnkleRoll"]:
        if shape.kind == "box":
            half = np.array(shape.size) / 2.0
            c, s = np.cos(shape.rpy[2]), np.sin(shape.rpy[2])
            for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                x, y = x * half[0], y * half[1]
                corner = (c * x - s * y, s * x + c * y, -half[2])
                points.append(np.add(shape.xyz, corner))
        else:
            points.append(np.subtract(shape.xyz, (0.0, 0.0, shape.size[0])))
    lowest = min(point[2] for point in points)
    assert lowest == pytest.approx(-model.sole_height, abs=1e-9)
    return np.array([point[:2] for point in points if point[2] < lowest + 1e-6])


def test_the_support_polygon_is_that_of_the_sole():
    contour, points = load_model().sole_contour, sole_points()
    angles = np.radians(np.arange(0, 360, 2))
    directions = np.stack([np.cos(angles), np.sin(angles)])
    # How far the two outlines reach in each direction.
    difference = np.abs((points @ directions).max(axis=0) - (contour @ directions).max(axis=0))
    assert difference.max() < 0.004


def test_the_right_foot_mirrors_the_left():
    shapes = read_collision_shapes(load_model())
    for left, right in zip(shapes["LAnkleRoll"], shapes["RAnkleRoll"]):
        assert right.xyz == (left.xyz[0], -left.xyz[1], left.xyz[2])
        assert right.rpy[2] == -left.rpy[2]


def test_full_urdf_has_every_frame_that_clients_know():
    tree = ElementTree.fromstring(full_urdf(load_model(), load_appearance()))
    links = [link.get("name") for link in tree.iter("link")]
    assert len(links) == len(set(links))
    assert set(FRAMES_OF_CLIENTS) <= set(links)


def test_full_urdf_is_one_tree_from_base_link():
    tree = ElementTree.fromstring(full_urdf(load_model(), load_appearance()))
    parent = {j.find("child").get("link"): j.find("parent").get("link") for j in tree.iter("joint")}
    links = {link.get("name") for link in tree.iter("link")}
    assert links - set(parent) == {"base_link"}
    assert set(parent.values()) <= links
    materials = {material.get("name") for material in tree.findall("material")}
    used = {visual.find("material").get("name") for visual in tree.iter("visual")}
    assert used <= materials


def test_full_urdf_has_a_link_for_every_lamp():
    tree = ElementTree.fromstring(full_urdf(load_model(), load_appearance()))
    shown = {link.get("name") for link in tree.iter("link") if link.find("visual") is not None}
    assert {f"{lamp.name}_led" for lamp in load_leds().lamps} <= shown


def test_full_urdf_weighs_what_the_tables_say_in_the_engine(tmp_path):
    text = full_urdf(load_model(), load_appearance())
    text = text.replace("package://nao_sim_bridge", str(data_root()))
    loaded = Loaded(text, tmp_path)
    try:
        # The base is the empty root link, for which PyBullet puts in a mass of its own.
        masses = [loaded.dynamics(link)[0] for link in loaded.links.values()]
        assert sum(masses) == pytest.approx(load_model().total_mass, abs=1e-9)
    finally:
        pybullet.disconnect(physicsClientId=loaded.client)


def test_phalanges_follow_the_hand_from_closed_to_open():
    tree = ElementTree.fromstring(full_urdf(load_model(), load_appearance()))
    joints = {joint.get("name"): joint for joint in tree.iter("joint")}
    followers = [name for name, joint in joints.items() if (joint.find("mimic") is not None)]
    assert len(followers) == 17  # sixteen phalanges and RHipYawPitch
    mimic = joints["LFinger12"].find("mimic")
    multiplier, offset = float(mimic.get("multiplier")), float(mimic.get("offset"))
    assert mimic.get("joint") == "LHand"
    assert multiplier * 1.0 + offset == pytest.approx(0.0)
    assert multiplier * 0.0 + offset == pytest.approx(-0.999899)
    limit = joints["LHand"].find("limit")
    assert (float(limit.get("lower")), float(limit.get("upper"))) == (0.0, 1.0)


def test_files_in_the_package_are_what_the_generator_makes():
    assert urdf_file("nao_h25.urdf").read_text() == full_urdf(load_model(), load_appearance())
    folder = urdf_file("meshes")
    assert {path.name for path in folder.iterdir()} == set(mesh_files(load_appearance()))
    for name, content in mesh_files(load_appearance()).items():
        assert_same_triangles((folder / name).read_bytes(), content)


def assert_same_triangles(first, second):
    record = np.dtype([("vectors", "<f4", (4, 3)), ("pad", "<u2")])
    assert len(first) == len(second)
    one, other = (np.frombuffer(data[84:], dtype=record)["vectors"] for data in (first, second))
    # The last bit of a sine may differ between machines.
    np.testing.assert_allclose(one, other, atol=1e-5)


@pytest.mark.parametrize(
    "options, expected",
    [
        ([], full_urdf(load_model(), load_appearance())),
        (["--physics", "--version", "V5"], physics_urdf(load_model("V5"))),
    ],
)
def test_program_prints_the_urdf(options, expected):
    result = run_nao_urdf(*options)
    assert result.returncode == 0
    assert result.stdout == expected


def test_program_writes_files(tmp_path):
    output, meshes = tmp_path / "nao.urdf", tmp_path / "meshes"
    assert run_nao_urdf("--output", str(output), "--meshes", str(meshes)).returncode == 0
    assert output.read_text() == full_urdf(load_model(), load_appearance())
    assert {path.name for path in meshes.iterdir()} == set(mesh_files(load_appearance()))


def test_program_refuses_an_unknown_version():
    result = run_nao_urdf("--version", "V3")
    assert result.returncode == 2
    assert "V6" in result.stderr


def run_nao_urdf(*options):
    program = data_root() / "nodes" / "nao_urdf"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return subprocess.run(
        [sys.executable, str(program), *options], env=environment, capture_output=True, text=True, timeout=60
    )
