"""Chains for the audio module on stand-ins, and what they came to."""

from __future__ import annotations

from pathlib import Path

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_msgs.msg import AudioOutFunction

LIMIT = 5.0
EXAMPLES = Path(__file__).parents[2] / "nao_library_modules" / "examples"
WORD, SENTENCE = "ALTextToSpeech/CurrentWord", "ALTextToSpeech/CurrentSentence"


def f(function, text="", **fields):
    return AudioOutFunction(function=function, str_param=text, **fields)


def play(audio, *functions):
    return audio.server.play(NaoAudioOutGoal(list(functions)))


def in_background(audio, sounding, *functions):
    """Play a chain in a thread until something sounds; the thread."""
    sounding.quick = False
    sounding.started.clear()
    thread = audio.server.play_in_background(NaoAudioOutGoal(list(functions)))
    assert sounding.started.wait(LIMIT)
    return thread


def ended(thread, audio):
    thread.join(LIMIT)
    assert not thread.is_alive(), "the goal goes on"
    return audio.server


def calls(robot, module):
    """Calls of a module that change something or sound, in order."""
    return [call for call in robot.proxy(module).calls if not call[0].startswith(("get", "is", "list"))]


def spoken(robot):
    return calls(robot, "ALTextToSpeech")


def played(robot):
    return calls(robot, "ALAudioPlayer")
