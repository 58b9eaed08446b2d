"""Ctrl-C and the time limit while a goal is on its way and while it ends; the master and services over sockets."""

from __future__ import annotations

import os
import signal
import socket
import struct
import subprocess
import sys
import threading
from io import BytesIO
from pathlib import Path
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

import actionlib
import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeGoal
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from nao_library_modules.command_line import goals
from nao_library_modules.command_line.errors import CommandFailed, Interrupted, StackMissing
from nao_library_modules.command_line.goals import GoalRun, interrupt_held
from nao_library_modules.command_line.graph import Graph
from nao_library_modules.command_line.progress import Progress
from nao_library_modules.command_line.settings import Settings
from nao_library_msgs.msg import LedFunction

PROGRAM = Path(__file__).parents[3] / "nao_library_modules" / "nodes" / "nao"


def press():
    """Ctrl-C, as a terminal sends it."""
    os.kill(os.getpid(), signal.SIGINT)


def active(goal):
    goal.tell(GoalStatus.ACTIVE)


@pytest.fixture
def begin(monkeypatch, graph):
    """Sends a goal to a server that does as the test says: a run, what carries it out, and the goals that were sent."""
    graph()
    sent = []

    def make(on_sent, in_cancel=lambda: None, **settings):
        class Client:
            def __init__(self, *_):
                pass

            def wait_for_server(self):
                return True

            def send_goal(self, goal, on_change, _):
                sent.append(FakeGoal(on_change, in_cancel))  # published: the server has it
                on_sent(sent[-1])
                return sent[-1].handle

        monkeypatch.setattr(actionlib, "ActionClient", Client)
        monkeypatch.setattr(goals, "start_node", lambda: None)
        run = GoalRun(Settings(json=True, **settings), "NaoLights")
        return run, lambda: run.run([LedFunction(function="rasta")]), sent

    return make


@pytest.mark.parametrize("late", [False, True])
def test_ctrl_c_while_a_goal_is_sent_cancels_it_as_soon_as_the_server_knows_it(begin, late):
    def on_sent(goal):
        press()
        threading.Timer(0.1, active, [goal]).start() if late else active(goal)

    run, go, sent = begin(on_sent)
    with pytest.raises(Interrupted, match="preempted"):
        go()
    assert run.last.state == "preempted" and sent[0].cancelled == [CommState.ACTIVE]


def test_ctrl_c_once_more_does_not_lose_the_goal(begin, monkeypatch):
    _, go, sent = begin(lambda goal: (press(), active(goal)), press)
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(sent[0].cancelled) == 1
    monkeypatch.setattr(Progress, "note", lambda *_: press())  # while it says that it stops
    _, go, sent = begin(lambda goal: (press(), active(goal)))
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(sent[1].cancelled) == 1


def test_ctrl_c_when_the_goal_is_over_cancels_nothing(begin):
    run, go, sent = begin(lambda goal: (press(), goal.end(GoalStatus.SUCCEEDED), goal.tell()))
    with pytest.raises(Interrupted, match="the goal was over before: succeeded"):
        go()
    assert (run.last.state, sent[0].cancelled) == ("succeeded", [])


@pytest.mark.parametrize("when", ["at once", "while it is to be cancelled"])
def test_a_goal_that_is_over_when_the_time_is_up_has_its_end(begin, when):
    def on_sent(goal):
        end = lambda: goal.end(GoalStatus.SUCCEEDED)  # noqa: E731
        end() if when == "at once" else (active(goal), goal.just_before_the_cancel(end))

    _, go, sent = begin(on_sent, timeout=1e-9)
    assert go().succeeded and sent[0].cancelled == []


def test_a_goal_that_takes_too_long_is_cancelled_in_spite_of_ctrl_c(begin, capsys):
    run, go, sent = begin(active, timeout=0.01)
    with pytest.raises(CommandFailed, match="not done within 0.01 s: cancelled"):
        go()
    assert (run.last.state, sent[0].cancelled) == ("preempted", [CommState.ACTIVE])
    assert '"state": "preempted"' in capsys.readouterr().out
    _, go, sent = begin(lambda goal: (active(goal), goal.just_before_the_cancel(press)), timeout=1e-9)
    with pytest.raises(KeyboardInterrupt):
        go()
    assert len(sent[1].cancelled) == 1


def test_an_interrupt_that_was_held_counts_afterwards_and_the_next_one_at_once():
    done = []
    with pytest.raises(KeyboardInterrupt):
        with interrupt_held():
            press()
            done.append("inside")
        done.append("after")
    assert done == ["inside"]
    with pytest.raises(KeyboardInterrupt):
        press()


def test_ctrl_c_while_the_program_loads_ends_it_quietly(tmp_path):
    pressed = "import os, signal\nos.kill(os.getpid(), signal.SIGINT)\nraise SystemExit('went on in spite of Ctrl-C')\n"
    (tmp_path / "click.py").write_text(pressed)  # stands for the first module that takes a moment to load
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    command = [sys.executable, str(PROGRAM), "status"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr, done.stdout) == (130, "", "")


class Service:
    """One ROS service: notes the headers that come, answers what it is given; never, if that is None."""

    def __init__(self, answer):
        self._answer, self.headers = answer, []
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.uri = f"rosrpc://127.0.0.1:{self._socket.getsockname()[1]}"
        self.close = self._socket.close
        if answer is not None:
            threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:
                return
            with connection, connection.makefile("rwb") as stream:
                try:
                    self._talk(stream)
                except (OSError, struct.error):
                    pass

    def _talk(self, stream):
        (length,) = struct.unpack("<I", stream.read(4))
        fields, content, begin = {}, stream.read(length), 0
        while begin < length:
            (size,) = struct.unpack_from("<I", content, begin)
            name, _, value = content[begin + 4 : begin + 4 + size].decode().partition("=")
            fields[name], begin = value, begin + 4 + size
        self.headers.append(fields)
        line = b"md5sum=x" if fields["md5sum"] in ("*", Trigger._md5sum) else b"error=wrong type"
        stream.write(struct.pack("<II", len(line) + 4, len(line)) + line)
        stream.flush()
        if "probe" not in fields and not line.startswith(b"error"):
            stream.read(struct.unpack("<I", stream.read(4))[0])
            stream.write(self._answer())


def answered(succeeded, content):
    return bytes([succeeded]) + struct.pack("<I", len(content)) + content


def response(text=""):
    buffer = BytesIO()
    TriggerResponse(True, text).serialize(buffer)
    return answered(1, buffer.getvalue())


@pytest.fixture
def master(monkeypatch):
    """Starts a master that knows services by name -> Service."""

    class Quiet(SimpleXMLRPCRequestHandler):
        def log_message(self, *_):
            pass

    server = SimpleXMLRPCServer(("127.0.0.1", 0), requestHandler=Quiet, logRequests=False)
    services = {}
    found = lambda _, name: [1, "", services[name].uri] if name in services else [-1, "none", 0]  # noqa: E731
    state = lambda _: [1, "", [[], [["/a/goal", ["/n"]]], [[name, ["/n"]] for name in services]]]  # noqa: E731
    server.register_function(found, "lookupService")
    server.register_function(state, "getSystemState")
    server.register_function(lambda _: [1, "", [["/a/goal", "some/Goal"]]], "getTopicTypes")
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{server.server_address[1]}")
    yield services
    server.shutdown()
    server.server_close()
    for service in services.values():
        service.close()


def test_the_master_tells_services_and_topics_and_services_are_called_as_a_node_would(master):
    master["/s"] = Service(lambda: response("hello"))
    graph = Graph()
    assert (graph.services(), graph.subscribed()) == (["/s"], {"/a/goal": ["/n"]})
    assert graph.topic_types() == {"/a/goal": "some/Goal"}
    answer = graph.call("/s", Trigger, TriggerRequest())
    assert (answer.success, answer.message) == (True, "hello")
    (header,) = master["/s"].headers
    assert (header["service"], header["md5sum"]) == ("/s", Trigger._md5sum)


def test_a_look_whether_it_is_alive_calls_nothing(master):
    master["/s"] = Service(lambda: pytest.fail("it was called"))
    assert Graph().alive("/s") and master["/s"].headers[0]["probe"] == "1" and not Graph().alive("/other")


@pytest.mark.parametrize(
    "answer, error, told",
    [
        (lambda: answered(0, b"it hurts"), CommandFailed, "/s: it hurts"),
        (lambda: b"", StackMissing, "/s does not answer"),
        (None, StackMissing, "/s does not answer"),
    ],
    ids=["refuses", "hangs up", "keeps silent"],
)
def test_a_service_that_does_not_do_it_is_told(master, answer, error, told):
    master["/s"] = Service(answer)
    with pytest.raises(error, match=told):
        Graph(limit=0.2).call("/s", Trigger, TriggerRequest())
    assert Graph(limit=0.2).alive("/s") == (answer is not None)
    with pytest.raises(StackMissing, match="there is no service /other"):
        Graph().call("/other", Trigger, TriggerRequest())


def test_a_service_that_takes_its_time_is_waited_for_by_who_is_patient(master):
    done = threading.Event()
    master["/s"] = Service(lambda: done.wait(10.0) and response("at last"))
    threading.Timer(0.5, done.set).start()
    assert Graph(limit=0.2).call("/s", Trigger, TriggerRequest(), patient=True).message == "at last"
