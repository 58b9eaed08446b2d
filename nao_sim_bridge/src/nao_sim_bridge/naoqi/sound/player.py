"""What ALAudioPlayer has loaded and plays. Its sounds are numbered; one number sounds once at a time."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass
from typing import Any, Callable

from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.sizes import LoadedSizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

SHOWN = 5
"""How many sounds a refusal names."""


@dataclass
class LoadedSound:
    """A sound that has a number; everything but its name and sound is touched in the simulation thread only."""

    number: int  # what clients call it by
    name: str  # name of the file as it was given
    sound: Sound  # as it was read
    volume: float = 1.0  # 0 to 1
    pan: float = 0.0  # -1 left to 1 right
    begins: float = 0.0  # where it begins when it is played next, s
    altered: Sound | None = None  # at another pitch; as long as `sound`
    temporary: bool = False  # forgotten when it has been played
    run: Run | None = None  # what plays it now

    @property
    def size(self) -> int:
        return self.sound.samples.nbytes + (self.altered.samples.nbytes if self.altered else 0)

    @property
    def heard(self) -> Sound:
        """What sounds when it is played."""
        return self.altered or self.sound


@dataclass
class Run:
    """One time that a sound is played."""

    task: Task  # for who waits for its end; it outlives a change of the sound
    playing: Any  # what sounds
    loop: bool  # whether it begins again at its end
    begun: float  # simulated time of its first sample, s


class Player:
    """Loaded sounds and how they are played; the loudspeakers are touched in the simulation thread only.

    Args:
        on_end: Told the simulated times of first and last sample, s, when a sound has been played.
        sizes: Answers how many bytes all sounds may take together, and how many there may be.
        elsewhere: Names and bytes of other sounds that count with them.
    """

    def __init__(
        self,
        simulation: Simulation,
        on_end: Callable[[float, float], None],
        sizes: Callable[[], LoadedSizes],
        elsewhere: Callable[[], list[tuple[str, int]]],
    ) -> None:
        self._sizes = sizes
        self._elsewhere = elsewhere
        self._on_end = on_end
        self._simulation = simulation
        self._lock = threading.Lock()  # guards the table; the sounds in it belong to the simulation thread
        self._sounds: dict[int, LoadedSound] = {}
        self._numbers = itertools.count(1)
        self.volume = 1.0
        self._panorama = 0.0

    # --- from any thread ------------------------------------------------------------------------------------------

    def load(self, name: str, sound: Sound, temporary: bool = False) -> LoadedSound:
        """Give a sound a number; a NaoqiError when there is no room for it."""
        self.check_room(name, sound.samples.nbytes)
        loaded = LoadedSound(next(self._numbers), name, sound, temporary=temporary)
        with self._lock:
            self._sounds[loaded.number] = loaded
        return loaded

    def check_room(self, name: str, size: int) -> None:
        """Raise a NaoqiError that names what takes the most, unless there is room for a sound of so many bytes."""
        largest = self._sizes().bytes
        there, most = self.loaded(), self._sizes().sounds
        if len(there) >= most:
            raise NaoqiError(f"no room for {name!r}: {len(there)} sounds are loaded or play, {most} at most")
        kept = [(loaded.name, loaded.size) for loaded in there] + self._elsewhere()
        if sum(each for _, each in kept) + size <= largest:
            return
        most = sorted(kept, key=lambda entry: -entry[1])[:SHOWN]
        listed = ", ".join(f"{each!r} {_megabytes(taken)}" for each, taken in most) or "nothing"
        raise NaoqiError(
            f"no room for {name!r} ({_megabytes(size)}): {_megabytes(largest)} are allowed for all sounds, "
            f"{len(kept)} are loaded or play ({listed}{', ...' if len(kept) > SHOWN else ''}); unloadFile, "
            "unloadAllFiles, unloadSoundSet and stopAll make room"
        )

    def loaded(self) -> list[LoadedSound]:
        with self._lock:
            return list(self._sounds.values())

    def find(self, number: int) -> LoadedSound:
        """The sound of a number; a NaoqiError when there is none."""
        with self._lock:
            if number not in self._sounds:
                known = ", ".join(map(str, self._sounds)) or "none"
                raise NaoqiError(f"no sound is loaded under the id {number}; ids in use: {known}")
            return self._sounds[number]

    # --- in the simulation thread ---------------------------------------------------------------------------------

    def play(self, loaded: LoadedSound, name: str, loop: bool = False) -> Task:
        """Let a sound be heard; one that is paused goes on, one that plays begins anew. Returns its task."""
        run = loaded.run
        if run is not None and run.playing.paused and run.loop == loop:
            run.playing.resume()
            self._adjust(loaded)
            return run.task
        if run is not None:
            run.task.kill()
        task = self._simulation.task_ids.make(name, lambda _: self._silence(loaded))
        loaded.run = Run(task, None, loop, self._simulation.sound.time)
        self._begin(loaded, loaded.begins)
        loaded.begins = 0.0
        return task

    def pause(self, loaded: LoadedSound) -> None:
        if loaded.run is None:
            raise NaoqiError(f"the sound {loaded.number} ({loaded.name}) does not play")
        loaded.run.playing.pause()

    def position(self, loaded: LoadedSound) -> float:
        """Where a sound is, s; where it will begin when it does not play."""
        return loaded.run.playing.position if loaded.run is not None else loaded.begins

    def go_to(self, loaded: LoadedSound, position: float) -> None:
        """Jump to a place, s; a sound that does not play begins there next time."""
        if loaded.run is not None:
            loaded.run.playing.seek(position)
        else:
            loaded.begins = position

    def set_volume(self, loaded: LoadedSound, volume: float, pan: float | None = None) -> None:
        """Volume 0 to 1 and pan -1 to 1 of a sound."""
        loaded.volume = volume
        if pan is not None:
            loaded.pan = pan
        self._adjust(loaded)

    def set_all(self, volume: float | None = None, panorama: float | None = None) -> None:
        """Volume 0 to 1 and panorama -1 to 1 of the whole player, on top of those of each sound."""
        self.volume = self.volume if volume is None else volume
        self._panorama = self._panorama if panorama is None else panorama
        for loaded in self.loaded():
            self._adjust(loaded)

    def stop(self, loaded: LoadedSound) -> None:
        if loaded.run is not None:
            loaded.run.task.kill()

    def stop_all(self) -> None:
        for loaded in self.loaded():
            self.stop(loaded)

    def unload(self, loaded: LoadedSound) -> None:
        """Forget a sound; it is silent then."""
        self.stop(loaded)
        with self._lock:
            self._sounds.pop(loaded.number, None)

    def unload_all(self) -> None:
        for loaded in self.loaded():
            self.unload(loaded)

    def _begin(self, loaded: LoadedSound, position: float) -> None:
        run = loaded.run
        pan = max(-1.0, min(1.0, loaded.pan + self._panorama))
        speakers = self._simulation.sound.loudspeakers
        playing = speakers.play(loaded.heard, loaded.name, loaded.volume * self.volume, pan, position, run.loop)
        run.playing = playing
        playing.task.add_done_callback(lambda done: self._ended(loaded, run, playing, done))

    def _ended(self, loaded: LoadedSound, run: Run, playing: Any, done: Task) -> None:
        if run.playing is not playing or loaded.run is not run:
            return  # it was exchanged for another, or silenced
        self._forget_run(loaded)
        run.task.killed = done.killed
        run.task.finish(error=done.error)

    def _silence(self, loaded: LoadedSound) -> None:
        run = loaded.run
        self._forget_run(loaded)
        if run is not None:
            run.playing.stop()

    def _forget_run(self, loaded: LoadedSound) -> None:
        if loaded.run is not None:
            self._on_end(loaded.run.begun, self._simulation.sound.time)
        loaded.run = None
        if loaded.temporary:
            with self._lock:
                self._sounds.pop(loaded.number, None)

    def exchange(self, loaded: LoadedSound, altered: Sound | None) -> None:
        """Have a sound at another pitch, or as it was read; what plays goes on at the place where it is."""
        loaded.altered = altered
        run = loaded.run
        if run is None:
            return
        old, position, paused = run.playing, run.playing.position, run.playing.paused
        self._begin(loaded, position)
        old.stop()
        if paused:
            run.playing.pause()

    def _adjust(self, loaded: LoadedSound) -> None:
        if loaded.run is not None:
            loaded.run.playing.set_volume(loaded.volume * self.volume)
            loaded.run.playing.set_pan(max(-1.0, min(1.0, loaded.pan + self._panorama)))


def _megabytes(size: int) -> str:
    return f"{size / 1e6:.1f} MB"
