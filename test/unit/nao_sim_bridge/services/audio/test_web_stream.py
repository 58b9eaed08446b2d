"""Sound from the web, from a server on this machine."""

from __future__ import annotations

import io
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest
import soundfile

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.audio import web_stream
from nao_sim_bridge.services.audio.web_stream import fetch_sound
from nao_sim_bridge.services.errors import NaoqiError


def encoded(kind):
    time = np.arange(24000) / 24000
    file = io.BytesIO()
    soundfile.write(file, 0.5 * np.sin(2.0 * np.pi * 440.0 * time), 24000, format=kind)
    return file.getvalue()


class Site(BaseHTTPRequestHandler):
    """Sounds, things that are none, and a stream without an end."""

    leave = threading.Event()
    pages = {"/a.ogg": ("OGG",), "/radio": ("MP3",), "/a.wav": ("WAV",)}

    def do_GET(self):
        if self.path in self.pages:
            self._answer(encoded(*self.pages[self.path]))
        elif self.path == "/page.html":
            self._answer(b"<html>no sound</html>")
        elif self.path == "/inward":
            self.send_response(302)
            self.send_header("Location", "file:///etc/passwd")
            self.end_headers()
        elif self.path == "/endless":
            self.send_response(200)
            self.end_headers()
            try:
                while not self.leave.is_set():
                    self.wfile.write(bytes(65536))
            except OSError:
                pass
        else:
            self.send_error(404)

    def _answer(self, body):
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


@pytest.fixture(scope="module")
def site():
    Site.leave.clear()
    server = ThreadingHTTPServer(("127.0.0.1", 0), Site)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    Site.leave.set()
    server.shutdown()
    server.server_close()


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.setenv("no_proxy", "127.0.0.1")
    return ClientFiles(tmp_path / "records")


@pytest.mark.parametrize("path", ["/a.ogg", "/a.wav", "/radio"])
def test_sounds_are_fetched_whatever_their_name(site, files, path):
    sound = fetch_sound(site + path, files)
    assert sound.rate == 48000
    assert sound.duration == pytest.approx(1.0, abs=0.1)
    middle = sound.samples[12000:36000, 0]
    assert np.argmax(np.abs(np.fft.rfft(middle * np.hanning(24000)))) * 2.0 == 440.0


def test_a_file_may_be_named_as_an_address(files, tmp_path):
    (tmp_path / "records").mkdir()
    (tmp_path / "records/my song.wav").write_bytes(encoded("WAV"))
    (tmp_path / "outside.wav").write_bytes(encoded("WAV"))
    for address in (
        f"file://{tmp_path}/records/my%20song.wav",
        "file:///home/nao/my%20song.wav",
    ):
        assert fetch_sound(address, files).duration == 1.0
    with pytest.raises(ValueError, match="is not inside .*records; give a relative name"):
        fetch_sound(f"file://{tmp_path}/outside.wav", files)


@pytest.mark.parametrize(
    "path, message",
    [
        ("/missing.ogg", "nothing can be fetched from .*/missing.ogg: .*404"),
        ("/page.html", ".*/page.html' cannot be read as sound"),
        ("/inward", "nothing can be fetched from .*/inward"),
    ],
)
def test_what_is_no_sound_is_named(site, files, path, message):
    with pytest.raises(NaoqiError, match=message):
        fetch_sound(site + path, files)


@pytest.mark.parametrize("address", ["", "a.wav", "ftp://example.org/a.wav", "http://", "http:///a.wav", "http://["])
def test_what_is_no_address_is_refused(files, address):
    with pytest.raises(NaoqiError, match="streamName is .*, allowed is an address of http, https or file"):
        fetch_sound(address, files)


def test_a_server_that_is_not_there_is_named(files):
    with pytest.raises(NaoqiError, match="nothing can be fetched from http://127.0.0.1:9/a.wav: .*refused"):
        fetch_sound("http://127.0.0.1:9/a.wav", files)


def test_a_stream_without_an_end_has_one(site, files, monkeypatch):
    with pytest.raises(NaoqiError, match="endless is larger than 32 MiB"):
        fetch_sound(site + "/endless", files)
    monkeypatch.setattr(web_stream, "PATIENCE", 0.0)
    with pytest.raises(NaoqiError, match="endless has not ended after 0 s"):
        fetch_sound(site + "/endless", files)


def test_fetching_ends_when_nobody_wants_it_any_more(site, files):
    asked = []

    def wanted():
        asked.append(None)
        return len(asked) < 3

    with pytest.raises(NaoqiError, match="cannot be read as sound"):
        fetch_sound(site + "/endless", files, wanted)
    assert len(asked) == 3
