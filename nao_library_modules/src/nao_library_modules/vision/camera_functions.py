"""Functions that set the cameras and take pictures."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nao_library_msgs.msg import PictureFile
from naoqi.errors import NaoError

from ..core.chain import Part, checked_by
from ..core.errors import BadGoal
from ..core.waiting import CancellationToken
from .cameras import (
    CAMERAS,
    OPTICAL_FRAMES,
    PARAMETERS,
    RESOLUTIONS,
    VIDEO,
    Cameras,
    ChainResults,
    parameter_number,
    resolution_name,
    resolution_of,
)
from .pictures import PICTURE_TYPES, Frame, encoded, encoding_of, frame_of, picture_of, scaled
from .video import VisionFiles
from .vision_fields import (
    DEFAULT_TIMEOUT,
    AutoExposure,
    AutoWhiteBalance,
    Camera,
    Count,
    FrameRate,
    Height,
    Interval,
    NamedCamera,
    Overwrite,
    Parameter,
    PictureName,
    PictureNames,
    PictureType,
    Quality,
    Resolution,
    Revert,
    Timeout,
    Topic,
    Value,
    Width,
)

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic


log = logging.getLogger(__name__)

RESOLUTION, FRAME_RATE = "resolution", "frame_rate"
"""Parameters of the node that reads a camera."""


class SettingFunctions(Part):
    def __init__(self, module: NaoBasic, cameras: Cameras, servers: Mapping[str, str]) -> None:
        """Keep what the functions need. `servers`: camera -> where its node takes dynamic_reconfigure."""
        self._module = module
        self._cameras = cameras
        self._servers = servers

    # Which camera

    def get_cameras(self) -> list[list[str]]:
        """Name, topic and optical frame of each camera."""
        return [[name, self._cameras.source(name, ""), OPTICAL_FRAMES[name]] for name in CAMERAS]

    def set_active_camera(self, camera: NamedCamera, revert: Revert) -> None:
        """Choose the camera that functions take which name none; the robot's own choice too, if it is there."""
        before, name = self._cameras.active, self._cameras.name(camera)
        if revert:
            self._module.after_wait(lambda: self._activate(before, self._module.call_now))
        self._activate(name, self._module.call)

    def get_active_camera(self) -> str:
        """The camera that functions take which name none."""
        return self._cameras.active

    def _activate(self, name: str, call: Callable[..., Any]) -> None:
        self._cameras.active = name
        if self._module.robot.connection.state == "connected":  # topics of other cameras need no robot
            try:
                call(self._module.robot.proxy(VIDEO), "setActiveCamera", CAMERAS[name])
            except NaoError as error:
                log.warning("the robot has its own active camera now: %s", error)

    # The robot's cameras

    def set_parameter(self, camera: Camera, str_param: Parameter, values: Value, revert: Revert) -> None:
        """Set a parameter of a camera: brightness, contrast, ..."""
        self._set(camera, parameter_number(str_param), int(values[0]), revert)

    def get_parameter(self, camera: Camera, str_param: Parameter) -> int:
        """A parameter of a camera."""
        return int(self._ask("getParameter", camera, parameter_number(str_param)))

    def get_parameter_range(self, camera: Camera, str_param: Parameter) -> list[int]:
        """The least, the greatest and the usual value of a parameter of a camera."""
        return [int(value) for value in self._ask("getParameterRange", camera, parameter_number(str_param))]

    def set_all_parameters_to_default(self, camera: Camera) -> None:
        """Set all parameters of a camera to their usual values."""
        self._ask("setAllParametersToDefault", camera)

    def set_auto_exposure(self, camera: Camera, enable: AutoExposure, revert: Revert) -> None:
        """Have a camera choose exposure and gain by itself, or leave them as they are now."""
        self._set(camera, PARAMETERS["AutoExposition"], int(enable), revert)

    def set_auto_white_balance(self, camera: Camera, enable: AutoWhiteBalance, revert: Revert) -> None:
        """Have a camera choose the white balance by itself, or leave it as it is now."""
        self._set(camera, PARAMETERS["AutoWhiteBalance"], int(enable), revert)

    def _ask(self, method: str, camera: str, *args: Any) -> Any:
        index = CAMERAS[self._cameras.name(camera)]
        return self._module.call(self._module.robot.proxy(VIDEO), method, index, *args)

    def _set(self, camera: str, number: int, value: int, revert: bool) -> None:
        name = self._cameras.name(camera)
        if revert:
            before = int(self._ask("getParameter", name, number))
            proxy = self._module.robot.proxy(VIDEO)
            self._module.after_wait(lambda: self._module.call_now(proxy, "setParameter", CAMERAS[name], number, before))
        if self._ask("setParameter", name, number, value) is False:
            problem = f"the {name} camera refuses"
            raise BadGoal(
                "values",
                [value],
                f"see getParameterRange of parameter {number}, and whether an automatic chooses it",
                problem=problem,
            )

    # The nodes that read them

    def set_resolution(self, camera: Camera, resolution: Resolution, revert: Revert) -> None:
        """Set the resolution that a camera is read with."""
        self._configure(camera, RESOLUTION, RESOLUTIONS[resolution_name(resolution)][0], revert)

    def get_resolution(self, camera: Camera) -> str:
        """Resolution that a camera is read with: VGA, ..."""
        return resolution_of(self._configured(camera, RESOLUTION))

    def set_frame_rate(self, camera: Camera, rate: FrameRate, revert: Revert) -> None:
        """Set how many frames a second are read from a camera."""
        self._configure(camera, FRAME_RATE, rate, revert)

    def get_frame_rate(self, camera: Camera) -> float:
        """How many frames a second are read from a camera."""
        return float(self._configured(camera, FRAME_RATE))

    def _configured(self, camera: str, parameter: str) -> Any:
        server = self._servers[self._cameras.name(camera)]
        known = self._cameras.topics.settings(server)
        if parameter not in known:
            text = f"the node of {server} has no parameter {parameter}; it has {', '.join(sorted(known))}"
            raise NaoError(text)
        return known[parameter]

    def _configure(self, camera: str, parameter: str, value: float, revert: bool) -> None:
        server = self._servers[self._cameras.name(camera)]
        before = self._configured(camera, parameter)
        value = type(before)(value)  # dynamic_reconfigure takes whole numbers and others for different things
        if revert:
            self._module.after_wait(lambda: self._cameras.topics.set(server, {parameter: before}))
        reached = self._cameras.topics.set(server, {parameter: value}).get(parameter, value)
        if reached != value:
            raise NaoError(f"the camera's node {server} keeps {parameter} at {reached} instead of {value}")

    functions = {
        "getCameras": get_cameras,
        "setActiveCamera": set_active_camera,
        "getActiveCamera": get_active_camera,
        "setParameter": set_parameter,
        "getParameter": get_parameter,
        "getParameterRange": get_parameter_range,
        "setAllParametersToDefault": set_all_parameters_to_default,
        "setAutoExposure": set_auto_exposure,
        "setAutoWhiteBalance": set_auto_white_balance,
        "setResolution": set_resolution,
        "getResolution": get_resolution,
        "setFrameRate": set_frame_rate,
        "getFrameRate": get_frame_rate,
    }


TAKING = "taking pictures"
"""Status in the feedback."""
OLD_FRAMES = 5
"""So many frames may be older than the request: they were on their way. A camera that sends more of them has another
clock, and its stamps do not count."""

SILENCE_GRACE = 1.0
"""s of ROS time that pictures are waited for at least while the robot is silent, and after that."""


class Frames:
    """The newest frame of a topic, for one function that waits for it."""

    def __init__(self, topic: str, clock: Any, interrupt: CancellationToken, connection: Any) -> None:
        """Wait for none yet. `connection`: of the robot, whose silence gives its cameras more time."""
        self._topic = topic
        self._clock = clock
        self._interrupt = interrupt
        self._connection = connection
        self._news = CancellationToken()
        self._newest: Frame | None = None
        self._old = 0

    def take(self, message: Any) -> None:
        """Take a message. Called from the thread that receives it."""
        self._newest = frame_of(message, self._clock.now())
        self._news.trigger()

    def next(self, since: float, timeout: float) -> Frame:
        """The next frame that is not older than a time, or comes after OLD_FRAMES older ones.

        `since`: ROS time, s. `timeout`: s to wait for it. Raises NaoError if none came; Preempted, or whatever reason
        the interrupt has.
        """
        end = self._clock.now() + timeout
        while True:
            self._interrupt.check()
            self._news.clear()
            frame, self._newest = self._newest, None
            if frame is not None:
                if frame.stamp >= since or self._old >= OLD_FRAMES:
                    return frame
                self._old += 1
                continue
            if self._connection.silent:
                end = max(end, self._clock.now() + SILENCE_GRACE)
            remaining = end - self._clock.now()
            if remaining <= 0.0:
                raise NaoError(f"no picture came from {self._topic} within {timeout:g} s: is its camera running?")
            with self._interrupt.waking(self._news.trigger):
                self._clock.wait(remaining, self._news)


class PictureFunctions(Part):
    left_by_goals = frozenset({"files"})

    def __init__(self, module: NaoBasic, cameras: Cameras, files: VisionFiles, results: ChainResults) -> None:
        self.files = files
        self._module = module
        self._cameras = cameras
        self._results = results

    def _check_pictures(
        self, str_param: str, file_type: str, count: int, overwrite: bool, context: dict[str, Any]
    ) -> None:
        kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
        if str_param.strip():
            path = self.files.path(str_param, kind)
            for number in range(1, (count or 1) + 1):
                self.files.plan(_numbered(path, number, count or 1), overwrite, context.setdefault("files", set()))

    def _check_picture(self, str_param: str, file_type: str, overwrite: bool, context: dict[str, Any]) -> None:
        self._check_pictures(str_param, file_type, 1, overwrite, context)

    @checked_by(_check_picture)
    def take_picture(
        self,
        str_param: PictureName,
        camera: Camera,
        topic: Topic,
        file_type: PictureType,
        quality: Quality,
        width: Width,
        height: Height,
        timeout: Timeout,
        overwrite: Overwrite,
    ) -> list[str]:
        """Take a picture from now on, not an older one; answers its file."""
        return self.take_pictures(
            str_param, camera, topic, file_type, quality, width, height, timeout, 1, 0.0, overwrite
        )

    @checked_by(_check_pictures)
    def take_pictures(
        self,
        str_param: PictureNames,
        camera: Camera,
        topic: Topic,
        file_type: PictureType,
        quality: Quality,
        width: Width,
        height: Height,
        timeout: Timeout,
        count: Count,
        interval: Interval,
        overwrite: Overwrite,
    ) -> list[str]:
        """Take several pictures; answers their files."""
        module, cameras = self._module, self._cameras
        source = cameras.source(camera, topic)
        kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
        named = self.files.path(str_param, kind) if str_param.strip() else None
        prefix = cameras.name(camera) if not topic.strip() else "picture"
        count = count or 1
        answers = []
        began = module.clock.now()
        frames = Frames(source, module.clock, module.interrupt, module.robot.connection)
        with closing(cameras.topics.subscribe(source, frames.take)):
            for number in range(1, count + 1):
                due = began + (number - 1) * interval
                module.wait(due - module.clock.now())
                frame = frames.next(due, timeout or DEFAULT_TIMEOUT)
                picture = scaled(picture_of(frame.message), width, height)
                path = _numbered(named, number, count) if named else self.files.named_by_time(prefix, kind)
                data = encoded(picture, kind, quality)
                path = self.files.write(path, data, overwrite and named is not None, numbered=named is None)
                self._results.pictures.append(
                    PictureFile(
                        header=frame.message.header,
                        path=str(path),
                        file_type=kind,
                        topic=source,
                        width=picture.shape[1],
                        height=picture.shape[0],
                        encoding=encoding_of(frame.message),
                    )
                )
                answers.append(str(path))
                if count > 1:
                    module.publish_feedback(status=TAKING, done=number)
        return answers

    functions = {
        "takePicture": take_picture,
        "takePictures": take_pictures,
    }


def _numbered(path: Path, number: int, count: int) -> Path:
    """Path of one of several pictures: name-001 and so on; the path itself if there is only one picture."""
    if count == 1:
        return path
    return path.with_name(f"{path.stem}-{number:0{max(3, len(str(count)))}d}{path.suffix}")
