"""What a robot cannot be asked."""

from __future__ import annotations

from naoqi.errors import NaoError


class NotThere(NaoError):
    """A server, service or topic does not run."""


class Stopped(NaoError):
    """The robot was stopped since something was asked of it."""


class ServiceRefused(NaoError):
    """A service answers that it cannot."""
