"""Both URDF texts against the tables, in PyBullet and as XML."""

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pybullet
import pytest

from nao_sim_bridge.base.engine import LOAD_FLAGS
from nao_sim_bridge.model.appearance import load_appearance
from nao_sim_bridge.model.body_mass import center_of_links
from nao_sim_bridge.model.kinematics import link_transforms, quaternion_matrix
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.model.urdf.full import full_urdf, mesh_files
from nao_sim_bridge.model.urdf.physics import physics_urdf

PACKAGE = Path(__file__).resolve().parents[3] / "nao_sim_bridge"
MODEL = load_model()
TRAVEL = MODEL.simulated_hand.travel
FULL = full_urdf(MODEL, load_appearance())
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
        self.body = self.of("loadURDF", str(path), flags=LOAD_FLAGS)
        infos = [self.of("getJointInfo", self.body, i) for i in range(self.of("getNumJoints", self.body))]
        self.joints = {info[1].decode(): info for info in infos}
        self.links = {info[12].decode(): info[0] for info in infos}

    def of(self, function, *arguments, **options):
        return getattr(pybullet, function)(*arguments, physicsClientId=self.client, **options)

    def dynamics(self, link):
        return self.of("getDynamicsInfo", self.body, link)

    def frame(self, link):
        """Position and orientation of the frame of a link in world."""
        return self.of("getLinkState", self.body, self.links[link], 0, 1)[4:6]

    def put(self, name, angle):
        self.of("resetJointState", self.body, self.joints[name][0], angle)

    def pose(self, name):
        for joint, value in zip(MODEL.joints, posture(MODEL, name)):
            self.put(joint.name, (value - 1.0) * TRAVEL if joint.is_hand else value)

    def torso_position(self):
        base = self.of("getBasePositionAndOrientation", self.body)
        return np.array(pybullet.multiplyTransforms(*base, *pybullet.invertTransform(*self.dynamics(-1)[3:5]))[0])

    def center_of_mass(self):
        """From the torso, m."""
        places = {-1: self.of("getBasePositionAndOrientation", self.body)[0]}
        places.update({i: self.of("getLinkState", self.body, i, 1, 1)[0] for i in self.links.values()})
        masses = [self.dynamics(i)[0] for i in places]
        return np.average(list(places.values()), axis=0, weights=masses) - self.torso_position()


@pytest.fixture
def physics(tmp_path):
    loaded = Loaded(physics_urdf(MODEL), tmp_path)
    yield loaded
    loaded.of("disconnect")


def test_physics_has_26_joints_with_limits_and_motors(physics):
    assert set(physics.joints) == {joint.name for joint in MODEL.joints}
    for joint in MODEL.joints:
        scale = TRAVEL if joint.is_hand else 1.0
        lower, upper = (-scale, 0.0) if joint.is_hand else (joint.lower, joint.upper)
        found = physics.joints[joint.name][8:12]
        assert found == pytest.approx((lower, upper, joint.max_torque, joint.max_velocity * scale))


def test_masses_and_frames_in_the_engine_are_those_of_the_tables(physics):
    hands = {joint.parent_link for joint in MODEL.joints if joint.is_hand}
    for link in MODEL.links:
        if link.name not in hands:
            _, _, diagonal, position, orientation = physics.dynamics(physics.links.get(link.alt_name, -1))[:5]
            turn = quaternion_matrix(orientation)
            assert turn @ np.diag(diagonal) @ turn.T == pytest.approx(link.inertia, abs=2e-8), link.name
            assert position == pytest.approx(link.com, abs=1e-9)
    physics.pose("Sit")
    torso = physics.torso_position()
    for name, pose in link_transforms(MODEL, posture(MODEL, "Sit")).items():
        if name != "Torso":
            position, orientation = physics.frame(MODEL.link(name).alt_name)
            assert np.array(position) - torso == pytest.approx(pose[:3, 3], abs=1e-5), name
            assert quaternion_matrix(orientation) == pytest.approx(pose[:3, :3], abs=1e-5), name
    physics.pose("Crouch")
    for hand in ("LHand", "RHand"):
        physics.put(hand, 0.0)  # the finger body meets the tables where the tables have it: open
    by_tables = center_of_links(MODEL, MODEL.links, posture(MODEL, "Crouch"))
    assert physics.center_of_mass() == pytest.approx(by_tables, abs=1e-6)


def test_the_full_urdf_is_one_tree_with_every_frame_that_clients_know_and_a_link_for_every_lamp():
    tree = ElementTree.fromstring(FULL)
    links = [link.get("name") for link in tree.iter("link")]
    assert len(links) == len(set(links)) and set(FRAMES_OF_CLIENTS) <= set(links)
    parent = {j.find("child").get("link"): j.find("parent").get("link") for j in tree.iter("joint")}
    assert set(links) - set(parent) == {"base_link"} and set(parent.values()) <= set(links)
    used = {visual.find("material").get("name") for visual in tree.iter("visual")}
    assert used <= {material.get("name") for material in tree.findall("material")}
    shown = {link.get("name") for link in tree.iter("link") if link.find("visual") is not None}
    assert {f"{lamp.name}_led" for lamp in load_leds().lamps} <= shown
    joints = {joint.get("name"): joint for joint in tree.iter("joint")}
    followers = [name for name, joint in joints.items() if joint.find("mimic") is not None]
    assert len(followers) == 17  # sixteen phalanges and RHipYawPitch
    mimic, limit = joints["LFinger12"].find("mimic"), joints["LHand"].find("limit")
    closed, open_ = (float(mimic.get("multiplier")) * opening + float(mimic.get("offset")) for opening in (0.0, 1.0))
    assert mimic.get("joint") == "LHand" and (closed, open_) == pytest.approx((-0.999899, 0.0))
    assert (float(limit.get("lower")), float(limit.get("upper"))) == (0.0, 1.0)


def test_files_in_the_package_are_what_the_generator_makes():
    assert (PACKAGE / "urdf" / "nao_h25.urdf").read_text() == FULL
    folder, record = PACKAGE / "urdf" / "meshes", np.dtype([("vectors", "<f4", (4, 3)), ("pad", "<u2")])
    assert {path.name for path in folder.iterdir()} == set(mesh_files(load_appearance()))
    for name, content in mesh_files(load_appearance()).items():
        files = (folder / name).read_bytes(), content
        assert len(files[0]) == len(files[1])
        # The last bit of a sine may differ between machines.
        np.testing.assert_allclose(*(np.frombuffer(data[84:], dtype=record)["vectors"] for data in files), atol=1e-5)


def test_the_program_prints_and_writes_the_urdf_and_refuses_an_unknown_version(tmp_path):
    def run(*options):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        program = [sys.executable, str(PACKAGE / "nodes" / "nao_urdf"), *options]
        return subprocess.run(program, env=environment, capture_output=True, text=True, timeout=60)

    assert run().stdout == FULL and run("--physics", "--version", "V5").stdout == physics_urdf(load_model("V5"))
    output, meshes = tmp_path / "nao.urdf", tmp_path / "meshes"
    assert run("--output", str(output), "--meshes", str(meshes)).returncode == 0
    assert output.read_text() == FULL and {path.name for path in meshes.iterdir()} == set(mesh_files(load_appearance()))
    wrong = run("--version", "V3")
    assert wrong.returncode == 2 and "V6" in wrong.stderr
