"""Streams of the web: public addresses only, also behind redirections; bounded; ended while headers drip."""

from __future__ import annotations

import io
import signal
import socket
import threading
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles
from nao_sim_bridge.naoqi.sound.web_fetch import Refused, anything, checked_addresses, fetch, is_public
from nao_sim_bridge.naoqi.sound.web_stream import MODULE, WebStreams
from nao_sim_bridge.sound.files import SoundReader

SIZES = load_sizes().stream
PATIENCE = 60.0

PRIVATE = [
    *("127.0.0.1", "127.8.9.1", "0.0.0.0", "10.1.2.3", "172.16.0.1", "192.168.1.1", "169.254.169.254", "100.64.0.1"),
    *("224.0.0.1", "255.255.255.255", "::1", "::", "fe80::1", "fe80::1%eth0", "fc00::1", "ff02::1", "::127.0.0.1"),
    *("::ffff:127.0.0.1", "::ffff:10.0.0.1", "64:ff9b::7f00:1", "64:ff9b::a00:1", "2002:7f00:1::", "2002:c0a8:101::"),
    "fec0::1",
]


@pytest.mark.parametrize("address", PRIVATE)
def test_private_addresses_are_known_in_every_dress(address):
    assert not is_public(address)


@pytest.mark.parametrize("address", ["1.1.1.1", "93.184.216.34", "2606:4700:4700::1111", "::ffff:1.1.1.1"])
def test_public_addresses_are_public(address):
    assert is_public(address)


def test_a_public_name_with_one_private_address_is_refused():
    with pytest.raises(Refused, match="music.example is 10.0.0.1, a private address; allow_private_streams"):
        checked_addresses("music.example", 80, is_public, lambda host, port: ["1.1.1.1", "10.0.0.1"])


class Site(BaseHTTPRequestHandler):
    """Leads on, or has too much."""

    def do_GET(self):
        port = self.server.server_port
        target = {"/away": f"http://127.0.0.2:{port}/", "/file": "file:///etc/passwd", "/round": "/round"}.get(
            self.path
        )
        self.send_response(302 if target else 200)
        if target:
            self.send_header("Location", target)
        self.end_headers()
        if not target:
            self.wfile.write(bytes(100_000))

    def log_message(self, *_):
        pass


@pytest.fixture
def site():
    server = ThreadingHTTPServer(("127.0.0.1", 0), Site)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()


@pytest.mark.parametrize(
    "path, text",
    [
        ("/away", "127.0.0.2 is 127.0.0.2, a private address"),
        ("/file", "file:///etc/passwd is no address of http or https"),
        ("/round", "it leads on more than 5 times"),
        ("/much", "it has more than 99999 bytes"),
    ],
)
def test_what_a_server_leads_to_is_looked_at_as_what_a_client_asked_for(site, path, text):
    with pytest.raises(Refused, match=text):
        fetch(site + path, io.BytesIO(), replace(SIZES, bytes=99_999), lambda address: address == "127.0.0.1")


def test_what_is_there_is_fetched_whole(site):
    file = io.BytesIO()
    assert fetch(site, file, SIZES, anything) == len(file.getvalue()) == 100_000


class Dripping(threading.Thread):
    """A server that sends its headers byte by byte and never comes to an end. `met`: somebody is connected."""

    def __init__(self):
        super().__init__(daemon=True)
        self.met, self._over = threading.Semaphore(0), threading.Event()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = "http://127.0.0.1:{}/".format(self._listener.getsockname()[1])
        self.start()

    def run(self):
        while True:
            try:
                channel, _ = self._listener.accept()
            except OSError:
                return
            threading.Thread(target=self._drip, args=(channel,), daemon=True).start()

    def _drip(self, channel):
        with channel:
            try:
                channel.sendall(b"HTTP/1.1 200 OK\r\nX: ")
                self.met.release()
                while not self._over.wait(0.02):
                    channel.sendall(b"x")
            except OSError:
                pass

    def close(self):
        self._over.set()
        self._listener.close()


@pytest.fixture
def dripping():
    server = Dripping()
    yield server
    server.close()


@pytest.fixture
def streams(tmp_path):
    reader = SoundReader()
    yield WebStreams(SoundFiles(ClientFiles(tmp_path), reader), allow_private=True)
    reader.close()


def begun(streams, server, wanted):
    """A thread that fetches from the server, which it has reached, and where the text of the refusal will be."""
    texts = []

    def run():
        with pytest.raises(NaoqiError) as raised:
            streams.fetch(server.address, wanted.is_set)
        texts.append(str(raised.value))

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    assert server.met.acquire(timeout=PATIENCE)
    return thread, texts


def test_a_stream_ends_with_who_wants_it_while_headers_drip_and_makes_room_for_another(streams, dripping):
    streams.sizes = replace(streams.sizes, at_once=2)
    wanted = threading.Event()
    wanted.set()
    running = [begun(streams, dripping, wanted) for _ in range(2)]
    with pytest.raises(NaoqiError, match="2 streams are being fetched, at most 2 at once are allowed"):
        streams.fetch(dripping.address)
    wanted.clear()
    for thread, texts in running:
        thread.join(PATIENCE)
        assert texts and "nobody wants it any more" in texts[0]
    assert streams.count == 0


def test_a_stream_has_a_time_for_all_of_it(streams, dripping):
    streams.sizes = replace(streams.sizes, total_s=0.5)
    with pytest.raises(NaoqiError, match="it has not ended after 0.5 s"):
        streams.fetch(dripping.address)


def test_the_fetching_process_ends_when_nobody_listens_any_more(tmp_path, dripping):
    (tmp_path / "a").touch()
    child = ChildProcess(MODULE, [str(SIZES.memory_bytes)], "fetching process", SimulationError, SimulationError)
    child.send("fetch", (dripping.address, str(tmp_path / "a"), SIZES, True), "fetching")
    assert dripping.met.acquire(timeout=PATIENCE)
    child.leave()
    assert child.process.wait(PATIENCE) == -signal.SIGIO


def test_private_addresses_are_refused_unless_they_are_allowed(tmp_path, site):
    reader = SoundReader()
    streams = WebStreams(SoundFiles(ClientFiles(tmp_path), reader), allow_private=False)
    with pytest.raises(NaoqiError, match="nothing can be fetched from .*: 127.0.0.1 is 127.0.0.1, a private address"):
        streams.fetch(site)
