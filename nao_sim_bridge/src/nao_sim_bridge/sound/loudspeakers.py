"""The two loudspeakers in the robot's head: what they play, mixed, and what other robots hear of it."""

from __future__ import annotations

from typing import Iterable

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE, Sound, frame_at, pcm16
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.sound.envelope import Envelope
from nao_sim_bridge.sound.playing import RAMP, Mark, Playing
from nao_sim_bridge.sound.poses import PoseTrack
from nao_sim_bridge.sound.settings import SoundSettings
from nao_sim_bridge.sound.sources import LONGEST_WAY
from nao_sim_bridge.sound.timeline import Timeline

SIDES = "-1 (left) to 1 (right)"


class SpeakerPlaying(Playing):
    def __init__(self, volume: float, pan: float, *args, **options) -> None:
        self.follows = False  # whether it was to begin when another one ends
        self.volume, self.pan = _within("volume", volume, 0.0, "0 to 1"), _within("pan", pan, -1.0, SIDES)
        super().__init__(*args, gains=self._sides(), **options)

    def set_volume(self, volume: float) -> None:
        """Its own volume from now on, 0..1."""
        self.volume = _within("volume", volume, 0.0, "0 to 1")
        self._set_gains(self._sides())

    def set_pan(self, pan: float) -> None:
        """From which side it comes from now on: -1 left, 0 both, 1 right."""
        self.pan = _within("pan", pan, -1.0, SIDES)
        self._set_gains(self._sides())

    def _sides(self) -> tuple[float, float]:
        return self.volume * min(1.0, 1.0 - self.pan), self.volume * min(1.0, 1.0 + self.pan)


class Loudspeakers:
    """Both loudspeakers. Simulation thread, but for reading properties and `played`. Volumes: 0..100."""

    def __init__(self, timeline: Timeline, ids: TaskIds, volume: float = 100.0) -> None:
        self._timeline = timeline
        self._ids = ids
        self._volume = volume
        self._muted = False
        self._closed = False
        self._master = Envelope((volume / 100.0,), RAMP)
        self._players: tuple[SpeakerPlaying, ...] = ()
        timeline.forget.append(self._forget)

    @property
    def volume(self) -> float:
        """Master volume, 0..100."""
        return self._volume

    @volume.setter
    def volume(self, volume: float) -> None:
        if not 0.0 <= volume <= 100.0:
            raise BadValue("volume", volume, "0 to 100")
        self._volume = volume
        self._set_master()

    @property
    def muted(self) -> bool:
        """Whether nothing is to be heard; what plays goes on."""
        return self._muted

    @muted.setter
    def muted(self, muted: bool) -> None:
        self._muted = bool(muted)
        self._set_master()

    @property
    def closed(self) -> bool:
        """Whether the outputs are closed: as muted."""
        return self._closed

    @closed.setter
    def closed(self, closed: bool) -> None:
        self._closed = bool(closed)
        self._set_master()

    @property
    def playing(self) -> tuple[SpeakerPlaying, ...]:
        """What plays or is paused."""
        return tuple(player for player in self._players if not player.ended)

    def play(
        self,
        sound: Sound,
        name: str,
        volume: float = 1.0,
        pan: float = 0.0,
        start: float = 0.0,
        loop: bool = False,
        marks: Iterable[Mark] = (),
        after: Playing | None = None,
    ) -> SpeakerPlaying:
        """Play a sound from now on; volume and pan are as in `SpeakerPlaying`, start, loop and marks as in `Playing`.

        Args:
            sound: One channel for both loudspeakers, or two for left and right; of more the first two count. A long
                one should have RATE already: else it is converted here.
            after: Begin at the very frame at which this one will end as things are, so that they follow without a gap;
                now when that is over, paused or a loop.

        Raises:
            BadValue: Too much plays already.
        """
        if after is None:  # else it plays when others have ended
            self._require_room(sound)
        begin = after.end_frame if after is not None else None
        if sound.channels > 2:
            sound = Sound(sound.samples[:, :2], sound.rate)
        options = {"start": start, "loop": loop, "marks": marks, "begin": begin}
        player = SpeakerPlaying(volume, pan, self._timeline, self._ids, name, sound, **options)
        player.follows = after is not None
        self._players = (*self._players, player)
        return player

    def stop_all(self) -> None:
        for player in self.playing:
            player.stop()

    def played(self, from_s: float, to_s: float) -> Sound:
        """What they played between two simulated times, s: two channels, before the air.

        Raises:
            BadValue: The time is still to come, or has been forgotten.
        """
        first, last = checked_past(self._timeline, from_s, to_s)
        mixed = self.mixed(first, last)
        return Sound(np.zeros((last - first, 2), np.float32) if mixed is None else mixed)

    def sounds(self, first: int, last: int) -> bool:
        """Whether anything may sound from frame `first` to `last`; never False when something does."""
        return bool(self._players) and any(not player.over_before(first) for player in self._players)

    def mixed(self, first: int, last: int) -> np.ndarray | None:
        """(last - first, 2) from frame `first` to `last`; None when nothing plays."""
        out = None
        for player in self._players:
            dry = player.render(first, last)
            if dry is None:
                continue
            if out is None:
                out = np.zeros((last - first, 2), np.float32)
            for side, gain in enumerate(player.gains(first, last)):
                out[:, side] += dry[:, min(side, dry.shape[1] - 1)] * np.float32(gain)
        if out is None:
            return None
        out *= np.reshape(np.float32(self._master.between(first, last)[0]), (-1, 1))
        return np.clip(out, -1.0, 1.0, out=out)

    def pcm(self, first: int, last: int) -> np.ndarray:
        """(last - first, 2) int16 from frame `first` to `last`, silence included."""
        mixed = self.mixed(first, last)
        return np.zeros((last - first, 2), np.int16) if mixed is None else pcm16(mixed)

    def _require_room(self, sound: Sound) -> None:
        sizes, playing = load_sizes().loaded_sounds, self.playing
        if len(playing) >= sizes.at_once and sum(not player.follows for player in playing) >= sizes.at_once:
            raise BadValue("number of sounds that play", len(playing) + 1, f"{sizes.at_once} at most")
        taken = sum({id(each): each.samples.nbytes for each in (sound, *(p.sound for p in playing))}.values())
        if taken > sizes.bytes:
            raise BadValue("bytes of sounds that play", taken, f"{sizes.bytes} at most")

    def _set_master(self) -> None:
        on = not (self._muted or self._closed)
        self._master.set(self._timeline.now, (self._volume / 100.0 if on else 0.0,))

    def _forget(self, before: int) -> None:
        before -= LONGEST_WAY  # another robot hears it later
        self._players = tuple(player for player in self._players if not player.over_before(before))
        for player in self._players:
            player.forget(before)
        self._master.forget(before)


def checked_past(timeline: Timeline, from_s: float, to_s: float) -> tuple[int, int]:
    """Frames of two simulated times that are past and not forgotten.

    Raises:
        BadValue: They are not.
    """
    first, last = frame_at(from_s), frame_at(to_s)
    if last > timeline.now:
        raise BadValue("to_s", to_s, f"at most {timeline.now / RATE:g} s, the time of now")
    if not timeline.oldest <= first <= last:
        oldest = timeline.oldest / RATE
        raise BadValue("from_s", from_s, f"{oldest:g} s, where memory begins, to {to_s:g} s")
    return first, last


def _within(name: str, value: float, least: float, allowed: str) -> float:
    if not least <= value <= 1.0:
        raise BadValue(name, value, allowed)
    return float(value)


class RobotVoice:
    """The loudspeakers of a robot, heard from outside: half-way between the two. Any thread."""

    def __init__(
        self,
        model: RobotModel,
        settings: SoundSettings,
        timeline: Timeline,
        loudspeakers: Loudspeakers,
        poses: PoseTrack,
        frames_per_tick: int,
    ) -> None:
        self.loudspeakers = loudspeakers
        self._timeline = timeline
        self._poses = poses
        self._tick = frames_per_tick
        self._mouth = np.mean([place.position for place in model.loudspeakers], axis=0)[None]
        self._peak = np.float32(settings.loudspeaker_peak)

    def silent(self, first: int, last: int) -> bool:
        """Whether nothing has been played from frame `first` to `last`."""
        return not self.loudspeakers.sounds(first, last)

    def at(self, frames: np.ndarray) -> np.ndarray:
        """(..., 3) where it is at `frames` of any shape, none after now, in world, m; straight between two ticks."""
        newest = self._timeline.now // self._tick
        flat = np.minimum(frames.ravel() / self._tick, newest)
        first = int(np.floor(flat.min()))
        last = min(int(np.ceil(flat.max())), newest)
        places = self._poses.at(first, max(first, last)).place(self._mouth)[:, 0]
        knots = np.arange(first, first + len(places))
        lines = [np.interp(flat, knots, places[:, axis]) for axis in range(3)]
        return np.stack(lines, axis=-1).reshape((*frames.shape, 3))

    def dry(self, first: int, last: int) -> np.ndarray | None:
        """(last - first,) what it gives off, as a microphone at 1 m has it; None when that is nothing."""
        mixed = self.loudspeakers.mixed(first, last)
        return None if mixed is None else (mixed[:, 0] + mixed[:, 1]) * self._peak
