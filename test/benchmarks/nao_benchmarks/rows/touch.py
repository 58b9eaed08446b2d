"""How soon a touch is known: from the finger on the sensor to the driver's topic, beside the robot's own event."""

from __future__ import annotations

import threading
import time

from ..errors import BenchmarkError
from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample

ROUNDS = 60
SENSOR, EVENT = "Head/Touch/Front", "FrontTactilTouched"
TOPIC = "head_touch"
LIMIT = 5.0


class TouchEvent(Row):
    """From a touch in the simulator to the message of nao_tactile, and to a subscriber of the event over libqi."""

    name = "touch_event"
    subject = "touch of the head, to nao_tactile's topic"
    against = "to a bare subscriber of the event"
    unit = "ms"
    bound = at_most(2.0)

    def measure(self, stack: Stack) -> Figures:
        """Touch and let go in turns; both are told of the same changes."""
        stack.start_tactile()
        import rospy  # not above: it needs the messages of the built workspace

        from nao_library_msgs.msg import HeadTouch

        ours, bare = _Arrival(), _Arrival()
        topic = rospy.Subscriber(TOPIC, HeadTouch, lambda _: ours.now(), tcp_nodelay=True)
        signal = stack.simulator.session.service("ALMemory").subscriber(EVENT)
        link = signal.signal.connect(lambda _: bare.now())
        deadline = time.monotonic() + LIMIT
        while not topic.get_num_connections():
            if time.monotonic() > deadline:
                raise BenchmarkError(f"nobody publishes {TOPIC}")
            time.sleep(0.01)
        taken: tuple[list[float], list[float]] = ([], [])
        for turn in range(ROUNDS):
            began = time.perf_counter()
            stack.simulator.ask("NaoSimulation", "press", [] if turn % 2 else [SENSOR])
            for arrival, times in zip((ours, bare), taken):
                times.append(arrival.wait() - began)
        topic.unregister()
        signal.signal.disconnect(link)
        samples = [Sample(tuple(times)) for times in taken]
        longest = 1e3 * max(samples[0].seconds)
        return Figures.compared(*samples, scale=1e3, note=f"the longest {longest:.0f} ms")


class _Arrival:
    """When something came last; any thread may tell."""

    def __init__(self) -> None:
        self._came = threading.Event()
        self._at = 0.0

    def now(self) -> None:
        self._at = time.perf_counter()
        self._came.set()

    def wait(self) -> float:
        if not self._came.wait(LIMIT):
            raise BenchmarkError(f"a touch was not told within {LIMIT:g} s")
        self._came.clear()
        return self._at
