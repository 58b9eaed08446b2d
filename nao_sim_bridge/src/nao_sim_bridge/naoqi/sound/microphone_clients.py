"""Modules of clients that hear the robot's microphones: their method `processRemote` is called for each block.

Modules for NAOqi before 1.12 have `processSoundRemote` instead, which gets no time.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from dataclasses import replace
from typing import Any, Callable, Sequence

import numpy as np

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.client_calls import NoAnswer, answer, worth_telling
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.sound.microphone_formats import MicrophoneFormat

log = logging.getLogger("nao_sim.microphones")

METHOD, OLDER_METHOD = "processRemote", "processSoundRemote"
# Blocks that wait for a client, at 170 ms each; it loses the oldest when it is that far behind.
WAITING = load_sizes().clients.sound_blocks
# Modules that are subscribed, and modules that have said what they want.
MOST = load_sizes().clients.microphones
# Wall time, s: how long one call may take before the client counts as hanging, and its time is not waited for any more.
HANGS = load_sizes().clients.held_up_s
# While time runs faster than real time, it waits for a client with more blocks than this before it.
HELD_UP = 2


class MicrophoneClients:
    """The subscribers of ALAudioDevice.

    `service` finds the module of a client by its name, or raises a RuntimeError; `released` is called when a client has
    caught up, for time that waits.
    """

    def __init__(self, ears: Any, service: Callable[[str], Any], released: Callable[[], None] = lambda: None) -> None:
        self._ears = ears
        self._service = service
        self._released = released
        self._lock = threading.Lock()
        self._formats: dict[str, MicrophoneFormat] = {}
        self._clients: dict[str, _Client] = {}
        self._at_once = 1
        self._closed = False

    def prefer(self, module: str, wanted: MicrophoneFormat) -> None:
        """What a module wants to get, now or when it subscribes; a NaoqiError when too many have said it."""
        with self._lock:
            if module not in self._formats and len(self._formats) >= MOST:
                raise NaoqiError(f"{MOST} modules have client preferences, which is the most allowed")
            self._formats[module] = wanted
            client = self._clients.get(module)
        if client is not None:
            client.listen(wanted)

    def subscribe(self, module: str) -> None:
        """Begin to call a module. One that is subscribed already stays so.

        A NaoqiError when there is no such module, or too many are subscribed.
        """
        try:
            remote = self._service(module)
        except NoAnswer as error:
            raise NaoqiError(f"module {module!r} gives {error}; its program may have stopped") from error
        except RuntimeError as error:
            raise NaoqiError(f"there is no module {module!r} to send sound to; register it first") from error
        with self._lock:
            old = self._clients.get(module)
            if old is not None and old.alive:
                return
            if len(self._clients) >= MOST:
                raise NaoqiError(f"{MOST} modules hear the microphones, which is the most allowed; unsubscribe some")
            wanted = self._formats.get(module, MicrophoneFormat())
            client = self._clients[module] = _Client(
                module, remote, self._service, self._ears, self._gone, self._released
            )
            client.at_once = self._at_once
            muted = self._closed
        if not muted:
            client.listen(wanted)

    def unsubscribe(self, module: str) -> None:
        """Call a module no more; a NaoqiError when it is not subscribed."""
        with self._lock:
            client = self._clients.pop(module, None)
            known = ", ".join(self._clients) or "none"
        if client is None:
            raise NaoqiError(f"module {module!r} is not subscribed; subscribed are {known}")
        client.end()

    def gone(self, module: str) -> None:
        with self._lock:
            client = self._clients.pop(module, None)
            self._formats.pop(module, None)
        if client is not None:
            log.warning("%s is gone, so it is unsubscribed from the microphones", module)
            client.end()

    def names(self) -> list[str]:
        with self._lock:
            return list(self._clients)

    def behind(self) -> bool:
        """Whether a module has more to do than it should; one that hangs does not count."""
        with self._lock:
            return any(client.behind for client in self._clients.values())

    def set_closed(self, closed: bool) -> None:
        """Whether the microphones are closed: then nobody is called."""
        with self._lock:
            self._closed = closed
            clients = [(client, self._formats.get(name, MicrophoneFormat())) for name, client in self._clients.items()]
        for client, wanted in clients:
            if closed:
                client.silence()
            else:
                client.listen(wanted)

    def set_at_once(self, blocks: int) -> None:
        """How many blocks of 170 ms a module gets with each call."""
        with self._lock:
            self._at_once = blocks
            for client in self._clients.values():
                client.at_once = blocks

    def close(self) -> None:
        with self._lock:
            clients, self._clients = list(self._clients.values()), {}
        for client in clients:
            client.end()

    def _gone(self, client: _Client) -> None:
        with self._lock:
            if self._clients.get(client.module) is client:
                del self._clients[client.module]


class _Client:
    """One module, called in a thread of its own: one that is slow must not keep the others from hearing."""

    def __init__(
        self,
        module: str,
        remote: Any,
        service: Callable[[str], Any],
        ears: Any,
        gone: Callable[[_Client], None],
        released: Callable[[], None],
    ) -> None:
        self.module = module
        self.lost = 0
        self.at_once = 1
        # Of the listener that counts: blocks that are to be sent together with the next ones.
        self._begun: list[Any] = []
        self._remote = remote
        self._method = METHOD
        self._service = service
        self._ears = ears
        self._gone = gone
        self._released = released
        self._news = threading.Condition()
        self._blocks: deque[tuple[MicrophoneFormat, Any]] = deque()
        self._listener: Any = None
        self._called = 0.0
        self._failing = False
        self._ended = False
        threading.Thread(target=self._run, name=f"sound for {module}", daemon=True).start()

    @property
    def alive(self) -> bool:
        return not self._ended

    @property
    def behind(self) -> bool:
        """Whether time should wait for it, where time can wait."""
        called = self._called
        hangs = called > 0.0 and time.monotonic() - called > HANGS
        return len(self._blocks) > HELD_UP and not hangs

    def listen(self, wanted: MicrophoneFormat) -> None:
        begun = self.silence()
        listener = self._ears.listen(
            self.module, lambda block: self._hear(wanted, begun, block), wants=wanted.wants, channel=wanted.channel_name
        )
        with self._news:
            if self._begun is begun and not self._ended:
                self._listener = listener
                return
        listener.close()

    def silence(self) -> list[Any]:
        """Hear nothing more; blocks that wait are dropped. Answers where a new listener puts its blocks."""
        with self._news:
            listener, self._listener = self._listener, None
            # Not cleared: the old listener may be about to bring a block of another format, which counts no more.
            begun = self._begun = []
            self._blocks.clear()
        if listener is not None:
            listener.close()
        return begun

    def end(self) -> None:
        """End the thread; a call that is under way is not waited for."""
        with self._news:
            self._ended = True
            self._news.notify_all()
        self.silence()

    def _hear(self, wanted: MicrophoneFormat, begun: list[Any], block: Any) -> None:
        """A new block for the listener that has begun these; in the thread of the ears."""
        with self._news:
            if self._ended or begun is not self._begun:
                return
            begun.append(block)
            if len(begun) < self.at_once:
                return
            together = begun.copy()
            begun.clear()
            block = _joined(together)
            if len(self._blocks) >= WAITING:
                self._blocks.popleft()
                self.lost += 1
                if worth_telling(self.lost):
                    log.warning("%s is too slow for the microphones: %d blocks lost so far", self.module, self.lost)
            self._blocks.append((wanted, block))
            self._news.notify_all()

    def _run(self) -> None:
        self._method = _receiver(self.module, self._remote)
        while True:
            with self._news:
                self._called = 0.0
                self._news.wait_for(lambda: self._blocks or self._ended)
                if self._ended:
                    return
                wanted, block = self._blocks.popleft()
                self._called = time.monotonic()
            self._send(wanted, block)
            if not self.behind:
                self._released()

    def _send(self, wanted: MicrophoneFormat, block: Any) -> None:
        microseconds = round(block.time * 1e6)
        stamp = [microseconds // 1000000, microseconds % 1000000]
        frames, channels = block.samples.shape
        try:
            when = [] if self._method == OLDER_METHOD else [stamp]
            call = self._remote.call(self._method, channels, frames, *when, wanted.packed(block.samples), _async=True)
            answer(call, self._news, lambda: not self._ended)
            self._failing = False
        except NoAnswer as error:
            self._leave(f"{self.module}: {error}")
        except (RuntimeError, AttributeError) as error:
            if not self._is_there():
                self._leave(f"{self.module} is gone")
            elif not self._failing:
                self._failing = True
                log.warning("%s.%s failed: %s", self.module, self._method, error)

    def _leave(self, reason: str) -> None:
        if not self._ended:
            log.warning("%s, so it is unsubscribed from the microphones", reason)
        self.end()
        self._gone(self)

    def _is_there(self) -> bool:
        try:
            self._remote = self._service(self.module)
        except RuntimeError:
            return False
        return True


def _joined(blocks: Sequence[Any]) -> Any:
    if len(blocks) == 1:
        return blocks[0]
    return replace(blocks[0], samples=np.concatenate([block.samples for block in blocks]))


def _receiver(module: str, remote: Any) -> str:
    """The method that takes the sound."""
    try:
        names = {method["name"] for method in remote.metaObject()["methods"].values()}
    except RuntimeError:
        return METHOD  # it is gone again; the first call finds out
    if not names & {METHOD, OLDER_METHOD}:
        log.warning("%s has no method %s to send sound to", module, METHOD)
    return OLDER_METHOD if OLDER_METHOD in names and METHOD not in names else METHOD
