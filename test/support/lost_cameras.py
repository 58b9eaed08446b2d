"""The robot is late, dies while somebody looks through its cameras, and comes back: pictures and detections go on."""

import unittest

import rospy
from camera_fixture import LIMIT, Look
from dynamic_reconfigure.client import Client
from mortal_simulator import PORT, MortalSimulator
from news import Reports
from std_srvs.srv import Empty

from nao_sim_bridge.testing import wait_until
from naoqi import ALProxy

BRIGHTNESS = 0


class LostCameras(MortalSimulator, unittest.TestCase):
    def setUp(self):
        self.assertIsNone(self.simulator)
        self.reports = Reports()
        self.addCleanup(self.reports.subscriber.unregister)
        self.switches = {}
        for change in ("enable", "disable"):
            name = f"nao_vision/landmark_detection/{change}"
            rospy.wait_for_service(name, LIMIT)
            self.switches[change] = rospy.ServiceProxy(name, Empty)
        self.settings = Client("nao_camera/top", timeout=LIMIT)

    def proxy(self, name):
        return ALProxy(name, "127.0.0.1", PORT)

    def wait_for_report(self, name, beginning):
        self.reports.wait(name, lambda status: status.message.startswith(beginning))

    def check_pictures(self, look):
        image, info = look.now()
        self.assertEqual((image.width, info.width), (160, 160))
        self.assertLess(abs(image.header.stamp.to_sec() - rospy.get_time()), 5.0)
        self.assertGreater(info.K[0], 0.0)
        self.wait_for_report("nao_camera: camera top", "pictures")
        subscribers = self.proxy("ALVideoDevice").getSubscribers()
        self.assertIn("ros_nao_camera_top_0", subscribers)
        self.assertEqual(self.proxy("ALVideoDevice").getParameter(0, BRIGHTNESS), 20)

    def enabled(self):
        """Whether the detection could be switched on; it has a connection of its own, which may come after pictures."""
        try:
            self.switches["enable"]()
        except rospy.ServiceException:
            return False
        return True

    def check_detection(self):
        landmarks = self.proxy("ALLandMarkDetection")
        wait_until(lambda: landmarks.getSubscribersInfo(), LIMIT, "the detection of landmarks")
        self.assertEqual([entry[0] for entry in landmarks.getSubscribersInfo()], ["ros_nao_vision"])

    def test_a_robot_that_is_late_dies_and_comes_back(self):
        # What is set before the robot is there holds when it comes.
        self.settings.update_configuration({"resolution": 0, "brightness": 20})
        with Look("nao_robot/camera/top/") as look:
            self.wait_for_report("nao_camera: camera top", "no pictures: ")
            self.assertEqual(look.pairs, [])
            self.start()
            self.check_pictures(look)
            wait_until(self.enabled, LIMIT, "the robot for the detection")
            self.check_detection()
            self.kill()
            self.wait_for_report("nao_camera: camera top", "no pictures: ")
            self.wait_for_report("nao_vision: landmark detection", "cannot run")
            self.start()
            self.check_pictures(look)
            self.check_detection()
            stamps = [image.header.stamp for image, _ in look.pairs]
            self.assertEqual(stamps, sorted(set(stamps)))
            self.switches["disable"]()
            self.assertEqual(self.proxy("ALLandMarkDetection").getSubscribersInfo(), [])
        device = self.proxy("ALVideoDevice")
        wait_until(lambda: device.getSubscribers() == [], LIMIT, "the end of the subscription")
