"""Messages in which one number is what nobody means: each number of a message, one at a time."""

from __future__ import annotations

import copy
import math
import re

import genpy
import roslib.message
from goal_functions import audio_in, audio_out, behavior, led, motion, tactile, vision
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

FLOATS = (1e-320, 1e6, 1e9, 1.7e308, math.nan, -1.0)
INTEGERS = (-1, 10**6, 2**31 - 1)
LARGEST_FLOAT32 = 3.4e38
MANY = 10**5
"""Items of a list in the place of its first."""
_ARRAY = re.compile(r"(.+)\[\d*\]")
_INTEGER = re.compile(r"(u?)int(\d+)")


def _fits(kind, value):
    if kind in ("time", "duration"):
        return not math.isnan(value) and -(2**31) <= value < 2**31 and (kind == "duration" or value >= 0.0)
    if kind == "float32":
        return not 1e38 < value < math.inf and not 0.0 < abs(value) < 1e-45
    integer = _INTEGER.fullmatch(kind)
    if integer:
        bits = int(integer[2])
        low, high = (0, 2**bits - 1) if integer[1] else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        return low <= value <= high
    return True


def _values(kind):
    if kind in ("float64", "time", "duration"):
        return [value for value in FLOATS if _fits(kind, value)]
    if kind == "float32":
        return [value for value in (*FLOATS, LARGEST_FLOAT32, 1e-45) if _fits(kind, value)]
    return [value for value in INTEGERS if _fits(kind, value)] if _INTEGER.fullmatch(kind) else []


def numbers(message):
    """Place and type of every number in a message: ("trajectory", "points", 0, "positions", 1), "float64"."""
    for name, kind in zip(message.__slots__, message._slot_types):
        value = getattr(message, name)
        array = _ARRAY.fullmatch(kind)
        items = [((name, i), array[1], each) for i, each in enumerate(value)] if array else [((name,), kind, value)]
        for place, item_kind, item in items:
            if isinstance(item, genpy.Message):
                yield from ((place + rest, inner) for rest, inner in numbers(item))
            elif _values(item_kind):
                yield place, item_kind


def with_number(message, place, kind, value):
    """A copy of a message in which one number is another."""
    other = copy.deepcopy(message)
    holder = other
    for step in place[:-1]:
        holder = holder[step] if isinstance(step, int) else getattr(holder, step)
    if isinstance(place[-1], int):
        values = getattr_path(other, place[:-2]), place[-2]
        changed = list(getattr(*values))
        changed[place[-1]] = value
        setattr(*values, changed)
    elif kind == "duration":
        setattr(holder, place[-1], genpy.Duration.from_sec(value))
    elif kind == "time":
        setattr(holder, place[-1], genpy.Time.from_sec(value))
    else:
        setattr(holder, place[-1], value)
    return other


def getattr_path(message, place):
    """What is at a place in a message."""
    for step in place:
        message = message[step] if isinstance(step, int) else getattr(message, step)
    return message


def variants(message, fields=None):
    """(place as text, value, message) for each number and each value that nobody means."""
    for place, kind in numbers(message):
        if fields is None or place[0] in fields:
            for value in _values(kind):
                yield ".".join(map(str, place)), value, with_number(message, place, kind, value)


def long_lists(message):
    """(place as text, number of items, message) for each list of numbers that becomes very long, one at a time."""
    for place, _ in numbers(message):
        if place[-1] == 0:
            other = copy.deepcopy(message)
            holder, name = getattr_path(other, place[:-2]), place[-2]
            if not holder._slot_types[holder.__slots__.index(name)].endswith("[]"):
                continue  # its length is fixed
            setattr(holder, name, [getattr(holder, name)[0]] * MANY)
            yield ".".join(map(str, place)), MANY, other


def _curve(*velocities):
    points = [
        JointTrajectoryPoint(positions=[0.1], velocities=list(velocities), time_from_start=genpy.Duration(1)),
        JointTrajectoryPoint(positions=[0.0], velocities=list(velocities), time_from_start=genpy.Duration(2)),
    ]
    return JointTrajectory(joint_names=["HeadYaw"], points=points)


STIFF = {"names": ["HeadYaw"], "stiffness": 1.0}
HAND = [0.2, 0.12, 0.05, 0.0, 0.0, 0.0]
TRANSFORM = [1.0, 0.0, 0.0, 0.2, 0.0, 1.0, 0.0, 0.12, 0.0, 0.0, 1.0, 0.05]
ARM = {"names": ["LArm"], "frame": 0, "axis_mask": 7, "stiffness": 1.0}
LISTED = {"lights": ["Brain0"], "i_values": [0.5]}
GREEN = {"lights": ["FaceLeds"], "i_values": [0.0, 1.0, 0.0]}
LOOK = {"timeout": 0.2, "confidence": 0.5, "count": 1}
SOUND = {"volume": 0.5, "pan": 1.0, "duration": 0.2}
TEXT = {"volume": 0.5, "speed": 100.0, "pitch": 100.0}
PICTURE = {"width": 64, "height": 48}
GAIT = {"gait": ["StepHeight"], "gait_values": [0.02]}

EXAMPLES = {
    "NaoLights": [
        led("setIntensity", **LISTED),
        led("setColor", **GREEN),
        led("fade", duration=0.2, **LISTED),
        led("fadeRGB", duration=0.2, **GREEN),
        led("fadeListRGB", times=[0.1, 0.2], lights=["FaceLeds"], i_values=[0.0, 1.0, 0.0, 1.0, 0.0, 0.0]),
        led("randomEyes", duration=0.2),
        led("rasta", duration=0.2),
        led("rotateEyes", i_values=[0.0, 1.0, 0.0], rotation_time=0.5, duration=0.2),
        led("earLedsSetAngle", angle=90, duration=0.2),
    ],
    "NaoMotion": [
        motion("setAngles", angles=[0.1], speed=0.5, **STIFF),
        motion("setAngles", angles=[0.1], speeds=[0.5], **STIFF),
        motion("changeAngles", angles=[0.1], speed=0.5, **STIFF),
        motion("angleInterpolation", angles=[0.1, 0.0], times=[1.0, 2.0], **STIFF),
        motion("angleInterpolationWithSpeed", angles=[0.1], speed=0.5, **STIFF),
        motion("angleInterpolationBezier", trajectory=_curve(0.0), stiffness=1.0),
        motion("setTrajectory", trajectory=_curve(), stiffness=1.0),
        motion("setPose", angles=[0.1], speed=0.5, **STIFF),
        motion("setPose", angles=[0.1], duration=1.0, **STIFF),
        motion("setStiffnesses", names=["Head"], angles=[1.0]),
        motion("stiffnessInterpolation", names=["Head"], angles=[0.5, 1.0], times=[0.2, 0.4]),
        motion("goToPosture", str_param="Stand", speed=0.8),
        motion("applyPosture", str_param="Stand", speed=0.8, stiffness=1.0),
        motion("setMaxTryNumber", values=[3.0]),
        motion("lookAt", values=[1.0, 0.0, 0.2], speed=0.3, stiffness=1.0),
        motion("lookAt", values=[1.0, 0.0, 0.2], duration=1.0, stiffness=1.0),
        motion("getPosition", names=["LArm"], frame=0),
        motion("getTransform", names=["LArm"], frame=0),
        motion("setPosition", values=HAND, speed=0.3, **ARM),
        motion("setTransform", values=TRANSFORM, speed=0.3, **ARM),
        motion("changePosition", values=[0.01, 0.0, 0.0, 0.0, 0.0, 0.0], speed=0.3, **ARM),
        motion("positionInterpolation", values=HAND, times=[1.0], **ARM),
        motion("transformInterpolation", values=TRANSFORM, times=[1.0], **ARM),
        motion("getCOM", names=["Body"], frame=0),
        motion("getSupportPolygon", frame=0),
        motion("recordMotion", str_param="boundary", names=["Head"], duration=0.2, rate=25.0, overwrite=True),
        motion("playMotion", str_param="dance", speed=1.0, stiffness=1.0),
        motion("killTask", values=[77.0]),
        motion("setBreathConfig", texts=["Bpm", "Amplitude"], values=[20.0, 0.5]),
        motion("wbGoToBalance", str_param="Legs", duration=1.0),
        motion("wbSetEffectorControl", names=["LArm"], values=HAND[:3]),
        motion("wbGoToBalanceWithSpeed", str_param="Legs", speed=0.5),
        motion("setMotionConfig", texts=["ENABLE_FOOT_CONTACT_PROTECTION"], values=[1.0]),
        motion("getChainClosestObstaclePosition", names=["LArm"], frame=0),
        motion("moveTo", values=[0.1, 0.0, 0.1], duration=2.0, **GAIT),
        motion("walkTo", values=[0.1, 0.0, 0.1], duration=2.0, **GAIT),
        motion("walkTarget", values=[0.1, 0.0, 0.1], frame=2, **GAIT),
        motion("walk_target", values=[0.1, 0.0, 0.1], frame=2, **GAIT),
        motion("walkPath", values=[0.1, 0.0, 0.1], frame=2, **GAIT),
        motion("walk_path", values=[0.1, 0.0, 0.1], frame=2, **GAIT),
        motion("move", values=[0.05, 0.0, 0.1], duration=1.0, **GAIT),
        motion("moveToward", values=[0.5, 0.0, 0.1], duration=1.0, **GAIT),
        motion("setFootSteps", names=["LLeg"], values=[0.04, 0.1, 0.0], times=[0.6]),
        motion("setFootStepsWithSpeed", names=["LLeg"], values=[0.04, 0.1, 0.0], speed=0.5),
        motion("setFootStepsWithSpeed", names=["LLeg"], values=[0.04, 0.1, 0.0], speeds=[0.5]),
        motion("setOrthogonalSecurityDistance", values=[0.4]),
        motion("setTangentialSecurityDistance", values=[0.1]),
    ],
    "NaoTactile": [
        tactile("waitForTouch", touch="count", count=2, duration=1.0, timeout=0.2),
        tactile("waitForChestButton", count=1, timeout=0.2),
        tactile("waitForObstacle", distance=0.1, timeout=0.2),
        tactile("waitForFall", timeout=0.2),
        tactile("onTouch", touch="count", duration=1.0, behavior="nod", count=2, cooldown=1.0),
    ],
    "NaoVision": [
        vision("subscribe", id="boundary", topic_out="boundary", rate=5.0, **PICTURE),
        vision("createStream", id="boundary", topic_out="boundary", rate=5.0, **PICTURE),
        vision("startRecording", id="boundary", str_param="boundary", rate=5.0, overwrite=True, **PICTURE),
        vision("createRecording", id="boundary", str_param="boundary", rate=5.0, overwrite=True, **PICTURE),
        vision("takePicture", str_param="boundary", quality=90, timeout=0.2, overwrite=True, **PICTURE),
        vision(
            "takePictures",
            str_param="boundary",
            quality=90,
            timeout=0.2,
            count=2,
            interval=0.1,
            overwrite=True,
            **PICTURE,
        ),
        vision("setParameter", camera="top", str_param="brightness", values=[60.0]),
        vision("setFrameRate", camera="top", rate=10.0),
        vision("detectBall", size=0.03, **LOOK),
        vision("detectLandmarks", size=0.09, **LOOK),
        vision("readBarcodes", size=0.1, **LOOK),
        vision("detectMovement", sensitivity=0.5, **LOOK),
        vision("detectFaces", size=0.16, **LOOK),
        vision("learnFace", str_param="Ada", timeout=0.2),
        vision("reLearnFace", str_param="Ada", timeout=0.2),
        vision("trackBall", timeout=0.2, confidence=0.5, size=0.03, duration=0.2, speed=0.3),
        vision("trackFace", timeout=0.2, confidence=0.5, size=0.16, duration=0.2, speed=0.3),
        vision("lookFor", str_param="ball", size=0.03, speed=0.3, **LOOK),
    ],
    "nao_audio_in": [
        audio_in("setOutputVolume", volume=50.0),
        audio_in("setParameter", str_param="Sensitivity", values=[0.5]),
        audio_in("record", str_param="boundary.wav", rate=16000, duration=0.2, overwrite=True),
        audio_in("startRecording", str_param="boundary.wav", rate=16000, overwrite=True),
        audio_in("startMicrophonesRecording", str_param="boundary.wav", rate=16000, overwrite=True),
        audio_in("listen", vocabulary=["yes"], timeout=0.2, confidence=0.5),
        audio_in("setContextParam", str_param="boundary", vocabulary=["parameter"], values=[0.5]),
        audio_in("detectSound", timeout=0.2, confidence=0.5),
        audio_in("localizeSound", timeout=0.2, confidence=0.5, duration=0.1),
        audio_in("setSensitivity", sensitivity=0.5),
        *(audio_in(f"get{side}Energy", duration=0.2) for side in ("", "LeftMic", "RightMic", "FrontMic", "RearMic")),
    ],
    "nao_audio_out": [
        audio_out("setOutputVolume", volume=50.0),
        audio_out("setParameter", names=["pitchShift"], values=[1.5]),
        audio_out("say", "one", **TEXT),
        audio_out("animatedSay", "one", **TEXT),
        audio_out("sayToFile", "one", file_name="boundary.wav", overwrite=True, **TEXT),
        audio_out("sayToFileAndPlay", "one", **TEXT),
        audio_out("playFile", "boundary.wav", **SOUND),
        audio_out("playFileInLoop", "boundary.wav", **SOUND),
        audio_out("playFileFromPosition", "boundary.wav", position=0.1, **SOUND),
        audio_out("playSine", frequency=440.0, **SOUND),
        audio_out("playWebStream", "http://127.0.0.1:9/x.wav", **SOUND),
        audio_out("play", sound_id=7, **SOUND),
        audio_out("playInLoop", sound_id=7, **SOUND),
        *(audio_out(name, sound_id=7) for name in ("pause", "getCurrentPosition", "getFileLength")),
        *(audio_out(name, sound_id=7) for name in ("disablePitch", "unloadFile", "getVolume")),
        audio_out("goTo", sound_id=7, position=0.1),
        audio_out("setPitch", sound_id=7, pitch=1.5),
        audio_out("setVolume", sound_id=7, volume=0.5),
        audio_out("setMasterVolume", volume=0.5),
        audio_out("setPanorama", pan=0.5),
        audio_out("playSoundSetFile", file_name="boundary", position=0.1, **SOUND),
    ],
    "NaoBehavior": [behavior("recordBehavior", "boundary", duration=0.2, overwrite=True)],
}
"""Server -> a valid message of each function that takes numbers."""


def message_class(name):
    """A message by its type."""
    return roslib.message.get_message_class(name)
