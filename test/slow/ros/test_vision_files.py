"""Streams, recordings and pictures of any ROS camera, without a robot: what is in the files, and how threads end."""

import os
import resource
import signal
import subprocess
import threading
import time
import unittest
from pathlib import Path

import actionlib
import av
import cv2
import numpy as np
import rospkg
import rospy
from actionlib_msgs.msg import GoalStatus
from camera_topics import number_of, numbered
from goal_functions import vision as f
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from nao_library_actions.msg import NaoVisionAction, NaoVisionGoal
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

NS = "webcam_only"
TOP, BOTTOM = f"{NS}/webcam/image_raw", f"{NS}/other_camera/image_raw/compressed"
SIZE = (320, 240)
RATE = 15.0
LIMIT = 60.0


class Camera:
    """Publishes numbered pictures at a rate, as cameras do.

    Attributes:
        stamps: Number -> stamp of each picture that was sent, s.
    """

    def __init__(self, topic, kind=Image):
        self.publisher = rospy.Publisher(topic, kind, queue_size=1000)
        self.stamps = {}
        self._kind = kind
        self._pictures = {}
        self._ended = threading.Event()
        self._running = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def run(self):
        self._running.set()

    def close(self):
        self._ended.set()
        self._running.set()
        self._thread.join()
        self.publisher.unregister()

    def _run(self):
        number, due, last = 0, time.monotonic(), 0.0
        while self._running.wait() and not self._ended.is_set():
            # Two are never closer than a period: files that count time in ticks would have no room for both.
            self._ended.wait(max(0.0, due - time.monotonic()))
            stamp = rospy.Time.now()
            if stamp.to_sec() < last + 0.5 / RATE:  # the simulated clock has fallen behind
                due = time.monotonic() + 0.005
                continue
            due = max(due, time.monotonic()) + 1.0 / RATE
            number += 1
            last = self.stamps[number] = stamp.to_sec()
            self.publisher.publish(self._message(number % 256, Header(stamp=stamp, frame_id="webcam_optical")))

    def _message(self, number, header):
        picture = self._pictures.get(number)
        if picture is None:
            picture = self._pictures[number] = numbered(number, SIZE)
        if self._kind is CompressedImage:
            return CompressedImage(header=header, format="jpeg", data=cv2.imencode(".jpg", picture)[1].tobytes())
        width, height = SIZE
        return Image(header=header, width=width, height=height, encoding="bgr8", step=3 * width, data=picture.tobytes())


def read(path):
    """Times in s and numbers of the frames of a video, and its length in s."""
    with av.open(str(path)) as container:
        frames = [(float(one.pts * one.time_base), one.to_ndarray(format="bgr24")) for one in container.decode(video=0)]
        length = container.duration / 1e6 if container.duration else 0.0
    return [time for time, _ in frames], [number_of(picture) for _, picture in frames], length


def readable(path):
    """How many frames of a video can be read that ends in the middle of one."""
    capture, count = cv2.VideoCapture(str(path)), 0
    while capture.read()[0]:
        count += 1
    return count


class Vision(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(rospkg.get_ros_home()) / "vision_files"
        cls.top, cls.bottom = Camera(TOP), Camera(BOTTOM, CompressedImage)
        cls.client = cls.connect(f"{NS}/NaoVision")
        cls.real_time = SimulatedRobot().at_speed(1.0)  # the cameras send in this computer's time
        cls.real_time.__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.real_time.__exit__(None, None, None)
        cls.top.close()
        cls.bottom.close()

    @staticmethod
    def connect(name):
        client = actionlib.SimpleActionClient(name, NaoVisionAction)
        wait_until(lambda: client.wait_for_server(rospy.Duration(0.01)), 60.0, name)
        return client

    def setUp(self):
        self.top.run()
        self.bottom.run()

    def tearDown(self):
        for thread in self.play(f("listThreads")).threads:
            self.play(f("deleteThread", id=thread.id))

    def play(self, *functions, client=None):
        run = send(client or self.client, NaoVisionGoal(list(functions))).wait(60.0)
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        return run.result

    def thread(self, ident, client=None):
        (thread,) = self.play(f("listThreads", id=ident), client=client).threads
        return thread

    def wait_for(self, ident, condition, what, client=None):
        wait_until(lambda: condition(self.thread(ident, client)), LIMIT, what)

    def check_video(self, video, camera):
        """Frames are those of the camera, all of them between the first and the last, each at its time."""
        times, numbers, length = read(video.path)
        self.assertEqual(len(numbers), video.frames)
        stamps = dict(camera.stamps)
        (first,) = [n for n, stamp in stamps.items() if abs(stamp - video.began.to_sec()) < 1e-6]
        self.assertEqual(numbers[0], first % 256)
        # Numbers begin anew after 256; those of dropped frames are missing.
        steps = [(b - a) % 256 for a, b in zip(numbers, numbers[1:])]
        self.assertTrue(all(steps), numbers)
        indices = [first, *(first + int(step) for step in np.cumsum(steps))]
        wanted = [stamps[index] - stamps[first] for index in indices]
        slack = 1e-3 if video.file_type == "mp4" else 0.006
        self.assertLess(max(abs(a - b) for a, b in zip(times, wanted)), slack)
        self.assertEqual(indices[-1] - first + 1, video.frames + video.dropped)
        self.assertAlmostEqual(length, video.duration, delta=0.02 if video.file_type == "mp4" else 0.25)
        self.assertAlmostEqual(video.duration, 2.0 * wanted[-1] - wanted[-2], places=3)

    # What goes through

    def test_a_stream_and_a_recording_of_each_camera(self):
        heard = []
        listener = rospy.Subscriber(f"{NS}/NaoVision/small/image_raw", Image, heard.append)
        self.play(
            f("subscribe", id="small", width=160),
            f("startRecording", id="top"),
            f("startRecording", id="bottom", camera="bottom", file_type="avi"),
        )
        wait_until(lambda: len(heard) >= 20, LIMIT, "20 frames of the stream")
        self.wait_for("top", lambda thread: thread.frames >= 30, "30 frames")
        self.wait_for("bottom", lambda thread: thread.frames >= 30, "30 frames")
        running = {thread.id: thread for thread in self.play(f("listThreads")).threads}
        for ident in ("small", "top", "bottom"):
            self.assertEqual((running[ident].state, running[ident].error), ("running", ""))
            self.assertTrue(0.0 < running[ident].frame_rate < 1.3 * RATE, running[ident].frame_rate)
        result = self.play(*(f("stopThread", id=ident) for ident in ("small", "top", "bottom")))
        listener.unregister()
        for message in heard:
            self.assertEqual((message.width, message.height, message.header.frame_id), (160, 120, "webcam_optical"))
            stamp = message.header.stamp.to_sec()
            picture = np.frombuffer(message.data, np.uint8).reshape(120, 160, 3)
            self.assertEqual(abs(self.stamp_of(number_of(picture), stamp) - stamp) < 1e-6, True)
        top, bottom = result.recordings
        self.check_video(top, self.top)
        self.check_video(bottom, self.bottom)
        self.assertEqual(Path(top.path).parent, self.folder)

    def stamp_of(self, number, near):
        return min((s for n, s in list(self.top.stamps.items()) if n % 256 == number), key=lambda s: abs(s - near))

    def test_ten_streams_and_ten_recordings_at_once(self):
        heard = [[] for _ in range(10)]
        listeners = [
            rospy.Subscriber(f"{NS}/NaoVision/s{k}/image_raw", Image, heard[k].append, buff_size=1 << 22)
            for k in range(10)
        ]
        codecs = ["h264", "mpeg4"] * 5
        self.play(
            *(f("subscribe", id=f"s{k}", width=32 * (k + 1)) for k in range(10)),
            *(f("startRecording", id=f"r{k}", codec=codecs[k], str_param=f"ten/r{k}") for k in range(10)),
        )
        for k in range(10):
            wait_until(lambda k=k: len(heard[k]) >= 45, 60.0, f"45 frames of stream {k}")
            self.wait_for(f"r{k}", lambda thread: thread.frames >= 60, "60 frames")
        threads = self.play(f("listThreads")).threads
        self.assertEqual({thread.state for thread in threads}, {"running"})
        began = time.monotonic()
        result = self.play(*(f("stopRecording", id=f"r{k}") for k in range(10)))
        dropped = [video.dropped for video in result.recordings]
        print(f"ten recordings ended in {time.monotonic() - began:.2f} s; dropped {dropped}")
        for listener in listeners:
            listener.unregister()
        for video, codec in zip(result.recordings, codecs):
            self.assertEqual(video.codec, codec)
            self.check_video(video, self.top)
        for k in range(10):
            self.assertEqual({message.width for message in heard[k]}, {32 * (k + 1)})

    # How it ends

    def start_server(self, name, largest_file=None):
        """A server of its own in a namespace; its process, client and folder."""

        def limit():
            if largest_file:
                resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))

        folder = self.folder.parent / name
        process = subprocess.Popen(
            ["rosrun", "nao_library_modules", "nao_vision_server", f"__ns:={name}", "_pport:=9",
             f"_record_dir:={folder}", f"_camera_top:=/{TOP}"],
            preexec_fn=limit,
        )  # fmt: skip
        self.addCleanup(self.end, process)
        return process, self.connect(f"{name}/NaoVision"), folder

    def end(self, process, number=signal.SIGINT):
        if process.poll() is None:
            os.kill(process.pid, number)
            process.wait(60.0)

    def test_a_file_that_cannot_grow_ends_its_recording_alone(self):
        _, client, folder = self.start_server("small", largest_file=60_000)
        self.play(
            f("startRecording", id="small", width=16, str_param="small"),
            f("startRecording", id="large", codec="mjpeg", str_param="large"),
            f("subscribe", id="s"),
            client=client,
        )
        self.wait_for("large", lambda thread: thread.state == "failed", "the error", client)
        self.assertRegex(self.thread("large", client).error, "large.mp4 cannot be written: File too large")
        before = self.thread("small", client).frames
        for ident in ("small", "s"):
            self.wait_for(ident, lambda thread: thread.frames > before + 10, "further frames", client)
        result = self.play(f("stopRecording", id="large"), f("stopRecording", id="small"), client=client)
        self.assertIn("File too large", result.recordings[0].error)
        frames = result.recordings[0].frames
        self.assertTrue(frames / 2 < readable(folder / "large.mp4") <= frames, frames)
        self.assertEqual(len(read(folder / "small.mp4")[0]), result.recordings[1].frames)

    def test_the_end_of_the_server_completes_its_files(self):
        process, client, folder = self.start_server("ending")
        self.play(f("startRecording", id="mp4", str_param="a.mp4"), f("startRecording", id="avi", str_param="a.avi"),
                  client=client)  # fmt: skip
        self.wait_for("avi", lambda thread: thread.frames >= 10, "frames", client)
        self.end(process, signal.SIGTERM)
        for name in ("a.mp4", "a.avi"):
            times, _, length = read(folder / name)
            self.assertGreaterEqual(len(times), 10)
            # As long as the time from the first frame to the last, and that one's.
            self.assertAlmostEqual(length, 2.0 * times[-1] - times[-2], delta=0.02 if name.endswith("mp4") else 0.25)

    def test_a_server_that_is_killed_leaves_what_it_has_written(self):
        process, client, folder = self.start_server("killed")
        self.play(f("startRecording", id="walk", str_param="a.mp4"), client=client)
        self.wait_for("walk", lambda thread: thread.frames >= 75, "frames", client)
        self.end(process, signal.SIGKILL)
        self.assertGreaterEqual(readable(folder / "a.mp4"), 60)
