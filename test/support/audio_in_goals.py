"""Chains for the module for hearing on stand-ins, and what they came to."""

from __future__ import annotations

from nao_library_actions.msg import NaoAudioInGoal
from nao_library_msgs.msg import AudioInFunction

WORDS, STATUS = "WordRecognized", "ALSpeechRecognition/Status"
LOCATED, DETECTED = "ALSoundLocalization/SoundLocated", "SoundDetected"
YES_NO = ["yes", "no"]
LEVEL = [0.0] * 6


def f(function, **fields):
    return AudioInFunction(function=function, **fields)


LISTEN = f("listen", vocabulary=YES_NO, timeout=5.0)


def play(hearing, *functions):
    return hearing.server.play(NaoAudioInGoal(list(functions)))


def succeed(hearing, *functions):
    server = play(hearing, *functions)
    assert server.end == "succeeded", server.text
    return server.result
