"""Sound from an address of the web: fetched as a whole, with limits, then decoded."""

from __future__ import annotations

import http.client
import tempfile
import time
import urllib.error
import urllib.parse
import urllib.request
from pathlib import Path
from typing import BinaryIO, Callable

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.audio.sound_files import read_checked, read_client_file
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.sim.sound.samples import Sound

LARGEST = 32 * 1024 * 1024
# Wall time, s: how long a server may be silent, and how long all of it may take.
SILENCE, PATIENCE = 10.0, 60.0
CHUNK = 64 * 1024


def fetch_sound(address: str, files: ClientFiles, wanted: Callable[[], bool] = lambda: True) -> Sound:
    """The sound at an address; takes its time, so for a thread of its own.

    Args:
        address: http, https, or file; a file has to be one that the client may read.
        files: Where clients may read.
        wanted: Asked now and then whether to go on.

    Raises:
        NaoqiError: The address is none, nothing usable is there, it is too large, or it does not end.
    """
    try:
        parts = urllib.parse.urlsplit(address)
    except ValueError as error:
        raise _no_address(address) from error
    if parts.scheme == "file":
        return read_client_file(files, urllib.parse.unquote(parts.path).replace(str(files.folder) + "/", "", 1))
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise _no_address(address)
    with tempfile.NamedTemporaryFile(suffix=Path(parts.path).suffix) as file:
        try:
            _download(address, file, wanted)
        except (OSError, ValueError, http.client.HTTPException) as error:
            # What is wrong with an address is in `reason`; of an answer, `reason` lacks the number.
            plain = isinstance(error, urllib.error.URLError) and not isinstance(error, urllib.error.HTTPError)
            reason = error.reason if plain else error
            raise NaoqiError(f"nothing can be fetched from {address}: {reason}") from error
        file.flush()
        return read_checked(Path(file.name), address)


def _download(address: str, file: BinaryIO, wanted: Callable[[], bool]) -> None:
    end, size = time.monotonic() + PATIENCE, 0
    with urllib.request.urlopen(address, timeout=SILENCE) as answer:  # noqa: S310 the scheme is checked above
        while wanted():
            chunk = answer.read1(CHUNK)
            if not chunk:
                return
            size += len(chunk)
            if size > LARGEST:
                raise NaoqiError(f"{address} is larger than {LARGEST // 1024 // 1024} MiB")
            if time.monotonic() > end:
                raise NaoqiError(f"{address} has not ended after {PATIENCE:.0f} s")
            file.write(chunk)


def _no_address(address: str) -> NaoqiError:
    return NaoqiError(f"streamName is {address!r}, allowed is an address of http, https or file")
