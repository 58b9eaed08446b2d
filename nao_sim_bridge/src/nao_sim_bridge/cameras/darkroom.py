"""Where the cameras are, and the thread that has their pictures drawn in order; what is asked twice is drawn once."""

from __future__ import annotations

import threading
from collections import OrderedDict, deque
from typing import Any, Callable, Protocol

import numpy as np

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.guard import Guard
from nao_sim_bridge.base.imports import Library
from nao_sim_bridge.base.rotations import Quaternion, Vector3, vector3
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.cameras.frame import Frame, Moment, Position6D
from nao_sim_bridge.cameras.optics import CameraOptics
from nao_sim_bridge.cameras.sensor import Photograph, Shot, photograph, read_photograph
from nao_sim_bridge.cameras.settings import CAMERA_NAMES, ColorSpace, Resolution
from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.model.frames import ROBOT, Placement, frame_of, space_in_torso
from nao_sim_bridge.model.kinematics import matrix_quaternion, matrix_rpy, quaternion_matrix, transform
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.world.render_state import RenderState

cv2 = Library("cv2")
TIMEOUT = 30.0
"""Longest time for a picture, s of wall time; a busy machine may take a thousand times as long as an idle one."""
CLOSING = 5.0
"""How long the end waits for the thread, s of wall time."""
KEPT = 4
"""How many pictures are kept for those who ask for the same a little later."""


class CameraPlaces:
    """The cameras of one robot."""

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._body = body_kinematics(model)
        self._frames = [frame_of(model, name) for name in CAMERA_NAMES]
        self.optics = [CameraOptics(model.version, index) for index in range(len(CAMERA_NAMES))]

    def in_world(self, state: RenderState, camera: int) -> tuple[Vector3, Quaternion]:
        """Where a camera truly is."""
        torso = transform(quaternion_matrix(state.base_orientation), state.base_position)
        pose = torso @ self._body.at(state.joint_positions).pose(self._frames[camera])
        return vector3(pose[:3, 3]), matrix_quaternion(pose[:3, :3])

    def measured(self, snapshot: Snapshot, camera: int) -> tuple[Position6D, Position6D]:
        """Where ALMotion says that a camera is, from the sensors: in the torso's frame, and in the robot's."""
        torso = transform(quaternion_matrix(snapshot.odometry.orientation), snapshot.odometry.position)
        poses = self._body.at(snapshot.positions).poses
        placement = Placement({link: poses[row] for link, row in self._body.row.items()}, torso)
        in_torso = placement.in_torso(self._frames[camera])
        robot_in_torso = space_in_torso(self._model, ROBOT, placement)
        return _position6d(in_torso), _position6d(np.linalg.inv(robot_in_torso) @ in_torso)


def _position6d(pose: np.ndarray) -> Position6D:
    return (*vector3(pose[:3, 3]), *matrix_rpy(pose[:3, :3]))


class CapturesPictures(Protocol):
    """What draws; a `Renderer`."""

    def capture(self, state: Any, shot: Shot, timeout: float = 10.0) -> bytes:
        """What `photograph` makes of what a camera sees."""


class Darkroom:
    """Turns moments into frames."""

    def __init__(self, renderer: CapturesPictures, places: CameraPlaces, version: str, guard: Guard) -> None:
        self._guard = guard
        self.renderer = renderer
        self._places = places
        self._version = version
        self._jobs: deque[Callable[[], None]] = deque()
        self._news = threading.Condition()
        self._thread: threading.Thread | None = None
        self._closed = False
        self._kept: OrderedDict[tuple, tuple[Frame, Photograph]] = OrderedDict()

    def put(self, job: Callable[[], None]) -> None:
        """Have something done in the thread, after what was put before it."""
        with self._news:
            self._jobs.append(job)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="cameras", daemon=True)
                self._thread.start()
            self._news.notify()

    def develop(self, moment: Moment, size: Resolution, pixels: ColorSpace) -> tuple[Frame, Photograph]:
        """The frame of a moment; only in the thread.

        Raises:
            RenderError: It cannot be drawn.
        """
        key = (moment, size.id, pixels.id)
        if key not in self._kept:
            self._kept[key] = self._draw(moment, size, pixels)
            if len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        return self._kept[key]

    def close(self) -> None:
        """Do what has been put, and end the thread; a picture that is late is not waited for."""
        with self._news:
            self._closed = True
            self._news.notify()
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join(CLOSING)

    def _run(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._jobs or self._closed)
                if not self._jobs:
                    self._thread = None
                    self._kept.clear()
                    return
                job = self._jobs.popleft()
            self._guard.call(job)

    def _draw(self, moment: Moment, size: Resolution, pixels: ColorSpace) -> tuple[Frame, Photograph]:
        optics = self._places.optics[moment.camera]
        position, orientation = self._places.in_world(moment.state, moment.camera)
        shot = Shot(
            version=self._version,
            camera=moment.camera,
            position=position,
            orientation=orientation,
            hfov=optics.hfov,
            vfov=optics.vfov,
            width=size.width,
            height=size.height,
            color_space=pixels.id,
            parameters=moment.parameters,
            seed=moment.noise,
        )
        photo = read_photograph(self._photograph(moment, shot))
        if len(photo.data) != size.width * size.height * pixels.layers:
            raise SimulationError(
                f"a picture has {len(photo.data)} bytes, not {size.width}x{size.height}x{pixels.layers}"
            )
        in_torso, in_robot = self._places.measured(moment.snapshot, moment.camera)
        frame = Frame(
            time=moment.time,
            camera=moment.camera,
            width=size.width,
            height=size.height,
            color_space=pixels.id,
            layers=pixels.layers,
            data=photo.data,
            hfov=optics.hfov,
            vfov=optics.vfov,
            pose_in_torso=in_torso,
            pose_in_robot=in_robot,
            number=moment.number,
        )
        return frame, photo

    def _photograph(self, moment: Moment, shot: Shot) -> bytes:
        if moment.replaced_by is None:
            return self.renderer.capture(moment.state, shot, TIMEOUT)
        size = (shot.width, shot.height)
        larger = shot.width > moment.replaced_by.shape[1]
        picture = cv2.resize(moment.replaced_by, size, interpolation=cv2.INTER_LINEAR if larger else cv2.INTER_AREA)
        return photograph(picture, shot)
