"""Both cameras of the robot: which frames fall due, who looks, and how they are set.

Simulated time is their only clock. At a tick at which somebody's frame falls due, a snapshot is kept; nothing is drawn
before somebody asks for the frame. Then another process draws it, and the thread of the cameras hands it over:
physics never waits, unless it runs faster than the wall clock and somebody needs every frame.
"""

from __future__ import annotations

import logging
import threading
from concurrent.futures import Future
from fractions import Fraction
from typing import Callable, Mapping

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.cameras.automatics import NEUTRAL_KELVIN
from nao_sim_bridge.cameras.darkroom import CameraPlaces, CapturesPictures, Darkroom
from nao_sim_bridge.cameras.frame import Answer, Ask, CameraClosed, Frame, Moment
from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.cameras.rate import Shutter
from nao_sim_bridge.cameras.sensor import Chosen
from nao_sim_bridge.cameras.settings import (
    AUTO_EXPOSURE,
    AUTO_WHITE_BALANCE,
    CAMERAS,
    EXPOSURE,
    GAIN,
    KEEP_ALIVE,
    LUMINANCE,
    WHITE_BALANCE,
    Resolution,
    load_cameras,
)
from nao_sim_bridge.cameras.stream import CameraStream
from nao_sim_bridge.model.kinematics import quaternion_matrix
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.world.render_state import RenderState

log = logging.getLogger("nao_sim.cameras")

RGB = 11
"""NAOqi's id of the colour space."""
# What automatics choose, by the parameter that says how it was; and the parameter that turns them on.
CHOSEN_BY = {EXPOSURE: AUTO_EXPOSURE, GAIN: AUTO_EXPOSURE, WHITE_BALANCE: AUTO_WHITE_BALANCE}


class ChosenAutomatically(BadValue):
    """A parameter of a camera that an automatic chooses as long as it is on."""


class Cameras:
    """The cameras of one robot. Any thread but for `tick`, which is the simulation's.

    Attributes:
        tables: Resolutions, colour spaces and parameters that there are.
        streams: Those who look; replaced, never changed.
        lock: Guards everything in here and in the streams.
        active: Index of the camera that NAOqi's modules take when nobody says which.

    Args:
        look: What there is to see at a snapshot.
        released: Called when time that waited need not wait any more.
        guard: Calls who gets frames; None for one of its own.
    """

    def __init__(
        self,
        model: RobotModel,
        tick_s: float,
        renderer: CapturesPictures,
        look: Callable[[Snapshot], RenderState],
        released: Callable[[], None] = lambda: None,
        guard: Guard | None = None,
    ) -> None:
        self.tables = load_cameras(model.version)
        self.ticks_per_second = (1 / Fraction(tick_s)).limit_denominator(100000)
        self.lock = threading.RLock()
        self.active = 0
        self.released = released
        self._look = look
        self._places = CameraPlaces(model)
        self._darkroom = Darkroom(renderer, self._places, model.version, guard or Guard())
        self.streams: tuple[CameraStream, ...] = ()
        self._shutters = [Shutter(self.ticks_per_second) for _ in CAMERAS]
        self._stopped = [False for _ in CAMERAS]
        self._numbers = [0 for _ in CAMERAS]
        self._parameters: list[Mapping[int, int]] = [self.tables.defaults for _ in CAMERAS]
        self._chosen = [self._nothing_chosen() for _ in CAMERAS]
        self._replaced: list[np.ndarray | None] = [None for _ in CAMERAS]
        self._snapshot: Snapshot | None = None
        self._seed = self._began = 0
        self._next_tick = Shutter.NEVER
        self._closed = False

    # --- in the simulation thread ---------------------------------------------------------------------------------

    def begin(self, snapshot: Snapshot, seed: int = 0) -> None:
        """The robot stands at its start; `seed` is that of the noise from now on."""
        self._snapshot, self._seed, self._began = snapshot, seed, snapshot.tick

    def tick(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        if snapshot.tick >= self._next_tick:
            with self.lock:
                self._take(snapshot)

    def holds(self) -> bool:
        """Whether time should wait, when it runs faster than the wall clock."""
        return any(stream.waits for stream in self.streams)

    # --- looking --------------------------------------------------------------------------------------------------

    def open(
        self,
        name: str,
        camera: int,
        resolution: int,
        color_space: int,
        fps: float,
        every: bool = False,
        keep: int = 1,
    ) -> CameraStream:
        """Look through a camera from now on, 0 top, 1 bottom; resolution and colour space are NAOqi's ids.

        The first frame is that of the next tick.

        Args:
            name: For the log.
            fps: Frames a second, up to 30. The camera runs at the highest rate that somebody asks for; others get
                those of its frames that come next when theirs is due.
            every: Keep all frames that are due, in order, and let time that runs faster than the wall clock wait for
                those who take them; else there is always just the newest one.
            keep: With `every`, how many frames wait at most when time does not; the oldest ones are dropped first.

        Raises:
            BadValue: The cameras cannot do that.
            CameraClosed: The simulation has ended.
        """
        if keep < 1:
            raise BadValue("keep", keep, "1 or more")
        stream = CameraStream(self, name, every, keep)
        with self.lock:
            if self._closed:
                raise CameraClosed("the cameras are closed: the simulation has ended")
            stream.set_up(camera, resolution, color_space, fps)
            self.streams = (*self.streams, stream)
            self.changed()
        return stream

    def picture(self, snapshot: Snapshot, camera: int, width: int, height: int) -> np.ndarray:
        """What a camera sees at a snapshot, the last one, (height, width, 3) uint8 RGB; waits until it is drawn.

        Raises:
            BadValue: The cameras have no such resolution.
            RenderError: It cannot be drawn.
        """
        size, pixels = self._size(width, height), self.tables.color_space(RGB)
        with self.lock:
            moment = self._moment(self.tables.camera(camera), snapshot, self._look(snapshot))
        drawn: Future[Frame] = Future()

        def draw() -> None:
            try:
                drawn.set_result(self._darkroom.develop(moment, size, pixels)[0])
            except Exception as error:
                drawn.set_exception(error)

        self._darkroom.put(draw)
        return drawn.result().array()

    def project(self, snapshot: Snapshot, camera: int, points: np.ndarray, width: int, height: int) -> np.ndarray:
        """Pixels (n, 2) of (n, 3) points of the world in the picture of a snapshot; NaN behind the camera.

        Raises:
            BadValue: The cameras have no such resolution.
        """
        self._size(width, height)
        position, orientation = self._places.in_world(self._look(snapshot), camera)
        optics = self.optics(camera)
        in_camera = (points - np.array(position)) @ quaternion_matrix(orientation)
        places = [optics.project(point) or (np.nan, np.nan) for point in in_camera]
        return np.array(places).reshape(-1, 2) * (width, height)

    def _size(self, width: int, height: int) -> Resolution:
        sizes = {(size.width, size.height): size for size in self.tables.resolutions.values()}
        if (width, height) not in sizes:
            allowed = ", ".join(f"{w}x{h}" for w, h in sorted(sizes))
            raise BadValue("picture", f"{width}x{height}", allowed)
        return sizes[width, height]

    def optics(self, camera: int) -> CameraOptics:
        return self._places.optics[self.tables.camera(camera)]

    def rate(self, camera: int) -> float:
        """Frames a second that a camera takes now."""
        return float(self._shutters[self.tables.camera(camera)].rate)

    # --- settings -------------------------------------------------------------------------------------------------

    def parameter(self, camera: int, number: int) -> int:
        """Value of a parameter, by NAOqi's id; of what an automatic chooses, what it chose for the last frame.

        Raises:
            BadValue: There is no such camera or parameter.
        """
        camera = self.tables.camera(camera)
        parameter = self.tables.parameter(number)
        with self.lock:
            chosen, values = self._chosen[camera], self._parameters[camera]
        if parameter.id == LUMINANCE:
            return round(chosen.luminance)
        if parameter.id in CHOSEN_BY and values[CHOSEN_BY[parameter.id]]:
            return _chosen_value(chosen, parameter.id)
        return values[parameter.id]

    def set_parameter(self, camera: int, number: int, value: int) -> None:
        """Change a parameter; frames that fall due from now on have it.

        Raises:
            BadValue: There is no such camera or parameter, the value is out of range, or the parameter can only be
                read.
            ChosenAutomatically: An automatic chooses the parameter now.
        """
        camera = self.tables.camera(camera)
        parameter = self.tables.parameter(number)
        if isinstance(value, bool) or not isinstance(value, int) or not parameter.least <= value <= parameter.most:
            raise BadValue(parameter.name, value, f"{parameter.least} to {parameter.most}")
        if parameter.read_only:
            raise BadValue(parameter.name, value, "no value: it can only be read")
        with self.lock:
            values = dict(self._parameters[camera])
            switch = CHOSEN_BY.get(parameter.id)
            if switch is not None and values[switch]:
                name = self.tables.parameters[switch].name
                raise ChosenAutomatically(parameter.name, value, f"no value while {name} is 1; set it to 0 first")
            if parameter.id in CHOSEN_BY.values() and values[parameter.id] and not value:
                # Who turns an automatic off finds what it chose last.
                for chosen, by in CHOSEN_BY.items():
                    if by == parameter.id and chosen in values:
                        values[chosen] = _chosen_value(self._chosen[camera], chosen)
            values[parameter.id] = value
            self._parameters[camera] = values

    def reset_parameters(self, camera: int) -> None:
        with self.lock:
            self._parameters[self.tables.camera(camera)] = self.tables.defaults
            self._chosen[camera] = self._nothing_chosen()

    def kept_alive(self, camera: int) -> bool:
        """Whether a camera stays on while nobody looks."""
        return bool(self._parameters[self.tables.camera(camera)].get(KEEP_ALIVE, 0))

    def stopped(self, camera: int) -> bool:
        return self._stopped[self.tables.camera(camera)]

    def set_stopped(self, camera: int, stopped: bool) -> None:
        """Stop a camera, so that no frames fall due, or let it run again."""
        with self.lock:
            self._stopped[self.tables.camera(camera)] = stopped
            self.changed()

    def show(self, camera: int, picture: np.ndarray | None) -> None:
        """Let a camera see a (h, w, 3) uint8 RGB picture instead of the world; None for the world again."""
        with self.lock:
            self._replaced[self.tables.camera(camera)] = picture

    def close(self) -> None:
        """Everybody who waits gets CameraClosed, and nobody sees anything any more."""
        with self.lock:
            self._closed = True
            for stream in self.streams:
                stream.close()
        self._darkroom.close()

    # --- for the streams; with the lock held ----------------------------------------------------------------------

    def changed(self) -> None:
        """Somebody looks, or looks no more, or at another rate."""
        now = self._snapshot.tick if self._snapshot is not None else 0
        for camera, shutter in enumerate(self._shutters):
            rates = [stream.rate for stream in self.streams if stream.camera == camera]
            shutter.set_rate(Fraction(0) if self._stopped[camera] else max(rates, default=Fraction(0)), now)
        self._next_tick = min(shutter.next_tick for shutter in self._shutters)

    def forget(self, stream: CameraStream) -> None:
        """A stream has been closed."""
        self.streams = tuple(other for other in self.streams if other is not stream)
        self.changed()

    def draw(self, stream: CameraStream, ask: Ask, moment: Moment) -> None:
        """Have a frame drawn for somebody who asked."""
        self._darkroom.put(lambda: self._develop(stream, ask, moment))

    def answer(self, ask: Ask, answer: Answer) -> None:
        """Tell somebody who asked, in the cameras' thread."""
        callback = ask.take_callback()
        self._darkroom.put(lambda: callback(answer))

    # --- inside ---------------------------------------------------------------------------------------------------

    def _take(self, snapshot: Snapshot) -> None:
        """Frames fall due."""
        state = None
        for camera, shutter in enumerate(self._shutters):
            if snapshot.tick < shutter.next_tick:
                continue
            exact_time = shutter.advance(snapshot.tick)
            wanted = [stream for stream in self.streams if stream.camera == camera and stream.takes(exact_time)]
            if wanted:
                state = state or self._look(snapshot)
                moment = self._moment(camera, snapshot, state)
                for stream in wanted:
                    stream.put(moment)
            self._numbers[camera] += 1
        self._next_tick = min(shutter.next_tick for shutter in self._shutters)

    def _moment(self, camera: int, snapshot: Snapshot, state: RenderState) -> Moment:
        return Moment(
            camera,
            self._numbers[camera],
            snapshot,
            state,
            self._parameters[camera],
            (self._seed * 2 + camera) * 1000003 + snapshot.tick - self._began,
            self._replaced[camera],
        )

    def _develop(self, stream: CameraStream, ask: Ask, moment: Moment) -> None:
        """Draw a frame and hand it over; cameras' thread."""
        answer: Answer
        try:
            answer, photo = self._darkroom.develop(moment, stream.size, stream.pixels)
        except Exception as error:
            answer = error
        else:
            self._chosen[moment.camera] = photo.chosen
        with self.lock:
            callback = stream.handed_over(ask, moment)
        if callback is not None:
            callback(answer)
        self.released()

    def _nothing_chosen(self) -> Chosen:
        sensor = self.tables.sensor
        return Chosen(sensor.exposure, sensor.gain, NEUTRAL_KELVIN, 0.0)


def _chosen_value(chosen: Chosen, number: int) -> int:
    return {EXPOSURE: chosen.exposure, GAIN: chosen.gain, WHITE_BALANCE: chosen.white_balance}[number]
