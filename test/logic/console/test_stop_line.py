"""The stop comes through whatever pages do, and strangers have few connections."""

from __future__ import annotations

import asyncio
import json
import socket
import threading
import time
from types import SimpleNamespace

import pytest

from nao_library_modules.console.access.connections import (
    BURST,
    OF_ADDRESS,
    OF_SESSION,
    PATIENCE,
    STRANGERS,
    Connections,
    CountedListener,
    console_time,
)
from nao_library_modules.console.access.guard import COOKIE, Guard
from nao_library_modules.console.access.sessions import OBSERVER, OPERATOR, Sessions
from nao_library_modules.console.app import PATH, PageLoop, StopLine
from nao_library_modules.console.robots.robot_goals import STOPPED, STOPPING, LastStop, Run
from nao_library_modules.console.view.background import Lane
from nao_library_modules.studies.commands import NotThere

LIMIT = 60.0
HERE = "127.0.0.1:8080"


class FakeRobots:
    """One robot, whose stops are counted."""

    def __init__(self):
        self.stops = []
        self._robot = SimpleNamespace(name="nao1", stop=self.stops.append, stop_state="stopping")

    def known(self, name):
        return self._robot if name == "nao1" else None

    def robot(self, name):
        if name not in ("", "nao1"):
            raise NotThere(f"there is no robot {name!r}")
        return self._robot


@pytest.fixture
def robots():
    return FakeRobots()


@pytest.fixture
def sessions():
    return Sessions()


async def ask(app, session, path, method="GET", told=(), kind="http"):
    """The messages that an application answers with. `told`: what comes on a WebSocket."""
    path, _, query = path.partition("?")
    headers = [(b"host", HERE.encode()), (b"cookie", f"{COOKIE}={session.key}".encode())]
    headers += [(b"origin", f"http://{HERE}".encode())]
    scope = {"type": kind, "method": method, "path": path, "query_string": query.encode(), "headers": headers}
    coming = [{"type": "websocket.receive", "text": text} for text in told]
    coming = [{"type": "websocket.connect"}, *coming, {"type": "websocket.disconnect"}]
    coming = [{"type": "http.request", "body": b""}] if kind == "http" else coming
    answers = []

    async def receive():
        return coming.pop(0)

    async def send(message):
        answers.append(message)

    await asyncio.wait_for(app(scope, receive, send), LIMIT)
    return answers


def guard_of(robots, sessions, pages=None, answers=lambda: True):
    return Guard(pages, sessions, ("127.0.0.1",), own={PATH: StopLine(robots, sessions, answers)})


def told_by(message):
    return json.loads(message["text"])


def test_a_stop_comes_through_while_a_page_holds_up_all_others(robots, sessions):
    held, go, ended = threading.Event(), threading.Event(), []
    operator = sessions.by_token(sessions.tokens[OPERATOR])

    async def page(scope, receive, send):
        held.set()
        ended.append(go.wait(LIMIT))
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": (await receive())["body"]})

    async def run():
        pages = PageLoop(page)
        guard = guard_of(robots, sessions, pages)
        loading = asyncio.ensure_future(ask(guard, operator, "/"))
        await asyncio.get_running_loop().run_in_executor(None, held.wait, LIMIT)
        stopped = await ask(guard, operator, f"{PATH}?robot=nao1", "POST")
        before = list(ended)
        go.set()
        loaded = await loading
        pages.close()
        return stopped[0]["status"], before, loaded[0]["status"]

    assert asyncio.run(run()) == (200, [], 200)
    assert robots.stops == ["operator"] and ended == [True]


def test_a_stop_that_is_sent_on_both_ways_is_carried_out_once(robots, sessions):
    operator = sessions.by_token(sessions.tokens[OPERATOR])

    async def run():
        guard = guard_of(robots, sessions)
        words = [json.dumps({"robot": "nao1", "id": each}) for each in ("a", "b")]
        line = await ask(guard, operator, PATH, told=words, kind="websocket")
        return line, await ask(guard, operator, f"{PATH}?robot=nao1&id=b", "POST")

    line, request = asyncio.run(run())
    told = {"stopped": "nao1", "state": "stopping"}
    answers = [each for each in map(told_by, line[1:]) if "id" in each]
    assert answers == [{"id": each, **told} for each in "ab"]
    assert json.loads(request[1]["body"]) == told and robots.stops == ["operator", "operator"]


@pytest.mark.parametrize("told", ["", "{", "[]", "1", '{"robot": "nao1"}', "x" * 10_000])
def test_a_line_that_brings_nonsense_is_closed(robots, sessions, told):
    operator = sessions.by_token(sessions.tokens[OPERATOR])
    answers = asyncio.run(ask(guard_of(robots, sessions), operator, PATH, told=[told], kind="websocket"))
    assert answers[-1]["type"] == "websocket.close" and not robots.stops


def status_of_stop(robots, sessions, session, robot="nao1"):
    line = StopLine(robots, sessions)
    app = lambda scope, *more: line({**scope, "nao_session": session}, *more)  # noqa: E731
    return asyncio.run(ask(app, session, f"{PATH}?robot={robot}", "POST"))[0]["status"]


def test_who_looks_on_may_stop_a_robot_and_the_robot_is_told_who(robots, sessions):
    observer = sessions.by_token(sessions.tokens[OBSERVER])
    assert status_of_stop(robots, sessions, observer) == 200 and robots.stops == ["observer"]


def test_who_has_logged_out_stops_nothing(robots, sessions):
    operator = sessions.by_token(sessions.tokens[OPERATOR])
    assert status_of_stop(robots, sessions, operator, "nao7") == 404
    sessions.end(operator)
    assert status_of_stop(robots, sessions, operator) == 403 and not robots.stops


async def first_beats(robots, sessions, count=1, answers=lambda: True):
    """What a page hears that says nothing."""
    operator, heard, enough = sessions.by_token(sessions.tokens[OPERATOR]), [], asyncio.Event()

    async def receive():
        if heard:
            await enough.wait()
            return {"type": "websocket.disconnect"}
        heard.append({})
        return {"type": "websocket.connect"}

    async def send(message):
        if "text" in message:
            heard.append(told_by(message))
        if len(heard) > count:
            enough.set()

    headers = [(b"host", HERE.encode()), (b"cookie", f"{COOKIE}={operator.key}".encode())]
    headers += [(b"origin", f"http://{HERE}".encode())]
    scope = {"type": "websocket", "path": PATH, "query_string": b"robot=nao1", "headers": headers}
    await asyncio.wait_for(guard_of(robots, sessions, answers=answers)(scope, receive, send), LIMIT)
    return heard[1:]


def test_a_page_hears_that_the_console_lives_and_how_far_its_stop_is(robots, sessions):
    first, second = asyncio.run(first_beats(robots, sessions, 2))
    assert first["beat"] < second["beat"] <= console_time() and first["console"] == second["console"]
    assert (first["pages"], first["state"]) == (True, "stopping")


def test_a_page_hears_of_a_loop_of_pages_that_hangs(robots, sessions):
    async def page(scope, receive, send):
        held.set()
        go.wait(LIMIT)

    held, go = threading.Event(), threading.Event()
    pages = PageLoop(page)
    assert pages.answers()
    looked = threading.Thread(target=lambda: asyncio.run(pages({}, None, None)))
    looked.start()
    held.wait(LIMIT)
    deadline = time.monotonic() + LIMIT
    while pages.answers() and time.monotonic() < deadline:
        held.wait(0.01)
    (beat,) = asyncio.run(first_beats(robots, sessions, answers=pages.answers))
    go.set()
    looked.join(LIMIT)
    pages.close()
    assert beat["pages"] is False


def test_work_for_pages_keeps_one_thread_busy():
    running, most, lock = 0, 0, threading.Lock()

    def work():
        nonlocal running, most
        with lock:
            running += 1
            most = max(most, running)
        with lock:
            running -= 1

    async def run():
        lane = Lane()
        await asyncio.gather(*(lane.do(work) for _ in range(50)))

    asyncio.run(run())
    assert most == 1


def test_work_of_pages_pauses_as_long_as_it_takes():
    times = []

    def work():
        times.append(time.monotonic())
        time.sleep(0.05)
        times.append(time.monotonic())

    async def run():
        lane = Lane()
        await lane.do(work)
        await lane.do(work)

    asyncio.run(run())
    began, ended, again, _ = times
    assert again - ended >= ended - began


# --- the state of a stop ----------------------------------------------------------------------------------------------


def test_a_stop_is_over_when_what_ran_and_its_own_steps_are():
    last, run = LastStop(), Run("1", "/", "NaoMotion", ["walk"], "walk", "ann", 0.0)
    assert last.state([run]) == ""
    done = []
    steps = last.begin([run], lambda: done.append("walk"), lambda: done.append("others"))
    states = [last.state([run])]
    for step in steps:
        step()
        states.append(last.state([run]))
    assert states == [STOPPING] * 3 and done == ["walk", "others"]
    assert last.state([]) == STOPPED


def test_a_stop_is_past_when_something_begins():
    last, later = LastStop(), Run("2", "/", "NaoMotion", ["walk"], "walk", "ann", 0.0)
    last.begin([])
    assert last.state([later]) == "" and last.state([]) == ""
    last.begin([])
    last.has_begun()
    assert last.state([]) == ""


def test_a_step_of_a_stop_that_fails_is_over():
    last = LastStop()

    def fails():
        raise OSError

    (step,) = last.begin([], fails)
    with pytest.raises(OSError):
        step()
    assert last.state([]) == STOPPED


# --- connections ------------------------------------------------------------------------------------------------------


class FakeSocket:
    """A connection; `waits`: whether something has come on it that was not read."""

    def __init__(self, waits=False):
        self.open, self.waits = True, waits

    def fileno(self):
        return 7 if self.open else -1

    def recv(self, *_):
        if not self.waits:
            raise BlockingIOError
        return b"G"

    def shutdown(self, _):
        self.open = False


class Crowd:
    """Connections that come to a listener, with a clock that stands."""

    def __init__(self):
        self.now = 0.0
        self.connections = Connections(lambda: self.now)
        self._port = 0

    def come(self, address="10.0.0.9", waits=False):
        """One more; its peer and its socket."""
        self._port += 1
        peer, made = (address, self._port), FakeSocket(waits)
        self.connections.add(peer, made)
        return peer, made


def crowded(test):
    """The event loop for a test that has a crowd."""

    async def run():
        test(Crowd())

    def called():
        asyncio.run(run())

    called.__name__ = test.__name__
    return called


@crowded
def test_strangers_of_an_address_have_few_connections_and_the_newest_gets_in(crowd):
    made = [crowd.come()[1] for _ in range(1200)]
    assert [each.open for each in made] == [False] * (1200 - OF_ADDRESS) + [True] * OF_ADDRESS


@crowded
def test_strangers_of_many_addresses_have_few_as_well(crowd):
    mine, made = crowd.come("10.0.0.7")
    for i in range(1200):
        crowd.come(f"10.0.1.{i % 40}")
    assert crowd.connections.strangers == STRANGERS and made.open


@crowded
def test_who_asks_at_this_moment_stays_though_others_come(crowd):
    _, made = crowd.come(waits=True)
    for _ in range(1200):
        crowd.come()
    assert made.open


@crowded
def test_a_visitor_is_no_stranger(crowd):
    peer, made = crowd.come()
    assert crowd.connections.admit(peer, "session")
    for _ in range(1200):
        crowd.come()
    crowd.now += PATIENCE
    crowd.connections.sweep()
    assert made.open and crowd.connections.admit(peer, "session")


@crowded
def test_a_silent_stranger_is_closed_after_a_while_and_one_that_asks_later(crowd):
    (_, silent), (peer, asking) = crowd.come(), crowd.come()
    crowd.now += 0.9 * PATIENCE
    crowd.connections.heard(peer)
    crowd.now += 0.2 * PATIENCE
    crowd.connections.sweep()
    assert (silent.open, asking.open) == (False, True)


@crowded
def test_a_session_has_room_for_many_pages_and_not_for_all(crowd):
    admitted = [crowd.connections.admit(crowd.come()[0], "session") for _ in range(OF_SESSION + 5)]
    assert admitted == [True] * OF_SESSION + [False] * 5
    assert crowd.connections.admit(crowd.come()[0], "another")


def test_a_flood_of_connections_leaves_the_loop_time_for_others():
    with CountedListener.on("127.0.0.1", 0) as listener:
        listener.setblocking(False)
        callers = [socket.create_connection(listener.getsockname()) for _ in range(BURST + 1)]
        taken = [listener.accept()[0] for _ in range(BURST)]
        with pytest.raises(BlockingIOError):
            listener.accept()
        taken.append(listener.accept()[0])
        for each in (*callers, *taken):
            each.close()
