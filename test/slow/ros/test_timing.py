"""Times that results tell against the simulator's own, and how soon actions begin: prints figures of docs/timing.md.

`scripts/ros-env python3 -m pytest test/slow/ros/test_timing.py -n 0 -s` shows them: median, 95 %, largest, ms.
"""

import statistics
import threading
from contextlib import contextmanager

import rospy
from actionlib_msgs.msg import GoalStatus
from things_fixture import FACING, Things

from nao_library_actions.msg import (
    NaoAudioOutAction,
    NaoAudioOutGoal,
    NaoLedAction,
    NaoLedGoal,
    NaoMotionAction,
    NaoMotionGoal,
    NaoTactileAction,
    NaoVisionAction,
    NaoVisionGoal,
)
from nao_library_msgs.msg import AudioOutFunction, LedFunction, MotionFunction, TactileFunction, VisionFunction
from nao_library_msgs.srv import TouchSensors
from nao_sim_bridge.testing import RobotTestCase, send, wait_until

SOUND = "nao_library/bip.ogg"
HEAD, CHEST = "Head/Touch/Middle", "ChestBoard/Button"
COMMAND = "Device/SubDeviceList/{}/Position/Actuator/Value"
LIGHT = "Device/SubDeviceList/Head/Led/Front/Right/1/Actuator/Value"
ROUNDS = 12
STRICT = 0.010
"""s between contact in the physics and the time that is told, at most."""


def show(what, seconds):
    """Print the figures of a row; their largest magnitude."""
    ordered = sorted(seconds)
    almost_all = ordered[min(len(ordered) - 1, round(0.95 * (len(ordered) - 1)))]
    figures = (statistics.median(ordered), almost_all, max(ordered, key=abs))
    print(f"| {what} | {' | '.join(f'{1000.0 * each:.1f}' for each in figures)} |", flush=True)
    return abs(figures[-1])


class Samples:
    """Values of a key of the robot's memory with the simulator's time, as fast as the robot answers."""

    def __init__(self, robot, keys):
        self._memory, self._simulation, self._keys = robot.module("ALMemory"), robot.module("NaoSimulation"), keys
        self.values = []
        self._over = threading.Event()

    def now(self):
        return self._simulation.time()

    @contextmanager
    def taken(self):
        thread = threading.Thread(target=self._take, daemon=True)
        thread.start()
        wait_until(lambda: self.values, 60.0, "the first sample")
        try:
            yield self
        finally:
            self._over.set()
            thread.join()

    def _take(self):
        while not self._over.is_set():
            time = self._simulation.time()
            self.values.append((time, self._memory.getListData(self._keys)))

    def changes(self, since):
        """Times, s, at which a value was another one than before."""
        pairs = zip(self.values, self.values[1:])
        return [after[0] for before, after in pairs if after[0] >= since and after[1] != before[1]]


class Timing(RobotTestCase):
    server = ("NaoTactile", NaoTactileAction)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lights = cls.robot.action_client("NaoLights", NaoLedAction)
        cls.motion = cls.robot.action_client("NaoMotion", NaoMotionAction)
        cls.vision = cls.robot.action_client("NaoVision", NaoVisionAction)
        cls.things = Things(cls.robot)
        cls.hand = rospy.ServiceProxy("nao_sim/touch", TouchSensors)

    def touched(self, sensor, **fields):
        """When a hand touched, and the FunctionResult of a function that waited for it."""
        run = self.send(TactileFunction(timeout=600.0, **fields))
        wait_until(lambda: any(each.status == "waiting" for _, each in run.feedback), 60.0, "a goal that waits")
        answer = self.hand(sensors=[sensor], time=rospy.Duration.from_sec(0.1), wait=True)
        self.assertTrue(answer.success, answer.message)
        (one,) = self.ends(run, GoalStatus.SUCCEEDED).result.results
        return answer.contact, one

    def test_onsets_of_touches_are_those_of_the_physics(self):
        for speed in (1.0, 4.0):
            with self.robot.at_speed(speed):
                pairs = [self.touched(HEAD, function="waitForTouch") for _ in range(ROUNDS)]
            onsets = [(one.onset - contact).to_sec() for contact, one in pairs]
            off = show(f"touch, speed {speed:g}: contact to onset", onsets)
            show("its contact to the end of the function", [(one.end - contact).to_sec() for contact, one in pairs])
            self.assertLess(off, STRICT)

    def test_onsets_of_clicks_are_those_of_the_physics(self):
        with self.robot.at_speed(1.0):
            pairs = [self.touched(CHEST, function="waitForChestButton") for _ in range(ROUNDS // 2)]
        self.assertLess(
            show("click: contact to onset", [(one.onset - contact).to_sec() for contact, one in pairs]), STRICT
        )
        show("its last contact to the end of the function", [(one.end - one.offset).to_sec() for _, one in pairs])

    def test_first_sights(self):
        looking = VisionFunction(function="detectBall", timeout=600.0)
        first, told = [], []
        with self.robot.at_speed(1.0):
            for number in range(ROUNDS // 2):
                run = send(self.vision, NaoVisionGoal([looking]))
                wait_until(
                    lambda r=run: any(each.status == "looking" for _, each in r.feedback), 60.0, "a goal that looks"
                )
                self.robot.advance(0.5)
                self.robot.pause()  # it is there at a time that is known
                self.things.place(f"ball{number}", (0.6, 0.0, 0.4), FACING, ball=0.05)
                placed = self.robot.module("NaoSimulation").time()
                self.robot.resume()
                (one,) = run.wait(60.0).result.results
                self.robot.module("NaoSimulation").removeObject(f"ball{number}")
                first.append(one.onset.to_sec() - placed)
                told.append((one.end - one.onset).to_sec())
        show("ball: in view to first sight", first)
        show("its first sight to the end of the function", told)
        self.assertGreater(min(first), -STRICT)
        self.assertLess(min(first), 0.1)

    def test_actions_begin_and_are_told_of_soon(self):
        self.robot.module("ALMotion").setStiffnesses("Body", 1.0)
        begins, ends, lights = [], [], []
        with self.robot.at_speed(1.0):
            for turn in range(ROUNDS):
                angle = 0.3 if turn % 2 else -0.3
                turned = MotionFunction(function="angleInterpolation", names=["HeadYaw"], angles=[angle], times=[0.5])
                sent, changes, one = self.done(self.motion, NaoMotionGoal([turned]), COMMAND.format("HeadYaw"))
                begins.append(changes[0] - sent)
                ends.append(one.end.to_sec() - changes[-1])
                lit = LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.2 if turn % 2 else 0.8])
                sent, changes, _ = self.done(self.lights, NaoLedGoal([lit]), LIGHT)
                lights.append(changes[0] - sent)
        rows = (("goal to the first movement of a joint", begins), ("end of that movement to the end", ends))
        for row in (*rows, ("goal to a light", lights)):
            show(*row)
        self.assertGreater(min(*begins, *lights), -STRICT)

    def test_walks_begin_and_are_told_of_soon(self):
        self.robot.module("ALMotion").wakeUp()
        begins, ends = [], []
        with self.robot.at_speed(1.0):
            for turn in range(3):
                walk = MotionFunction(function="moveTo", values=[-0.1 if turn % 2 else 0.1, 0.0, 0.0])
                keys = [COMMAND.format(joint) for joint in ("LHipRoll", "LKneePitch", "RKneePitch")]
                sent, changes, one = self.done(self.motion, NaoMotionGoal([walk]), *keys)
                begins.append(changes[0] - sent)
                ends.append(one.end.to_sec() - changes[-1])
        show("goal to the first movement of a walk", begins)
        show("last movement of a walk to the end of the function", ends)
        self.assertGreater(min(begins), -STRICT)

    def test_sounds_and_pictures_are_there_soon(self):
        speech = self.robot.action_client("nao_audio_out", NaoAudioOutAction)
        said, played, over, taken, told = [], [], [], [], []
        with self.robot.at_speed(1.0):
            for turn in range(ROUNDS):
                text = f"Sentence {turn}."  # one that was said before is at hand
                for function, argument, begins in (("say", text, said), ("playFile", SOUND, played)):
                    run = send(speech, NaoAudioOutGoal([AudioOutFunction(function=function, str_param=argument)]))
                    (one,) = self.ends(run, GoalStatus.SUCCEEDED).result.results
                    begins.append(one.onset.to_sec() - run.sent)
                    over.append((one.end - one.offset).to_sec())
                run = send(self.vision, NaoVisionGoal([VisionFunction(function="takePicture")]))
                result = self.ends(run, GoalStatus.SUCCEEDED).result
                taken.append(result.pictures[0].header.stamp.to_sec() - run.sent)
                told.append((result.results[0].end - result.pictures[0].header.stamp).to_sec())
        rows = (("goal to the first sound of say", said), ("goal to the first sample of playFile", played))
        for row in (*rows, ("goal to the time of a picture", taken)):
            show(*row)
        show("last sound to the end of the function", over)
        show("time of a picture to the end of the function", told)
        self.assertGreater(min(*said, *played, *taken), -STRICT)

    def done(self, client, goal, *keys):
        """When a goal was sent, times at which values changed, and the result of its function."""
        samples = Samples(self.robot, keys)
        with samples.taken():
            sent = samples.now()
            run = send(client, goal).wait(60.0)
            self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
            over = samples.now()
            wait_until(lambda: samples.values[-1][0] > over, 60.0, "a sample after the end")
        return sent, samples.changes(sent), run.result.results[0]
