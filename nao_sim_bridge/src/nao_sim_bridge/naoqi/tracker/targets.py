"""What ALTracker can follow: which module tells where it is, and what its events say. Pure but for the table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterable, Mapping, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue, SimulationError
from nao_sim_bridge.model.frames import ROBOT, WORLD
from nao_sim_bridge.naoqi.binding.arguments import number, numbers
from nao_sim_bridge.tracking.geometry import Point, distance_of, seen_place

# What `registerTarget` takes: a length in m, and for some targets ids or a confidence.
LENGTH = (0.005, 5.0)
LARGEST_ID = 10000


@dataclass(frozen=True)
class Sighting:
    """Something that was seen or heard."""

    place: Point  # x, y, z in `frame` at the time, m
    distance: float  # from the camera or the head, m
    number: int = 0  # of the landmark, or of the face; 0 for what has none
    frame: int = ROBOT  # one of ALMotion's


@dataclass(frozen=True)
class Parameters:
    """What a client has registered."""

    length: float  # diameter, width or distance, m
    numbers: Tuple[int, ...] = ()  # ids that count; none for all
    confidence: float = 0.0  # sounds have at least, 0..1


Read = Callable[[Any, Parameters], Sequence[Sighting]]


@dataclass(frozen=True)
class Target:
    """A kind of target: the module whose event tells where it is, and its default period in ms."""

    name: str
    module: str
    event: str
    period: int
    read: Read
    parameters: Callable[[Any], Parameters]


def read_ball(value: Any, parameters: Parameters) -> list[Sighting]:
    """`redBallDetected`: its sizes are angular radii."""
    if not value:
        return []
    alpha, beta, radius = value[1][:3]
    distance = distance_of(parameters.length, 2.0 * radius)
    return [Sighting(seen_place(value[3], alpha, beta, distance), distance)]


def read_faces(value: Any, parameters: Parameters) -> list[Sighting]:
    """`FaceDetected`: the last of its faces is what is new about names."""
    faces = [(int(face[1][0]), *face[0][1:4]) for face in value[1][:-1]] if value else []
    return _nearest_first(value, parameters, faces)


def read_landmarks(value: Any, parameters: Parameters) -> list[Sighting]:
    """`LandmarkDetected`: a mark that is seen from the side is as wide as it is high."""
    marks = value[1] if value else ()
    return _nearest_first(value, parameters, [(int(mark), *shape[1:3], max(shape[3:5])) for shape, (mark, *_) in marks])


def _nearest_first(
    value: Any, parameters: Parameters, seen: Iterable[Tuple[int, float, float, float]]
) -> list[Sighting]:
    """Sightings of what counts among number, angles in the picture, and angular size of each, in rad."""
    found = []
    for number_of_it, alpha, beta, size in seen:
        if not parameters.numbers or number_of_it in parameters.numbers:
            distance = distance_of(parameters.length, size)
            found.append(Sighting(seen_place(value[3], alpha, beta, distance), distance, number_of_it))
    return sorted(found, key=lambda sighting: sighting.distance)


def read_sound(value: Any, parameters: Parameters) -> list[Sighting]:
    """`SoundLocated` gives a direction; the distance is what the client supposes."""
    if not value or value[1][2] < parameters.confidence:
        return []
    azimuth, elevation = value[1][:2]
    return [Sighting(seen_place(value[3], azimuth, -elevation, parameters.length), parameters.length)]


def read_place(value: Any) -> list[Sighting]:
    """Of an event that tells a place; what is none does not count.

    It is NAOqi's [place in WORLD, time, effector, ...] or [place in TORSO, place in ROBOT, time, effector, ...], or in
    short [[x, y, z, ...], frame] or [x, y, z, ...] in ROBOT.
    """
    place, frame = value, ROBOT
    if _is_list(value) and value and _is_list(value[0]):
        place, second, *_ = *value, None
        if _is_list(second) and len(second) == len(place):
            place = second
        elif _is_list(second) or second == WORLD:
            frame = WORLD
    try:
        x, y, z, *_ = numbers(place, "place")
    except (SimulationError, ValueError, TypeError):
        return []
    return [Sighting((x, y, z), 0.0, frame=frame)]


def _length(field: str) -> Callable[[Any], Parameters]:
    return lambda value: Parameters(number(value[0] if _is_list(value) and len(value) == 1 else value, field, *LENGTH))


def _length_and_ids(value: Any) -> Parameters:
    if not _is_list(value) or not value or len(value) > 2:
        raise BadValue("pParams", value, "[size in m, [mark, ...]]")
    return Parameters(number(value[0], "size", *LENGTH), _ids(value[1] if len(value) == 2 else []))


def _people(value: Any) -> Parameters:
    return Parameters(FACE_WIDTH, _ids(value if _is_list(value) else [value]))


def _sound(value: Any) -> Parameters:
    if not _is_list(value) or len(value) != 2:
        raise BadValue("pParams", value, "[distance in m, confidence 0..1]")
    return Parameters(number(value[0], "distance", 0.1, 20.0), (), number(value[1], "confidence", 0.0, 1.0))


def _ids(value: Any) -> Tuple[int, ...]:
    listed = value if _is_list(value) else [value]
    for one in listed:
        if isinstance(one, bool) or not isinstance(one, int) or not 0 <= one <= LARGEST_ID:
            raise BadValue("ids", one, f"whole numbers, 0 to {LARGEST_ID}")
    return tuple(listed)


def _is_list(value: Any) -> bool:
    return isinstance(value, (list, tuple))


# Width of a face, m, where a client does not say.
FACE_WIDTH = 0.15
FACES = ("ALFaceDetection", "FaceDetected", 100)
MARKS = ("ALLandMarkDetection", "LandmarkDetected", 60)
TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (
        Target("RedBall", "ALRedBallDetection", "redBallDetected", 30, read_ball, _length("diameter")),
        Target("Face", *FACES, read_faces, _length("width")),
        Target("LandMark", *MARKS, read_landmarks, _length_and_ids),
        Target("LandMarks", *MARKS, read_landmarks, _length_and_ids),
        Target("People", *FACES, read_faces, _people),
        Target("Sound", "ALSoundLocalization", "ALSoundLocalization/SoundLocated", 170, read_sound, _sound),
    )
}
