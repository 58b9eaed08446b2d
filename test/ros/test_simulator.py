"""The simulator's own topics and services: truth, time, hands, things, power, films, and beginning anew."""

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion
from nav_msgs.msg import Odometry
from services import service
from std_srvs.srv import SetBool

from nao_library_msgs.msg import WorldShapes
from nao_library_msgs.srv import (
    CaptionFilm,
    MoveObject,
    PlaceObject,
    ReleaseSensors,
    RemoveObject,
    SetFloat,
    SetSpeed,
    StartFilm,
    StopFilm,
    TouchSensors,
)
from nao_sim_bridge.testing import RobotTestCase, wait_until

FRONT = "Head/Touch/Front"
TOUCHED = f"Device/SubDeviceList/{FRONT}/Sensor/Value"
BATTERY = "Device/SubDeviceList/Battery/{}/Sensor/Value"


def at(x, y, z):
    return Pose(Point(x, y, z), Quaternion(0.0, 0.0, 0.0, 1.0))


class SimulatorServices(RobotTestCase):
    def setUp(self):
        super().setUp()
        self.robot.pause()
        self.addCleanup(self.robot.resume)
        self.simulation = self.robot.module("NaoSimulation")

    def good(self, answer):
        self.assertEqual((answer.success, answer.message), (True, ""))

    def bad(self, answer, text):
        self.assertFalse(answer.success)
        self.assertIn(text, answer.message)

    def test_topic_and_service_of_the_true_pose_agree(self):
        self.robot.resume()
        message = rospy.wait_for_message("ground_truth/odom", Odometry, timeout=60.0)
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("world", "torso"))
        topic, told = message.pose.pose, self.robot.true_pose()
        for axis in "xyz":
            self.assertAlmostEqual(getattr(topic.position, axis), getattr(told.position, axis), delta=0.002)
        for axis in "xyzw":
            self.assertAlmostEqual(getattr(topic.orientation, axis), getattr(told.orientation, axis), delta=0.01)

    def test_true_poses_come_fifty_times_a_second(self):
        """So some come two ticks after another one; a busy computer leaves some out."""
        stamps = []
        listening = rospy.Subscriber("ground_truth/odom", Odometry, lambda m: stamps.append(m.header.stamp.to_sec()))
        self.addCleanup(listening.unregister)
        self.robot.resume()
        wait_until(lambda: len(stamps) > 30, 60.0, "true poses")
        spans = [later - stamp for stamp, later in zip(stamps, stamps[1:])]
        self.assertLess(min(spans), 0.018)
        self.assertGreater(sum(spans) / len(spans), 0.0192)

    def test_time_moves_only_as_told_while_paused(self):
        before = self.robot.advance(0.0)
        self.assertAlmostEqual(self.robot.advance(1.0) - before, 1.0, delta=0.01)
        self.assertAlmostEqual(self.robot.advance(0.0) - before, 1.0, delta=0.01)

    def test_a_hand_touches_until_it_is_released_and_a_wrong_sensor_is_told(self):
        touch, release = service("nao_sim/touch", TouchSensors), service("nao_sim/release", ReleaseSensors)
        self.good(touch(sensors=["FrontTactilTouched"]))
        self.robot.advance(1.0)
        self.assertEqual(self.robot.value(TOUCHED), 1.0)
        self.good(release(sensors=[FRONT]))
        self.robot.advance(1.0)
        self.assertEqual(self.robot.value(TOUCHED), 0.0)
        self.bad(touch(sensors=["Head/Touch/Fron"]), "Head/Touch/Fron")
        with self.assertRaisesRegex(ValueError, "Head/Touch/Fron"):
            self.robot.press(["Head/Touch/Fron"])

    def test_things_are_placed_moved_and_removed(self):
        place, move, remove = (
            service(f"nao_sim/{name}_object", kind)
            for name, kind in (("place", PlaceObject), ("move", MoveObject), ("remove", RemoveObject))
        )
        where = lambda name: self.simulation.objects()[name]  # noqa: E731
        self.good(place(name="b", kind="ball", size=[0.03], pose=at(0.4, 0.4, 0.3)))
        self.good(place(name="p", kind="person", content="anna", pose=at(2.0, 1.5, 0.0)))
        self.good(place(description="{name: q, qr: hello, position: [0.8, 0.6, 0.5], heading: 1.0}"))
        self.good(move(name="p", pose=at(2.0, 0.5, 0.0), time=rospy.Duration(2.0)))
        self.robot.advance(1.0)
        self.assertAlmostEqual(where("b")[2], 0.03, delta=0.003)
        self.assertAlmostEqual(where("p")[1], 1.0, delta=0.02)
        self.assertAlmostEqual(where("q")[5], 1.0, places=4)
        self.good(remove(name="b"))
        self.assertNotIn("b", self.simulation.objects())
        self.bad(remove(name="b"), "b")
        self.bad(place(description="{}", kind="ball"), "description is '{}', allowed is empty when")

    def test_shapes_tell_where_things_are(self):
        self.good(
            service("nao_sim/place_object", PlaceObject)(name="cone", kind="ball", size=[0.1], pose=at(1, 0, 0.1))
        )
        told = rospy.wait_for_message("nao_sim/shapes", WorldShapes, timeout=60.0)
        (shape,) = (shape for shape in told.shapes if shape.thing == "cone")
        self.assertEqual((shape.what, shape.kind, list(shape.size)), ("ball", "sphere", [0.1]))
        self.assertAlmostEqual(shape.pose.position.x, 1.0, delta=0.01)

    def test_the_speed_is_set_and_a_wrong_one_is_told(self):
        set_speed, before = service("nao_sim/set_speed", SetSpeed), self.simulation.speed()
        self.addCleanup(set_speed, before)
        self.good(set_speed(2.0))
        self.assertEqual(self.simulation.speed(), 2.0)
        self.bad(set_speed(-1.0), "speed")

    def test_the_charger_is_plugged_in_and_the_battery_set(self):
        plug, charge = service("nao_sim/plug_charger", SetBool), service("nao_sim/set_battery", SetFloat)
        self.good(charge(0.5))
        self.robot.advance(0.3)
        self.assertAlmostEqual(self.robot.value(BATTERY.format("Charge")), 0.5, delta=0.001)
        self.assertLess(self.robot.value(BATTERY.format("Current")), 0.0)
        self.assertTrue(plug(True).success)
        self.robot.advance(0.3)
        self.assertGreater(self.robot.value(BATTERY.format("Current")), 0.0)
        self.bad(charge(1.5), "charge is 1.5, allowed is 0 to 1")

    def test_pictures_stay_in_their_folder(self):
        self.assertTrue(self.robot.picture("face", "folder/face.png").is_file())
        with self.assertRaisesRegex(ValueError, "relative"):
            self.robot.picture("face", "../face.png")
        with self.assertRaisesRegex(ValueError, "front"):
            self.robot.picture("frnt", "face.png")

    def test_a_film_is_started_once_has_its_length_and_is_stopped(self):
        start, caption, stop = (
            service(f"nao_sim/film/{name}", kind)
            for name, kind in (("start", StartFilm), ("caption", CaptionFilm), ("stop", StopFilm))
        )
        self.bad(stop(), "nothing is being filmed")
        self.bad(start("", "sideways", 0, 0, 0.0), "unknown view")
        self.bad(start("", "", 101, 100, 0.0), "even numbers")
        self.assertTrue(start("films/short.mp4", "front", 96, 96, 5.0).success)
        self.bad(start("other.mp4", "", 96, 96, 5.0), "end it first")
        self.assertTrue(caption("a word").success)
        self.robot.advance(2.0)
        film = stop()
        self.assertTrue(film.success, film.message)
        self.assertAlmostEqual(film.length.to_sec(), 2.0, delta=0.3)
        self.assertAlmostEqual(film.frames, film.length.to_sec() * 5.0, delta=1.5)
