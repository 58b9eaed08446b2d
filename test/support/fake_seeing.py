"""A robot that sees, on stand-ins: things around it, a head that turns in time, extractors that tell what is in view.

Frames here are the torso's, and FRAME_ROBOT, which is TORSO_HEIGHT lower.
"""

from __future__ import annotations

import math

from fake_subscriptions import FakeSubscriptions

from nao_library_modules.gaze import load_head
from naoqi.errors import UnknownMethod

HFOV, VFOV = math.radians(56.3), math.radians(43.7)
TORSO_HEIGHT = 0.33
LIMITS = {"HeadYaw": (-2.0857, 2.0857, 8.27), "HeadPitch": (-0.6720, 0.5149, 7.19)}
HEAD = ("HeadYaw", "HeadPitch")
PICTURE_TIME = 0.1
MOUNTS = ("CameraTop", "CameraBottom")


class FakeExtractor(FakeSubscriptions):
    """Works for its subscribers, through one camera."""

    own_camera = True

    def __init__(self):
        super().__init__()
        self.camera = 0
        self.calls = []

    def getActiveCamera(self):
        if not self.own_camera:
            raise UnknownMethod(self.name, "getActiveCamera", [], ["subscribe"])
        return self.camera

    def setActiveCamera(self, camera):
        self.calls.append(("setActiveCamera", camera))
        self.camera = camera
        return True

    def getResolution(self):
        return 1


class FakeBallDetection(FakeExtractor):
    name = "ALRedBallDetection"
    own_camera = False


class FakeFaceDetection(FakeExtractor):
    """Learns any face that is there, unless it is told to refuse."""

    name = "ALFaceDetection"

    def __init__(self):
        super().__init__()
        self.learnt = []
        self.refuse = 0

    def learnFace(self, name):
        self.calls.append(("learnFace", name))
        if self.refuse:
            self.refuse -= 1
            return False
        self.learnt.append(name)
        return True

    def reLearnFace(self, name):
        self.calls.append(("reLearnFace", name))
        return True

    def forgetPerson(self, name):
        if name not in self.learnt:
            return False
        self.learnt.remove(name)
        return True

    def clearDatabase(self):
        self.learnt.clear()
        return True

    def getLearnedFacesList(self):
        return list(self.learnt)


class FakeMovementDetection(FakeExtractor):
    name = "ALMovementDetection"

    def __init__(self):
        super().__init__()
        self.sensitivity = 0.5

    def getColorSensitivity(self):
        return self.sensitivity

    def setColorSensitivity(self, value):
        self.calls.append(("setColorSensitivity", value))
        self.sensitivity = value


class FakeVideo:
    """ALVideoDevice, as far as angles and the active camera go."""

    def __init__(self):
        self.camera = 0
        self.calls = []

    def getActiveCamera(self):
        return self.camera

    def setActiveCamera(self, camera):
        self.calls.append(("setActiveCamera", camera))
        self.camera = camera
        return True

    def getHorizontalFOV(self, camera):
        return HFOV

    def getVerticalFOV(self, camera):
        return VFOV

    def getImageInfoFromAngularInfo(self, camera, info):
        alpha, beta, width, height = info
        return [
            0.5 - math.tan(alpha) / math.tan(HFOV / 2.0) / 2.0,
            0.5 + math.tan(beta) / math.tan(VFOV / 2.0) / 2.0,
            math.tan(width / 2.0) / math.tan(HFOV / 2.0),
            math.tan(height / 2.0) / math.tan(VFOV / 2.0),
        ]


class FakeHead:
    """ALMotion of a head that moves while time goes on."""

    def __init__(self):
        self.angles = [0.0, 0.0]
        self.targets = [0.0, 0.0]
        self.share = 0.0
        self.stiffnesses = [1.0, 1.0]
        self.commands = []

    def getLimits(self, joint):
        return [[*LIMITS[joint], 1.5]]

    def getAngles(self, names, measured):
        assert tuple(names) == HEAD
        return list(self.angles)

    def setAngles(self, names, angles, share):
        assert tuple(names) == HEAD and 0.0 < share <= 1.0
        assert all(LIMITS[joint][0] <= angle <= LIMITS[joint][1] for joint, angle in zip(HEAD, angles))
        self.targets, self.share = list(angles), share
        self.commands.append((list(angles), share))

    def angleInterpolationWithSpeed(self, names, angles, share):
        self.angles, self.targets = list(angles), list(angles)
        self.commands.append(("back", list(angles)))

    def getStiffnesses(self, names):
        return list(self.stiffnesses)

    def setStiffnesses(self, names, values):
        for name, value in zip(names, values):
            self.stiffnesses[HEAD.index(name)] = value

    def getPosition(self, name, frame, measured):
        in_torso, in_robot = camera_pose(MOUNTS.index(name), self.angles)
        return {0: in_torso, 2: in_robot}[frame]

    def move(self, duration):
        for i, joint in enumerate(HEAD):
            if self.stiffnesses[i] > 0.0:
                step = LIMITS[joint][2] * self.share * duration
                self.angles[i] += min(max(self.targets[i] - self.angles[i], -step), step)


def camera_pose(camera, angles):
    """Position6D of a camera in the torso frame, and in FRAME_ROBOT."""
    head, (yaw, pitch) = load_head(), angles
    mount = head.cameras[MOUNTS[camera]]
    ahead = mount.ahead * math.cos(pitch) + mount.above * math.sin(pitch)
    above = mount.above * math.cos(pitch) - mount.ahead * math.sin(pitch)
    pose = [ahead * math.cos(yaw), ahead * math.sin(yaw), head.height + above, 0.0, pitch + mount.down, yaw]
    return pose, [pose[0], pose[1], pose[2] + TORSO_HEIGHT, *pose[3:]]


def seen_from(camera, angles, point):
    """A point of the torso frame in the frame of a camera, m: X along its axis, Y left, Z up."""
    x, y, z, _, down, yaw = camera_pose(camera, angles)[0]
    dx, dy, dz = point[0] - x, point[1] - y, point[2] - z
    flat, left = dx * math.cos(yaw) + dy * math.sin(yaw), dy * math.cos(yaw) - dx * math.sin(yaw)
    return flat * math.cos(down) - dz * math.sin(down), left, flat * math.sin(down) + dz * math.cos(down)


class Eyes:
    """The stand-ins of one robot, and what is around it.

    Attributes:
        ball: Where a red ball of 3 cm is in the torso frame, m; None: nowhere.
        move_ball: Where it is at a time in s, if it moves.
        head: ALMotion.
    """

    radius = 0.03

    def __init__(self, robot):
        self.memory = robot.memory
        self.ball = None
        self.move_ball = None
        self.balls, self.faces = FakeBallDetection(), FakeFaceDetection()
        self.marks, self.codes, self.movement = FakeExtractor(), FakeExtractor(), FakeMovementDetection()
        self.video, self.head = FakeVideo(), FakeHead()
        for name, service in (
            ("ALRedBallDetection", self.balls),
            ("ALFaceDetection", self.faces),
            ("ALLandMarkDetection", self.marks),
            ("ALBarcodeReader", self.codes),
            ("ALMovementDetection", self.movement),
            ("ALVideoDevice", self.video),
            ("ALMotion", self.head),
        ):
            robot.add(name, service)

    def raise_event(self, name, value):
        self.memory.signals[name](value)

    def poses(self, camera=0):
        return [list(pose) for pose in camera_pose(camera, self.head.angles)]

    def stamp(self, time):
        return [int(time), int(round((time - int(time)) * 1e6))]

    def look(self, time):
        """What the extractors tell of a picture that is taken now."""
        if self.move_ball is not None:
            self.ball = self.move_ball(time)
        if self.balls.subscribers and self.ball is not None:
            value = self.ball_value(time, self.video.camera)
            if value:
                self.raise_event("redBallDetected", value)

    def ball_value(self, time, camera):
        x, y, z = seen_from(camera, self.head.angles, self.ball)
        if x <= 0.0:
            return None
        alpha, beta = math.atan2(y, x), math.atan2(-z, x)
        if abs(alpha) > HFOV / 2.0 or abs(beta) > VFOV / 2.0:
            return None
        radius = math.asin(self.radius / math.sqrt(x * x + y * y + z * z))
        return [
            self.stamp(time),
            [alpha, beta, radius, radius],
            *self.poses(camera),
            camera,
        ]

    def idle(self):
        """Nobody looks, no event is subscribed, cameras are as they were."""
        extractors = (self.balls, self.faces, self.marks, self.codes, self.movement)
        assert [extractor.subscribers for extractor in extractors] == [[]] * len(extractors)
        assert not any(signal.links for signal in self.memory.signals.values())
        assert [extractor.camera for extractor in extractors] == [0] * len(extractors) and self.video.camera == 0
        return True


class SeeingClock:
    """Time that passes only while somebody waits; pictures are taken ten times a second, the head moves meanwhile.

    Attributes:
        time: s.
        script: Functions, one for each of the next pictures.
        every: Called for each picture with the time.
    """

    def __init__(self):
        self.time = 100.0
        self.script = []
        self.every = []
        self._picture = self.time

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        end = self.time + duration
        while self.time < end:
            step = min(end, self._picture + PICTURE_TIME) - self.time
            self.time = min(end, self._picture + PICTURE_TIME)
            for action in self.every:
                action(step, self.time >= self._picture + PICTURE_TIME - 1e-9)
            if self.time >= self._picture + PICTURE_TIME - 1e-9:
                self._picture = self.time
                if self.script:
                    self.script.pop(0)()
            if interrupt.is_set():
                return False
        return True
