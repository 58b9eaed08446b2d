"""The thread that listens: it works out what the microphones heard, block by block, and hands it to listeners."""

from __future__ import annotations

import logging
import threading
from dataclasses import dataclass
from typing import Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.base.samples import RATE, frame_at, pcm16
from nao_sim_bridge.sound.microphones import GUARD, Microphones
from nao_sim_bridge.sound.settings import CHANNELS
from nao_sim_bridge.sound.timeline import NEVER, Timeline

log = logging.getLogger("nao_sim.ears")

BLOCK = 8160
"""Frames of a block, 170 ms."""
HOLD_LAG = 0.25
"""When ears are behind by more, s, time that runs faster than the wall clock waits for them."""
GIVE_UP = 20.0
"""When they are behind by more, s, what is between is left out: nobody waited for them."""
WANTS = ("48k4", "16k1")
REACH = 48
"""Frames before and after a place that the filter looks at."""
THIRD_RATE = 16000


def _low_pass() -> np.ndarray:
    """Passes up to 7 kHz within 0.1 dB, and what would be folded down from above 9 kHz not at all (-80 dB)."""
    at = np.arange(-REACH, REACH + 1)
    taps = np.sinc(at / 3.0) * np.kaiser(2 * REACH + 1, 8.0)
    return (taps / taps.sum()).astype(np.float32)


LOW_PASS = _low_pass()


def third(signal: np.ndarray) -> np.ndarray:
    """Every third sample, (n,) float32, of a (REACH + 3 n + REACH,) signal, free of what the lower rate cannot hold.

    The first sample of the result is that at REACH.
    """
    # Three filters for the three phases, each at the lower rate: a third of the work.
    count = (len(signal) - 2 * REACH) // 3
    out = np.zeros(count, np.float32)
    for phase in range(3):
        taps = LOW_PASS[phase::3]
        out += np.convolve(signal[phase::3][: count + len(taps) - 1], taps[::-1], "valid")
    return out


@dataclass(frozen=True, eq=False)
class MicrophoneBlock:
    """What the microphones heard from a time on, simulated s: (frames, channels) int16, read-only, `rate` a second."""

    time: float
    samples: np.ndarray
    rate: int

    @property
    def end(self) -> float:
        """Simulated time after the last sample, s."""
        return self.time + len(self.samples) / self.rate


@dataclass(eq=False)
class Listener:
    """Somebody who hears; `key` is what they want and which channel, `next` their next frame."""

    ears: Ears
    name: str
    callback: Callable[[MicrophoneBlock], None]
    key: tuple[str, str]
    next: int
    exact: bool
    closed: bool = False

    def close(self) -> None:
        """Hear nothing any more; one that is `exact` gets the rest up to now first. Not in the simulation thread then.

        When it returns, no callback runs, unless it is called from one; so it must not be called in a thread that a
        callback waits for.
        """
        self.ears.remove(self)

    def deliver(self, block: MicrophoneBlock) -> None:
        """Hand over a block; ears' thread."""
        try:
            self.callback(block)
        except Exception as error:
            self.ears.guard.caught(f"listener {self.name}", error)


class Ears:
    """Listeners and their thread, which runs as long as there are any.

    `released` is called when time that waited need not wait any more; the guard is told of listeners that fail.
    """

    def __init__(
        self, timeline: Timeline, microphones: Microphones, released: Callable[[], None], guard: Guard
    ) -> None:
        self.guard = guard
        self._timeline = timeline
        self._microphones = microphones
        self._released = released
        self._news = threading.Condition()
        self._busy = threading.RLock()  # held while blocks are delivered
        self._listeners: tuple[Listener, ...] = ()
        self._thread: threading.Thread | None = None
        self._done = 0  # blocks up to this frame are delivered
        self.due = NEVER
        """The frame at which the next block can be heard; the simulation thread calls `wake` then."""

    @property
    def lag(self) -> float:
        """By how much they are behind what can be heard, s."""
        if not self._listeners:
            return 0.0
        return max(0, self._timeline.now - GUARD - self._done) // BLOCK * BLOCK / RATE

    @property
    def listening(self) -> bool:
        return bool(self._listeners)

    def holds(self) -> bool:
        """Whether time should wait, when it runs faster than the wall clock."""
        return self.lag > HOLD_LAG

    def listen(
        self,
        name: str,
        callback: Callable[[MicrophoneBlock], None],
        wants: str = "48k4",
        channel: str = "front",
        exact: bool = False,
        begin: float | None = None,
    ) -> Listener:
        """Hear from now on. Any thread.

        Args:
            name: For the log.
            callback: Called with each block in the ears' thread, in order.
            wants: "48k4" for 48 kHz and all four microphones, "16k1" for 16 kHz and one.
            channel: Which one: left, right, front, rear, or all for their mean.
            exact: The first block begins exactly now, and the last ends exactly at `close`; else all blocks are
                whole, and the first is the first whole one that begins from now on.
            begin: Simulated time of the first sample, s, not before now: then only the first block is not whole. None:
                as `exact` says.
        """
        if wants not in WANTS:
            raise BadValue("wants", wants, " or ".join(WANTS))
        if channel not in (*CHANNELS, "all"):
            raise BadValue("channel", channel, f"{', '.join(CHANNELS)} or all")
        with self._news:
            now = self._timeline.now
            start = _next_sample(now, wants) if exact else -(-now // BLOCK) * BLOCK
            if begin is not None:
                start = _next_sample(max(now, frame_at(begin)), wants)
            listener = Listener(self, name, callback, (wants, channel), start, exact)
            if not self._listeners:
                self._done = now // BLOCK * BLOCK
            self._listeners = (*self._listeners, listener)
            self.due = min(self.due, self._done + BLOCK + GUARD)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="ears", daemon=True)
                self._thread.start()
        return listener

    def past(self, seconds: float, wants: str = "48k4", channel: str = "front") -> np.ndarray:
        """(frames, channels) int16 of what was heard last, as `listen` has it; less where less is remembered."""
        last = (self._timeline.now - GUARD - REACH) // 3 * 3
        first = max(last - frame_at(seconds) // 3 * 3, -(-(self._timeline.oldest + REACH) // 3) * 3)
        if last <= first:  # it has just begun
            return np.zeros((0, len(CHANNELS) if wants == "48k4" else 1), np.int16)
        return _block(self._microphones.render(first - REACH, last + REACH), wants, channel)

    def remove(self, listener: Listener) -> None:
        """End of a listener; see `Listener.close`."""
        inside = threading.current_thread() is self._thread
        if listener.exact and not inside and not listener.closed:
            self._finish(listener)
        with self._news:
            listener.closed = True
            self._listeners = tuple(other for other in self._listeners if other is not listener)
            if not self._listeners:
                self.due = NEVER
            self._news.notify_all()
        if not inside:
            with self._busy:  # a callback that runs comes to its end
                pass
        self._released()

    def wake(self) -> None:
        """A block can be heard. Simulation thread."""
        with self._news:
            self.due = NEVER
            self._news.notify_all()

    def catch_up(self, timeout: float = 30.0) -> None:
        """Wait until everything that can be heard now has been delivered (wall time, s).

        Raises:
            TimeoutError: It has not been within `timeout`.
        """
        wanted = self._timeline.now - GUARD - BLOCK
        with self._news:
            self._news.notify_all()
            if not self._news.wait_for(lambda: not self._listeners or self._done > wanted, timeout):
                raise TimeoutError(f"ears have not caught up within {timeout} s; they are {self.lag:.1f} s behind")

    def close(self) -> None:
        with self._news:
            for listener in self._listeners:
                listener.closed = True
            self._listeners = ()
            self.due = NEVER
            self._news.notify_all()

    # --- ears' thread ---------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: not self._listeners or self._ready())
                if not self._listeners:
                    self._thread = None
                    return
                first = self._skip_if_late()
                listeners = self._listeners
            with self._busy:
                self._deliver(listeners, first, first + BLOCK)
            with self._news:
                self._done = max(self._done, first + BLOCK)
                self._news.notify_all()
            self._released()

    def _ready(self) -> bool:
        due = self._done + BLOCK + GUARD
        if self._timeline.now < due:
            self.due = due
        return self._timeline.now >= due  # time may have passed meanwhile

    def _skip_if_late(self) -> int:
        if self.lag > GIVE_UP:
            late = self._done
            self._done = (self._timeline.now - GUARD) // BLOCK * BLOCK - BLOCK
            log.warning("ears are too slow: %.1f s are left out", (self._done - late) / RATE)
            for listener in self._listeners:
                listener.next = max(listener.next, self._done)
        return self._done

    def _finish(self, listener: Listener) -> None:
        """Deliver what an exact listener has not had yet; the caller's thread."""
        now = _next_sample(self._timeline.now, listener.key[0])
        self.catch_up()
        with self._busy:
            while listener.next < now and not listener.closed:
                first = listener.next
                last = min(now, (first // BLOCK + 1) * BLOCK)
                self._deliver((listener,), first, last)

    def _deliver(self, listeners: tuple[Listener, ...], first: int, last: int) -> None:
        """Work out the frames `first` to `last` and hand them over; what cannot be worked out is not heard."""
        self.guard.call(self._hand_over, listeners, first, last)
        for listener in listeners:
            listener.next = max(listener.next, last)

    def _hand_over(self, listeners: tuple[Listener, ...], first: int, last: int) -> None:
        wide: np.ndarray | None = None
        made: dict[tuple[str, str], np.ndarray] = {}
        for listener in listeners:
            if listener.closed or listener.next >= last:
                continue
            if wide is None:
                wide = self._microphones.render(first - REACH, last + REACH)
            if listener.key not in made:
                made[listener.key] = _block(wide, *listener.key)
            samples, begin = made[listener.key], max(first, listener.next)
            rate = RATE if listener.key[0] == "48k4" else THIRD_RATE
            listener.next = last
            listener.deliver(MicrophoneBlock(begin / RATE, samples[(begin - first) * rate // RATE :], rate))


def _next_sample(frame: int, wants: str) -> int:
    """The first frame from `frame` on at which there is a sample: at 16 kHz that is every third."""
    return frame if wants == "48k4" else -(-frame // 3) * 3


def _block(wide: np.ndarray, wants: str, channel: str) -> np.ndarray:
    """Samples of a block in the form that somebody wants, from (4, REACH + frames + REACH)."""
    if wants == "48k4":
        samples = pcm16(wide[:, REACH:-REACH]).T
        samples = np.ascontiguousarray(samples)
    else:
        one = wide.mean(axis=0) if channel == "all" else wide[CHANNELS.index(channel)]
        samples = pcm16(third(one))[:, None]
    samples.flags.writeable = False
    return samples
