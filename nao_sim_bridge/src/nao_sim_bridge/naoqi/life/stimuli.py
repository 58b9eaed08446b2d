"""What basic awareness takes notice of: which modules tell of it, and where it is.

Events of the modules that see, hear and feel come in threads of their own and are handed over.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.naoqi.binding.background import ModuleCalls
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.tracker.targets import FACE_WIDTH, Parameters, Sighting, read_faces, read_sound
from nao_sim_bridge.tracking import geometry

NAME = "ALBasicAwareness"
PEOPLE, TOUCH, TABLET, SOUND, MOVEMENT, NAVIGATION = STIMULI = (
    "People",
    "Touch",
    "TabletTouch",
    "Sound",
    "Movement",
    "NavigationMotion",
)
# Those that only other robots have a sense for.
MISSING: Mapping[str, str] = {
    TABLET: "a NAO has no tablet",
    NAVIGATION: "a NAO has no infrared sensors that see motion before its base",
}
MOVEMENT_INFO = "MovementDetection/MovementInfo"
# Which module tells of a stimulus, with which event, and how often it looks, ms; None: what is there without asking.
SOURCES: Mapping[str, tuple[str | None, str, int]] = {
    PEOPLE: ("ALFaceDetection", "FaceDetected", 200),
    SOUND: ("ALSoundLocalization", "ALSoundLocalization/SoundLocated", 170),
    MOVEMENT: ("ALMovementDetection", "MovementDetection/MovementDetected", 200),
    TOUCH: (None, "TouchChanged", 0),
}
# What is heard or moves is taken to be so far away, m, and counts from this confidence on.
SUPPOSED_DISTANCE, SOUND_CONFIDENCE = 1.5, 0.4
# The face of who touches the robot is so far before it, and so high above the floor, m.
TOUCHER_DISTANCE, TOUCHER_HEIGHT = 0.6, 1.0


class Stimuli:
    """Listens for what interests the robot, which stands `offset` m over the floor that people stand on.

    `react` is called in the simulation thread with a stimulus and where it is, in FRAME_ROBOT, the first first.
    """

    def __init__(
        self,
        runner: RobotRunner,
        memory: MemoryStore,
        calls: ModuleCalls,
        react: Callable[[str, Sequence[Sighting]], None],
    ) -> None:
        self.offset = 0.0
        self._runner = runner
        self._memory = memory
        self._calls = calls
        self._react = react
        self._enabled: dict[str, bool] = {}
        self._listens = False
        self._subscribed: set[str] = set()
        self._heard_first: set[str] = set()
        self.enable_all()

    def enabled(self, stimulus: str) -> bool:
        """Whether a stimulus interests the robot; an UnknownName when there is no such stimulus."""
        return self._enabled[known(stimulus, "stimulus", STIMULI)]

    def enable(self, stimulus: str, enabled: bool) -> None:
        """Have a stimulus interest the robot or not; `listen` puts it to work.

        An UnknownName when there is no such stimulus, a NaoqiError when a NAO has no sense for it.
        """
        check(stimulus, enabled)
        self._enabled[stimulus] = enabled

    def enable_all(self) -> None:
        """All interest the robot that it has a sense for."""
        self._enabled = {stimulus: stimulus not in MISSING for stimulus in STIMULI}

    def listen(self, on: bool) -> None:
        """Subscribe to the modules that tell of what is enabled, or to none."""
        self._listens = on
        for stimulus, (module, event, period) in SOURCES.items():
            if event not in self._heard_first:
                self._heard_first.add(event)
                self._memory.listen(event, lambda value, what=stimulus: self._hear(what, value))
            wanted = self._interests(stimulus) and module is not None
            if wanted and module not in self._subscribed:
                self._subscribed.add(module)
                self._calls.tell(module, "subscribe", NAME, period, 0.0)
            elif not wanted and module in self._subscribed:
                self._subscribed.discard(module)
                self._calls.tell(module, "unsubscribe", NAME)

    def _interests(self, stimulus: str) -> bool:
        return self._listens and self._enabled[stimulus]

    def _hear(self, stimulus: str, value: Any) -> None:
        """Any thread."""
        if not self._interests(stimulus):
            return
        with suppress(SimulationStopped):
            self._runner.execute(lambda: self._tell(stimulus, value), "awareness")

    def _tell(self, stimulus: str, value: Any) -> None:
        if self._interests(stimulus):
            sightings = self._sightings(stimulus, value)
            if sightings:
                self._react(stimulus, sightings)

    def _sightings(self, stimulus: str, value: Any) -> Sequence[Sighting]:
        if stimulus == PEOPLE:
            return read_faces(value, Parameters(FACE_WIDTH))
        if stimulus == SOUND:
            return read_sound(value, Parameters(SUPPOSED_DISTANCE, (), SOUND_CONFIDENCE))
        if stimulus == MOVEMENT:
            info = self._memory.get(MOVEMENT_INFO)
            if not info:
                return []
            alpha, beta = info[1][0][0]
            return [Sighting(geometry.seen_place(info[3], alpha, beta, SUPPOSED_DISTANCE), SUPPOSED_DISTANCE)]
        touched = any(len(part) > 1 and part[1] for part in value or ())
        face = (TOUCHER_DISTANCE, 0.0, TOUCHER_HEIGHT - self.offset)
        return [Sighting(face, TOUCHER_DISTANCE)] if touched else []


def check(stimulus: str, enabled: bool) -> None:
    """Refuse what is no stimulus (UnknownName), and to enable one that a NAO has no sense for (NaoqiError)."""
    if known(stimulus, "stimulus", STIMULI) in MISSING and enabled:
        raise NaoqiError(f"{stimulus}: {MISSING[stimulus]}")
