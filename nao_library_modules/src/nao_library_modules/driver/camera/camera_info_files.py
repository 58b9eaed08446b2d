"""Files of calibrations: URLs and names by the convention of camera_info_manager. No ROS."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote

from naoqi.errors import NaoError

from ...base.paths import ros_home
from ...base.whole_file import write_whole
from .camera_calibration import Calibration, from_yaml, to_yaml

log = logging.getLogger(__name__)

FILE, PACKAGE = "file://", "package://"
DEFAULT_URL = "file://${ROS_HOME}/camera_info/${NAME}.yaml"
UNSAFE = re.compile(r"[^A-Za-z0-9_]")


def camera_name(words: str) -> str:
    """A name of letters, digits and underscores, as the convention demands."""
    return UNSAFE.sub("_", words.strip("/"))


def path_of(url: str, name: str, package_folder: Callable[[str], str]) -> Path:
    """The file that a URL stands for.

    Raises NaoError if it is another kind of URL, or there is no such package.

    Args:
        url: `file:///folder/file.yaml` or `package://package/file.yaml`, with ${NAME} for the name of the camera and
            ${ROS_HOME} for the folder of ROS; empty: the default of the convention.
        name: Of the camera.
    """
    text = (url or DEFAULT_URL).replace("${NAME}", name).replace("${ROS_HOME}", str(ros_home()))
    kind = text[: text.find("://") + 3].lower()
    if kind == FILE and text[len(FILE) :].startswith("/"):
        return Path(unquote(text[len(FILE) :]))
    package, _, inside = text[len(PACKAGE) :].partition("/")
    if kind == PACKAGE and package and inside:
        return Path(package_folder(package)) / unquote(inside)
    raise NaoError(f"camera_info_url is {url!r}: file:///folder/file.yaml or package://package/file.yaml")


def sized(path: Path, width: int, height: int) -> Path:
    """The file beside another one that holds the calibration of one size only."""
    return path.with_name(f"{path.stem}_{width}x{height}{path.suffix}")


def read(path: Path, name: str | None = None) -> Calibration:
    """The calibration in a file; another `name` of the camera in it is logged.

    Raises NaoError if it cannot be read, or holds none.
    """
    try:
        calibration = from_yaml(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise NaoError(f"{path} cannot be read: {error}") from error
    except NaoError as error:
        raise NaoError(f"{path} is no calibration: {error}") from error
    if name is not None and calibration.name != name:
        log.warning("%s is of the camera %r, and used for %r", path, calibration.name, name)
    return calibration


def write(path: Path, calibration: Calibration) -> None:
    """Write a calibration to a file, all of it or nothing; raises FileTrouble."""
    write_whole(path, to_yaml(calibration))
