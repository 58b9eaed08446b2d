"""Selects the calibration of pictures of one size: from a file, set by the service, or computed. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from naoqi.errors import NaoError

from ...base.whole_file import put_aside
from .camera_calibration import Calibration, ideal, scaled
from .camera_info_files import path_of, read, sized, write

log = logging.getLogger(__name__)


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
