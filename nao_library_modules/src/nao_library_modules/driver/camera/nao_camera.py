"""The node nao_camera: images of both cameras, their calibration and settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import rospkg
import rospy
from rospy.rostime import is_wallclock
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from sensor_msgs.srv import SetCameraInfo, SetCameraInfoResponse
from std_msgs.msg import Header

from naoqi.errors import NaoError

from ...core.errors import did_you_mean
from ...core.health import Report
from ...core.nao_facts import CAMERA_NAMES, CAMERAS, SIZES, TOP
from ...core.robot import ask
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock
from ..base.driver_node import LazyTopic, frame_parameter, name_for_robot, publish
from ..base.reconfigure import ReconfigureField, serve, update
from .camera_calibration import CameraInfos, camera_name
from .camera_images import FORMATS, JPEG, Picture, compress, from_info, header_of, to_compressed, to_image, to_info
from .camera_settings import NO_ANSWER, TUNINGS, CameraTuning, changed_tunings, fields_of, settled, stream_settings
from .camera_stream import DEVICE, CameraStream

QUEUE = 2
"""Pictures that wait for a subscriber that is slow; the oldest is dropped."""
QVGA = 1
RATE = 15.0
COMPRESSION = (
    ReconfigureField("format", JPEG, "format of the files", choices=FORMATS),
    ReconfigureField("jpeg_quality", 80, "quality of JPEG in percent", 1, 100),
    ReconfigureField("png_level", 3, "effort to make PNG small", 1, 9),
)
WARN_PERIOD = 10.0


class CameraTopics:
    """Publishes the pictures of one camera while it has subscribers; otherwise the robot sends nothing.

    See `nao_camera.NaoCamera` for names. Pictures are published in a thread of the camera; parameters change in those
    of their services.
    """

    def __init__(self, robot: Any, node: NodeInterface, camera: int, folder: str, part: str, alone: bool) -> None:
        """Raises NaoError for a wrong parameter. The robot need not be connected yet.

        Args:
            camera: NAOqi's number.
            folder: Prefix of the topics, with its slash.
            part: Prefix of the parameters; may be empty.
            alone: Whether the node serves this camera only, and can switch to the other.
        """
        self._robot = robot
        self._node = node
        self._camera = camera
        self._frames = {
            each: frame_parameter(node, f"~camera_{name}_frame", f"{CAMERA_NAMES[each]}_optical_frame")
            for each, name in CAMERAS.items()
        }
        # Names in calibration files; the namespace of the robot tells several apart.
        names = {each: camera_name(f"{node.namespace}nao_camera_{name}") for each, name in CAMERAS.items()}
        self._infos = {each: CameraInfos(name, _package_folder) for each, name in names.items()}
        self._config: Mapping[str, Any] = {}
        self._compression: Mapping[str, Any] = {}
        self._url = ""
        self._shown: dict[str, int] = {}  # parameters of the picture as the robot has them, as far as that is known
        prefix = f"~{part}/" if part else "~"
        # The defaults are those of the camera. A node that was started again finds all parameters set: these too.
        given = {name: node.param(prefix + name, tuning.field.default) for name, tuning in TUNINGS.items()}
        given = {name: value for name, value in given.items() if value != TUNINGS[name].field.default}
        fields = fields_of(QVGA, RATE, is_wallclock(), camera, alone)
        defaults = {field.name: field.default for field in fields}
        subscriber = name_for_robot(node.name) + (f"_{part}" if part else "")
        self._tuning = CameraTuning(self._ask, {})
        self._choices = 0
        stream = stream_settings(defaults, camera)
        self._stream = CameraStream(robot, subscriber, stream, RosClock(), self._show, self._prepare)
        node.if_it_fails(self._stream.close)
        self._server = serve(node, fields, self._changed, part)
        self._tuning.choose(camera, given, connected=False)
        compressed = f"{folder}image_raw/compressed"
        self._compression_server = serve(node, COMPRESSION, self._compress_as, node.resolve(compressed))
        folders = (folder,) if alone else (folder, f"{folder}camera/")
        self._images = [node.publisher(f"{each}image_raw", Image, queue_size=QUEUE) for each in folders]
        self._info_topics = [node.publisher(f"{each}camera_info", CameraInfo, queue_size=QUEUE) for each in folders]
        self._compressed = node.publisher(compressed, CompressedImage, queue_size=QUEUE)
        self._lazy = LazyTopic(self._stream.want, *self._images, *self._info_topics, self._compressed)
        for each in folders:
            node.service(f"{each}set_camera_info", SetCameraInfo, self._set_camera_info)

    @property
    def camera(self) -> int:
        """NAOqi's number of the present camera."""
        return self._stream.settings.camera

    def report(self) -> Report:
        report = self._stream.report()
        source = self._infos[self.camera].source(*SIZES[self._stream.settings.resolution])
        return Report(report.level, report.message, {**report.values, "calibration": source})

    def close(self) -> None:
        self._stream.close()

    # --- pictures -------------------------------------------------------------------------------------------------

    def _show(self, picture: Picture, ros_time: float) -> None:
        """Publish a picture with its calibration; called in the thread of the pictures."""
        time = ros_time if self._config["use_ros_time"] else picture.time
        header = header_of(time, self._frames[picture.camera])
        images, infos = (
            [topic for topic in topics if topic.get_num_connections()] for topics in (self._images, self._info_topics)
        )
        if images:
            image = to_image(picture, header)
            for topic in images:
                publish(topic, image)
        if infos:
            calibration = self._infos[picture.camera].of(picture.width, picture.height)
            info = to_info(calibration, picture.width, picture.height, header)
            for topic in infos:
                publish(topic, info)
        if self._compressed.get_num_connections():
            self._show_compressed(picture, header)

    def _show_compressed(self, picture: Picture, header: Header) -> None:
        chosen = self._compression
        try:
            kind, file = compress(picture, chosen["format"], chosen["jpeg_quality"], chosen["png_level"])
        except NaoError as error:
            rospy.logwarn_throttle(WARN_PERIOD, f"{self._compressed.name}: {error}")
        else:
            publish(self._compressed, to_compressed(kind, file, header))

    # --- the robot ------------------------------------------------------------------------------------------------

    def _ask(self, method: str, *arguments: Any) -> Any:
        return ask(self._robot, DEVICE, method, *arguments)

    def _prepare(self) -> None:
        """Make robot and parameters agree; called in the thread of the lazy subscription, before pictures come.

        Raises one of `NO_ANSWER`: this is tried again then.
        """
        camera = self.camera
        try:
            fov = self._ask("getHorizontalFOV", camera), self._ask("getVerticalFOV", camera)
            self._infos[camera].set_fov(*fov)
        except NO_ANSWER:
            raise
        except NaoError as error:
            rospy.logwarn("the field of view of the %s cannot be read: %s", CAMERA_NAMES[camera], error)
        self._tuning.set_again(camera)
        while True:
            choices = self._choices
            shown = self._tuning.read(camera)
            if choices == self._choices:
                break  # else a client has chosen meanwhile, and what was read may be older
        self._shown.update(shown)
        if any(self._config[name] != value for name, value in shown.items()):
            update(self._server, shown)

    # --- parameters -----------------------------------------------------------------------------------------------

    def _changed(self, before: Mapping[str, Any], after: Mapping[str, Any]) -> Mapping[str, Any]:
        """Apply new values; called in the thread of the service, and once at the start."""
        changed = changed_tunings(before, after) if before else {}
        if changed and all(self._shown.get(name) == value for name, value in changed.items()):
            changed = {}  # what the robot has said
        else:
            after = settled(before, after)
            changed = changed_tunings(before, after) if before else {}
        stream, former = stream_settings(after, self._camera), self._stream.settings
        url = after["camera_info_url"] or self._node.param(f"~calibration_file_{CAMERAS[stream.camera]}", "")
        if not before or url != self._url or stream.camera != former.camera:
            self._infos[stream.camera].set_url(url)
        self._stream.change(stream)
        if changed:
            self._choices += 1
            connected = self._robot.connection.state == "connected"
            try:
                self._tuning.choose(stream.camera, changed, connected)
            except NaoError:
                self._stream.change(former)
                raise
            if connected:
                self._shown.update(changed)
        self._url, self._config = url, after
        return after

    def _compress_as(self, _before: Mapping[str, Any], after: Mapping[str, Any]) -> Mapping[str, Any]:
        self._compression = after
        return after

    # --- calibration ----------------------------------------------------------------------------------------------

    def _set_camera_info(self, request: Any) -> SetCameraInfoResponse:
        try:
            path = self._infos[self.camera].set(from_info(request.camera_info))
        except NaoError as error:
            rospy.logerr("set_camera_info: %s", error)
            return SetCameraInfoResponse(False, str(error))
        return SetCameraInfoResponse(True, f"kept in {path}")


def _package_folder(package: str) -> str:
    packages = rospkg.RosPack()
    try:
        return packages.get_path(package)
    except rospkg.ResourceNotFound as error:
        raise NaoError(f"package {package!r} not found{did_you_mean(package, packages.list())}") from error


ALONE = ("camera_switch", "source")
"""Parameters whose presence says that the node is to serve one camera."""


class NaoCamera:
    """Publishes the pictures of both cameras, each while it has subscribers.

    ROS API (relative names, the same with `bottom` for `top`):
        Publishes `nao_robot/camera/top/image_raw` (sensor_msgs/Image), `nao_robot/camera/top/camera_info`
        (sensor_msgs/CameraInfo, with the stamps of the pictures), `nao_robot/camera/top/image_raw/compressed`
        (sensor_msgs/CompressedImage). Frame `CameraTop_optical_frame` (z ahead, x right, y down), after `tf_prefix`.
        Service `nao_robot/camera/top/set_camera_info` (sensor_msgs/SetCameraInfo). Pictures, calibration and service
        also in `nao_robot/camera/top/camera/`, where the launch files of nao_robot have them.
        Parameters, also by dynamic_reconfigure of `~top`: `~top/resolution` (NAOqi's number, 1: 320x240),
        `~top/frame_rate` (15), `~top/color_space` (NAOqi's number, 13: bgr8), `~top/camera_info_url`,
        `~top/use_ros_time` (true: stamps in ROS time; false: stamps of the robot's own clock. Default true; false on
        simulated time, which is the clock of the simulated robot), and those of the picture, which belong to the
        robot's camera and are left as they are until a client sets them: `~top/auto_exposition`, `auto_exposure_algo`,
        `exposure`, `gain`, `brightness`, `contrast`, `saturation`, `hue`, `sharpness`, `auto_white_balance`,
        `white_balance`. `nao_robot/camera/top/image_raw/compressed/format` (jpeg or png), `jpeg_quality`, `png_level`,
        as image_transport has them. `~camera_top_frame`, `~camera_bottom_frame`: other names of the frames.
        `~calibration_file_top`, `~calibration_file_bottom`: URLs where camera_info_url is not set.
        Calibration: that of camera_info_url; without one, that of ROS_HOME/camera_info/NAME.yaml, where
        set_camera_info puts it (NAME is nao_camera_top, with the namespace before it); without that, computed from
        the field of view. One for another size is scaled; NAME_320x240.yaml is for that size only.
        With `~camera_switch` or `~source` (0 top, 1 bottom) the node serves that camera alone, as `image_raw`,
        `camera_info`, `image_raw/compressed`, `set_camera_info`, with parameters without `top/`; `~source` can be
        changed while it runs.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._cameras: dict[str, CameraTopics] = {}
        alone = next((name for name in reversed(ALONE) if node.has_param(f"~{name}")), None)
        if alone is None:
            for camera, name in CAMERAS.items():
                self._cameras[name] = CameraTopics(robot, node, camera, f"nao_robot/camera/{name}/", name, alone=False)
            return
        camera = node.param(f"~{alone}", TOP)
        if isinstance(camera, bool) or camera not in CAMERAS:
            listed = " or ".join(f"{number} ({name})" for number, name in CAMERAS.items())
            raise NaoError(f"~{alone} is {camera!r}: {listed}")
        self._cameras["alone"] = CameraTopics(robot, node, camera, "", "", alone=True)

    def reports(self) -> dict[str, Callable[[], Report]]:
        if "alone" in self._cameras:
            return {"camera": self._cameras["alone"].report}
        return {f"camera {name}": camera.report for name, camera in self._cameras.items()}

    def close(self) -> None:
        for camera in self._cameras.values():
            camera.close()
