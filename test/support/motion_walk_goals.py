"""Chains of walks for the motion module on stand-ins."""

from __future__ import annotations

from nao_library_actions.msg import NaoMotionGoal
from nao_library_msgs.msg import MotionFunction

LIMIT = 5.0
STOP = ("stopMove",), ("waitUntilMoveIsFinished",)


def f(function, **fields):
    return MotionFunction(function=function, **fields)


def play(motion, *functions):
    return motion.server.play(NaoMotionGoal(list(functions)))


def play_until(motion, event, *functions):
    """Play a chain in the background until an event; the thread that plays it."""
    thread = motion.server.play_in_background(NaoMotionGoal(list(functions)))
    assert event.wait(LIMIT)
    return thread


def moved(robot):
    """Calls that change something, in order."""
    asking = ("get", "robotIs", "moveIs")
    return [call for call in robot.proxy("ALMotion").calls if not call[0].startswith(asking)]
