"""Codes of errors that other nodes act on. Their texts are for people and may be reworded; the codes stay.

The error of a service and the status of a goal of nao_robot's types are a text and nothing else: it ends in the code,
as in "walking to ... ended early: another command came [walk_ended]".
"""

from __future__ import annotations

from enum import Enum
from typing import ClassVar

from naoqi.errors import NaoError


class ErrorCode(Enum):
    """What a client of the driver can act on."""

    WALK_ENDED = "walk_ended"  # a walk was stopped, or replaced by another command, before the robot got there
    POSTURE_MISSED = "posture_missed"  # the robot ended its motion elsewhere


class CodedError(NaoError):
    """An error whose code reaches clients in other nodes; each subclass has one."""

    code: ClassVar[ErrorCode]


def with_code(error: Exception) -> str:
    """Text of an error for a client in another node."""
    return f"{error} [{error.code.value}]" if isinstance(error, CodedError) else str(error)


def code_in(text: str) -> ErrorCode | None:
    """The code of an error's text, as `with_code` gives it, also inside of what ROS writes around it."""
    return next((code for code in ErrorCode if f"[{code.value}]" in text), None)
