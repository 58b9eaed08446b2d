"""The node nao_camera: the robot's cameras as topics."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from naoqi.errors import NaoError

from ...nao.camera_facts import CAMERAS, TOP
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from .camera_topics import CameraTopics

ALONE = ("camera_switch", "source")
"""Parameters whose presence tells that the node is to serve one camera."""


class NaoCamera:
    """Publishes the pictures of both cameras, each while somebody looks.

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
        robot's camera and are left as they are until somebody sets them: `~top/auto_exposition`, `auto_exposure_algo`,
        `exposure`, `gain`, `brightness`, `contrast`, `saturation`, `hue`, `sharpness`, `auto_white_balance`,
        `white_balance`. `nao_robot/camera/top/image_raw/compressed/format` (jpeg or png), `jpeg_quality`, `png_level`,
        as image_transport has them. `~camera_top_frame`, `~camera_bottom_frame`: other names of the frames.
        `~calibration_file_top`, `~calibration_file_bottom`: URLs where there is no camera_info_url.
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
