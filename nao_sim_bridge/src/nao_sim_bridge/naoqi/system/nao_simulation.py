"""NaoSimulation: what only a simulator has. Time, reset, pushes, fingers, ground truth, pictures. No NAOqi module."""

from __future__ import annotations

from typing import Any, Sequence

import qi

from nao_sim_bridge.base.record_dir import world_of_client
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.runner import FASTEST
from nao_sim_bridge.naoqi.binding.binding import typed
from nao_sim_bridge.naoqi.binding.client_calls import ClientWatch

NAME = "NaoSimulation"


class NaoSimulation:
    """Control of the simulation over libqi; a real robot has no such service.

    The host is the server: its `broker`, `runner`, `sounds`, `things`, `hands`, `film`, `health`, `files`,
    `file_access`, `options`, and its methods `push`, `press`, `picture`, `reset_task`, `factory_reset_task`.
    """

    def __init__(self, host: Any) -> None:
        self._host = host
        self._watch = ClientWatch(lambda: host.broker.has_clients())

    @typed(NAME, qi.Float, [])
    def time(self) -> float:
        """Simulated time, s."""
        return self._host.runner.snapshot.time

    @typed(NAME, qi.Float, [])
    def speed(self) -> float:
        """Simulated seconds per wall second that are asked for; 0 when as fast as possible."""
        return 0.0 if self._host.runner.speed == FASTEST else self._host.runner.speed

    @typed(NAME, qi.Void, [qi.Float])
    def setSpeed(self, speed: float) -> Any:
        """Simulated seconds per wall second; 0 for as fast as possible."""
        return self._host.runner.set_speed(speed if speed else FASTEST)

    @typed(NAME, qi.Void, [])
    def pause(self) -> None:
        """Let time stand still; calls are still answered."""
        self._host.runner.pause()

    @typed(NAME, qi.Void, [])
    def resume(self) -> None:
        """Let time pass again."""
        self._host.runner.resume()

    @typed(NAME, qi.Bool, [])
    def isPaused(self) -> bool:
        """Whether time stands still."""
        return self._host.runner.paused

    @typed(NAME, qi.Float, [qi.Float])
    def advance(self, seconds: float) -> Any:
        """Let `seconds` of simulated time pass as fast as possible; returns the time after it, s.

        A pause or a reset before that is over ends it with an error; it ends, too, when no client is left.
        """
        return self._watch.add(self._host.runner.advance(seconds)).then(lambda snapshot: snapshot and snapshot.time)

    @typed(NAME, qi.Void, [])
    def reset(self) -> Any:
        """Put robot and world to where they started; tasks are killed, time goes on."""
        return self._host.reset_task()

    @typed(NAME, qi.Void, [qi.String], "reset")
    def resetTo(self, world: str) -> Any:
        """Begin anew in another world, a name or a file in `record_dir`; all that clients have changed is forgotten."""
        named = world_of_client(world, self._host.files, self._host.options.scene.world)
        return self._host.factory_reset_task(named)

    @typed(NAME, qi.Void, [])
    def factoryReset(self) -> Any:
        """Begin anew as at the start of the program, at time 0: all that clients have changed is forgotten."""
        return self._host.factory_reset_task("")

    @typed(NAME, qi.Void, [qi.List(qi.Float), qi.Float, qi.String])
    def push(self, force: Sequence[float], duration: float, link: str) -> Any:
        """Push a link ("torso", "Head", "l_wrist"...) with `force` [x, y, z] N in world for `duration` s."""
        return self._host.push(force, duration, link)

    @typed(NAME, qi.Void, [qi.List(qi.String)])
    def press(self, sensors: Sequence[str]) -> Any:
        """Simulated fingers on these touch sensors ("Head/Touch/Front"...) and no others; an empty list lets go."""
        return self._host.press(sensors)

    @typed(NAME, qi.Float, [qi.String, qi.Float])
    def touch(self, sensor: str, duration: float) -> Any:
        """A hand comes, touches a sensor ("Head/Touch/Front", "FrontTactilTouched"...) for `duration` s, and goes.

        Ends when it has gone; with a duration of 0, which is until `release`, when it is felt. Returns the simulated
        time at which it was felt first, s; 0 if it was sent away before.
        """
        return _first_contact(self._host.hands.touch([sensor], duration))

    @typed(NAME, qi.Float, [qi.List(qi.String), qi.Float])
    def stroke(self, sensors: Sequence[str], duration: float) -> Any:
        """A hand strokes over sensors of one part of the robot in this order in `duration` s; ends when it has gone.

        Returns as `touch` does.
        """
        return _first_contact(self._host.hands.touch(sensors, duration))

    @typed(NAME, qi.Void, [qi.List(qi.String)])
    def release(self, sensors: Sequence[str]) -> Any:
        """Hands on these sensors go; all hands when the list is empty."""
        return self._host.hands.release(sensors)

    @typed(NAME, "r", [qi.String, qi.Int32, qi.Int32])
    def picture(self, view: str, width: int, height: int) -> Any:
        """A PNG picture from a view: front, three_quarter, side, back, stage, far, room, robots, or face."""
        return self._host.picture(view, width, height)

    @typed(NAME, qi.String, [qi.String, qi.String, qi.Int32, qi.Int32, qi.Float])
    def startFilm(self, file: str, view: str, width: int, height: int, frame_rate: float) -> Any:
        """Film the robot, with what it says and plays, from a view of `picture`; returns the path of the mp4 file.

        `file` ends with .mp4; an empty text or 0 stands for what is usual.
        """
        return self._host.film.start(file, view, width, height, frame_rate)

    @typed(NAME, qi.Void, [qi.String])
    def captionFilm(self, text: str) -> Any:
        """Write a text into the film from now on; empty for none."""
        return self._host.film.caption(text)

    @typed(NAME, qi.Map(qi.String, qi.Dynamic), [])
    def stopFilm(self) -> Any:
        """End the film; returns its path, frames, duration in s, and frames left_out, when the file is complete."""
        return self._host.film.stop().then(lambda film: {**vars(film), "path": str(film.path)})

    @typed(NAME, qi.Map(qi.String, qi.Int64), [qi.String])
    def listFiles(self, folder: str) -> dict[str, int]:
        """Bytes of the files in a folder of the robot ("~", "/tmp"...), by name; names of folders end with a slash."""
        return self._host.file_access.listed(folder)

    @typed(NAME, "r", [qi.String, qi.Int64])
    def readFile(self, path: str, offset: int) -> bytes:
        """A piece of a file of the robot, from the byte `offset` on; empty at its end."""
        return self._host.file_access.read(path, offset)

    @typed(NAME, qi.Int64, [qi.String])
    def beginFile(self, path: str) -> int:
        """Begin to write a file of the robot; returns the number that `writeFile` takes its pieces by."""
        return self._host.file_access.begin(path)

    @typed(NAME, qi.String, [qi.Int64, "r", qi.Bool])
    def writeFile(self, number: int, piece: bytes, last: bool) -> str:
        """Write the next piece of a file that `beginFile` has begun; with the last it is there. Returns its path."""
        return self._host.file_access.write(number, piece, last)

    @typed(NAME, qi.Void, [qi.Bool])
    def plugCharger(self, plugged: bool) -> Any:
        """Plug the charger in, or pull it. A V6 does not report the plug itself, only that its battery charges."""
        return self._host.health.plug_charger(plugged)

    @typed(NAME, qi.Void, [qi.Float])
    def setBatteryCharge(self, charge: float) -> Any:
        """Have the battery this full, 0..1; it goes on from there."""
        return self._host.health.set_battery_charge(charge)

    @typed(NAME, qi.Void, [qi.String, qi.Float])
    def setTemperature(self, device: str, celsius: float) -> Any:
        """Have the motor of a joint, the "Head" or the "Battery" this warm, degC; it goes on from there."""
        return self._host.health.set_temperature(device, celsius)

    @typed(NAME, qi.Void, [qi.String])
    def breakDevice(self, name: str) -> Any:
        """Let a device fail: the motor of a joint, or a sensor ("Head/Touch/Front", "US/Left", "InertialSensor"...)."""
        return self._host.health.break_device(name)

    @typed(NAME, qi.Void, [qi.String])
    def repairDevice(self, name: str) -> Any:
        """Have a device work again; so does a reset."""
        return self._host.health.repair_device(name)

    @typed(NAME, qi.List(qi.String), [])
    def devices(self) -> Any:
        """Names of all devices that can break."""
        return self._host.health.devices()

    @typed(NAME, qi.List(qi.Float), [])
    def torsoPose(self) -> list[float]:
        """True pose of the torso in world: x, y, z in m, quaternion x, y, z, w."""
        pose = self._host.runner.snapshot.torso
        return [*pose.position, *pose.orientation]

    @typed(NAME, qi.Map(qi.String, qi.List(qi.Float)), [])
    def objectPoses(self) -> dict[str, list[float]]:
        """True poses of what can be moved, was placed or moved, as `torsoPose`: of centres of mass."""
        return {n: [*p.position, *p.orientation] for n, p in self._host.runner.snapshot.objects.items()}

    @typed(NAME, qi.Void, [qi.String])
    def placeObject(self, description: str) -> Any:
        """Place a thing: an entry of a world file in YAML or JSON, such as "{name: m, landmark: 64, position: ...}"."""
        return self._host.things.place_described(description)

    @typed(NAME, qi.Void, [qi.String, qi.List(qi.Float), qi.List(qi.Float), qi.Float])
    def moveObject(self, name: str, position: Sequence[float], rpy: Sequence[float], duration: float) -> Any:
        """Put a thing to `position` [x, y, z] m over the floor in `duration` s; ends when it is there.

        `rpy` is [roll, pitch, yaw] in rad, [] to keep it.
        """
        return self._host.things.move(name, position, rpy, duration)

    @typed(NAME, qi.Void, [qi.String])
    def removeObject(self, name: str) -> Any:
        """Take a thing away; those of the world file are back after a reset."""
        return self._host.things.remove(name)

    @typed(NAME, qi.Map(qi.String, qi.List(qi.Float)), [])
    def objects(self) -> Any:
        """Where all things are, by name: x, y, z in m over the floor, roll, pitch, yaw in rad, as moveObject has it."""
        return self._host.things.places()

    @typed(NAME, qi.Void, [qi.String, qi.String, qi.List(qi.Float), qi.Float, qi.Bool])
    def addSound(self, name: str, sound: str, position: Sequence[float], level_db: float, loop: bool) -> Any:
        """Place a sound at `position` [x, y, z] m in world: a file, "noise:white", "noise:pink", "tone:440"."""
        return self._host.sounds.add(name, sound, position, level_db, loop)

    @typed(NAME, qi.Void, [qi.String, qi.List(qi.Float)])
    def moveSound(self, name: str, position: Sequence[float]) -> Any:
        """Put a sound of the world to another place, [x, y, z] m in world."""
        return self._host.sounds.move(name, position)

    @typed(NAME, qi.Void, [qi.String])
    def removeSound(self, name: str) -> Any:
        """Silence a sound of the world."""
        return self._host.sounds.remove(name)

    @typed(NAME, qi.Map(qi.String, qi.List(qi.Float)), [])
    def sounds(self) -> Any:
        """Where the sounds of the world are, by name: [x, y, z] m in world."""
        return self._host.sounds.places()

    @typed(NAME, qi.Void, [qi.String, qi.List(qi.Float), qi.String, qi.Float])
    def personSays(self, text: str, position: Sequence[float], voice: str, level_db: float) -> Any:
        """Let a person say a text at `position` [x, y, z] m in world; ends when it has been said.

        `voice` is one of those of ALTextToSpeech, "" for the first; `level_db` is that at 1 m, 0 for a person's (65).
        """
        return self._host.sounds.person_says(text, position, voice, level_db)


def _first_contact(called: Task) -> Task:
    """The time at the end of a touch, also of one that was sent away."""
    return called.then(lambda hand: hand.then(lambda contact: contact or 0.0))
