"""Who gets into the console, and who of those moves the robot."""

from __future__ import annotations

import asyncio
import stat
import threading
import time
from contextlib import suppress
from dataclasses import replace
from types import SimpleNamespace

import pytest
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from nao_library_modules.console.access.connections import address_group
from nao_library_modules.console.access.guard import COOKIE, LARGEST, SESSION, Guard
from nao_library_modules.console.access.sessions import (
    LONGEST,
    MOST_WAITING,
    OBSERVER,
    OPERATOR,
    TRIES,
    TRY_PERIOD,
    Controls,
    Logins,
    Session,
    SessionFile,
    Sessions,
    add_user,
    hashed,
    read_users,
)
from nao_library_modules.console.app import ConsoleSettings
from nao_library_modules.studies.commands import ConsoleFileError
from naoqi.errors import NaoError

HERE = "127.0.0.1:8080"
ORIGIN = f"http://{HERE}"
LIMIT = 60.0


async def behind(scope, receive, send):
    """What is behind the guard: says whose request it is, or how much of it came."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    size, more = 0, True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            raise RuntimeError("No response returned.")
        size += len(message["body"])
        more = message.get("more_body", False)
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": f"{scope[SESSION].name} {size}".encode()})


class Door:
    """A guard, called as a browser would."""

    def __init__(self, sessions, hosts=("127.0.0.1",)):
        self.guard = Guard(behind, sessions, hosts)

    def ask(self, path="/", method="GET", kind="http", cookie="", host=HERE, origin=None, bodies=(b"",), leaves=False):
        """Returns the messages of the answer."""
        headers = [(b"host", host.encode())]
        headers += [(b"cookie", f"{COOKIE}={cookie}".encode())] if cookie else []
        headers += [(b"origin", origin.encode())] if origin else []
        path, _, query = path.partition("?")
        scope = {"type": kind, "method": method, "path": path, "query_string": query.encode(), "headers": headers}
        last = len(bodies) - 1
        messages = [{"type": "http.request", "body": b, "more_body": i < last} for i, b in enumerate(bodies)]
        messages = [{"type": "http.disconnect"}] if leaves else messages
        told = []

        async def receive():
            return messages.pop(0)

        async def send(message):
            told.append(message)

        asyncio.run(self.guard(scope, receive, send))
        return told

    def status(self, *arguments, **options):
        return self.ask(*arguments, **options)[0]["status"]


def header(told, name):
    return dict(told[0]["headers"])[name.encode()].decode()


@pytest.fixture
def sessions():
    return Sessions()


@pytest.fixture
def door(sessions):
    return Door(sessions)


@pytest.fixture
def operator(sessions):
    return sessions.by_token(sessions.tokens[OPERATOR])


def test_without_a_token_nobody_gets_in(door):
    assert door.status("/") == 401
    assert door.status("/?token=guess") == 401
    assert door.status("/console/static/frame.js", cookie="guess") == 401


@pytest.mark.parametrize("role", [OPERATOR, OBSERVER])
def test_a_token_makes_a_session_of_its_role_and_leaves_the_address(door, sessions, role):
    told = door.ask(f"/wizard?robot=nao1&token={sessions.tokens[role]}")
    assert told[0]["status"] == 303 and header(told, "location") == "/wizard?robot=nao1"
    cookie = header(told, "set-cookie")
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    assert sessions.get(cookie.partition("=")[2].partition(";")[0]).role == role


def test_a_token_sends_nobody_to_another_page(door, sessions):
    told = door.ask(f"//evil.org/\\evil.org?token={sessions.tokens[OPERATOR]}")
    location = header(told, "location")
    assert location.startswith("/") and location[1] not in "/\\"


def test_requests_of_other_pages_are_refused(door, operator):
    assert door.status("/", cookie=operator.key, origin=ORIGIN) == 200
    assert door.status("/console/stop", "POST", cookie=operator.key, origin="http://evil.org") == 403
    assert door.status("/", cookie=operator.key, host="evil.org:8080") == 403


@pytest.mark.parametrize(
    "options, accepted",
    [({"origin": ORIGIN}, True), ({"origin": "http://evil.org"}, False), ({}, False), ({"origin": "null"}, False)],
)
def test_a_websocket_comes_from_the_console_itself(door, operator, options, accepted):
    (told,) = door.ask(kind="websocket", cookie=operator.key, **options)
    assert told["type"] == ("websocket.accept" if accepted else "websocket.close")


@pytest.mark.parametrize("reads", [False, True], ids=["answered", "read"])
def test_a_websocket_whose_browser_has_left_ends_without_an_error(sessions, operator, reads):
    ended = []

    async def answers(scope, receive, _):
        async def send(_):
            raise OSError("gone")

        socket = WebSocket(scope, receive, send)
        socket.client_state = socket.application_state = WebSocketState.CONNECTED
        try:
            with suppress(WebSocketDisconnect if reads else ()):
                await socket.send_text("to nobody")
            await socket.receive_text()
        finally:
            ended.append(True)

    door = Door(sessions)
    door.guard.app = answers
    assert door.ask(kind="websocket", cookie=operator.key, origin=ORIGIN) == [] and ended


def test_a_websocket_without_a_session_is_closed(door):
    (told,) = door.ask(kind="websocket", origin=ORIGIN)
    assert told["type"] == "websocket.close"


def test_uploads_have_a_limit_whatever_they_say_of_their_size(door, operator):
    half = bytes(LARGEST // 2 + 1)
    assert door.ask(method="POST", cookie=operator.key, bodies=(half,))[1]["body"] == b"operator %d" % len(half)
    assert door.status(method="POST", cookie=operator.key, bodies=(half, half)) == 413


def test_a_browser_that_leaves_is_no_error(door, operator):
    assert door.ask(cookie=operator.key, leaves=True) == []


@pytest.fixture
def people(tmp_path):
    add_user(tmp_path / "people.yaml", "ann", OPERATOR, "long enough")
    return tmp_path / "people.yaml"


def test_people_log_in_with_their_password(people):
    door = Door(Sessions(read_users(people)), hosts=())
    form = lambda word: (f"name=ann&password={word}".encode(),)  # noqa: E731
    assert door.status("/") == 401
    assert door.status("/login", "POST", bodies=form("wrong")) == 403
    told = door.ask("/login", "POST", bodies=form("long+enough"))
    key = header(told, "set-cookie").partition("=")[2].partition(";")[0]
    assert door.ask(cookie=key)[1]["body"] == b"ann 0"
    assert header(door.ask("/logout", cookie=key), "location") == "/" and door.status(cookie=key) == 401


def test_passwords_are_hashed_in_a_file_of_its_owner(people):
    assert "long enough" not in people.read_text() and stat.S_IMODE(people.stat().st_mode) == 0o600
    with pytest.raises(NaoError, match="8 characters at least"):
        add_user(people, "bob", OBSERVER, "short")


@pytest.mark.parametrize("password", ["scrypt$A$A", "scrypt$$", "scrypt$AAAA", "plain"])
def test_who_has_no_hash_that_can_be_read_is_refused_with_the_file(tmp_path, password):
    path = tmp_path / "people.yaml"
    path.write_text(f"ann:\n  role: operator\n  password: {password}\n")
    with pytest.raises(ConsoleFileError, match=r"ann.password \(line 3\): no hash"):
        read_users(path)


def test_a_file_of_people_without_hashes_is_refused_with_its_lines(tmp_path):
    path = tmp_path / "people.yaml"
    path.write_text("ann:\n  role: king\n  password: plain\n")
    with pytest.raises(ConsoleFileError, match=r"ann.role \(line 2\): 'king'.*ann.password \(line 3\): no hash"):
        read_users(path)


@pytest.mark.parametrize("content", [b"\xff\xfe", b"[" * 9999, b"ann: [1e999]", None])
def test_a_file_of_people_that_cannot_be_read_lets_in_nobody_and_stays(tmp_path, content):
    path = tmp_path / "people.yaml"
    path.mkdir() if content is None else path.write_bytes(content)
    with pytest.raises(ConsoleFileError, match="people.yaml"):
        read_users(path)
    assert path.is_dir() if content is None else path.read_bytes() == content


def test_who_guesses_is_not_listened_to_for_a_while(people):
    now = [0.0]
    sessions = Sessions(read_users(people), clock=lambda: now[0])
    assert not any(sessions.by_password("ann", "wrong") for _ in range(TRIES))
    assert sessions.by_password("ann", "long enough") is None
    now[0] += TRY_PERIOD + 1.0
    assert sessions.by_password("ann", "long enough").operator


def tries(sessions, source, count=TRIES):
    return [sessions.by_password("ann", "wrong", source) for _ in range(count)]


def test_who_guesses_at_another_address_locks_nobody_out(people):
    sessions = Sessions(read_users(people))
    tries(sessions, sessions.source_of("ann", "10.0.0.9", ""))
    assert sessions.by_password("ann", "long enough", sessions.source_of("ann", "10.0.0.7", "")).name == "ann"


def test_a_browser_that_has_logged_in_has_tries_of_its_own(people):
    first, other = Sessions(read_users(people)), Sessions(read_users(people))  # the console was started anew
    device = first.device_of(first.by_password("ann", "long enough"))
    tries(other, other.source_of("ann", "10.0.0.7", ""))
    assert other.by_password("ann", "long enough", other.source_of("ann", "10.0.0.7", "")) is None
    assert other.by_password("ann", "long enough", other.source_of("ann", "10.0.0.7", device)).name == "ann"


@pytest.mark.parametrize("device", ["guess", "guess.", "12ab.cd34", "ä.ö"])
def test_a_browser_cannot_say_of_itself_that_it_is_known(people, device):
    sessions = Sessions(read_users(people))
    assert sessions.source_of("ann", "10.0.0.7", device) == sessions.source_of("ann", "10.0.0.7", "")


@pytest.mark.parametrize(
    "address, group",
    [
        ("10.0.0.7", "10.0.0.7"),
        ("::ffff:10.0.0.7", "10.0.0.7"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("fe80::1%eth0", "fe80::/64"),
        ("", ""),
    ],
)
def test_a_host_that_has_many_addresses_is_one(address, group):
    assert address_group(address) == group


def test_the_tries_of_a_source_wait_for_each_other_and_not_for_those_of_others():
    asked, go = [], threading.Event()

    class SlowSessions:
        def source_of(self, name, address, device):
            return address

        def by_password(self, name, password, source):
            asked.append(password)
            assert source == "here" or go.wait(LIMIT)
            return password

    async def log_in():
        logins = Logins(SlowSessions())
        flood = [asyncio.ensure_future(logins.by_password("ann", i, "there", "")) for i in range(100)]
        mine = await asyncio.wait_for(logins.by_password("ann", "mine", "here", ""), LIMIT)
        during = list(asked)
        go.set()
        return mine, during, await asyncio.gather(*flood)

    mine, during, flood = asyncio.run(log_in())
    assert (mine, sorted(map(str, during))) == ("mine", ["0", "mine"])
    assert flood == [*range(MOST_WAITING), *[None] * (100 - MOST_WAITING)]


def test_beyond_this_computer_people_need_a_password():
    with pytest.raises(NaoError, match="--users"):
        ConsoleSettings(listen="0.0.0.0")
    assert ConsoleSettings(listen="127.0.0.1").url == "http://127.0.0.1:8080/"


@pytest.fixture
def two():
    return Session("ann", OPERATOR), Session("bob", OPERATOR)


def test_the_first_operator_who_moves_the_robot_holds_it_until_another_takes_over(two):
    ann, bob = two
    controls = Controls()
    assert controls.may_move("/", ann) and not controls.may_move("/", bob)
    assert controls.may_move("/nao2/", bob)
    assert controls.take("/", bob) and controls.may_move("/", bob) and not controls.may_move("/", ann)
    assert "bob holds the controls" in controls.refusal("/", ann)


def test_observers_never_move_the_robot(two):
    controls, observer = Controls(), Session("eve", OBSERVER)
    assert not controls.may_move("/", observer) and not controls.take("/", observer)
    assert controls.may_move("/", two[0])


def test_controls_are_free_when_the_last_page_of_their_holder_is_gone(two):
    ann, bob = two
    controls = Controls()
    pages = [controls.enter(ann, "/"), controls.enter(ann, "/"), controls.enter(bob, "/")]
    controls.take("/", ann)
    assert controls.visitors("/") == [ann, bob]
    pages[0]()
    assert controls.holder("/") is ann
    pages[1]()
    assert controls.holder("/") is None and controls.visitors("/") == [bob]


# --- sessions that survive their console ------------------------------------------------------------------------------


@pytest.fixture
def kept(tmp_path):
    """The file of the sessions, and what makes a console's sessions of it, as after a restart."""

    def restarted(users=None, clock=time.time):
        file = SessionFile(path, clock)
        made = Sessions(users)
        made.keep_in(file)
        files.append(file)
        return made

    def written():
        assert all(file.wait(LIMIT) for file in files)
        return path

    files, path = [], tmp_path / "ros" / "sessions.json"
    return SimpleNamespace(restarted=restarted, written=written, path=path)


def test_a_browser_is_known_to_the_restarted_console_with_its_role(kept):
    first = kept.restarted()
    made = [first.by_token(first.tokens[role]) for role in (OPERATOR, OBSERVER)]
    kept.written()
    again = kept.restarted()
    found = [again.get(each.key) for each in made]
    assert [(each.name, each.role) for each in found] == [(each.name, each.role) for each in made]
    assert again.by_token(again.tokens[OPERATOR]).name not in {each.name for each in made}


def test_only_its_owner_can_read_the_sessions(kept):
    first = kept.restarted()
    first.by_token(first.tokens[OPERATOR])
    assert stat.S_IMODE(kept.written().stat().st_mode) == 0o600


def test_who_has_logged_out_is_not_known_after_a_restart(kept):
    first = kept.restarted()
    session = first.by_token(first.tokens[OPERATOR])
    first.end(session)
    kept.written()
    assert kept.restarted().get(session.key) is None


def test_a_session_of_another_day_is_not_known_after_a_restart(kept):
    first = kept.restarted()
    session = first.by_token(first.tokens[OPERATOR])
    kept.written()
    assert kept.restarted(clock=lambda: session.began + LONGEST + 1.0).get(session.key) is None


def test_a_person_is_known_after_a_restart_with_the_role_of_now_and_not_with_another_password(kept, people):
    session = kept.restarted(read_users(people)).by_password("ann", "long enough")
    kept.written()
    users = read_users(people)
    assert kept.restarted(users).get(session.key).operator
    demoted = {"ann": replace(users["ann"], role=OBSERVER)}
    assert not kept.restarted(demoted).get(session.key).operator
    changed = {"ann": replace(users["ann"], password=hashed("another one"))}
    assert [kept.restarted(each).get(session.key) for each in (changed, {}, None)] == [None, None, None]


def test_who_had_a_token_is_not_known_where_people_log_in(kept, people):
    first = kept.restarted()
    session = first.by_token(first.tokens[OPERATOR])
    kept.written()
    assert kept.restarted(read_users(people)).get(session.key) is None


ONE = '[{"key": "k", "name": "operator", "role": "operator", "proof": "", "began": %f}]'


@pytest.mark.parametrize("text", ["", "{", "[1]", "3", '[{"key": "k"}]', ONE.replace('"k"', "7") % 1.0, "[" * 10_000])
def test_a_file_that_is_none_of_the_consoles_lets_in_nobody_and_is_put_aside(kept, text):
    kept.path.parent.mkdir()
    kept.path.touch(0o600)
    kept.path.write_text(text)
    assert kept.restarted().get("k") is None
    assert not kept.path.exists() and kept.path.with_name("sessions.json.broken").read_text() == text


@pytest.mark.parametrize("mode, known", [(0o600, True), (0o660, False), (0o644, False)])
def test_sessions_that_others_may_have_read_or_written_are_not_believed(kept, mode, known):
    kept.path.parent.mkdir()
    kept.path.write_text(ONE % time.time())
    kept.path.chmod(mode)
    assert (kept.restarted().get("k") is not None) == known
