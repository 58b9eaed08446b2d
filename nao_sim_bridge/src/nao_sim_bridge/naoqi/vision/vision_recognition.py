"""ALVisionRecognition of the simulated robot: pictures and sides of things that it has learnt."""

from __future__ import annotations

import logging
import os
import threading
from pathlib import Path
from typing import Any, Callable, Sequence, Tuple

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles, NoSuchFile, full_path, load_places
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import put_aside
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import known, text, whole_number
from nao_sim_bridge.naoqi.binding.background import Background
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.names import PICTURE, RECOGNITION
from nao_sim_bridge.naoqi.vision.vision_extractor import Sight
from nao_sim_bridge.naoqi.vision.watching import Watching
from nao_sim_bridge.vision.client import VisionProcess
from nao_sim_bridge.vision.picture_features import SeenPicture
from nao_sim_bridge.vision.picture_memory import MOST, KnownPicture, PictureFileError, load, save
from nao_sim_bridge.world.pictures import read_picture_file

DEFAULT_PATH, DEFAULT_NAME = "/home/nao/naoqi/.local/share/naoqi/vision/visionrecognition/", "current"
PATH, DATABASE = "db_path", "db_name"
RESOLUTION = "resolution"
FPS = 5
MOST_SEEN = 10
LONGEST_NAME, MOST_TAGS = 200, 20
MOST_WAITING = load_sizes().clients.faces
"""Calls that look at a file at the same time, that is one after the other."""
log = logging.getLogger("nao_sim.vision")


class ALVisionRecognition:
    """Tells which of the learnt pictures are in view. Only NAOqi methods are public, `watching` and `close`.

    With each picture that shows some it raises `PictureDetected`, and once [] when there are none any more: [[seconds,
    microseconds], [[labels, key points, ratio, outline], ...]], with the outline as [[x, y], ...] in rad, x to the left
    and y downwards. A database is a file, NAME.npz in the folder of databases.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess, files: ClientFiles) -> None:
        self._cameras = simulation.cameras
        self._now = lambda: simulation.time
        self._files = files
        self._lock = threading.RLock()  # held while a database is read, changed and written
        self._path, self._name = DEFAULT_PATH, DEFAULT_NAME
        self._database = _file(DEFAULT_PATH, DEFAULT_NAME)
        self._pictures: Tuple[KnownPicture, ...] | None = None
        self._most = 1
        self._sight = Sight(memory, PICTURE, tell_end=True)
        self._work = Background(most=MOST_WAITING)
        # One looks through the camera, the other one at files.
        features = lambda: (tuple(one.features for one in self._known()),)  # noqa: E731
        self._detectors = [vision.detector("pictures", features) for _ in range(2)]
        self.watching = Watching(
            self._cameras,
            RECOGNITION,
            self._detectors[0],
            self._on_result,
            settings=lambda _: self._most,
            on_stop=self._sight.nothing,
            fps=FPS,
        )

    def learnFromFile(
        self, filename: str, name: str, tags: Sequence[str], whole: bool = True, forced: bool = False
    ) -> Task:
        """False for a file that was learnt before, unless `forced`, and for a picture without texture.

        It is learnt into the database of the time of the call.
        """
        path = self._files.to_read(filename)
        file, labels, database = self._files.to_robot(path), _labels(name, tags), self._database

        def learn(_: Any) -> bool:
            if not forced and any(one.file == file for one in self._known(database)):
                return False
            features = self._detectors[1].call("learn", _picture(path), bool(whole))
            if features is None:
                log.warning("%s cannot be learnt: it has too little texture", filename)
                return False
            learnt = KnownPicture(labels, file, features)
            self._change(database, lambda known: (*(one for one in known if one.file != file), learnt))
            return True

        return self._work.in_turn(learn, "learnFromFile")

    def detectFromFile(self, filename: str) -> Task:
        """What is found is told as if the camera had seen it now."""
        path = self._files.to_read(filename)

        def look(_: Any) -> None:
            optics = self._cameras.optics(self.watching.camera)
            found = self._detectors[1].detect(_picture(path), Optics(*optics.fov), self._most)
            microseconds = round(self._now() * 1e6)
            self._tell([microseconds // 1000000, microseconds % 1000000], found)

        return self._work.in_turn(look, "detectFromFile")

    def getSize(self) -> int:
        return len(self._known())

    def changeDatabase(self, path: str, name: str) -> bool:
        """Empty texts stand for the first database; one that is not there begins empty."""
        path, name = path or DEFAULT_PATH, name or DEFAULT_NAME
        if "/" in name:
            raise BadValue("databaseName", name, "a name without a folder")
        database = _file(path, name)
        with self._lock:
            pictures = self._read(database)
            self._path, self._name, self._database, self._pictures = path, name, database, pictures
        self._forget()
        return True

    def clearCurrentDatabase(self) -> None:
        self._change(self._database, lambda _: ())

    def getParam(self, name: str) -> str:
        return {PATH: self._path, DATABASE: self._name}[known(name, "parameter", (PATH, DATABASE))]

    def setParam(self, name: str, value: Any) -> None:
        """Of its parameters, NAOqi has kept the resolution."""
        if name != RESOLUTION:
            raise NaoqiError(f"{name!r} is nothing that can be set; {RESOLUTION} is, and changeDatabase has the rest")
        self.watching.set_resolution(self._cameras.tables.resolution(value).id)

    def getMaxOutObjs(self) -> int:
        return self._most

    def setMaxOutObjs(self, most: int) -> None:
        self._most = whole_number(most, "maxOutObjs", 1, MOST_SEEN)

    def close(self) -> None:
        self._work.close()
        self.watching.stop()

    # --- inside ---------------------------------------------------------------------------------------------------

    def _on_result(self, frame: Frame, found: list[SeenPicture]) -> None:
        self._tell(list(frame.stamp), found)

    def _tell(self, stamp: list[int], found: list[SeenPicture]) -> None:
        pictures = self._known()
        # What is known may have changed since it was looked for.
        seen = [
            [list(pictures[one.number].labels), one.found, one.share, [list(corner) for corner in one.outline]]
            for one in found
            if one.number < len(pictures)
        ]
        if seen:
            self._sight.show([stamp, seen])
        else:
            self._sight.nothing()

    def _known(self, database: str | None = None) -> Tuple[KnownPicture, ...]:
        """Pictures of a database, of that which is in use without one."""
        with self._lock:
            if database not in (None, self._database):
                return self._read(database)
            if self._pictures is None:
                self._pictures = self._first()
            return self._pictures

    def _change(self, database: str, change: Callable[[Tuple[KnownPicture, ...]], Tuple[KnownPicture, ...]]) -> None:
        """Change a database; it is on the disk before it counts."""
        with self._lock:
            changed = change(self._known(database))
            if len(changed) > MOST:
                raise BadValue("pictures", len(changed), f"at most {MOST} in a database")
            save(changed, self._files.to_change(database))
            if database != self._database:
                return
            self._pictures = changed
        self._forget()

    def _first(self) -> Tuple[KnownPicture, ...]:
        """Pictures of the first database, which nobody has named: one that cannot be used is put aside."""
        place = self._files.folder / os.path.relpath(self._database, load_places()[0].path)
        problem: Exception = BadValue(place.name, "no file", "a file")
        try:
            if not os.path.exists(place) or place.is_file():
                return self._read(self._database)
        except (PictureFileError, OSError, ValueError) as error:
            problem = error
        put_aside(place, problem, "no picture is known")
        return ()

    def _read(self, database: str) -> Tuple[KnownPicture, ...]:
        try:
            return load(self._files.to_read(database))
        except NoSuchFile:
            return ()

    def _forget(self) -> None:
        """Detectors are made again with what is known now."""
        for detector in self._detectors:
            detector.close()


def _file(path: str, name: str) -> str:
    """The file of a database, by its one path on the robot."""
    return full_path(f"{path}/{name}.npz")


def _labels(name: str, tags: Sequence[str]) -> Tuple[str, ...]:
    if not text(name, "name", LONGEST_NAME).strip():
        raise BadValue("name", name, "the name of the thing, not empty")
    if len(tags) > MOST_TAGS:
        raise BadValue("tags", len(tags), f"at most {MOST_TAGS}")
    return (name, *(text(tag, "tags", LONGEST_NAME) for tag in tags))


def _picture(path: Path) -> np.ndarray:
    """(h, w, 3) uint8, blue, green, red, of a file; a BadValue when it is no picture."""
    return np.ascontiguousarray(read_picture_file(str(path))[..., ::-1])
