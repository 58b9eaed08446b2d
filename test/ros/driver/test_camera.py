"""Both cameras as topics: what they show and where, calibrations, rates, changes at run time, and nobody looking."""

import math
import subprocess
import tempfile
import unittest
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
import rospy
import yaml
from camera_fixture import LIMIT, MAGENTA, Geometry, Look, magenta_spot, pixels_of, project
from cases import case
from dynamic_reconfigure import DynamicReconfigureCallbackException
from dynamic_reconfigure.client import Client
from news import Reports
from sensor_msgs.msg import CompressedImage
from services import configuration
from waits import PATIENCE

from nao_sim_bridge.testing import SimulatedRobot, wait_until

TOP, BOTTOM = 0, 1
NAMES = ("top", "bottom")
FOLDERS = tuple(f"nao_robot/camera/{name}/" for name in NAMES)
FRAMES = ("CameraTop_optical_frame", "CameraBottom_optical_frame")
SIZES = {0: (160, 120), 1: (320, 240), 2: (640, 480)}
TICK = 1 / 120.0
DEFAULTS = {
    "resolution": 1,
    "frame_rate": 15.0,
    "color_space": 13,
    "auto_exposition": 1,
    "auto_white_balance": 1,
    "brightness": 0,
    "contrast": 32,
    "camera_info_url": "",
}
BRIGHTNESS, CONTRAST, AUTO_EXPOSITION = 0, 1, 11


class DriverCamera(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.device = cls.robot.module("ALVideoDevice")
        cls.simulation = cls.robot.module("NaoSimulation")
        cls.geometry = Geometry(cls.robot)
        cls.settings = [Client(f"nao_camera/{name}", timeout=LIMIT) for name in NAMES]
        cls.reports = Reports()
        with Look(FOLDERS[TOP]) as look:  # what draws the pictures has begun
            look.after(0.0)

    def setUp(self):
        self.robot.reset()
        for settings in self.settings:
            settings.update_configuration(DEFAULTS)
        self.wait_for_nobody()

    def wait_for_nobody(self):
        wait_until(lambda: self.device.getSubscribers() == [], LIMIT, "the end of all subscriptions")

    # --- what is seen, and where ----------------------------------------------------------------------------------

    @contextmanager
    def placed(self, position):
        """A magenta ball that hangs in the air, at (3,) m in world."""
        description = {"name": "spot", "sphere": 0.03, "position": [float(each) for each in position], "color": MAGENTA}
        self.simulation.placeObject(yaml.safe_dump(description, default_flow_style=True))
        try:
            yield
        finally:
            self.simulation.removeObject("spot")

    def error_of_the_spot(self, look, image_point):
        """Pixels between where a ball at 0.7 m is seen and where it should be.

        Args:
            look: Open camera.
            image_point: Where to place it, share of the width and height of the picture.
        """
        image, info = look.now()
        pose = self.geometry.optical_in_world(image.header.frame_id, image.header.stamp)
        x, y = image_point[0] * info.width, image_point[1] * info.height
        ray = np.array(((x - info.K[2]) / info.K[0], (y - info.K[5]) / info.K[4], 1.0))
        point = pose @ np.append(0.7 * ray, 1.0)
        with self.placed(point[:3]):
            image, info = look.now(lambda image: magenta_spot(image)[1] > 0)
            pose = self.geometry.optical_in_world(image.header.frame_id, image.header.stamp)
        spot, _ = magenta_spot(image)
        should = project(info, (np.linalg.inv(pose) @ point)[:3])
        look.now(lambda image: magenta_spot(image)[1] == 0)
        return float(np.linalg.norm(spot - should))

    def test_a_thing_is_seen_where_camera_info_and_tf_say(self):
        for camera, resolution, head in ((TOP, 1, (0.0, -0.2)), (TOP, 2, (0.5, -0.1)), (BOTTOM, 1, (-0.4, -0.5))):
            with case(camera=NAMES[camera], size=SIZES[resolution], head=head):
                self.settings[camera].update_configuration({"resolution": resolution})
                motion = self.robot.module("ALMotion")
                motion.setStiffnesses("Head", 1.0)
                motion.angleInterpolation("Head", list(head), 1.0, True)
                with Look(FOLDERS[camera]) as look:
                    look.now(lambda image, width=SIZES[resolution][0]: image.width == width)
                    for place in ((0.5, 0.5), (0.15, 0.25), (0.85, 0.7)):
                        self.assertLess(self.error_of_the_spot(look, place), 2.0, place)

    def test_camera_info_is_the_geometry_of_the_camera(self):
        for camera in (TOP, BOTTOM):
            hfov, vfov = self.device.getHorizontalFOV(camera), self.device.getVerticalFOV(camera)
            for resolution, (width, height) in SIZES.items():
                with case(camera=NAMES[camera], size=(width, height)):
                    self.settings[camera].update_configuration({"resolution": resolution})
                    with Look(FOLDERS[camera]) as look:
                        image, info = look.now(lambda image, width=width: image.width == width)
                    self.assertEqual(info.header.stamp, image.header.stamp)
                    self.assertEqual(info.header.frame_id, FRAMES[camera])
                    self.assertEqual((info.width, info.height), (width, height))
                    self.assertEqual((image.width, image.height, image.step), (width, height, 3 * width))
                    self.assertEqual((image.encoding, len(image.data)), ("bgr8", 3 * width * height))
                    fx, fy = width / 2 / math.tan(hfov / 2), height / 2 / math.tan(vfov / 2)
                    np.testing.assert_allclose(info.K, (fx, 0, width / 2, 0, fy, height / 2, 0, 0, 1), rtol=1e-5)
                    np.testing.assert_allclose(np.array(info.P).reshape(3, 4)[:, :3].ravel(), info.K)
                    self.assertEqual((info.distortion_model, list(info.D)), ("plumb_bob", [0.0] * 5))

    # --- rates and demand -----------------------------------------------------------------------------------------

    def test_the_robot_is_asked_for_nothing_while_nobody_looks(self):
        self.assertEqual(self.device.getSubscribers(), [])
        with Look(FOLDERS[BOTTOM]) as look:
            look.now()
            self.assertEqual(len(self.device.getSubscribers()), 1)
            with Look(FOLDERS[BOTTOM]) as second:
                second.now()
                self.assertEqual(len(self.device.getSubscribers()), 1)
        self.wait_for_nobody()
        counts = []
        for _ in range(3):  # one that is under way still comes after the first
            counts.append(self.reports.values("nao_camera: camera bottom", "no subscriber")["pictures"])
            self.robot.advance(1.0)
        self.assertEqual(counts[1], counts[2])

    def test_pictures_come_under_the_names_of_nao_robots_launch_files_too(self):
        with Look(f"{FOLDERS[TOP]}camera/") as look:
            image, info = look.now()
        self.assertEqual((image.width, info.width, info.header.frame_id), (320, 320, FRAMES[TOP]))

    def test_diagnostics_tell_what_comes(self):
        told = lambda status: {entry.key: entry.value for entry in status.values}  # noqa: E731
        with Look(FOLDERS[TOP]) as look:
            look.now()
            measured = lambda status: status.message != "no subscriber" and told(status)["rate reached (1/s)"]  # noqa: E731
            report = self.reports.wait("nao_camera: camera top", measured)
        self.assertRegex(report.message, "^(pictures come|only .* of 15 pictures a second)$")  # as the computer can
        values = told(report)
        self.assertEqual((values["size"], values["colour space"]), ("320x240", "BGR"))
        self.assertEqual(values["rate asked for (1/s)"], "15")
        self.assertIn("computed", values["calibration"])

    # --- colours and files ----------------------------------------------------------------------------------------

    def test_compressed_pictures_are_the_raw_ones(self):
        compression = Client(f"{FOLDERS[TOP]}image_raw/compressed", timeout=LIMIT)
        for kind, tolerance in (("png", 0), ("jpeg", 8)):
            compression.update_configuration({"format": kind, "jpeg_quality": 95})
            files = {}
            topic = f"{FOLDERS[TOP]}image_raw/compressed"
            subscriber = rospy.Subscriber(topic, CompressedImage, lambda m, f=files: f.update({m.header.stamp: m}))
            with case(kind=kind), Look(FOLDERS[TOP]) as look:
                known = "bgr8; {} compressed bgr8".format(kind)
                image, _ = look.now(lambda i, f=files, k=known: i.header.stamp in f and f[i.header.stamp].format == k)
                file = files[image.header.stamp]
                self.assertEqual(file.header.frame_id, image.header.frame_id)
                decoded = cv2.imdecode(np.frombuffer(file.data, np.uint8), cv2.IMREAD_COLOR)[..., ::-1]
                difference = np.abs(decoded.astype(int) - pixels_of(image))
                self.assertLessEqual(difference.mean(), tolerance)
                self.assertLess(len(file.data), len(image.data))
            subscriber.unregister()

    # --- parameters -----------------------------------------------------------------------------------------------

    def test_parameters_change_while_pictures_come(self):
        with Look(FOLDERS[TOP]) as look:
            before, _ = look.now()
            handles = self.device.getSubscribers()
            self.settings[TOP].update_configuration({"resolution": 2, "frame_rate": 10.0})
            after, info = look.now(lambda image: image.width == 640)
            self.assertEqual(info.width, 640)
            self.assertEqual(self.device.getSubscribers(), handles, "another subscription")
            self.settings[TOP].update_configuration({"resolution": 1, "frame_rate": 15.0})
            look.now(lambda image: image.width == 320)
            stamps = [image.header.stamp.to_sec() for image, _ in look.pairs]
            self.assertEqual(stamps, sorted(set(stamps)))

    def test_parameters_of_the_picture_are_the_cameras(self):
        with Look(FOLDERS[TOP]) as look:
            self.settings[TOP].update_configuration({"exposure": 8, "gain": 16})
            self.assertEqual(configuration(self.settings[TOP])["auto_exposition"], 0)
            self.assertEqual(self.device.getParameter(TOP, AUTO_EXPOSITION), 0)
            dark = np.mean(pixels_of(look.after(self.robot.advance(0.0) + 0.2)[0]))
            self.settings[TOP].update_configuration({"brightness": 100})
            self.assertEqual(self.device.getParameter(TOP, BRIGHTNESS), 100)
            bright = np.mean(pixels_of(look.after(self.robot.advance(0.0) + 0.2)[0]))
        self.assertGreater(bright, dark + 20.0)
        self.assertEqual(self.device.getParameter(BOTTOM, BRIGHTNESS), 0)

    def test_what_cannot_be_is_refused(self):
        before = configuration(self.settings[TOP])
        for change in ({"resolution": 6}, {"color_space": 14}, {"camera_info_url": "nowhere"}):
            with case(**change), self.assertRaises(DynamicReconfigureCallbackException):
                self.settings[TOP].update_configuration(change)
        after = configuration(self.settings[TOP])
        self.assertEqual({name: after[name] for name in DEFAULTS}, {name: before[name] for name in DEFAULTS})

    # --- calibration ----------------------------------------------------------------------------------------------

    def test_a_calibration_is_read_set_and_kept(self):
        folder = Path(tempfile.mkdtemp(prefix="nao_calibration"))
        path, measured = folder / "bottom.yaml", folder / "measured.yaml"
        program = ["rosrun", "nao_library_modules", "send_camera_info", "bottom"]
        content = {
            "image_width": 640,
            "image_height": 480,
            "camera_name": "nao_camera_bottom",
            "camera_matrix": {"rows": 3, "cols": 3, "data": [558.6, 0, 308.9, 0, 556.1, 247.6, 0, 0, 1]},
            "distortion_model": "plumb_bob",
            "distortion_coefficients": {"rows": 1, "cols": 5, "data": [-0.065, 0.061, 0.004, -0.006, 0]},
        }
        path.write_text(yaml.safe_dump(content), encoding="utf-8")
        content["camera_matrix"]["data"][0] = 600.0
        measured.write_text(yaml.safe_dump(content), encoding="utf-8")
        self.settings[BOTTOM].update_configuration({"camera_info_url": f"file://{path}"})
        with Look(FOLDERS[BOTTOM]) as look:
            _, info = look.after(self.robot.advance(0.0))
            np.testing.assert_allclose(info.K, (279.3, 0, 154.45, 0, 278.05, 123.8, 0, 0, 1))
            self.assertAlmostEqual(info.D[0], -0.065)
            told = subprocess.run([*program, str(measured)], stdout=subprocess.PIPE, text=True, timeout=PATIENCE)
            self.assertEqual((told.returncode, told.stdout), (0, f"kept in {path}\n"))
            _, info = look.after(self.robot.advance(0.0))
            self.assertAlmostEqual(info.K[0], 300.0)
            self.assertEqual(yaml.safe_load(path.read_text(encoding="utf-8"))["camera_matrix"]["data"][0], 600.0)
            self.settings[BOTTOM].update_configuration({"camera_info_url": ""})
            _, info = look.after(self.robot.advance(0.0))
            self.assertEqual(info.K[2], 160.0)

    # --- one camera -----------------------------------------------------------------------------------------------

    def test_one_camera_alone_has_the_names_of_nao_robot(self):
        settings = Client("alone/nao_camera", timeout=LIMIT)
        with Look("alone/") as look:
            image, info = look.now()
            self.assertEqual((image.header.frame_id, image.width), (FRAMES[BOTTOM], 160))
            settings.update_configuration({"source": TOP})
            image, info = look.now(lambda image: image.header.frame_id == FRAMES[TOP])
            self.assertGreater(info.K[0], 0.0)
            settings.update_configuration({"source": BOTTOM})
            look.now(lambda image: image.header.frame_id == FRAMES[BOTTOM])
