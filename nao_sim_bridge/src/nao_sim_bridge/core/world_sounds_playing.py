"""Lets the sounds of a world sound: begins them when they are due, and carries those that ride on objects."""

from __future__ import annotations

import math

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.rotations import Vector3, from_roll_pitch_yaw, plus, rotate
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.sound.sources import SoundSource
from nao_sim_bridge.world.sounds_made import Read, Speak, make_sound
from nao_sim_bridge.world.world import World, WorldError, WorldSound

# How often a sound follows the object that it rides on, s.
FOLLOW_PERIOD = 0.02


class WorldSounds:
    """The sounds of the simulation's world, from the start and from each reset on. Simulation thread.

    Args:
        simulation: Whose world it is; nothing is added to its ticks when the world is silent.

    Raises:
        WorldError: A file cannot be read, or a text cannot be said.
    """

    def __init__(self, simulation: Simulation, world: World, speak: Speak, read: Read) -> None:
        self._simulation = simulation
        self._world = world
        self._made = [(sound, _made(sound, speak, read, world)) for sound in world.sounds]
        self._due: list[tuple[float, WorldSound, Sound]] = []
        self._riding: list[WorldSound] = []
        self._next = math.inf
        if self._made:
            simulation.shared.after_reset.append(self.begin)
            simulation.after_tick.append(self._look)

    def begin(self) -> None:
        """Start all over: what is due at once sounds from now on."""
        now = self._simulation.time
        self._due = sorted(((now + sound.start, sound, made) for sound, made in self._made), key=lambda due: due[0])
        self._riding = []
        self._next = now
        self._look(self._simulation.snapshot)

    def place(self, sound: WorldSound, snapshot: Snapshot) -> Vector3:
        """Where a sound is, in world, m."""
        if sound.on is None:
            return rotate(self._world.floor.orientation, sound.position)
        pose = snapshot.objects.get(sound.on)
        if pose is not None:
            return plus(pose.position, rotate(pose.orientation, sound.position))
        thing = next(thing for thing in self._world.objects if thing.name == sound.on)
        in_floor = plus(thing.position, rotate(from_roll_pitch_yaw(*thing.rpy), sound.position))
        return rotate(self._world.floor.orientation, in_floor)

    def _look(self, snapshot: Snapshot) -> None:
        if snapshot.time < self._next:
            return
        while self._due and self._due[0][0] <= snapshot.time:
            self._start(*self._due.pop(0)[1:], snapshot)
        sources = self._simulation.sound.sources
        there = set(sources.names())
        self._riding = [sound for sound in self._riding if sound.name in there]
        for sound in self._riding:
            sources.move(sound.name, self.place(sound, snapshot))
        follow = snapshot.time + FOLLOW_PERIOD if self._riding else math.inf
        self._next = min(follow, self._due[0][0] if self._due else math.inf)

    def _start(self, sound: WorldSound, made: Sound, snapshot: Snapshot) -> None:
        sources = self._simulation.sound.sources
        if sound.name in sources.names():
            return  # somebody has placed another one of that name meanwhile
        endless = sound.kind in ("tone", "noise") and sound.duration is None
        place = self.place(sound, snapshot)
        sources.add(SoundSource(sound.name, place, made, sound.level_db, sound.loop or endless))
        if sound.on in snapshot.objects:
            self._riding.append(sound)


def _made(sound: WorldSound, speak: Speak, read: Read, world: World) -> Sound:
    try:
        return make_sound(sound, speak, read)
    except SimulationError as error:
        raise WorldError(f"world {world.name}: sound {sound.name!r}", str(error)) from error
