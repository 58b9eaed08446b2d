"""Calibrations of cameras: values, YAML files, and the one in use for each camera and size. No ROS."""

from __future__ import annotations

import logging
import math
import re
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Tuple
from urllib.parse import unquote

import yaml

from naoqi.errors import NaoError

from ...core.files import put_aside, ros_home, write_whole
from ...core.yaml_values import Budget, load_within

log = logging.getLogger(__name__)

Row = Tuple[float, ...]

PLUMB_BOB = "plumb_bob"
NO_DISTORTION = (0.0,) * 5
NO_ROTATION = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
MOST_VALUES, DEEPEST = 1000, 10
"""Of a file: values, and lists in each other."""
SAME_SHAPE = 0.01
"""Share by which width over height may differ between two sizes of the same field of view."""
MATRICES = {
    "camera_matrix": ("k", 3, 3),
    "distortion_coefficients": ("d", 1, None),
    "rectification_matrix": ("r", 3, 3),
    "projection_matrix": ("p", 3, 4),
}
"""Name in the file -> attribute, rows, columns (None: any)."""


@dataclass(frozen=True)
class Calibration:
    """Contents of sensor_msgs/CameraInfo for pictures of one size; matrices row by row, in pixels."""

    width: int
    height: int
    k: Row  # (9,) camera matrix
    d: Row = NO_DISTORTION  # (n,) distortion
    r: Row = NO_ROTATION  # (9,) rectification
    p: Row = ()  # (12,) projection; empty: that of k
    model: str = PLUMB_BOB
    name: str = ""  # of the camera; may be empty

    def __post_init__(self) -> None:
        """Raises NaoError for a wrong number or size."""
        if self.width <= 0 or self.height <= 0:
            raise NaoError(f"a calibration for pictures of {self.width}x{self.height} pixels is none")
        for name, row, count in (("K", self.k, 9), ("R", self.r, 9), ("P", self.p or (0.0,) * 12, 12)):
            if len(row) != count or not all(math.isfinite(each) for each in row):
                raise NaoError(f"{name} of a calibration has {count} finite numbers, not {row}")
        if not (self.k[0] > 0.0 and self.k[4] > 0.0):
            raise NaoError(f"K of a calibration has focal lengths above 0, not {self.k[0]} and {self.k[4]}")
        if not all(math.isfinite(each) for each in self.d):
            raise NaoError(f"D of a calibration has finite numbers, not {self.d}")
        if not self.p:
            fx, skew, cx, _, fy, cy = self.k[:6]
            object.__setattr__(self, "p", (fx, skew, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0))


def ideal(width: int, height: int, hfov: float, vfov: float) -> Calibration:
    """A pinhole without distortion; fields of view from edge to edge of the picture, rad."""
    fx, fy = width / 2.0 / math.tan(hfov / 2.0), height / 2.0 / math.tan(vfov / 2.0)
    return Calibration(width, height, (fx, 0.0, width / 2.0, 0.0, fy, height / 2.0, 0.0, 0.0, 1.0))


def scaled(calibration: Calibration, width: int, height: int) -> Calibration:
    """The same for pictures of another size: a NAO's camera has one field of view in all sizes.

    Raises NaoError if width over height differs.
    """
    x, y = width / calibration.width, height / calibration.height
    if abs(x / y - 1.0) > SAME_SHAPE:
        size = f"{calibration.width}x{calibration.height}"
        raise NaoError(f"a calibration for {size} is of no use for {width}x{height}: another shape of the picture")
    factors = (x, y, 1.0)
    k = tuple(value * factors[place // 3] for place, value in enumerate(calibration.k))
    p = tuple(value * factors[place // 4] for place, value in enumerate(calibration.p))
    return replace(calibration, width=width, height=height, k=k, p=p)


def to_yaml(calibration: Calibration) -> str:
    content: dict[str, Any] = {
        "image_width": calibration.width,
        "image_height": calibration.height,
        "camera_name": calibration.name,
        "distortion_model": calibration.model,
    }
    for key, (attribute, rows, columns) in MATRICES.items():
        values = list(getattr(calibration, attribute))
        content[key] = {"rows": rows, "cols": columns or len(values), "data": values}
    return yaml.safe_dump(content, sort_keys=False, default_flow_style=None)


def from_yaml(text: str) -> Calibration:
    """Calibration from the text of a file; raises NaoError if it holds none."""
    try:
        content = load_within(text, Budget(MOST_VALUES, DEEPEST))
    except yaml.YAMLError as error:
        raise NaoError(f"it is no YAML: {error}") from error
    if not isinstance(content, dict):
        raise NaoError("it holds no calibration")
    try:
        width, height = int(content["image_width"]), int(content["image_height"])
        rows = {attribute: _matrix(content, key, columns) for key, (attribute, _, columns) in MATRICES.items()}
    except KeyError as error:
        raise NaoError(f"it has no {error.args[0]}") from error
    except (TypeError, ValueError, OverflowError) as error:
        raise NaoError(f"it holds something else than numbers: {error}") from error
    model = str(content.get("distortion_model", PLUMB_BOB))
    return Calibration(width, height, model=model, name=str(content.get("camera_name", "")), **rows)


def _matrix(content: dict[str, Any], key: str, columns: int | None) -> Row:
    entry = content[key] if key in ("camera_matrix", "distortion_coefficients") else content.get(key)
    if entry is None:
        return NO_ROTATION if columns == 3 else ()
    return tuple(float(each) for each in entry["data"])


FILE, PACKAGE = "file://", "package://"
DEFAULT_URL = "file://${ROS_HOME}/camera_info/${NAME}.yaml"
UNSAFE = re.compile(r"[^A-Za-z0-9_]")


def camera_name(words: str) -> str:
    """A name of letters, digits and underscores, as the convention demands."""
    return UNSAFE.sub("_", words.strip("/"))


def path_of(url: str, name: str, package_folder: Callable[[str], str]) -> Path:
    """The file that a URL stands for.

    Raises NaoError if it is another kind of URL, or its package is not found.

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


class CameraInfos:
    """Calibrations of one camera. Any thread may call; files are read once, when their size is first asked for.

    Of the file that the URL names and the one beside it with the size in its name (`name_320x240.yaml`), the latter
    comes first. A file for another size is scaled, which is logged once.
    """

    def __init__(self, name: str, package_folder: Callable[[str], str]) -> None:
        self._name = name
        self._package_folder = package_folder
        self._lock = threading.Lock()
        self._url = ""
        self._path = path_of("", name, package_folder)
        self._known: dict[tuple[int, int], Calibration] = {}
        self._sources: dict[tuple[int, int], str] = {}
        self._fov: tuple[float, float] | None = None

    def set_url(self, url: str) -> None:
        """Take calibrations from another URL, see `path_of`; empty: the default place.

        Raises NaoError if it is no such URL, or names a file that is not there or no calibration.
        """
        path = path_of(url, self._name, self._package_folder)
        if url and not any(path.parent.glob(f"{path.stem}_*x*{path.suffix}")):
            read(path, self._name)
        with self._lock:
            self._url, self._path = url, path
            self._known.clear()

    def set_fov(self, hfov: float, vfov: float) -> None:
        """Set the fields of view, rad, for sizes without a file."""
        with self._lock:
            if (hfov, vfov) != self._fov:
                self._fov = (hfov, vfov)
                self._known.clear()

    def of(self, width: int, height: int) -> Calibration | None:
        """The calibration of pictures of one size; None while there is neither a file nor a field of view."""
        with self._lock:
            size = (width, height)
            if size not in self._known:
                found = self._find(width, height)
                if found is None:
                    return None
                self._known[size], self._sources[size] = found
                log.info("%s %dx%d: %s", self._name, width, height, found[1])
            return self._known[size]

    def source(self, width: int, height: int) -> str:
        """Origin of the calibration of one size, in words; empty if it was not asked for yet."""
        with self._lock:
            return self._sources.get((width, height), "")

    def set(self, calibration: Calibration) -> Path:
        """Save a calibration and return its file; raises NaoError if it cannot be written.

        The file is that of the URL, or the one beside it with the size in its name if that is for another size.
        """
        calibration = replace(calibration, name=self._name)
        with self._lock:
            path = self._path
            own = sized(path, calibration.width, calibration.height)
            if own.is_file() or self._is_for_another_size(path, calibration):
                path = own
            write(path, calibration)
            self._known.clear()
        return path

    def _is_for_another_size(self, path: Path, calibration: Calibration) -> bool:
        if not path.is_file():
            return False
        try:
            found = read(path, self._name)
        except NaoError as error:
            put_aside(path, error, "another calibration takes its place")
            return False
        return (found.width, found.height) != (calibration.width, calibration.height)

    def _find(self, width: int, height: int) -> tuple[Calibration, str] | None:
        for path in (sized(self._path, width, height), self._path):
            if not path.is_file():
                continue
            try:
                found = read(path, self._name)
                if (found.width, found.height) == (width, height):
                    return found, f"calibration of {path}"
                fitting = scaled(found, width, height)
            except NaoError as error:
                log.error("%s: %s", path, error)
                continue
            log.warning("%s is for %dx%d: scaled to %dx%d", path, found.width, found.height, width, height)
            return fitting, f"calibration of {path}, scaled"
        if self._fov is None:
            return None
        computed = replace(ideal(width, height, *self._fov), name=self._name)
        return computed, "computed from the field of view of the robot's camera"
