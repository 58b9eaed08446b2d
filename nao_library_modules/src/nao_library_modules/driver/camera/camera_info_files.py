"""Where calibrations are kept: URLs and file names by the convention of camera_info_manager. No ROS."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote

from naoqi.errors import NaoError

from ...base.whole_file import write_whole
from .camera_calibration import Calibration, from_yaml, to_yaml

log = logging.getLogger(__name__)

FILE, PACKAGE = "file://", "package://"
DEFAULT_URL = "file://${ROS_HOME}/camera_info/${NAME}.yaml"
UNSAFE = re.compile(r"[^A-Za-z0-9_]")


def ros_home() -> Path:
    """Folder of ROS for files of this user."""
    return Path(os.environ.get("ROS_HOME") or Path.home() / ".ros")


def camera_name(words: str) -> str:
    """A name as the convention wants it: letters, digits and underscores."""
    return UNSAFE.sub("_", words.strip("/"))


def path_of(url: str, name: str, package_folder: Callable[[str], str]) -> Path:
    """The file that a URL stands for.

    Args:
        url: `file:///folder/file.yaml` or `package://package/file.yaml`, with ${NAME} for the name of the camera and
            ${ROS_HOME} for the folder of ROS; empty: the default of the convention.
        name: Of the camera.
        package_folder: Gives the folder of a package.

    Raises:
        NaoError: If it is another kind of URL, or there is no such package.
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


def read(path: Path, name: str) -> Calibration:
    """The calibration in a file.

    Args:
        path: The file.
        name: Of the camera; another one in the file is told in the log.

    Raises:
        NaoError: If it cannot be read, or holds none.
    """
    try:
        calibration = from_yaml(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise NaoError(f"{path} cannot be read: {error}") from error
    except NaoError as error:
        raise NaoError(f"{path} is no calibration: {error}") from error
    if calibration.name != name:
        log.warning("%s is of the camera %r, and used for %r", path, calibration.name, name)
    return calibration


def write(path: Path, calibration: Calibration) -> None:
    """Put a calibration into a file, all of it or nothing.

    Raises:
        FileTrouble: If that does not work.
    """
    write_whole(path, to_yaml(calibration))
