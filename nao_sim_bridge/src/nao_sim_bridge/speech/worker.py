"""The speech process: `python -m nao_sim_bridge.speech.worker FD`. It holds the engines' libraries.

In a process of its own, because libraries of that kind crash now and then, and because what they compute must not
take time from the simulation. Each text is spoken in a copy of the process that ends with it: the engines keep a
state from text to text, which would make the sound of a text depend on what was said before.

It talks over the inherited pipe FD in tuples (kind, content): first it sends ("ready", {engine: [voices] or None for
any, or a text that says why it is missing}), then it answers ("synthesise", (engine, voice, text, speed)) with
("speech", (samples a second, words)) and the samples as raw bytes (int16, mono), or with ("error", text). Words are
tuples (first character, length, start, end), times in s. It ends when the pipe is closed.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
from multiprocessing.connection import Connection
from typing import Any

from nao_sim_bridge.base.child_process import pipe_to_parent
from nao_sim_bridge.speech.espeak import Espeak
from nao_sim_bridge.speech.flite import Flite

ENGINES = {"flite": Flite, "espeak-ng": Espeak}
PR_SET_PDEATHSIG = 1
"""Of prctl: the signal that a process gets when the thread that made it ends."""


def main(arguments: list[str]) -> int:
    """Serve one pipe until it is closed."""
    (descriptor,) = arguments
    pipe = pipe_to_parent(descriptor)
    engines: dict[str, Any] = {}
    found: dict[str, Any] = {}
    for name, make in ENGINES.items():
        try:
            engines[name] = make()
            found[name] = engines[name].voices()
        except OSError as error:
            found[name] = str(error)
    try:
        pipe.send(("ready", found))
        while True:
            _, (engine, *request) = pipe.recv()
            _speak(pipe, engines[engine], request)
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return 0  # the parent is gone or wants no more


def _speak(pipe: Connection, engine: Any, request: list) -> None:
    """Answer one request, from a copy of this process."""
    engine.prepare(request[0])
    original = os.getpid()
    copy = os.fork()
    if copy == 0:
        try:
            _end_with(original)
            _answer(pipe, engine, request)
        finally:
            os._exit(0)
    _, status = os.waitpid(copy, 0)
    if os.WIFSIGNALED(status):
        pipe.send(("error", f"the engine crashed (signal {os.WTERMSIG(status)})"))


def _end_with(original: int) -> None:
    """Have this copy killed when the process ends that it is a copy of; where the system is not Linux, it ends late."""
    prctl = getattr(ctypes.CDLL(None), "prctl", None)
    if prctl is not None:
        prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != original:  # that was too late
        os._exit(0)


def _answer(pipe: Connection, engine: Any, request: list) -> None:
    try:
        rate, sound, words = engine.synthesise(*request)
    except Exception as error:  # whatever it is: who asked waits for an answer
        pipe.send(("error", str(error) or repr(error)))
    else:
        pipe.send(("speech", (rate, words)))
        pipe.send_bytes(sound)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
