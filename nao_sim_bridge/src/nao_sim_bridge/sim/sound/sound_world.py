"""All sound of one simulation."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.snapshot import Snapshot
from nao_sim_bridge.sim.sound.ears import Ears
from nao_sim_bridge.sim.sound.loudspeakers import Loudspeakers
from nao_sim_bridge.sim.sound.microphones import Microphones
from nao_sim_bridge.sim.sound.samples import RATE
from nao_sim_bridge.sim.sound.settings import SoundSettings, load_sound_settings
from nao_sim_bridge.sim.sound.sources import Sources
from nao_sim_bridge.sim.sound.timeline import Timeline
from nao_sim_bridge.sim.tasks import TaskIds


class SoundWorld:
    """What sounds and what is heard. It stays at a reset of the simulation, which ends everything that plays.

    Attributes:
        settings: Levels.
        loudspeakers: Of the robot.
        sources: Sounds in the world.
        microphones: Of the robot.
        ears: Listeners.
        timeline: The clock of sound.
        after_reset: Called in the simulation thread at the end of each reset: world and robot are at the start again.

    Args:
        model: The robot.
        tick_s: Length of a tick, s.
        ids: Source of the tasks' numbers.
        seed: Of the background noise.
        released: Called when time that waited for ears need not wait any more.
        settings: None for those of the file.
    """

    def __init__(
        self,
        model: RobotModel,
        tick_s: float,
        ids: TaskIds,
        seed: int,
        released: Callable[[], None] = lambda: None,
        settings: SoundSettings | None = None,
    ) -> None:
        self.settings = settings or load_sound_settings()
        self._tick_s = tick_s
        self.timeline = Timeline(self.settings.keep_s)
        self.loudspeakers = Loudspeakers(self.timeline, ids)
        self.sources = Sources(self.timeline, ids, self.settings)
        self.microphones = Microphones(
            model, self.settings, self.timeline, self.loudspeakers, self.sources, round(tick_s * RATE), seed
        )
        self.ears = Ears(self.timeline, self.microphones, released)
        self._poses = self.microphones.poses
        self.after_reset: list[Callable[[], None]] = []

    @property
    def time(self) -> float:
        """The time of now, s; any thread."""
        return self.timeline.now / RATE

    def begin(self, snapshot: Snapshot) -> None:
        """The robot has been put into the world; at the start and at each reset."""
        if not self._poses.knows(snapshot.tick):  # else a reset, from the next tick on: what is past stays
            self._poses.record(snapshot.tick, snapshot)
        for call in self.after_reset:
            call()

    def tick(self, snapshot: Snapshot) -> None:
        """A tick has passed."""
        self._poses.record(snapshot.tick, snapshot)
        frame = round(snapshot.tick * self._tick_s * RATE)
        self.timeline.tick(frame)
        if frame >= self.ears.due:
            self.ears.wake()

    def stop_all(self) -> None:
        """End everything that sounds."""
        self.loudspeakers.stop_all()
        self.sources.clear()

    def close(self) -> None:
        """End everything that sounds, and all listeners."""
        self.stop_all()
        self.ears.close()
