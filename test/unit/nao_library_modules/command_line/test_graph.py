"""The master and services over real sockets, without ROS."""

import socket
import struct
import threading
import time
from io import BytesIO
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

import pytest
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from nao_library_modules.command_line.errors import CommandFailed, StackMissing
from nao_library_modules.command_line.graph import Graph


class Quiet(SimpleXMLRPCRequestHandler):
    def log_message(self, *_):
        pass


class Service:
    """One ROS service: notes the headers that come, answers what it is given."""

    def __init__(self, answer):
        self._answer = answer
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.headers = []
        self.uri = f"rosrpc://127.0.0.1:{self._socket.getsockname()[1]}"
        threading.Thread(target=self._serve, daemon=True).start()

    def close(self):
        self._socket.close()

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
        if "probe" in fields or line.startswith(b"error"):
            return
        stream.read(struct.unpack("<I", stream.read(4))[0])
        stream.write(self._answer())


def answered(succeeded, content):
    return bytes([succeeded]) + struct.pack("<I", len(content)) + content


def response(text):
    buffer = BytesIO()
    TriggerResponse(True, text).serialize(buffer)
    return answered(1, buffer.getvalue())


@pytest.fixture
def master(monkeypatch):
    """Starts a master that knows services by name -> Service."""
    server = SimpleXMLRPCServer(("127.0.0.1", 0), requestHandler=Quiet, logRequests=False)
    services = {}
    found = lambda _, name: [1, "", services[name].uri] if name in services else [-1, "none", 0]  # noqa: E731
    state = lambda _: [1, "", [[], [["/a/goal", ["/n"]]], [[name, ["/n"]] for name in services]]]  # noqa: E731
    server.register_function(found, "lookupService")
    server.register_function(state, "getSystemState")
    server.register_function(lambda _: [1, "", [["/a/goal", "some/Goal"]]], "getTopicTypes")
    threading.Thread(target=server.serve_forever, daemon=True).start()
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{server.server_address[1]}")
    yield services
    server.shutdown()
    server.server_close()
    for service in services.values():
        service.close()


def test_the_master_tells_services_and_topics(master):
    master["/a/describe"] = Service(lambda: response(""))
    graph = Graph()
    assert graph.services() == ["/a/describe"]
    assert graph.subscribed() == {"/a/goal": ["/n"]}
    assert graph.topic_types() == {"/a/goal": "some/Goal"}


def test_a_service_is_called_as_a_node_would(master):
    master["/s"] = Service(lambda: response("hello"))
    answer = Graph().call("/s", Trigger, TriggerRequest())
    assert (answer.success, answer.message) == (True, "hello")
    (header,) = master["/s"].headers
    assert (header["service"], header["md5sum"]) == ("/s", Trigger._md5sum)


def test_what_a_service_refuses_is_told(master):
    master["/s"] = Service(lambda: answered(0, b"it hurts"))
    with pytest.raises(CommandFailed, match="/s: it hurts"):
        Graph().call("/s", Trigger, TriggerRequest())


def test_a_service_that_hangs_up_or_is_not_there_is_missing(master):
    master["/s"] = Service(lambda: b"")
    with pytest.raises(StackMissing, match="/s does not answer"):
        Graph().call("/s", Trigger, TriggerRequest())
    with pytest.raises(StackMissing, match="there is no service /other"):
        Graph().call("/other", Trigger, TriggerRequest())


def test_a_look_whether_it_is_alive_calls_nothing(master):
    master["/s"] = Service(lambda: pytest.fail("it was called"))
    assert Graph().alive("/s")
    assert master["/s"].headers[0]["probe"] == "1"
    assert not Graph().alive("/other")


def test_a_service_that_keeps_silent_is_not_waited_for_for_ever(master):
    silent = socket.create_server(("127.0.0.1", 0))
    master["/s"] = type("Silent", (), {"uri": f"rosrpc://127.0.0.1:{silent.getsockname()[1]}", "close": silent.close})
    began = time.monotonic()
    with pytest.raises(StackMissing, match="does not answer"):
        Graph(limit=0.2).call("/s", Trigger, TriggerRequest())
    assert not Graph(limit=0.2).alive("/s")
    assert time.monotonic() - began < 10.0


def test_a_service_that_takes_its_time_is_waited_for_by_who_is_patient(master):
    done = threading.Event()
    master["/s"] = Service(lambda: done.wait(10.0) and response("at last"))
    threading.Timer(0.5, done.set).start()
    assert Graph(limit=0.2).call("/s", Trigger, TriggerRequest(), patient=True).message == "at last"
