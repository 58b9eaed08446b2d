"""The four microphones in the robot's head: what they hear, worked out when somebody asks."""

from __future__ import annotations

import math
from functools import lru_cache, partial
from typing import Callable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, ConfigError
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.sound.loudspeakers import Loudspeakers, RobotVoice, checked_past
from nao_sim_bridge.sound.poses import PoseTrack
from nao_sim_bridge.sound.propagation import FixedWays, arrivals, at_places, between_knots
from nao_sim_bridge.sound.settings import SoundSettings
from nao_sim_bridge.sound.sources import LONGEST_WAY, Sources
from nao_sim_bridge.sound.timeline import Timeline

GUARD = 96
"""Frames (2 ms) that the filters look ahead: what is heard at a frame is settled when so much more time has passed."""
CHUNK = 16384
SUPPLY = 2**18
"""Frames that noise is cut from: drawing new ones all the time would be most of the work of hearing."""


class Microphones:
    """What the microphones hear. `heard` and `render` are for any thread, the rest for the simulation thread.

    Raises:
        ConfigError: The settings name a microphone that the robot does not have.
    """

    def __init__(
        self,
        model: RobotModel,
        settings: SoundSettings,
        timeline: Timeline,
        loudspeakers: Loudspeakers,
        sources: Sources,
        frames_per_tick: int,
        seed: int,
        others: Callable[[], Sequence[RobotVoice]] = tuple,
    ) -> None:
        self._settings = settings
        self._timeline = timeline
        self._loudspeakers = loudspeakers
        self._sources = sources
        self._others = others
        self._tick = frames_per_tick
        by_name = {place.name: place for place in model.microphones}
        missing = [name for name in settings.order if name not in by_name]
        if missing:
            raise ConfigError("sound.json: channels", f"no such microphone: {', '.join(missing)}")
        link = by_name[settings.order[0]].parent_link
        self.places = np.array([by_name[name].position for name in settings.order])
        """(4, 3) in the frame of the head's link, m."""
        keep = math.ceil((settings.keep_s + 2.0) * RATE / frames_per_tick)
        self.poses = PoseTrack(model, link, keep)
        self._background = Background(seed, settings.peak_of(settings.background_db) / math.sqrt(2.0))
        self._per_meter = RATE / settings.speed_of_sound
        speakers = np.array([place.position for place in model.loudspeakers])
        distances = np.linalg.norm(self.places[None] - speakers[:, None], axis=-1)
        self.own_gains = settings.loudspeaker_peak / np.maximum(distances, settings.near_field_m)
        """(2, 4) of each loudspeaker in the same head, as each microphone hears it."""
        self._own_ways = FixedWays.of(distances * self._per_meter, self.own_gains)
        self._replacements: tuple[tuple[int, Sound | None], ...] = ((-(2**62), None),)
        timeline.forget.append(self._forget)

    @property
    def replaced_by(self) -> Sound | None:
        """A sound that is heard instead of everything else, from when it was set until it is over.

        One or two channels are heard by all four microphones, four by one each. None: they hear the world.
        """
        now = self._timeline.now
        return next(sound for begin, sound in reversed(self._replacements) if begin <= now)

    @replaced_by.setter
    def replaced_by(self, sound: Sound | None) -> None:
        if sound is not None:
            if sound.channels not in (1, 2, 4):
                allowed = "1 or 2 (heard by all four), or 4 (left, right, front, rear)"
                raise BadValue("channels", sound.channels, allowed)
            sound = (sound.mono() if sound.channels == 2 else sound).at_rate(RATE)
        now = self._timeline.now
        kept = [replacement for replacement in self._replacements if replacement[0] < now]
        end = [] if sound is None else [(now + sound.frames, None)]
        self._replacements = (*kept, (now, sound), *end)

    def heard(self, from_s: float, to_s: float) -> np.ndarray:
        """What they heard between two simulated times, s.

        Returns:
            (frames, 4) float32 left, right, front, rear; 1 is full scale, and no more than that is heard.

        Raises:
            BadValue: The time is still to come, or has been forgotten.
        """
        first, last = checked_past(self._timeline, from_s, to_s)
        return np.ascontiguousarray(self.render(first, last).T)

    def render(self, first: int, last: int) -> np.ndarray:
        """(4, last - first) float32 from frame `first` to `last`, -1..1; later than now it is a forecast."""
        out = np.zeros((len(self.places), last - first), np.float32)
        replacements = self._replacements
        for (begin, sound), (end, _) in zip(replacements, (*replacements[1:], (last, None))):
            low, high = max(first, begin), min(last, end)
            if low >= high:
                continue
            part = self._air(low, high) if sound is None else sound.samples[low - begin : high - begin].T
            out[:, low - first : high - first] = part
        np.minimum(out, 1.0, out=out)  # a seventh of the time of np.clip
        return np.maximum(out, -1.0, out=out)

    def _air(self, first: int, last: int) -> np.ndarray:
        out = self._background.between(first, last)
        self._add_loudspeakers(out, first, last)
        sources = [source for source in self._sources.sounding if not source.over_before(first - LONGEST_WAY)]
        voices = [voice for voice in self._others() if not voice.silent(first - LONGEST_WAY, last)]
        if sources or voices:
            # Knots of the movement are the ticks, whoever asks for which part of time.
            ticks = np.arange(first // self._tick, -(-last // self._tick) + 1)
            newest = self._timeline.now // self._tick
            knots = np.minimum(ticks, newest)
            microphones = self.poses.at(int(knots[0]), int(knots[-1])).place(self.places)[knots - knots[0]]
            for source in sources:
                for stint in source.stints:
                    dry = partial(source.dry, stint)
                    self._add_source(out, stint.at, dry, ticks * self._tick, microphones, first, last)
            for voice in voices:
                self._add_source(out, voice.at, voice.dry, ticks * self._tick, microphones, first, last)
        return out

    def _add_loudspeakers(self, out: np.ndarray, first: int, last: int) -> None:
        before, after = self._own_ways.span
        mixed = self._loudspeakers.mixed(first - before, last + after)
        if mixed is None:
            return
        left, right = (np.ascontiguousarray(mixed[:, side]) for side in range(2))
        signals = [(slice(None), left)] if np.array_equal(left, right) else [(0, left), (1, right)]  # speech is equal
        for side, signal in signals:
            for k, channel in enumerate(out):
                channel += self._own_ways.through(signal, (side, k))

    def _add_source(
        self,
        out: np.ndarray,
        at: Callable[[np.ndarray], np.ndarray],
        dry: Callable[[int, int], np.ndarray | None],
        knots: np.ndarray,
        microphones: np.ndarray,
        first: int,
        last: int,
    ) -> None:
        given_off, distances = arrivals(microphones, knots, at, self._per_meter)
        skip = first - int(knots[0])
        places = between_knots(given_off, self._tick, skip, last - first)
        heard = at_places(dry, places)
        if heard is None:
            return
        weaker = 1.0 / np.maximum(distances, self._settings.near_field_m)
        heard *= between_knots(weaker, self._tick, skip, last - first, np.float32)
        out += heard

    def _forget(self, before: int) -> None:
        kept = [n for n, (begin, _) in enumerate(self._replacements) if begin <= before]
        if kept and kept[-1] > 0:
            self._replacements = self._replacements[kept[-1] :]


class Background:
    """Noise of several channels, independent of each other.

    Each chunk is cut from the supply at a place of its own, so that nothing comes again at regular times.
    """

    def __init__(self, seed: int, rms: float, channels: int = 4) -> None:
        self._seed = abs(seed)
        self._rms = np.float32(rms)
        self._channels = channels
        self._supply: np.ndarray | None = None
        self._cut = lru_cache(maxsize=64)(self._draw_cut)

    def between(self, first: int, last: int) -> np.ndarray:
        """(channels, last - first) float32 from frame `first` to `last`."""
        if self._supply is None:
            chance = np.random.Generator(np.random.SFC64([self._seed]))
            self._supply = self._rms * chance.standard_normal((self._channels, SUPPLY), np.float32)
        out = np.empty((self._channels, last - first), np.float32)
        at = first
        while at < last:
            number, offset = divmod(at, CHUNK)
            count = min(CHUNK - offset, last - at)
            cut = self._cut(number) + offset
            out[:, at - first : at - first + count] = self._supply[:, cut : cut + count]
            at += count
        return out

    def _draw_cut(self, number: int) -> int:
        """Where in the supply a chunk is cut out."""
        # A generator of its own, so that no chunk depends on which others were asked for before.
        chance = np.random.Generator(np.random.SFC64([self._seed, abs(number), int(number < 0)]))
        return int(chance.integers(SUPPLY - CHUNK))
