"""The handle of the recogniser's process: hands it what is heard, starts it again when it has died."""

from __future__ import annotations

import logging
import queue
import threading
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.child_process import ChildProcess
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.hearing.listening import Listening, Recognised
from nao_sim_bridge.hearing.voice_activity import RATE, SpeechChange

log = logging.getLogger("nao_sim.recognition")

MODULE = "nao_sim_bridge.hearing.worker"
START_TIMEOUT = 60.0
"""s; a busy machine may need long to start an interpreter and to read the dictionary."""
ANSWER_TIMEOUT = 60.0
CLOSING = 1.0
"""s; at the end, a process that is still busy after this is ended by force."""
MOST_WAITING = 60.0
"""s of sound that may wait; what comes then is left out: time did not wait for the recogniser."""
# What error texts call the requests.
WHAT = {
    "listen": "what to listen for",
    "background": "what was heard before",
    "hear": "what is heard",
    "finish": "end of listening",
}
STARTS = 3
"""A process that dies this often in a row is not started again before something else is to be listened for."""


class RecogniserError(SimulationError):
    """The recogniser's process died or does not answer; it is started again when there is something to do."""


class RecogniserRefused(RecogniserError):
    """The recogniser is well but cannot do this."""


class SpareProcess:
    """A recogniser's process that nobody needs at the moment: a new one takes long to start. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: ChildProcess | None = None
        self._closed = False

    def take(self) -> ChildProcess | None:
        """The process, for the caller alone; None when there is none."""
        with self._lock:
            process, self._process = self._process, None
        return process

    def give(self, process: ChildProcess) -> None:
        """Keep a process that is not used any more, as if it had just been started, or end it."""
        try:
            process.ask("finish", None, ANSWER_TIMEOUT, WHAT["finish"])
            process.ask("listen", Listening(), ANSWER_TIMEOUT, WHAT["listen"])
        except RecogniserError:
            process.kill()
            return
        with self._lock:
            if self._process is None and not self._closed:
                self._process = process
                return
        process.stop()

    def close(self) -> None:
        with self._lock:
            self._closed = True
        process = self.take()
        if process is not None:
            process.stop()


@dataclass(frozen=True)
class _Job:
    kind: str
    content: Any
    seconds: float = 0.0
    done: Future | None = None


class Recogniser:
    """Recognises phrases in what is heard, in a process of its own. Any thread may call.

    A thread of the recogniser calls `on_event` with each SpeechChange and Recognised, in order, and `on_progress`
    whenever `lag` has become smaller. A process is had from, and goes back to, the spare one, if that is given.
    """

    def __init__(
        self,
        on_event: Callable[[SpeechChange | Recognised], None],
        on_progress: Callable[[], None] = lambda: None,
        spare: SpareProcess | None = None,
    ) -> None:
        self._spare = spare
        self._on_event = on_event
        self._on_progress = on_progress
        self._jobs: queue.Queue[_Job | None] = queue.Queue()
        self._lock = threading.Lock()
        self._waiting = 0.0
        self._left_out = False
        self._listening = Listening()
        self._process: ChildProcess | None = None
        self._deaths = 0
        self._closed = False
        self._thread: threading.Thread | None = None

    @property
    def lag(self) -> float:
        """Sound that was handed over and has not been worked through, s."""
        return self._waiting

    @property
    def pid(self) -> int | None:
        """Process id; None while there is no process."""
        process = self._process
        return process.process.pid if process is not None else None

    def listen(self, listening: Listening) -> None:
        """Listen for something else; returns when that is so.

        Raises:
            RecogniserRefused: This cannot be listened for: a word without pronunciation, a grammar too large. What was
                listened for before stays.
            RecogniserError: The process cannot be had.
        """
        done: Future = Future()
        self._put(_Job("listen", listening, done=done))
        done.result()

    def get_used_to(self, samples: np.ndarray) -> None:
        """Know the background from (n,) int16, 16 kHz, heard before what `hear` gets; returns at once."""
        self._put(_Job("background", np.ascontiguousarray(samples)))

    def hear(self, time: float, samples: np.ndarray) -> None:
        """Take the next block, (n,) int16, 16 kHz, from a simulated time on, s; returns at once."""
        seconds = len(samples) / RATE
        if self._waiting > MOST_WAITING:
            if not self._left_out:
                log.warning("speech recognition is %.0f s behind; what is heard now is left out", self._waiting)
            self._left_out = True
            return
        self._left_out = False
        with self._lock:
            self._waiting += seconds
        self._put(_Job("hear", (time, np.ascontiguousarray(samples)), seconds))

    def finish(self) -> None:
        """End an utterance that is not over, and forget what the background was like; returns at once."""
        self._put(_Job("finish", None))

    def catch_up(self, timeout: float = 60.0) -> None:
        """Wait until everything handed over has been worked through (wall time, s)."""
        done: Future = Future()
        self._put(_Job("nothing", None, done=done))
        done.result(timeout)

    def close(self) -> None:
        """End the process; what waits is dropped."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
            thread = self._thread
        self._jobs.put(None)
        if thread is None or thread is threading.current_thread():
            return
        thread.join(CLOSING)
        process = self._process
        if thread.is_alive() and process is not None:  # it works on something, or hangs, and nobody waits for that
            process.process.kill()
            thread.join(CLOSING)

    def _put(self, job: _Job) -> None:
        with self._lock:
            if self._closed:
                raise RecogniserError("speech recognition is closed")
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="recogniser", daemon=True)
                self._thread.start()
            self._jobs.put(job)

    # --- in the thread --------------------------------------------------------------------------------------------

    def _run(self) -> None:
        job = self._jobs.get()
        while job is not None and not self._closed:
            self._work(job)
            job = self._jobs.get()
        self._drop(job)
        process = self._process
        if process is None:
            return
        if self._spare is not None:
            self._spare.give(process)
        else:
            process.stop()
        self._process = None  # not before: `close` ends one that hangs

    def _drop(self, job: _Job | None) -> None:
        """Tell everybody who waits, from `job` on, that nothing comes any more."""
        while True:
            if job is not None and job.done is not None:
                job.done.set_exception(RecogniserError("speech recognition is closed"))
            try:
                job = self._jobs.get_nowait()
            except queue.Empty:
                return

    def _work(self, job: _Job) -> None:
        try:
            answer = self._answer(job)
        except RecogniserError as error:
            if job.done is not None:
                job.done.set_exception(error)
            elif not self._closed:
                log.error("speech recognition: %s", error)
        except Exception as error:  # whatever it is, the thread must go on
            log.exception("speech recognition failed")
            if job.done is not None:
                job.done.set_exception(error)
        else:
            self._tell(answer if job.kind in ("hear", "finish") else [])
            if job.done is not None:
                job.done.set_result(None)
        finally:
            if job.seconds:
                with self._lock:
                    self._waiting = max(self._waiting - job.seconds, 0.0)
                self._on_progress()

    def _tell(self, events: list[SpeechChange | Recognised] | None) -> None:
        for event in events or []:
            try:
                self._on_event(event)
            except Exception:
                log.exception("a listener of speech recognition failed")

    def _answer(self, job: _Job) -> Any:
        if job.kind == "nothing":
            return None
        if job.kind == "listen":
            self._deaths = 0
        elif self._process is None and (self._deaths >= STARTS or job.kind == "finish"):
            return None
        try:
            answer = self._running().ask(job.kind, job.content, ANSWER_TIMEOUT, WHAT[job.kind])
        except RecogniserRefused:
            raise
        except RecogniserError:
            self._deaths += 1
            self._process = None
            raise
        self._deaths = 0
        if job.kind == "listen":
            self._listening = job.content
        return answer

    def _running(self) -> ChildProcess:
        """The process; a spare one that is well, or a new one, listens for the same as the old one."""
        spare = self._spare.take() if self._process is None and self._spare is not None else None
        if spare is not None:
            with suppress(RecogniserError):
                self._process = self._begun(spare)
        if self._process is None:
            process = ChildProcess(MODULE, (), "recogniser", RecogniserError, RecogniserRefused)
            self._process = self._begun(process, is_new=True)
        return self._process

    def _begun(self, process: ChildProcess, is_new: bool = False) -> ChildProcess:
        try:
            if is_new:
                process.receive(START_TIMEOUT, "start of speech recognition")
            process.ask("listen", self._listening, ANSWER_TIMEOUT, "start of speech recognition")
        except RecogniserError:
            process.kill()
            raise
        return process
