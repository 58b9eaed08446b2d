"""Pages of the console as their WebSockets, without a browser; and attacks on a console."""

from __future__ import annotations

import html
import json
import os
import re
import resource
import signal
import socket
import threading
import time
import urllib.request
from contextlib import ExitStack, contextmanager, suppress
from urllib.parse import urlencode
from xmlrpc.client import ServerProxy

import yaml
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from nao_sim_bridge.testing import wait_until

LIMIT = 300.0
"""s of this computer for whatever is waited for."""


class Visitor:
    """Somebody with a session, and what this person opens. `url`: an address with a token in it."""

    def __init__(self, url):
        self.base = url.partition("/?")[0]
        jar = urllib.request.HTTPCookieProcessor()
        self.open = urllib.request.build_opener(jar).open
        self.open(url.replace("/?", "/console/static/frame.js?"), timeout=LIMIT).read()
        self.cookie = "; ".join(f"{each.name}={each.value}" for each in jar.cookiejar)

    def get(self, path, **options):
        return self.open(urllib.request.Request(f"{self.base}{path}", **options), timeout=LIMIT).read()

    def socket(self, path):
        """A WebSocket of the console."""
        address = self.base.replace("http", "ws", 1) + path
        headers = {"Cookie": self.cookie}
        made = connect(
            address, origin=self.base, additional_headers=headers, proxy=None, open_timeout=LIMIT, ping_interval=None,
            max_queue=None,  # it reads on, as a browser does: behind frames that nobody takes no end of it is heard of
        )  # fmt: skip
        return made.__enter__()  # whoever has it closes it


class Page:
    """One page, connected; what it is told is kept in `told`."""

    def __init__(self, visitor, path):
        text = visitor.get(path).decode()
        found = re.search(r"parseElements\(String\.raw`(.*?)`\)", text, re.S)[1]
        self._elements = json.loads(html.unescape(found))
        query = yaml.safe_load(re.search(r"^ *query: (\{.*\}),$", text, re.M)[1])
        self.client = query["client_id"]
        query = {**query, "implicit_handshake": "true", "tab_id": self.client, "document_id": self.client}
        path = f"/_nicegui_ws/socket.io/?{urlencode({'EIO': 4, 'transport': 'websocket', **query})}"
        self._socket = visitor.socket(path)
        self._socket.recv(LIMIT)
        self._socket.send("40")
        answer = self._socket.recv(LIMIT)
        assert answer.startswith("40"), answer
        self.told = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        with suppress(ConnectionClosed):
            for message in self._socket:
                if message == "2":
                    self._socket.send("3")
                else:
                    self._take(message)

    def _take(self, message):
        self.told.append(message)
        if message.startswith('42["update"'):
            for number, element in json.loads(message[2:])[1].items():
                if number != "_id":
                    self._elements[number] = element or {}

    def element(self, **props):
        """Wait for the element that has these properties, and give its id; `text` is what it shows."""
        found = []

        def there():
            for number, element in list(self._elements.items()):
                kept = {"text": element.get("text"), **element.get("props", {})}
                if all(kept.get(name) == value for name, value in props.items()):
                    found.append(int(number))
            return bool(found)

        wait_until(there, LIMIT, f"an element with {props}")
        return found[-1]

    def event(self, element, kind, *arguments):
        """Something happens to an element, as the browser tells it."""
        (listener,) = [each for each in self._elements[str(element)]["events"] if each["type"] == kind]
        event = {"id": element, "client_id": self.client, "listener_id": listener["listener_id"]}
        self._socket.send("42" + json.dumps(["event", {**event, "args": [json.dumps(each) for each in arguments]}]))

    def type(self, text, **props):
        self.event(self.element(**props), "update:value", text)

    def write(self, text, label):
        """Replace all of a text in an editor of code."""
        number = self.element(**{"aria-label": label})
        before = len(self._elements[str(number)]["props"]["value"] or "")
        self.event(number, "update:value", {"sections": [before, len(text)], "inserted": [text.split("\n")]})
        self._elements[str(number)]["props"]["value"] = text

    def click(self, label):
        self.event(self.element(label=label), "click", {})

    def close(self):
        self._socket.close()


class StopLine:
    """The line of a page's stop."""

    def __init__(self, visitor):
        self._socket = visitor.socket("/console/stop")
        self._count = 0

    def stop(self, robot="/"):
        """Stop a robot; the answer, which comes between beats of the console."""
        self._count += 1
        self._socket.send(json.dumps({"robot": robot, "id": str(self._count)}))
        while True:
            answer = json.loads(self._socket.recv(LIMIT))
            if answer.get("id") == str(self._count):
                return answer

    def close(self):
        self._socket.close()


def post_stop(visitor, robot="/"):
    """As the key Escape does it, on a connection of its own."""
    visitor.get(f"/console/stop?robot={robot}", method="POST")


# --- attacks ----------------------------------------------------------------------------------------------------------


@contextmanager
def pasted_yaml(observer, characters=270_000):
    """An observer pastes a long protocol and has it checked, again and again; gives how often that was answered."""
    steps = "      - {say: Please touch my head and wait, animated: true, label: l%d}\n"
    text = "name: long\nphases:\n  - phase: Task\n    steps:\n"
    text += "".join(steps % i for i in range((characters - len(text)) // len(steps)))
    page = Page(observer, "/study?robot=/")
    over = threading.Event()

    def paste():
        count = 0
        while not over.wait(0.2):
            count += 1
            with suppress(ConnectionClosed):
                page.write(f"{text}# {count}\n", "Protocol")
                page.click("Check")

    thread = threading.Thread(target=paste, daemon=True)
    thread.start()
    try:
        yield lambda: sum("The protocol cannot be run" in each or "Nothing wrong" in each for each in list(page.told))
    finally:
        over.set()
        thread.join(LIMIT)
        page.close()


@contextmanager
def hanging_master(master, visitor, paths):
    """The ROS master, a process of the test, does not answer, while pages are opened. `paths`: of these."""

    def look(path):
        with suppress(OSError):  # it may answer with an error, or late
            visitor.get(path)

    with stopped(master):
        for path in paths:
            threading.Thread(target=look, args=(path,), daemon=True).start()
        time.sleep(1.0)  # the requests are there, and whatever they hold up is held up
        yield


@contextmanager
def stopped(process):
    """A process that does nothing meanwhile."""
    os.kill(process, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(process, signal.SIGCONT)


@contextmanager
def begun_trial(master, visitor):
    """Somebody begins a trial while the master hangs. There are pages that look at trials."""
    page = Page(visitor, "/study?robot=/&protocol=ten_steps&participant=P01")
    with stopped(master):
        page.click("Start trial")
        time.sleep(1.0)
        try:
            yield
        finally:
            page.close()


@contextmanager
def idle_connections(port, count=1200, address="127.0.0.1"):
    """A stranger connects again and again, and says nothing."""
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    held, over, there = [], threading.Event(), threading.Event()

    def come():
        while not over.is_set():
            while len(held) >= count:
                there.set()
                held.pop(0).close()
                if over.wait(0.02):
                    return
            with suppress(OSError):  # a stranger who is closed comes again
                held.append(socket.create_connection(("127.0.0.1", port), LIMIT, source_address=(address, 0)))

    thread = threading.Thread(target=come, daemon=True)
    thread.start()
    assert there.wait(LIMIT), f"{len(held)} connections"
    try:
        yield
    finally:
        over.set()
        thread.join(LIMIT)
        for each in held:
            each.close()


def is_sent_here(topic, publisher=""):
    """Whether all publishers of a topic send it to this node, one of this name's beginning among them.

    A subscriber that counts its connections does not know whether their publishers do: what comes just then is lost.
    """
    import rosgraph
    import rospy

    master = rosgraph.Master("/tests")
    nodes = dict(master.getSystemState()[0]).get(topic, [])

    def sends(node):
        _, _, connections = ServerProxy(master.lookupNode(node)).getBusInfo("/tests")
        return any((to, way, name) == (rospy.get_name(), "o", topic) for _, to, way, _, name, *_ in connections)

    return any(node.startswith(publisher) for node in nodes) and all(map(sends, nodes))


class StopWatch:
    """Times from a stop to its cancel at a server, s. `topic`: of the cancels."""

    def __init__(self, topic="NaoLights/cancel"):
        import rospy
        from actionlib_msgs.msg import GoalID

        self._came = threading.Event()
        self._stamp = 0.0
        self._subscriber = rospy.Subscriber(topic, GoalID, self._take, tcp_nodelay=True)
        full = rospy.resolve_name(topic)
        wait_until(lambda: is_sent_here(full, "/nao_console"), LIMIT, f"the console at {topic}")

    def _take(self, _):
        self._stamp = time.monotonic()
        self._came.set()

    def measure(self, stop):
        """Carry out a stop; s until the first cancel."""
        self._came.clear()
        began = time.monotonic()
        stop()
        assert self._came.wait(LIMIT), "no cancel comes"
        return self._stamp - began

    def close(self):
        self._subscriber.unregister()


@contextmanager
def opened_pages(visitor, paths, count=20):
    """So many pages, each with its WebSockets."""
    with ExitStack() as held:
        for i in range(count):
            held.callback(Page(visitor, paths[i % len(paths)]).close)
            held.callback(visitor.socket("/console/live?robot=/").close)
            held.callback(StopLine(visitor).close)
        yield
