"""Time limits of waiting for a robot, each with its reason. All in s.

Three things may be wrong, and each has its own limit:

- The robot is gone: its connection is closed or refused. That shows at once and needs no limit.
- The robot is silent: nothing at all is answered. A busy computer or network is, now and then, so nothing is given up
  for it before `Timing.patience` is over. Then the connection is lost, and what waits for an answer fails.
- The robot answers, but not this call: a method that takes long, or a module that hangs. The limits below are for that.
  `Call.result` counts them by `Connection.answering_time`, which stands still while the robot is silent. So no such
  limit has to be longer than the patience, and none makes the patience longer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable


@dataclass(frozen=True)
class Timing:
    """How patient a connection is, all in s."""

    heartbeat_period: float = 0.3  # pause between two heartbeats: what happens within 2 s is seen by then
    silence: float = 1.3  # one that leaves a heartbeat unanswered so long is reported as silent; a busy one seldom is
    patience: float = (
        20.0  # one that is silent so long is lost: twice the longest silence that a robot was seen to recover from
    )
    first_delay: float = 0.2  # pause after the first failed attempt to connect; it doubles with each further one
    longest_delay: float = 2.0  # longest pause between two attempts


DEFAULT_TIMING = Timing()
"""Of programs, which have nothing better to do than to wait for their robot."""
SERVER_PATIENCE = 10.0
"""Of the nodes of this library: their clients want to know that the robot is lost. Busy computers with two whole stacks
reached 1.6 s."""

SILENT_SLICE = 0.05
"""Until the clock of a robot that was silent is read again."""


def wait_while_answering(wait: Callable[[float], bool], clock: Callable[[], float], limit: float) -> bool:
    """Wait up to a limit of a robot that answers.

    Args:
        wait: Waits up to so many s for what is awaited; returns whether it has come.
        clock: `answering_time` of the connection.
        limit: In s of that clock.

    Returns:
        Whether it has come.
    """
    left, end = limit, clock() + limit
    while not wait(left):
        left = end - clock()
        if left <= 0.0:
            return False
        left = max(left, SILENT_SLICE)
    return True


# Of the robot's answers, counted while it answers at all.

ANSWER_LIMIT = 5.0
"""A question, or a setting, that takes no time by itself."""
CLEAN_UP_LIMIT = ANSWER_LIMIT
"""A setting that is put back at the end of a function: nothing can interrupt it, so a module that hangs holds up what
comes next for so long. On two processors with 80 busy programs a simulator that answered took more than 2 s for one."""
START_LIMIT = 0.5
"""After the connection, modules may still appear: a starting robot registers them in turn."""
FIRST_MODULE_LIMIT = 10.0
"""The same while it has no module of NAOqi at all, and for one that it had before it went away: on a busy computer a
simulator listens for seconds before it has its modules, and a robot that starts again registers them for longer."""
READY_LIMIT = 1.0
"""A module that has just been registered may not be callable yet."""
STANDING_LIMIT = 2.0
"""A walk that was stopped: until the robot stands, and so how far it got is known."""
STOP_LIMIT = 10.0
"""A walk ends on both feet."""
FILE_LIMIT = 10.0
"""A recorder starts or completes a file."""
LEARN_LIMIT = 30.0
"""A face is learned from several pictures."""
MOVE_LIMIT = 60.0
"""A service that answers when the body has moved: to wake up, to rest, to change the state of life."""
LOST_WORD_LIMIT = 120.0
"""A speaking robot reports each word; one that reports none for so long has lost the text."""

WORD_TIMES_LIMIT = 0.5
"""The times of what was said are asked for when it is over, and may be missing in the result."""

# Of what the robot sends unasked, counted in the same way.

STREAM_LIMIT = 3.0
"""A stream of pictures or sound: without any for so long it is subscribed again."""
FIRST_PICTURE_LIMIT = 15.0
"""A camera that has just been subscribed opens its device first."""

# Of a call that was cancelled. The requests of a connection arrive in order, also at a robot that was silent: so what
# comes next may be sent before the end of the call is known, and these need not be long.

CANCELLED_LIMIT = 0.1
"""It ends by itself at once on a robot that knows cancellation."""
STOPPED_LIMIT = 0.5
"""It was stopped by another call as well; a robot that knows neither must not hold up preemption."""
GOAL_END_LIMIT = SERVER_PATIENCE + 5.0
"""A goal of a server ends when the robot stands still, also if it is silent at first."""

# Of the end of a program, which waits for no answers any more.

FLUSH_LIMIT = 0.5
"""What was sent arrives at the robot."""
EXIT_LIMIT = 1.0
"""Calls under way have failed."""
IDLE_LIMIT = 0.5
"""libqi has put everything away."""

# Of a start.

START_PATIENCE = 30.0
"""From the start of a server: goals wait for a robot, or simulator, that is launched together with it."""
TEXT_PATIENCE = 3.0
"""From the arrival of a text on the speech topic, which has no reply: for a robot that was never reached yet."""
LOST_PATIENCE = 5.0
"""What a program that died has left is stopped on a robot that is lost, if it is back by then."""
BOOT_LIMIT = 120.0
"""After the connection: ALMemory, which reports a restart of NAOqi, may appear."""
