"""How large what comes from files, clients and the network may be: all of `config/sizes.json`, read strictly."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import lru_cache

from nao_sim_bridge.base.config import config_file, read_json, read_settings
from nao_sim_bridge.base.errors import BadValue, ConfigError

FILE = "sizes.json"
_UNITS = {"bytes": "bytes", "s": "s", "hz": "Hz", "pixels": "pixels", "side": "pixels", "characters": "characters"}


@dataclass(frozen=True)
class SoundSizes:
    """Of sound files. `values` are frames x channels, as they are and at the rate of the simulated world."""

    file_bytes: int
    client_s: float
    world_s: float
    channels: int
    lowest_rate_hz: int
    highest_rate_hz: int
    values: int


@dataclass(frozen=True)
class DecoderSizes:
    """Of the process that decodes them: its address space, and the wall time for one file."""

    memory_bytes: int
    total_s: float


@dataclass(frozen=True)
class LoadedSizes:
    """Of all sounds that the player of a robot keeps, and how many its loudspeakers play at once."""

    bytes: int
    sounds: int
    at_once: int


@dataclass(frozen=True)
class WorldSoundSizes:
    """Of all sounds that the world has."""

    bytes: int
    sounds: int


@dataclass(frozen=True)
class StreamSizes:
    """Of what is fetched from the web: all of it, its longest silence, redirections, how many at once."""

    bytes: int
    total_s: float
    silence_s: float
    redirects: int
    at_once: int
    memory_bytes: int


@dataclass(frozen=True)
class ArchiveSizes:
    """Of ZIP archives; `total_bytes` is what is read of all members together."""

    file_bytes: int
    member_bytes: int
    total_bytes: int
    members: int


@dataclass(frozen=True)
class PictureSizes:
    """Of picture files: bytes, pixels of a side, pixels of all."""

    file_bytes: int
    side: int
    pixels: int


@dataclass(frozen=True)
class YamlSizes:
    """Of YAML files and texts: values, those of aliases counted each time; lists and mappings in each other."""

    values: int
    levels: int


@dataclass(frozen=True)
class XmlSizes:
    """Of XML files and texts; levels are elements in each other."""

    file_bytes: int
    elements: int
    attributes: int
    levels: int


@dataclass(frozen=True)
class CallSizes:
    """Of the arguments of a call: one text, one buffer, items of all lists together, lists in lists; names in them."""

    text_characters: int
    buffer_bytes: int
    items: int
    levels: int
    name_characters: int
    names: int


@dataclass(frozen=True)
class ListSizes:
    """Of lists that the simulation works through in one tick: all of a call together, and what is left of earlier ones.

    `commands` are those of one actuator, `devices` those of one alias.
    """

    key_frames: int
    poses: int
    places: int
    steps: int
    colours: int
    commands: int
    aliases: int
    devices: int
    led_groups: int
    led_members: int
    gestures: int
    pieces: int
    pushes: int


@dataclass(frozen=True)
class ClientSizes:
    """Of what waits for clients and is kept for them; the file says what each is."""

    stuck_s: float
    found_s: float
    held_up_s: float
    calls: int
    call_s: float
    changes: int
    subscribers: int
    sound_blocks: int
    cameras: int
    camera_idle_s: float
    cameras_remembered: int
    frames: int
    series: int
    faces: int
    things: int
    uploads: int
    resource_calls: int
    unfinished_calls: int
    called_modules: int
    microphones: int
    mapping_calls: int
    threads: int
    stacked_activities: int
    activities: int
    seen_faces: int


@dataclass(frozen=True)
class MemorySizes:
    """Of what clients write into ALMemory of one robot: bytes with all histories, keys and subscriptions together."""

    bytes: int
    keys: int


@dataclass(frozen=True)
class SpeechSizes:
    """Of a text to say and its pauses, of files of speech, of a dictionary, of what clients add to the animations."""

    text_characters: int
    pauses_s: float
    file_s: float
    dictionary_words: int
    words: int
    animations: int
    tags: int
    paths: int


@dataclass(frozen=True)
class VocabularySizes:
    """Of what the robot listens for; `put_aside` is how often contexts may be pushed."""

    phrases: int
    phrase_characters: int
    put_aside: int
    contexts: int
    grammar_characters: int


@dataclass(frozen=True)
class BehaviorSizes:
    """Of the behaviours of clients: those that they install, and those that ALFrameManager makes."""

    installed: int
    made: int
    bytes: int
    running: int
    packages: int


@dataclass(frozen=True)
class KeptSizes:
    """Of what clients have the robot keep in files of its own and in lists; the file says what each is."""

    file_bytes: int
    log_bytes: int
    triples: int
    resources: int
    notifications: int
    users: int
    people: int
    log_filters: int
    filter_stars: int
    robot_name_characters: int


@dataclass(frozen=True)
class FilmSizes:
    """Of what is written into a film."""

    caption_characters: int


@dataclass(frozen=True)
class Sizes:
    """All of `sizes.json`."""

    sound: SoundSizes
    decoder: DecoderSizes
    loaded_sounds: LoadedSizes
    world_sounds: WorldSoundSizes
    stream: StreamSizes
    archive: ArchiveSizes
    picture: PictureSizes
    yaml: YamlSizes
    xml: XmlSizes
    call: CallSizes
    lists: ListSizes
    clients: ClientSizes
    memory: MemorySizes
    speech: SpeechSizes
    vocabulary: VocabularySizes
    behaviors: BehaviorSizes
    kept: KeptSizes
    film: FilmSizes


@lru_cache(maxsize=None)
def load_sizes() -> Sizes:
    """The limits as the file gives them.

    Raises:
        ConfigError: The file cannot be read, a key is unknown or missing, or a limit is not above 0.
    """
    sizes = read_settings(Sizes, config_file(FILE))
    for name, limits in asdict(sizes).items():
        for key, limit in limits.items():
            if not limit > 0:
                raise ConfigError(f"{FILE}: {name}: {key}", f"is {limit!r}, not a number above 0")
    return sizes


def require_few(field: str, count: int, what: str) -> None:
    """See that a list is not too long: `count` with what it is added to; `what` of `ListSizes` bounds it.

    Raises:
        BadValue: It is too long.
    """
    most, words = getattr(load_sizes().lists, what), what.replace("_", " ")
    if count > most:
        raise BadValue(field, f"{count} {words}", f"{most} {words} at most")


def size_rows() -> list[tuple[str, float, str, str]]:
    """The limits as rows of a table: what, limit, unit (empty for a count), where it counts."""
    where_of, rows = read_json(config_file(FILE))["_meta"]["where"], []
    for name, limits in asdict(load_sizes()).items():
        for key, limit in limits.items():
            where = where_of[name] if isinstance(where_of[name], str) else where_of[name][key]
            rows.append((f"{name}.{key}", limit, _UNITS.get(key.rsplit("_", 1)[-1], ""), where))
    return rows
