"""What the proxy layer costs on top of libqi."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import interleave

ROUNDS = 2500
KEY = "Device/SubDeviceList/HeadYaw/Position/Sensor/Value"


class ProxyCall(Row):
    """A call that is answered at once: the same method of the same service, from the same process."""

    name = "proxy_call"
    subject = "call of ALProxy (ALMemory.getData)"
    against = "bare qi call"
    unit = "us"
    bound = at_most(1.15)

    def measure(self, stack: Stack) -> Figures:
        """Measure the two in turns, each over a connection of its own."""
        from naoqi import ALProxy  # not above: it is not there before the workspace is built

        bare = stack.simulator.session.service("ALMemory")
        proxy = ALProxy("ALMemory", "127.0.0.1", stack.simulator.port)
        try:
            calls = [lambda: proxy.getData(KEY), lambda: bare.getData(KEY)]
            samples = interleave(calls, ROUNDS, warm_up=100)
        finally:
            proxy.connection.close()
        return Figures.compared(*samples, scale=1e6)
