"""Functions of goals as tests write them: `motion("moveTo", values=[0.1, 0.0, 0.0])`, `audio_out("say", "Hello")`."""

from __future__ import annotations

from functools import partial

from genpy import Duration

from nao_library_msgs.msg import (
    AudioInFunction,
    AudioOutFunction,
    BehaviorFunction,
    LedFunction,
    MotionFunction,
    TactileFunction,
    VisionFunction,
)


def _timed(kind, /, function, time=0.0, **fields):
    """A function after which the server waits `time` s."""
    return kind(function=function, time=Duration.from_sec(time), **fields)


def _with_text(kind, /, function, str_param="", time=0.0, **fields):
    return _timed(kind, function, time, str_param=str_param, **fields)


audio_in, led, motion, tactile, vision = (
    partial(_timed, kind) for kind in (AudioInFunction, LedFunction, MotionFunction, TactileFunction, VisionFunction)
)
audio_out, behavior, led_with_text = (
    partial(_with_text, kind) for kind in (AudioOutFunction, BehaviorFunction, LedFunction)
)
