"""What services raise: errors a client sees as NAOqi's own, "Module::method text"."""

from __future__ import annotations


class NaoqiError(RuntimeError):
    """A call that the robot refuses; the client gets the text."""
