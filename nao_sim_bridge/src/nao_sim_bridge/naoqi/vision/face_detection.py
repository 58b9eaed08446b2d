"""ALFaceDetection of the simulated robot."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.cameras.frame import Frame
from nao_sim_bridge.cameras.optics import Optics
from nao_sim_bridge.cameras.stream import CameraClosed
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import number, text
from nao_sim_bridge.naoqi.binding.background import Background, Wanted
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.vision.face_detection_people import KnownPeople
from nao_sim_bridge.naoqi.vision.face_detection_value import NamedFace, NamesOnce, faces_value
from nao_sim_bridge.naoqi.vision.vision_extractor import Sight
from nao_sim_bridge.naoqi.vision.watching import BGR, Watching
from nao_sim_bridge.vision.client import VisionProcess
from nao_sim_bridge.vision.face_memory import POLICIES
from nao_sim_bridge.vision.faces import FaceSettings, SeenFace

NAME, EVENT = "ALFaceDetection", "FaceDetected"
FPS, VGA = 10, 2
"""In VGA: in QVGA a face two metres away is no larger than the smallest that can be found."""
DEFAULT_THRESHOLD = 0.4
LONGEST_NAME = 200
PICTURES = 5
"""That learning takes."""
LEAST_WIDTH = 24.0
"""Smaller faces are found but not learnt, px in a VGA picture: they show too little."""
LOOK_AGAIN = 1.0
"""How long a wait for a picture lasts before it is looked whether it is still wanted, s of wall time."""
MOST_WAITING = load_sizes().clients.faces
"""Calls that learn a face at the same time, that is one after the other."""


class ALFaceDetection:
    """Tells which faces are where, and whose they are. Public are NAOqi methods, `watching`, `learner` and `people`.

    The event `FaceDetected` is raised with each picture in which there is a face, as `faces_value` says, and once with
    an empty list when the last one has gone. Learning takes five pictures in a row; each has to show exactly one face.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore, vision: VisionProcess, files: ClientFiles) -> None:
        self._sight = Sight(memory, EVENT, tell_end=True)
        self.people = KnownPeople(files)
        self._names = NamesOnce()
        self._recognition = self._tracking = True
        self._threshold = DEFAULT_THRESHOLD
        self.watching = Watching(
            simulation.cameras,
            NAME,
            vision.detector("faces"),
            self._on_result,
            settings=self._settings,
            on_stop=self._nothing,
            resolution=VGA,
            fps=FPS,
        )
        self.learner = FaceLearner(simulation.cameras, vision.detector("faces"), lambda: self.watching.camera)

    def learnFace(self, name: str) -> Task:
        """Learn the face in view; False when there is none or more than one, or ten pictures of the person."""
        known_as = _checked(name)
        return self.learner.look(lambda description: self.people.learn(known_as, description))

    def reLearnFace(self, name: str) -> Task:
        """Learn one more picture of somebody who is known; False also when nobody of the name is."""
        if _checked(name) not in self.people.names:
            nothing = Task("learnFace", 0)
            nothing.finish(False)
            return nothing
        return self.learnFace(name)

    def forgetPerson(self, name: str) -> bool:
        return self.people.forget(name)

    def clearDatabase(self) -> bool:
        self.people.clear()
        return True

    def getLearnedFacesList(self) -> list[str]:
        return self.people.names

    def importOldDatabase(self, policy: str) -> bool:
        """Take people in from the file of another robot; False when there is none. See `KnownPeople.take_over`."""
        if policy not in POLICIES:
            raise BadValue("policy", policy, " or ".join(POLICIES))
        return self.people.take_over(policy)

    def setRecognitionConfidenceThreshold(self, threshold: float) -> None:
        self._threshold = number(threshold, "threshold", 0.0, 1.0)

    def getRecognitionConfidenceThreshold(self) -> float:
        return self._threshold

    def setRecognitionEnabled(self, enable: bool) -> None:
        self._recognition = bool(enable)

    def isRecognitionEnabled(self) -> bool:
        return self._recognition

    enableRecognition = setRecognitionEnabled

    def setTrackingEnabled(self, enable: bool) -> None:
        self._tracking = bool(enable)

    def isTrackingEnabled(self) -> bool:
        return self._tracking

    enableTracking = setTrackingEnabled

    def _settings(self, frame: Frame) -> FaceSettings:
        return FaceSettings(frame.time, frame.camera, self._tracking, self._recognition)

    def _on_result(self, frame: Frame, found: list[SeenFace]) -> None:
        faces = [self._named(face) for face in found]
        news = self._names.news(faces, frame.time)
        if faces:
            self._sight.show(faces_value(frame, faces, news))
        else:
            self._sight.nothing()

    def _named(self, face: SeenFace) -> NamedFace:
        name, score = "", 0.0
        if face.description is not None:
            name, score = self.people.recognise(face.description)
        return NamedFace(face, name if score >= self._threshold else "", score)

    def _nothing(self) -> None:
        self._names = NamesOnce()
        self._sight.nothing()


class FaceLearner:
    """Takes pictures of a face, for one call after the other."""

    def __init__(self, cameras: Any, detector: Any, camera: Callable[[], int]) -> None:
        self._cameras = cameras
        self._detector = detector
        self._camera = camera
        self._looks = Background(most=MOST_WAITING)

    def look(self, learn: Callable[[np.ndarray], bool]) -> Task:
        """Look at the face in view; a BadValue when too many calls wait for their turn.

        The task ends with what `learn` answers, or with False when the pictures do not show exactly one face.
        """

        def work(wanted: Wanted) -> bool:
            if not wanted():
                return False
            try:
                description = self._describe(wanted)
            except CameraClosed as error:
                raise NaoqiError("the cameras were closed before the face was learnt") from error
            return wanted() and description is not None and learn(description)

        return self._looks.in_turn(work, "learnFace")

    def close(self) -> None:
        self._looks.close()

    def _describe(self, wanted: Wanted) -> np.ndarray | None:
        """What the face in view looks like; None when there is none, or more than one, or it is too far away."""
        stream = self._cameras.open("learnFace", self._camera(), VGA, BGR, FPS, every=True)
        try:
            total, left = 0.0, PICTURES
            while left:
                if not wanted():
                    return None
                try:
                    frame = stream.take(LOOK_AGAIN)
                except TimeoutError:
                    continue
                settings = FaceSettings(frame.time, frame.camera)
                found = self._detector.detect(frame.array(), Optics(frame.hfov, frame.vfov), settings)
                if len(found) != 1 or found[0].box[2] < LEAST_WIDTH:
                    return None
                total, left = total + found[0].description, left - 1
            return total / np.linalg.norm(total)
        finally:
            stream.close()
            self._detector.close()


def _checked(name: str) -> str:
    if not text(name, "name", LONGEST_NAME).strip():
        raise BadValue("name", name, "the name of somebody, not empty")
    return name
