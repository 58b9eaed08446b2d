"""Speech of one robot: settings, voice, and texts said one after the other. No ROS."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import LOST_WORD_LIMIT, TEXT_PATIENCE

from ...core.errors import Preempted, RobotLost
from ...core.fields import limit
from ...core.health import Level, Report
from ...core.robot import ask, end_call
from ...core.robot_events import EventRelay
from ...core.waiting import CancellationToken

log = logging.getLogger(__name__)

SEPARATOR = "/"
ROBOTS_OWN = -1
"""Volume that leaves the robot's own."""
FULL_VOLUME = 100
FORMER_NAMES = {
    "audio_expression": "enable_audio_expression",
    "visual_expression": "enable_visual_expression",
    "word_spotting": "enable_word_spotting",
}
"""Parameter -> its name in the first versions of nao_speech."""


@dataclass(frozen=True)
class SpeechSettings:
    """Settings of speech and recognition; `PARAMETERS` of nao_speech describes them."""

    voice: str = ""  # empty: the robot's own
    language: str = ""  # empty: the robot's own
    volume: float | None = None  # 0 to 1; None: the robot's own
    vocabulary: tuple[str, ...] = ()
    audio_expression: bool = True
    visual_expression: bool = True
    word_spotting: bool = False


def from_config(config: Mapping[str, Any]) -> SpeechSettings:
    """Settings from the values of the parameters: volume in percent or -1, vocabulary as "yes / no"."""
    volume = config["volume"]
    return SpeechSettings(
        voice=config["voice"].strip(),
        language=config["language"].strip(),
        volume=None if volume < 0 else volume / FULL_VOLUME,
        vocabulary=split_vocabulary(config["vocabulary"]),
        audio_expression=config["audio_expression"],
        visual_expression=config["visual_expression"],
        word_spotting=config["word_spotting"],
    )


def given_parameters(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Private parameters that are set, in the form of today; raises NaoError for a wrong value.

    The first versions of nao_speech had the volume as a share of 1, the vocabulary as a list, and longer names for the
    switches: all of that is accepted.
    """
    given: dict[str, Any] = {}
    for name in ("voice", "language"):
        if name in parameters:
            given[name] = _checked(name, parameters[name], str, "a text")
    if "volume" in parameters:
        given["volume"] = percent(parameters["volume"])
    if "vocabulary" in parameters:
        given["vocabulary"] = _vocabulary(parameters["vocabulary"])
    for name, former in FORMER_NAMES.items():
        for each in (name, former):  # the node takes former names away when it has read them: one there is new
            if each in parameters:
                given[name] = _checked(each, parameters[each], bool, "true or false")
    return given


def percent(volume: Any) -> int:
    """Volume in percent, or -1 for the robot's own.

    Takes an integer in percent, or a float as a share of 1; raises NaoError for anything else.
    """
    if isinstance(volume, float) and 0.0 <= volume <= 1.0:
        return round(FULL_VOLUME * volume)
    whole = isinstance(volume, int) or (isinstance(volume, float) and volume.is_integer())
    if whole and not isinstance(volume, bool) and ROBOTS_OWN <= volume <= FULL_VOLUME:
        return int(volume)
    raise NaoError(f"~volume is {volume!r}: 0 to 100 %, 0.0 to 1.0, or -1 for the robot's own")


def split_vocabulary(text: str) -> tuple[str, ...]:
    """Words and phrases of "yes / no / good morning"."""
    return tuple(word.strip() for word in text.split(SEPARATOR) if word.strip())


def join_vocabulary(words: Sequence[str]) -> str:
    """The inverse of `split_vocabulary`; raises NaoError if a word is empty or holds the separator."""
    for word in words:
        if SEPARATOR in word:
            raise NaoError(f"field words: {word!r} holds {SEPARATOR!r}, which separates words")
        if not word.strip():
            raise NaoError(f"field words: {word!r} is empty")
    return f" {SEPARATOR} ".join(word.strip() for word in words)


def _vocabulary(value: Any) -> str:
    if isinstance(value, str):
        return join_vocabulary(split_vocabulary(value))
    if isinstance(value, (list, tuple)) and all(isinstance(word, str) for word in value):
        return join_vocabulary(value)
    raise NaoError(f"~vocabulary is {value!r}: a text as 'yes / no', or a list of texts")


def _checked(name: str, value: Any, kind: type, allowed: str) -> Any:
    if not isinstance(value, kind):
        raise NaoError(f"~{name} is {value!r}: {allowed}")
    return value


SPEECH = "ALTextToSpeech"
METHODS = {
    "language": ("getLanguage", "setLanguage"),
    "voice": ("getVoice", "setVoice"),
    "volume": ("getVolume", "setVolume"),
}
"""In this order: another language brings another voice with it."""
SAME_VOLUME = 0.005


class BorrowedVoice:
    """Changes how the robot speaks for a while, and restores it.

    Changes that others make meanwhile are left alone. What could not be restored because the robot was lost is restored
    when it is back. Used by one thread at a time.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._before: dict[str, Any] = {}
        self._ours: dict[str, Any] = {}

    @property
    def owed(self) -> bool:
        return bool(self._before)

    def take(self, settings: SpeechSettings) -> None:
        """Apply the settings that are given; raises NaoError if the robot cannot, and then it speaks as before."""
        if self.owed:
            self._settle()
        wanted = {"language": settings.language, "voice": settings.voice, "volume": settings.volume}
        wanted = {name: value for name, value in wanted.items() if value not in ("", None)}
        if not wanted:
            return
        touched = [name for name in METHODS if name in wanted or (name == "voice" and "language" in wanted)]
        self._before = {name: self._get(name) for name in touched}
        self._ours = dict(self._before)
        try:
            for name in touched:
                if name in wanted and not _same(self._get(name), wanted[name]):
                    self._ask(METHODS[name][1], wanted[name])
                    self._ours = {each: self._get(each) for each in touched}
        except NaoError:
            self._settle()
            raise

    def give_back(self) -> None:
        """Restore the former values; raises NaoError if the robot cannot be asked, and then they are still owed."""
        if not self.owed:
            return
        now = {name: self._get(name) for name in self._before}
        still_ours = [name for name in self._before if _same(now[name], self._ours[name])]
        changed = [name for name in still_ours if not _same(now[name], self._before[name])]
        if "language" in changed and "voice" in still_ours and "voice" not in changed:
            changed.append("voice")
        for name in METHODS:
            if name in changed:
                self._ask(METHODS[name][1], self._before[name])
        self._before, self._ours = {}, {}

    def _settle(self) -> None:
        """Restore what the robot accepts; what it refuses must not keep it silent."""
        try:
            self.give_back()
        except NaoError as error:
            log.warning("the robot keeps the voice that it was given: %s", error)
            self._before, self._ours = {}, {}

    def _get(self, name: str) -> Any:
        return self._ask(METHODS[name][0])

    def _ask(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, SPEECH, method, *arguments)


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return abs(one - other) < SAME_VOLUME
    return one == other


STARTED = f"{SPEECH}/TextStarted"
SIGNS_OF_LIFE = (STARTED, f"{SPEECH}/CurrentSentence", f"{SPEECH}/CurrentWord")
LONGEST_QUEUE = int(limit("waiting texts").highest)
CLOSE_LIMIT = 2.0


class Utterance:
    """A text in the queue.

    Callbacks run in threads of the queue or of libqi and must not wait. `ended` is set when the text was said, or will
    not be; `error` is the reason if it was not said to its end.
    """

    def __init__(self, text: str, on_start: Callable[[], None], on_failure: Callable[[Exception], None]) -> None:
        self.text = text
        self.ended = threading.Event()
        self.error: Exception | None = None
        self.interrupt = CancellationToken()
        self.arrived = time.monotonic()
        self._on_start = on_start
        self._on_failure = on_failure
        self._lock = threading.Lock()
        self._started = False

    def start(self) -> None:
        """Report, once, that the robot began to say it."""
        with self._lock:
            first, self._started = not self._started, True
        if first:
            self._on_start()

    def end(self, error: Exception | None) -> None:
        self.error = error
        if isinstance(error, NaoError):
            self._on_failure(error)
        self.ended.set()


class RobotSpeech:
    """The robot's voice: a queue of texts, and a thread that has them said.

    Any thread may call. The lock guards queue and counters; it is not held during calls to the robot.
    """

    def __init__(self, robot: Any, clock: Any, settings: Callable[[], SpeechSettings]) -> None:
        """Start with an empty queue; the robot need not be connected yet.

        `clock`: the robot's time: `now()` and `wait(duration, interrupt)`. `settings`: gives the settings of the next
        text.
        """
        self._robot = robot
        self._clock = clock
        self._settings = settings
        self._voice = BorrowedVoice(robot)
        self._events = EventRelay(lambda: robot.proxy("ALMemory"), self._on_event)
        self._news = threading.Condition()
        self._waiting: deque[Utterance] = deque()
        self._current: Utterance | None = None
        self._closed = False
        self._counts = {"said": 0, "interrupted": 0, "not said": 0}
        self._last_error = ""
        self._last_sign = 0.0
        self._gave_back_to = 0
        self._thread = threading.Thread(target=self._run, name="speech", daemon=True)
        self._thread.start()

    def say(
        self,
        text: str,
        on_start: Callable[[], None] = lambda: None,
        on_failure: Callable[[Exception], None] = lambda error: None,
    ) -> Utterance:
        """Append a text to the queue.

        `on_start`: called when the robot begins to say it. `on_failure`: called with the error if it could not be said.
        Raises NaoError if too many are waiting.
        """
        utterance = Utterance(text, on_start, on_failure)
        with self._news:
            if len(self._waiting) >= LONGEST_QUEUE:
                self._count("not said", f"{LONGEST_QUEUE} texts are waiting already")
                raise NaoError(self._last_error)
            if self._closed:
                utterance.end(Preempted())
                return utterance
            self._waiting.append(utterance)
            self._news.notify_all()
        return utterance

    def silence(self, utterance: Utterance) -> None:
        """End a text: at once if it is being said, and before it begins if it waits. Its `error` becomes Preempted."""
        with self._news:
            waits = utterance in self._waiting
            if waits:
                self._waiting.remove(utterance)
                self._count("interrupted")
        utterance.interrupt.trigger()
        if waits:
            utterance.end(Preempted())

    def robot_is_back(self) -> None:
        """Subscribe events again after a reconnection, and restore the voice if that is still owed."""
        self._events.renew()
        with self._news:
            self._news.notify_all()

    def report(self) -> Report:
        with self._news:
            values = {name: str(count) for name, count in self._counts.items()}
            values["waiting"] = str(len(self._waiting))
            values["last error"] = self._last_error
            speaks = self._current is not None
        return Report(Level.OK, "speaks" if speaks else "ready for texts", values)

    def close(self) -> None:
        """Be silent, now and for all texts to come, and restore the voice."""
        with self._news:
            self._closed = True
            waiting = [*self._waiting]
            current = self._current
            self._news.notify_all()
        for utterance in [*waiting, *([current] if current else [])]:
            self.silence(utterance)
        self._thread.join(CLOSE_LIMIT)
        self._events.close()

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._waiting or self._closed or self._can_give_back())
                if self._closed and not self._waiting:
                    return
                utterance = self._current = self._waiting.popleft() if self._waiting else None
            if utterance is None:
                self._give_back()
                continue
            error = self._outcome(utterance)
            with self._news:
                self._current = None
            utterance.end(error)

    def _can_give_back(self) -> bool:
        """Whether a lost robot is back whose voice has to be restored; one attempt a connection."""
        connection = self._robot.connection
        return self._voice.owed and connection.state == "connected" and self._gave_back_to != connection.generation

    def _outcome(self, utterance: Utterance) -> Exception | None:
        """Have a text said; the error if it was not."""
        try:
            self._speak(utterance)
        except Preempted as signal:
            self._count("interrupted")
            return signal
        except NaoError as error:
            self._count("not said", str(error))
            return error
        except Exception as error:  # a mistake in here must not silence the robot for ever
            log.exception("%r was not said", utterance.text)
            self._count("not said", repr(error))
            return NaoError(f"unexpected error: {error!r}")
        self._count("said")
        return None

    def _speak(self, utterance: Utterance) -> None:
        utterance.interrupt.check()
        self._wait_for_robot(utterance)
        self._listen()
        self._voice.take(self._settings())
        try:
            utterance.interrupt.check()
            self._last_sign = self._clock.now()
            call = self._robot.proxy(SPEECH).call_async("say", utterance.text)
            self._wait(call, utterance.interrupt)
            if not call.done():
                end_call(call, self._stop)
                utterance.interrupt.check()
            call.result(timeout=0)
            utterance.start()  # a robot without events, or a text without a sound
        finally:
            self._give_back()

    def _wait_for_robot(self, utterance: Utterance) -> None:
        """Wait a moment for a robot that was never there; one that was lost fails the text at once."""
        connection = self._robot.connection
        while connection.state == "connecting" and not utterance.interrupt.is_set():
            left = TEXT_PATIENCE - (time.monotonic() - utterance.arrived)
            if left <= 0.0 or connection.wait_connected(min(left, 0.5)):
                break
        utterance.interrupt.check()
        if connection.state == "lost":
            raise RobotLost(self._robot.address, connection.last_error or "no answer")

    def _listen(self) -> None:
        for name in SIGNS_OF_LIFE:
            try:
                self._events.subscribe(name)
            except NaoError as error:
                log.debug("event %s: %s", name, error)  # the text is said all the same

    def _wait(self, call: Any, interrupt: CancellationToken) -> None:
        """Wait for the end of a call, an interrupt, or a robot that says nothing."""
        news = CancellationToken()
        call.add_done_callback(lambda _: news.trigger())
        with interrupt.waking(news.trigger):
            while not news.is_set():
                left = self._last_sign + LOST_WORD_LIMIT - self._clock.now()
                if left <= 0.0:
                    quiet = f"the robot has said nothing for {LOST_WORD_LIMIT:g} s: the text was given up"
                    interrupt.trigger(NaoError(quiet))
                    return
                self._clock.wait(left, news)

    def _stop(self) -> None:
        """Silence a robot whose calls cannot be cancelled."""
        ask(self._robot, SPEECH, "stopAll")

    def _give_back(self) -> None:
        if self._robot.connection.state != "connected":
            return  # it is owed until the robot is back
        self._gave_back_to = self._robot.connection.generation
        try:
            self._voice.give_back()
        except NaoError as error:
            log.warning("the robot's own voice could not be put back: %s", error)

    def _on_event(self, name: str, value: Any) -> None:
        """Called in a thread of libqi."""
        self._last_sign = self._clock.now()
        current = self._current
        if name == STARTED and value and current is not None:
            current.start()

    def _count(self, what: str, error: str = "") -> None:
        with self._news:
            self._counts[what] += 1
            if error:
                self._last_error = error
