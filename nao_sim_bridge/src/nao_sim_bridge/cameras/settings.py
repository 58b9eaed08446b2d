"""What cameras can do: resolutions, colour spaces and parameters, from `config/cameras.json`, with NAOqi's numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Callable, Mapping, Tuple

from nao_sim_bridge.base.config import check_keys, config_file, read_json, section
from nao_sim_bridge.base.errors import BadValue, ConfigError

BRIGHTNESS = 0
CONTRAST = 1
SATURATION = 2
HUE = 3
GAIN = 6
H_FLIP = 7
V_FLIP = 8
AUTO_EXPOSURE = 11
AUTO_WHITE_BALANCE = 12
EXPOSURE = 17
EXPOSURE_ALGORITHM = 22
SHARPNESS = 24
WHITE_BALANCE = 33
BACKLIGHT = 34
KEEP_ALIVE = 35
LUMINANCE = 39
AUTO_FOCUS = 40
FOCUS = 43

FOCUS_ONCE = 250
"""This value of the focus makes the camera focus once; it is sharp then."""
FILE = "cameras.json"
CAMERAS = (0, 1)
"""Indexes of the cameras: top and bottom."""
CAMERA_NAMES = ("CameraTop", "CameraBottom")
LEAST_FPS = 0.001


@dataclass(frozen=True)
class Resolution:
    """A size of pictures, with NAOqi's number and name.

    Attributes:
        most_fps: The most frames a second, for each camera; 0 where it cannot be had.
    """

    id: int
    name: str
    width: int
    height: int
    most_fps: Tuple[int, ...]


@dataclass(frozen=True)
class ColorSpace:
    """A way to write pixels as bytes, `layers` of them a pixel (0 where only a depth camera has it)."""

    id: int
    name: str
    layers: int


@dataclass(frozen=True)
class CameraParameter:
    """A setting of a camera, with NAOqi's number and name."""

    id: int
    name: str
    least: int
    most: int
    default: int
    read_only: bool = False


@dataclass(frozen=True)
class SensorModel:
    """How the parameters of a camera model work; the file has the meanings."""

    exposure: int
    longest_exposure: int
    gain: int
    most_gain: int
    contrast: int
    saturation: int
    sharpness: int
    sharpness_step: float
    target_luminance: float
    target_of_brightness: float
    offset_of_brightness: float
    hue: bool
    backlight_weight: float


@dataclass(frozen=True)
class CameraTables:
    """What the cameras of one robot version can do. What is asked for and is not there is a BadValue.

    Attributes:
        model_id: NAOqi's number of the camera model.
        most_fps: The most frames a second of any resolution.
        same_name: How many subscribers may have the same name.
        color_spaces: By id, those included that only depth cameras have.
    """

    version: str
    model_id: int
    most_fps: int
    same_name: int
    resolutions: Mapping[int, Resolution]
    color_spaces: Mapping[int, ColorSpace]
    parameters: Mapping[int, CameraParameter]
    sensor: SensorModel

    @property
    def defaults(self) -> dict[int, int]:
        """Parameters at the start: id to value."""
        return {parameter.id: parameter.default for parameter in self.parameters.values()}

    def camera(self, index: Any) -> int:
        """`index`, if there is such a camera."""
        _known("camera", index, dict(zip(CAMERAS, ("top", "bottom"))), str)
        return int(index)

    def resolution(self, number: Any) -> Resolution:
        """The resolution with this id."""
        _known("resolution", number, self.resolutions, lambda r: f"{r.width}x{r.height}")
        return self.resolutions[number]

    def color_space(self, number: Any) -> ColorSpace:
        """The colour space with this id, which the camera must have."""
        colored = {space.id: space for space in self.color_spaces.values() if space.layers}
        if number in self.color_spaces and number not in colored:
            space = self.color_spaces[number]
            raise BadValue(
                "colorSpace", number, f"one of {', '.join(map(str, colored))}: {space.name} needs a depth camera"
            )
        _known("colorSpace", number, colored, lambda s: "")
        return colored[number]

    def parameter(self, number: Any) -> CameraParameter:
        """The parameter with this id."""
        _known("parameter", number, self.parameters, lambda p: p.name)
        return self.parameters[number]

    def check_rate(self, camera: int, resolution: Resolution, fps: Any) -> None:
        """Make sure that a camera has pictures of this size, and that a number is a frame rate."""
        if not resolution.most_fps[camera]:
            allowed = ", ".join(str(r.id) for r in self.resolutions.values() if r.most_fps[camera])
            raise BadValue("resolution", resolution.id, f"one of {allowed} with camera {camera}")
        number = isinstance(fps, (int, float)) and not isinstance(fps, bool)
        if not number or not LEAST_FPS <= fps <= self.most_fps:
            raise BadValue("fps", fps, f"up to {self.most_fps} frames a second, above 0")


def _known(field: str, number: Any, table: Mapping[int, Any], text: Callable[[Any], str]) -> None:
    if isinstance(number, bool) or not isinstance(number, int) or number not in table:
        listed = ", ".join(f"{key} ({text(value)})" if text(value) else str(key) for key, value in table.items())
        raise BadValue(field, number, f"one of {listed}")


@lru_cache(maxsize=None)
def load_cameras(version: str) -> CameraTables:
    """The tables of a robot version.

    Raises:
        ConfigError: The file does not hold what it should.
    """
    return parse_cameras(read_json(config_file(FILE)), version)


def parse_cameras(content: Mapping[str, Any], version: str) -> CameraTables:
    """Tables from the content of the file; see `load_cameras`."""
    check_keys(content, FILE, ("resolutions", "color_spaces", "most_fps", "same_name", "versions"), ("_note",))
    if version not in content["versions"]:
        raise ConfigError(f"{FILE}: versions", f"no cameras of version {version!r}")
    where = f"{FILE}: versions.{version}"
    model = check_keys(content["versions"][version], where, ("model_id", "resolutions", "sensor", "parameters"))
    resolutions = {}
    for name, most in model["resolutions"].items():
        if name.startswith("_"):
            continue
        number, width, height = _listed(content["resolutions"], name, 3, "resolutions")
        each = tuple(most) if isinstance(most, list) else (most,) * len(CAMERAS)
        resolutions[number] = Resolution(number, name, width, height, each)
    spaces = {}
    for name in content["color_spaces"]:
        number, layers = _listed(content["color_spaces"], name, 2, "color_spaces")
        spaces[number] = ColorSpace(number, name, layers)
    parameters = {}
    for name, entry in model["parameters"].items():
        at = f"{where}.parameters.{name}"
        check_keys(entry, at, ("id", "range", "default"), ("read_only",))
        least, most = entry["range"]
        if not least <= entry["default"] <= most:
            raise ConfigError(at, f"default {entry['default']} is not within {least}..{most}")
        parameters[entry["id"]] = CameraParameter(
            entry["id"], name, least, most, entry["default"], bool(entry.get("read_only", False))
        )
    sensor = section(SensorModel, model["sensor"], f"{where}.sensor")
    general = (model["model_id"], content["most_fps"], content["same_name"])
    return CameraTables(version, *general, resolutions, spaces, parameters, sensor)


def _listed(table: Mapping[str, Any], name: str, count: int, where: str) -> Any:
    values = table.get(name)
    if not isinstance(values, list) or len(values) != count or not all(isinstance(v, int) for v in values):
        raise ConfigError(f"{FILE}: {where}.{name}", f"is {values!r}, not {count} whole numbers")
    return values
