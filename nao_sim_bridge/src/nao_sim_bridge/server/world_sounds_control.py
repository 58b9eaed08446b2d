"""Sounds of the world that come and go while the simulation runs, and those of the world file. For any thread."""

from __future__ import annotations

import threading
from typing import Any, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.core.world_sounds_playing import WorldSounds
from nao_sim_bridge.naoqi.binding.arguments import number, numbers
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles
from nao_sim_bridge.sound.sources import SoundSource
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.studio import Studio
from nao_sim_bridge.speech.voices import load_voices
from nao_sim_bridge.world.sounds import HIGHEST_TONE, LOUDEST, NOISES
from nao_sim_bridge.world.sounds_made import noise, tone

LONGEST_TEXT = 10000


class WorldSoundsControl:
    """Places sounds in the world, and lets persons speak there.

    The studio makes the voices of persons: not that of the robot, for both may speak at the same time.
    """

    def __init__(self, runner: RobotRunner, sounds: SoundFiles, studio: Studio) -> None:
        self._simulation = runner.simulation
        self._runner = runner
        self._sounds = sounds
        self._studio = studio
        self._numbers = runner.simulation.sound.numbers
        self._lock = threading.Lock()
        self._being_made = 0
        runner.simulation.holds.append(lambda: self._being_made > 0)

    def begin(self) -> None:
        """Let the sounds of the world file begin; before time passes.

        A SimulationError when one of them cannot be had.
        """
        world = self._simulation.scene.load_world(self._simulation.settings.contact.sole_friction)
        WorldSounds(self._simulation, world, self._speak, self._sounds.reader.read).begin()

    def add(self, name: str, sound: str, position: Sequence[float], level_db: float, loop: bool) -> Task:
        """Place a sound; the task ends when it has begun.

        `sound` is a file's name, "noise:white", "noise:pink", or "tone:" and a frequency in Hz; position is [x, y, z]
        in world, m; the level is that at 1 m, dB SPL. With `loop` it sounds again and again, until it is removed, as
        noises and tones do anyway.
        """
        made, endless = self._sound(sound)
        source = SoundSource(name, _position(position), made, _level(level_db), bool(loop) or endless)
        return self._runner.execute(lambda: self._simulation.sound.sources.add(source), "addSound").then(lambda _: None)

    def move(self, name: str, position: Sequence[float]) -> Task:
        place = _position(position)
        return self._runner.execute(lambda: self._simulation.sound.sources.move(name, place), "moveSound")

    def remove(self, name: str) -> Task:
        return self._runner.execute(lambda: self._simulation.sound.sources.remove(name), "removeSound")

    def places(self) -> Task:
        """Positions of the sounds that there are, by name; the task's result."""
        sources = self._simulation.sound.sources
        return self._runner.execute(lambda: {n: list(sources.get(n).place) for n in sources.names()}, "sounds")

    def person_says(self, text: str, position: Sequence[float], voice: str, level_db: float) -> Task:
        """Let a person say something; the task ends when it has been said, and its kill silences.

        The position is that of the mouth, in world, m; no voice is the robot's first; the level is that at 1 m, dB SPL,
        0 for that of a talking person.
        """
        if not text.strip() or len(text) > LONGEST_TEXT:
            raise BadValue("text", text[:60], f"1 to {LONGEST_TEXT} characters")
        place = _position(position)
        level = _level(level_db) if level_db else self._simulation.sound.settings.talk_db
        name = f"person {next(self._numbers)}"
        with self._lock:
            self._being_made += 1

        def make() -> Task:
            try:
                source = SoundSource(name, place, self._speak(text, voice), level)
                return self._runner.execute(lambda: self._simulation.sound.sources.add(source).task, "personSays")
            finally:
                with self._lock:
                    self._being_made -= 1
                self._simulation.wake()

        return self._studio.in_background(make, "personSays")

    def _speak(self, text: str, voice: str) -> Sound:
        voices, engines = load_voices(), self._studio.engines
        spoken = voices.voice(voice or voices.languages[voices.default_language].voices[0], engines)
        return self._studio.sound(text, Style(spoken)).at_rate(RATE)

    def _sound(self, text: str) -> tuple[Sound, bool]:
        """A sound, and whether it does not end."""
        kind, _, what = text.partition(":")
        if kind == "noise":
            if what not in NOISES:
                raise BadValue("sound", text, " or ".join(f"noise:{known}" for known in NOISES))
            return noise(what, seed=next(self._numbers)), True
        if kind == "tone":
            try:
                frequency = float(what)
            except ValueError as error:
                raise BadValue("sound", text, '"tone:" and a frequency in Hz, "tone:440"') from error
            return tone([number(frequency, "frequency", 1.0, HIGHEST_TONE)]), True
        return self._sounds.read(text).mono(), False


def _position(value: Any) -> Vector3:
    listed = numbers(value, "position", -1000.0, 1000.0)
    if len(listed) != 3:
        raise BadValue("position", value, "[x, y, z] in m, in world")
    return (listed[0], listed[1], listed[2])


def _level(value: Any) -> float:
    return number(value, "level_db", -20.0, LOUDEST)
