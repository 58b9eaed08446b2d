"""How soon the console does what is pressed on its pages, and what it takes."""

from __future__ import annotations

import json
import sys
import tempfile
import threading
import time
import urllib.request
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from ..errors import BenchmarkError
from ..places import NODES
from ..program import Program
from ..row import Figures, Row, at_most
from ..stack import LIGHTS, START_LIMIT, Stack
from ..stats import interleave
from .memory import MIB, resident_kib

ROUNDS, STOPS, WARM_UP, PAGES = 100, 20, 10, 20
LIMIT = 10.0
GROUP = {"lights": ["ChestLeds"]}
BUTTON = {"label": "Press", "key": "p", "call": "NaoLights.listGroup", "with": GROUP}
LONG = {**GROUP, "str_param": "blue", "duration": 600.0}


class ConsoleUnderTest:
    """The console on the stack's ROS master, as a browser sees it."""

    def __init__(self, held: ExitStack) -> None:
        self._held = held
        folder = Path(held.enter_context(tempfile.TemporaryDirectory()))
        (folder / "buttons.yaml").write_text(json.dumps({"groups": [{"group": "A", "buttons": [BUTTON]}]}))
        options = ["--port", "0", "--console", str(folder / "buttons.yaml"), "--studies", str(folder)]
        self.program = held.enter_context(Program("console", [sys.executable, str(NODES / "nao"), "console", *options]))
        told = self.program.wait_for(r"NAO console: (\S+)/\?token=(\S+)", START_LIMIT)
        self._base, token = told[1], told[2]
        opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        self._open = opener.open
        answer = urllib.request.Request(f"{self._base}/functions?token={token}")
        self._open(answer).read()
        jar = next(handler for handler in opener.handlers if hasattr(handler, "cookiejar")).cookiejar
        self._cookie = "; ".join(f"{cookie.name}={cookie.value}" for cookie in jar)

    def page(self, path: str) -> None:
        """Have a page made."""
        self._open(f"{self._base}{path}?robot=/").read()

    def socket(self, path: str) -> Any:
        """A WebSocket, open until the end."""
        from websockets.sync.client import connect

        address = f"{self._base.replace('http', 'ws', 1)}{path}?robot=/"
        headers = {"Cookie": self._cookie}
        return self._held.enter_context(connect(address, origin=self._base, additional_headers=headers, proxy=None))

    def stop(self) -> None:
        """As the key Escape does it."""
        self._open(urllib.request.Request(f"{self._base}/console/stop?robot=/", method="POST")).read()


class Arrivals:
    """Waits for messages of a topic."""

    def __init__(self, topic: str, kind: type) -> None:
        import rospy

        self._came = threading.Event()
        self._subscriber = rospy.Subscriber(topic, kind, lambda _: self._came.set(), tcp_nodelay=True)
        deadline = time.monotonic() + LIMIT
        while not self._subscriber.get_num_connections():
            if time.monotonic() > deadline:
                raise BenchmarkError(f"nobody publishes {topic}")
            time.sleep(0.01)

    def after(self, action: Any) -> None:
        """Do something, and wait for a message that comes then."""
        self._came.clear()
        action()
        if not self._came.wait(LIMIT):
            raise BenchmarkError(f"{self._subscriber.name}: no message within {LIMIT:g} s")

    def close(self) -> None:
        self._subscriber.unregister()


class ConsolePress(Row):
    """From a key that is pressed on the wizard's page to its goal at the server's topic."""

    name = "console_press"
    subject = "key of the wizard's page, to its goal"
    against = "goal of a bare ActionClient"
    unit = "ms"
    bound = at_most(10.0)

    def measure(self, stack: Stack) -> Figures:
        """Press and send in turns."""
        from nao_library_actions.msg import NaoLedActionGoal

        bare = stack.lights_client
        goal = bare.goal("listGroup", GROUP)
        with ExitStack() as held:
            console = ConsoleUnderTest(held)
            socket = console.socket("/console/drive")
            layout = json.loads(socket.recv(LIMIT))["layout"]
            (button,) = layout["keys"].values()
            press = json.dumps({"press": button, "revision": layout["revision"], "via": "key"})
            goals = Arrivals(f"{LIGHTS}/goal", NaoLedActionGoal)
            held.callback(goals.close)
            acts = [lambda: goals.after(lambda: socket.send(press)), lambda: goals.after(lambda: bare.send(goal))]
            ours, reference = interleave(acts, ROUNDS, WARM_UP)
        surplus = 1e3 * (ours.median - reference.median)
        return Figures.compared(ours, reference, scale=1e3, note=f"{surplus:.1f} ms over it; at most 30 are promised")


class ConsoleStop(Row):
    """From the stop to the end of a goal, with twenty pages open."""

    name = "console_stop"
    subject = f"stop of the console with {PAGES} pages open, to the cancel at the server"
    unit = "ms"
    bound = at_most(100.0)

    def measure(self, stack: Stack) -> Figures:
        """Stop a long goal again and again."""
        from actionlib_msgs.msg import GoalID

        bare = stack.lights_client
        with ExitStack() as held:
            console = ConsoleUnderTest(held)
            for _ in range(PAGES):
                console.page("/wizard")
                console.socket("/console/live")
            bare.send(bare.goal("fade", LONG))
            cancels = Arrivals(f"{LIGHTS}/cancel", GoalID)
            held.callback(cancels.close)
            (times,) = interleave([lambda: cancels.after(console.stop)], STOPS, WARM_UP)
            most = resident_kib(console.program.pid, "VmRSS") / MIB
        note = f"the longest {1e3 * max(times.seconds):.0f} ms; {most:.0f} MiB resident"
        return Figures(1e3 * times.median, note=note)


class ConsoleMemory(Row):
    """Resident memory of a console that nobody looks at."""

    name = "console_memory"
    subject = "resident memory of the console, no page open"
    unit = "MiB"
    bound = at_most(120.0)

    def measure(self, stack: Stack) -> Figures:
        """Start it on the stack's ROS master, and read its account."""
        stack.start_ros()
        with ExitStack() as held:
            return Figures(resident_kib(ConsoleUnderTest(held).program.pid, "VmRSS") / MIB)


CONSOLE: tuple[Row, ...] = (ConsolePress(), ConsoleStop(), ConsoleMemory())
