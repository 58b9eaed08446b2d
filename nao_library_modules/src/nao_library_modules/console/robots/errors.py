"""What a robot cannot be asked."""

from __future__ import annotations

from naoqi.errors import NaoError


class NotThere(NaoError):
    """A server, service or topic does not run."""


class ServiceRefused(NaoError):
    """A service answers that it cannot."""


class Stopped(NaoError):
    """Everything was stopped between the wish and the deed."""
