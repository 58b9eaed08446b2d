"""A proxy whose service is an object of the test."""

from __future__ import annotations

from naoqi.errors import RobotError


class FakeProxy:
    """Starts calls of a service and keeps them in mind.

    Attributes:
        calls: (method, arguments) of each.
        lost: What every call fails with; None while the robot can be reached.
    """

    def __init__(self, service, make_call):
        self.calls = []
        self.lost = None
        self._service = service
        self._make_call = make_call

    def call_async(self, method, *arguments):
        if self.lost is not None:
            raise self.lost
        self.calls.append((method, *arguments))
        pending = self._make_call(method)
        try:
            result = getattr(self._service, method)(*arguments)
        except RobotError as error:
            pending.end(error=error)
            return pending
        if hasattr(result, "add_done_callback"):
            return result
        pending.end(result)
        return pending
