"""NaoSimulation: what only a simulator has. Time, reset, pushes, fingers, ground truth, pictures. No NAOqi module."""

from __future__ import annotations

from typing import Any, Callable, Sequence

import qi

from nao_sim_bridge.services.binding import answer, as_future
from nao_sim_bridge.sim.runner import FASTEST

NAME = "NaoSimulation"


class NaoSimulation:
    """Control of the simulation over libqi; a real robot has no such service.

    Args:
        host: The server: its `runner`, `sounds`, `things`, and its methods `push`, `press`, `picture`, `reset_task`.
    """

    def __init__(self, host: Any) -> None:
        self._host = host
        self._runner = host.runner

    @qi.bind(qi.Float, [])
    def time(self) -> float:
        """Simulated time, s."""
        return self._runner.snapshot.time

    @qi.bind(qi.Float, [])
    def speed(self) -> float:
        """Simulated seconds per wall second that are asked for; 0 when as fast as possible."""
        return 0.0 if self._runner.speed == FASTEST else self._runner.speed

    @qi.bind(qi.Void, [qi.Float])
    def setSpeed(self, speed: float) -> Any:
        """Simulated seconds per wall second; 0 for as fast as possible."""
        return _answer("setSpeed", lambda: self._runner.set_speed(speed if speed else FASTEST))

    @qi.bind(qi.Void, [])
    def pause(self) -> None:
        """Let time stand still; calls are still answered."""
        self._runner.pause()

    @qi.bind(qi.Void, [])
    def resume(self) -> None:
        """Let time pass again."""
        self._runner.resume()

    @qi.bind(qi.Bool, [])
    def isPaused(self) -> bool:
        """Whether time stands still."""
        return self._runner.paused

    @qi.bind(qi.Float, [qi.Float])
    def advance(self, seconds: float) -> Any:
        """Let `seconds` of simulated time pass as fast as possible; returns the time after it, s."""
        return _answer("advance", lambda: self._runner.advance(seconds).then(lambda snapshot: snapshot.time))

    @qi.bind(qi.Void, [])
    def reset(self) -> Any:
        """Put robot and world to where they started; tasks are killed, time goes on."""
        return as_future(self._host.reset_task(), f"{NAME}::reset")

    @qi.bind(qi.Void, [qi.List(qi.Float), qi.Float, qi.String])
    def push(self, force: Sequence[float], duration: float, link: str) -> Any:
        """Push a link ("torso", "Head", "l_wrist"...) with `force` [x, y, z] N in world for `duration` s."""
        return _answer("push", lambda: self._host.push(force, duration, link))

    @qi.bind(qi.Void, [qi.List(qi.String)])
    def press(self, sensors: Sequence[str]) -> Any:
        """Simulated fingers on these touch sensors ("Head/Touch/Front"...) and no others; an empty list lets go."""
        return _answer("press", lambda: self._host.press(sensors))

    @qi.bind("r", [qi.String, qi.Int32, qi.Int32])
    def picture(self, view: str, width: int, height: int) -> Any:
        """A PNG picture of the robot from a view ("front", "three_quarter", "side", "back", "far", "room", "face")."""
        return _answer("picture", lambda: self._host.picture(view, width, height))

    @qi.bind(qi.List(qi.Float), [])
    def torsoPose(self) -> list[float]:
        """True pose of the torso in world: x, y, z in m, quaternion x, y, z, w."""
        pose = self._runner.snapshot.torso
        return [*pose.position, *pose.orientation]

    @qi.bind(qi.Map(qi.String, qi.List(qi.Float)), [])
    def objectPoses(self) -> dict[str, list[float]]:
        """True poses of what can be moved, was placed or moved, as `torsoPose`: of centres of mass."""
        return {n: [*p.position, *p.orientation] for n, p in self._runner.snapshot.objects.items()}

    @qi.bind(qi.Void, [qi.String])
    def placeObject(self, description: str) -> Any:
        """Place a thing: an entry of a world file in YAML or JSON, such as "{name: m, landmark: 64, position: ...}"."""
        return _answer("placeObject", lambda: self._host.things.place_described(description))

    @qi.bind(qi.Void, [qi.String, qi.List(qi.Float), qi.List(qi.Float), qi.Float])
    def moveObject(self, name: str, position: Sequence[float], rpy: Sequence[float], duration: float) -> Any:
        """Put a thing to `position` [x, y, z] m over the floor in `duration` s; ends when it is there.

        `rpy` is [roll, pitch, yaw] in rad, [] to keep it.
        """
        return _answer("moveObject", lambda: self._host.things.move(name, position, rpy, duration))

    @qi.bind(qi.Void, [qi.String])
    def removeObject(self, name: str) -> Any:
        """Take a thing away; those of the world file are back after a reset."""
        return _answer("removeObject", lambda: self._host.things.remove(name))

    @qi.bind(qi.Map(qi.String, qi.List(qi.Float)), [])
    def objects(self) -> Any:
        """Where all things are, by name: x, y, z in m over the floor, roll, pitch, yaw in rad, as moveObject has it."""
        return _answer("objects", self._host.things.places)

    @qi.bind(qi.Void, [qi.String, qi.String, qi.List(qi.Float), qi.Float, qi.Bool])
    def addSound(self, name: str, sound: str, position: Sequence[float], level_db: float, loop: bool) -> Any:
        """Place a sound at `position` [x, y, z] m in world: a file, "noise:white", "noise:pink", "tone:440"."""
        return _answer("addSound", lambda: self._host.sounds.add(name, sound, position, level_db, loop))

    @qi.bind(qi.Void, [qi.String, qi.List(qi.Float)])
    def moveSound(self, name: str, position: Sequence[float]) -> Any:
        """Put a sound of the world to another place, [x, y, z] m in world."""
        return _answer("moveSound", lambda: self._host.sounds.move(name, position))

    @qi.bind(qi.Void, [qi.String])
    def removeSound(self, name: str) -> Any:
        """Silence a sound of the world."""
        return _answer("removeSound", lambda: self._host.sounds.remove(name))

    @qi.bind(qi.Map(qi.String, qi.List(qi.Float)), [])
    def sounds(self) -> Any:
        """Where the sounds of the world are, by name: [x, y, z] m in world."""
        return _answer("sounds", self._host.sounds.places)

    @qi.bind(qi.Void, [qi.String, qi.List(qi.Float), qi.String, qi.Float])
    def personSays(self, text: str, position: Sequence[float], voice: str, level_db: float) -> Any:
        """Let a person say a text at `position` [x, y, z] m in world; ends when it has been said.

        `voice` is one of those of ALTextToSpeech, "" for the first; `level_db` is that at 1 m, 0 for a person's (65).
        """
        return _answer("personSays", lambda: self._host.sounds.person_says(text, position, voice, level_db))


def _answer(method: str, call: Callable[[], Any]) -> Any:
    return answer(NAME, method, call, ())
