"""Functions that see faces, and learn whose they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from naoqi.errors import NaoError

from ...base.suggestion import did_you_mean
from ...functions.parts import Part
from ..capture.fields import Camera
from .detectors import DETECTORS, Detectors, WantedDetection
from .events import FACE
from .fields import (
    AnyPerson,
    DetectionTimeout,
    HeadSize,
    Looks,
    NameConfidence,
    Person,
    camera_index,
    require_name,
    timeout_of,
)
from .things import DetectionFunctions

FACES = DETECTORS[FACE].module


class FaceFunctions(Part):
    """Faces. Parameters are fields of VisionFunction. The robot keeps the faces that it learns."""

    def __init__(self, detectors: Detectors, detections: DetectionFunctions) -> None:
        self._detectors = detectors
        self._detections = detections

    def detect_faces(
        self,
        str_param: AnyPerson,
        camera: Camera,
        timeout: DetectionTimeout,
        confidence: NameConfidence,
        count: Looks,
        size: HeadSize,
    ) -> list[str]:
        """See faces; answers whose they are, "face" for each that nobody knows."""
        wanted = WantedDetection(FACE, str_param.strip(), confidence, size, camera_index(camera))
        return self._detections.detect(wanted, timeout, count)

    def learn_face(self, str_param: Person, camera: Camera, timeout: DetectionTimeout) -> list[bool]:
        """Learn the face that is in view under a name; answers whether there was one, alone, that could be learnt."""
        name = require_name(str_param)
        if name in self.list_faces():
            raise NaoError(f"the face of {name!r} is learnt already: reLearnFace adds to it, forgetFace forgets it")
        return self._learn("learnFace", name, camera, timeout)

    def relearn_face(self, str_param: Person, camera: Camera, timeout: DetectionTimeout) -> list[bool]:
        """Add the face that is in view to what is known of a person; answers as learnFace does."""
        name = self._known_person(str_param)
        return self._learn("reLearnFace", name, camera, timeout)

    def forget_face(self, str_param: Person) -> None:
        """Forget a person's face."""
        name = self._known_person(str_param)
        if not self._call("forgetPerson", name):
            raise NaoError(f"{FACES} did not forget the face of {name!r}")

    def forget_all_faces(self) -> None:
        """Forget all faces."""
        if not self._call("clearDatabase"):
            raise NaoError(f"{FACES} did not forget the faces")

    def list_faces(self) -> list[str]:
        """Whose faces are learnt."""
        return [str(name) for name in self._call("getLearnedFacesList")]

    def _call(self, method: str, *args: Any) -> Any:
        return self._detectors.call(self._detectors.robot.proxy(FACES), method, *args)

    def _known_person(self, str_param: str) -> str:
        name, known = require_name(str_param), self.list_faces()
        if name not in known:
            learnt = f"learnt are {', '.join(known)}" if known else "none is learnt"
            raise NaoError(f"no face of {name!r} is learnt{did_you_mean(name, known)}: {learnt}")
        return name

    def _learn(self, method: str, name: str, camera: str, timeout: float) -> list[bool]:
        detectors = self._detectors
        detectors.publish_seen("looking")
        with detectors.watching(WantedDetection(FACE, camera=camera_index(camera))) as watch:
            for detections in watch.until(detectors.clock.now() + timeout_of(timeout)):
                detectors.publish_seen("looking", detections)
                # The robot does not say which of several faces it would learn.
                if len(detections) == 1 and self._call(method, name):
                    (face,) = detections
                    detectors.note([replace(face, detection=replace(face.detection, name=name))])
                    return [True]
        return [False]

    functions = {
        "detectFaces": detect_faces,
        "learnFace": learn_face,
        "reLearnFace": relearn_face,
        "forgetFace": forget_face,
        "forgetPerson": forget_face,
        "forgetAllFaces": forget_all_faces,
        "clearDatabase": forget_all_faces,
        "listFaces": list_faces,
        "getLearnedFaces": list_faces,
        "getLearnedFacesList": list_faces,
    }
