"""Sounds in the world: persons who talk, radios, noises."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Tuple

import numpy as np

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.sound.envelope import Envelope
from nao_sim_bridge.sound.playing import RAMP, Playing
from nao_sim_bridge.sound.settings import SoundSettings
from nao_sim_bridge.sound.timeline import Timeline

Position = Tuple[float, float, float]

GLIDE = RATE // 120
"""Frames in which a source goes to a place that is near ..."""
GLIDE_SPEED = 12.0
"""... and at which speed at most, m/s."""
NEAR = 0.5
"""A step up to this length is a glide, m; at a longer one it fades at the old place and comes up at the new one."""
FARTHEST = 100.0
"""Largest coordinate of a place, m."""
LONGEST_WAY = RATE * 5 // 4
"""Frames that sound may be on its way, from one end of such a world to the other."""
LOUD_PART = 0.1
"""Share of the loudest 20 ms (as RMS) above which a part counts as sound and not as a pause in it."""


@dataclass(frozen=True, eq=False)
class SoundSource:
    """A sound at a place in the world, m. Best made outside the simulation thread: a long sound takes a moment.

    It becomes one channel at RATE and begins `start` s in it. The level is that of its loud parts at 1 m, dB SPL, as
    root mean square; the loudness is the same of the samples.
    """

    name: str
    position: Position
    sound: Sound
    level_db: float = 65.0
    loop: bool = False
    start: float = 0.0
    loudness: float = field(init=False)

    def __post_init__(self) -> None:
        sound = self.sound.mono().at_rate(RATE)
        object.__setattr__(self, "sound", sound)
        object.__setattr__(self, "loudness", loud_rms(sound.samples))


class Stint:
    """A time at one place in world, m, or on one way without jumps. Presence is 1 while the source is here."""

    def __init__(self, position: Position, presence: float) -> None:
        self.places = Envelope(position, GLIDE)
        self.presence = Envelope((presence,), RAMP)

    def at(self, frames: np.ndarray) -> np.ndarray:
        """(..., 3) where it is at `frames` of any shape, in world, m."""
        flat = self.places.over(frames.ravel())
        return np.stack(flat, axis=-1).reshape((*frames.shape, 3))


class SourcePlaying(Playing):
    """A source that sounds; its stints follow each other, the last one is now."""

    def __init__(self, source: SoundSource, peak: float, timeline: Timeline, ids: TaskIds) -> None:
        self.name = source.name
        self._gain = peak / math.sqrt(2.0) / source.loudness if source.loudness > 0.0 else 0.0
        self.stints: tuple[Stint, ...] = (Stint(position_of(source.position), 1.0),)
        super().__init__(
            timeline, ids, source.name, source.sound, source.start, source.loop, (), None, gains=(self._gain,)
        )

    @property
    def place(self) -> Position:
        """Where it is or is going to, in world, m."""
        return self.stints[-1].places.target  # type: ignore[return-value]

    def set_volume(self, volume: float) -> None:
        """Its volume from now on, as a share of what its level says, 0 or more."""
        if not 0.0 <= volume < math.inf:
            raise BadValue("volume", volume, "0 or more, finite")
        self._set_gains((self._gain * volume,))

    def move(self, position: Position) -> None:
        """Be somewhere else from now on."""
        position = position_of(position)
        now = self._timeline.now
        newest = self.stints[-1]
        step = math.dist(position, newest.places.at(now))
        if step <= NEAR:
            newest.places.set(now, position, max(GLIDE, round(step / GLIDE_SPEED * RATE)))
            return
        newest.presence.set(now, (0.0,))
        elsewhere = Stint(position, 0.0)
        elsewhere.presence.set(now, (1.0,))
        self.stints = (*self.stints, elsewhere)

    def dry(self, stint: Stint, first: int, last: int) -> np.ndarray | None:
        """(last - first,) what it gives off there, as a microphone at 1 m has it; None when that is nothing."""
        presence = stint.presence.between(first, last)[0]
        if isinstance(presence, float) and presence == 0.0:
            return None
        sound = self.render(first, last)
        if sound is None:
            return None
        return sound[:, 0] * (np.float32(self.gains(first, last)[0]) * np.float32(presence))

    def forget(self, before: int) -> None:
        """Drop what was over before a frame."""
        super().forget(before)
        self.stints = tuple(s for s in self.stints if s.presence.target != (0.0,) or s.presence.at(before) != (0.0,))
        for stint in self.stints:
            stint.places.forget(before)
            stint.presence.forget(before)


class Sources:
    """All sounds of the world. Simulation thread, but for `names` and `sounding`."""

    def __init__(self, timeline: Timeline, ids: TaskIds, settings: SoundSettings) -> None:
        self._timeline = timeline
        self._ids = ids
        self._settings = settings
        self._by_name: dict[str, SourcePlaying] = {}
        self._all: tuple[SourcePlaying, ...] = ()
        timeline.forget.append(self._forget)

    @property
    def sounding(self) -> tuple[SourcePlaying, ...]:
        """Those that are remembered, also of the past."""
        return self._all

    def names(self) -> list[str]:
        return [name for name, source in list(self._by_name.items()) if not source.ended]

    def get(self, name: str) -> SourcePlaying:
        """The source of that name.

        Raises:
            UnknownName: There is none, or its sound has ended.
        """
        if name not in self.names():
            raise UnknownName("sound source", name, self.names())
        return self._by_name[name]

    def add(self, source: SoundSource) -> SourcePlaying:
        """Let a source sound from now on; when its sound is over it is gone.

        Raises:
            BadValue: Its name is taken, its place or level is none, or there is no room for its sound.
        """
        if not source.name or source.name in self.names():
            raise BadValue("name", source.name, f"a name that is not among {', '.join(self.names()) or 'none'}")
        if not -60.0 <= source.level_db <= 140.0:
            raise BadValue("level_db", source.level_db, "-60 to 140 dB SPL at 1 m")
        sizes = load_sizes().world_sounds
        if len(self.names()) >= sizes.sounds:
            raise BadValue("number of sounds", len(self.names()) + 1, f"{sizes.sounds} at most: removeSound makes room")
        kept, largest = sum(playing.sound.samples.nbytes for playing in self._all), sizes.bytes
        if kept + source.sound.samples.nbytes > largest:
            there = f"{len(self._all)} sources have {kept} already: removeSound makes room"
            raise BadValue("sound", f"{source.sound.samples.nbytes} bytes", f"{largest} bytes for all sources; {there}")
        playing = SourcePlaying(source, self._settings.peak_of(source.level_db), self._timeline, self._ids)
        self._by_name[source.name] = playing
        self._all = (*self._all, playing)
        playing.task.add_done_callback(lambda _: self._gone(source.name, playing))
        return playing

    def move(self, name: str, position: Position) -> None:
        """Put a source to another place in world, m."""
        self.get(name).move(position)

    def remove(self, name: str) -> None:
        """Silence a source and forget its name; its task is killed."""
        self.get(name).stop()

    def clear(self) -> None:
        for name in self.names():
            self.remove(name)

    def _gone(self, name: str, playing: SourcePlaying) -> None:
        if self._by_name.get(name) is playing:
            del self._by_name[name]

    def _forget(self, before: int) -> None:
        before -= LONGEST_WAY
        self._all = tuple(source for source in self._all if not source.over_before(before))
        for source in self._all:
            source.forget(before)


def position_of(position: Position) -> Position:
    """The position as three finite numbers.

    Raises:
        BadValue: It is none.
    """
    try:
        x, y, z = (float(value) for value in position)
    except (TypeError, ValueError) as error:
        raise BadValue("position", position, "x, y, z in m, in world") from error
    if not all(abs(value) <= FARTHEST for value in (x, y, z)):
        raise BadValue("position", position, f"x, y, z within {FARTHEST:.0f} m")
    return x, y, z


def loud_rms(samples: np.ndarray) -> float:
    """Root mean square of a sound, (frames, 1) at RATE, without its pauses; 0 for silence."""
    step = RATE // 50
    padded = np.zeros(-(-len(samples) // step) * step)
    padded[: len(samples)] = samples[:, 0]
    powers = np.mean(padded.reshape(-1, step) ** 2, axis=1)
    if not len(powers) or powers.max() == 0.0:
        return 0.0
    if len(samples) < step:
        return float(np.sqrt(np.mean(samples**2)))
    return float(np.sqrt(powers[powers > LOUD_PART**2 * powers.max()].mean()))
