"""Somebody says a word to a robot that listens, and when that was."""

from __future__ import annotations

import numpy as np
from goal_functions import audio_in as f
from sounds import RATE, put
from spoken_words import RATE as SPEECH_RATE
from spoken_words import audible, spoken

from nao_sim_bridge.base.samples import Sound

PLACE = (1.0, 0.0, 0.5)
WAY = 1.0 / 343.0
"""s from there to the microphones."""


def listens(robot, goal):
    """Let time pass until the feedback of a goal says that what is said now is heard."""
    robot.advance_until(lambda: "listening" in [told.status for told in goal.feedback], 5.0, step=0.02)


def says(robot, text, voice="slt"):
    """Somebody 1 m in front of the robot speaks; simulated times, s, at which it begins and ends at the microphones."""
    speech = spoken(text, voice)
    first, last = audible(speech)
    part = Sound(speech[round(first * SPEECH_RATE) : round(last * SPEECH_RATE)].astype(np.float32), SPEECH_RATE)
    put(robot, PLACE, part.at_rate(RATE).samples[:, 0], name=text)
    return robot.now.time + WAY, robot.now.time + WAY + last - first


def trial(robot, ears, text, voice, vocabulary, after=0.05, **fields):
    """A goal that listens, and a word so long after its feedback says that it is heard.

    Returns:
        The result, the times of `says`, and the simulated time of the answer, s.
    """
    goal = ears.send(f("listen", vocabulary=vocabulary, timeout=4.0, **fields))
    listens(robot, goal)
    robot.advance(after)
    onset, end = says(robot, text, voice)
    result = goal.finish().result
    return result, onset, end, robot.now.time
