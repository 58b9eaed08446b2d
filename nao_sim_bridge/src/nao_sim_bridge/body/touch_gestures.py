"""Gestures on the three sensors of the head, as ALTactileGesture knows them, and clicks of buttons. Arithmetic only.

What is touched is a pattern of three digits, 1 for each of front, middle and rear that is: `100`. A gesture is a
sequence of patterns that begins with `000`; one that ends with it is over when the hand has gone, another one is held.

Source: overview of ALTactileGesture, NAOqi 2.8 (gestures, meaning of the three times); its Java proxy (defaults of the
times).
"""

from __future__ import annotations

from typing import Iterable, List, Mapping, NamedTuple, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few

FREE = "000"
Gesture = Tuple[str, ...]

GESTURES: Mapping[str, Gesture] = {
    name: (FREE, *patterns.split())
    for name, patterns in {
        "SingleFront": "100 000",
        "SingleMiddle": "010 000",
        "SingleRear": "001 000",
        "DoubleFront": "100 000 100 000",
        "DoubleMiddle": "010 000 010 000",
        "DoubleRear": "001 000 001 000",
        "SingleTap": "111 000",
        "DoubleTap": "111 000 111 000",
        "CaressFtoR": "100 010 001 000",
        "CaressRtoF": "001 010 100 000",
        "ZoomIn": "101 010 000",
        "ZoomOut": "010 101 000",
        "TheClaw": "101 000",
        "SingleFrontHold": "100",
        "SingleMiddleHold": "010",
        "SingleRearHold": "001",
        "SingleTapHold": "111",
        "TheClawHold": "101",
    }.items()
}
"""Those that are built in."""
MOST_PATTERNS = 32
SETTLE_TIME, HOLD_TIME, SEQUENCE_TIME = 0.04, 0.8, 0.2
LONGEST_TIME = 10.0
LONGEST_CLICK = 1.0
"""A button that is held longer, s, was no click."""
LONGEST_PAUSE = 0.5
"""Clicks that follow each other within this time, s, belong together."""
MOST_CLICKS = 3


class Seen(NamedTuple):
    """Something to tell.

    Attributes:
        gesture: Name of a gesture that was recognised; empty when there is none.
        released: Whether the hand has gone after a gesture.
    """

    gesture: str = ""
    released: bool = False


NOTHING = Seen()


class Times:
    """How long a touch takes to be read, to be held, and to be over.

    Attributes:
        settle: From the first change to the reading, s: fingers do not land all at once.
        hold: From a reading to a held gesture, and from each time that it is told to the next, s.
        sequence: Longest pause between two touches of one gesture, s.
    """

    def __init__(self) -> None:
        self.settle, self.hold, self.sequence = SETTLE_TIME, HOLD_TIME, SEQUENCE_TIME


class GestureBook:
    """The gestures that are known, by name."""

    def __init__(self) -> None:
        self._names = {gesture: name for name, gesture in GESTURES.items()}

    def all(self) -> dict[str, List[str]]:
        return {name: list(gesture) for gesture, name in self._names.items()}

    def name_of(self, sequence: Iterable[str]) -> str | None:
        """Name of a sequence; None when nobody has made it a gesture."""
        return self._names.get(tuple(sequence))

    def sequence_of(self, name: str) -> List[str] | None:
        """Sequence of a gesture; None when there is none of that name."""
        return next((list(gesture) for gesture, known in self._names.items() if known == name), None)

    def add(self, sequence: Sequence[str]) -> str:
        """Name of the gesture that a sequence is from now on; the one it has when it is known.

        Raises:
            BadValue: No head can be touched like that, or there would be too many gestures.
        """
        gesture = checked(sequence)
        name = "".join(("Gesture", *(f"_{pattern}" for pattern in gesture[1:])))
        if gesture not in self._names:
            require_few("sensor sequence", len(self._names) - len(GESTURES) + 1, "gestures")
        return self._names.setdefault(gesture, name)


class GestureRecogniser:
    """Finds gestures in what the sensors of one head feel: feed it with every reading. `times` may change meanwhile."""

    def __init__(self, book: GestureBook, times: Times) -> None:
        self._book = book
        self._times = times
        self._sequence = [FREE]
        self._raw = FREE
        self._settling: float | None = None
        self._read_at = 0.0
        self._held = False
        self._told = False

    def feed(self, pattern: str, now: float) -> Seen:
        """What there is to tell when `pattern` is touched at simulated time `now`, s."""
        if pattern != self._raw:
            self._raw = pattern
            if self._settling is None:
                self._settling = now
        if self._settling is not None:
            if now - self._settling < self._times.settle - 1e-9:
                return NOTHING
            self._settling = None
            return self._read(pattern, now)
        waited = now - self._read_at + 1e-9
        if self._sequence[-1] != FREE:
            return self._hold(now) if waited >= self._times.hold else NOTHING
        if len(self._sequence) > 1 and waited >= self._times.sequence:
            return self._complete()
        return NOTHING

    def _read(self, pattern: str, now: float) -> Seen:
        if pattern == self._sequence[-1]:
            return NOTHING
        self._read_at = now
        if not self._held:
            self._sequence.append(pattern)
            if len(self._sequence) > MOST_PATTERNS:  # nothing that long is a gesture
                self._sequence = [FREE, pattern]
            return NOTHING
        # What follows something held is a gesture of its own.
        released = Seen(released=self._told)
        self._begin([FREE] if pattern == FREE else [FREE, pattern])
        return released

    def _hold(self, now: float) -> Seen:
        self._held, self._read_at = True, now
        name = self._book.name_of(self._sequence)
        self._told = self._told or name is not None
        return Seen(name or "")

    def _complete(self) -> Seen:
        name = self._book.name_of(self._sequence)
        self._begin([FREE])
        return NOTHING if name is None else Seen(name, released=True)

    def _begin(self, sequence: List[str]) -> None:
        self._sequence, self._held, self._told = sequence, False, False


def checked(sequence: Sequence[str]) -> Gesture:
    """A sequence that can be a gesture.

    Raises:
        BadValue: It cannot.
    """
    gesture = tuple(sequence)
    allowed = f"2 to {MOST_PATTERNS} texts of three digits 0 or 1, '{FREE}' first, none like the one before"
    right = 2 <= len(gesture) <= MOST_PATTERNS and gesture[0] == FREE
    right = right and all(isinstance(p, str) and len(p) == 3 and set(p) <= {"0", "1"} for p in gesture)
    if not right or any(first == second for first, second in zip(gesture, gesture[1:])):
        raise BadValue("sensor sequence", list(gesture)[:MOST_PATTERNS], allowed)
    return gesture


class ClickCounter:
    """Counts the clicks of one button: feed it with every reading.

    NAOqi publishes no figures for its clicks; these are those of usual desktops.
    """

    def __init__(self) -> None:
        self._down = False
        self._since = 0.0
        self._clicks = 0

    def feed(self, down: bool, now: float) -> int:
        """How many clicks are over at simulated time `now`, s: 1 to 3, once for each series; else 0."""
        if down != self._down:
            held = now - self._since
            self._down, self._since = down, now
            if down:
                return 0
            # What was held breaks the series: somebody who wants three clicks does not hold the second.
            self._clicks = self._clicks + 1 if held <= LONGEST_CLICK else 0
        elif down or not self._clicks or now - self._since < LONGEST_PAUSE:
            return 0
        else:
            return self._end()
        return self._end() if self._clicks == MOST_CLICKS else 0

    def _end(self) -> int:
        clicks, self._clicks = self._clicks, 0
        return clicks
