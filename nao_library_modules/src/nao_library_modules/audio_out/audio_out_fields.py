"""What the fields of an AudioOutFunction mean to the functions of speech and sounds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import List
from urllib.parse import urlsplit

from ..core.describe import LANGUAGES, VOICES
from ..core.errors import BadGoal
from ..core.fields import CONTROL, Annotated, flag, free, limit, number, require_known, require_text, text, whole, word
from ..core.nao_facts import WRITTEN
from ..nao_audio import DEVICE_PARAMETERS, RATES, SET_PARAMETERS, SOUND_FILES, file_of_kind

STREAMS = ("http", "https")
SIDES = (-1.0, 0.0, 1.0)
TONE, SPEED, PITCH = limit("tone"), limit("speech rate")[:2], limit("speech pitch")[:2]
BODY_LANGUAGE = ("disabled", "random", "contextual")
# Ranges of the robot; the effects are off with 0.
PARAMETERS: dict[str, tuple[float, float]] = {
    "speed": SPEED,
    "defaultVoiceSpeed": SPEED,
    "pitch": PITCH,
    "volume": (0.0, 100.0),
    "pitchShift": (0.5, 4.0),
    "doubleVoice": (1.0, 4.0),
    "doubleVoiceLevel": (0.0, 4.0),
    "doubleVoiceTimeShift": (0.0, 0.5),
    "enableCompression": (0.0, 1.0),
}
EFFECTS = ("pitchShift", "doubleVoice")
ALL_PARAMETERS = (*PARAMETERS, *DEVICE_PARAMETERS)
VOICE_PARAMETERS = f"one or more of {', '.join(PARAMETERS)}"
ADDRESS = "an address that begins with http:// or https://"
WORD_TEXTS = "how it is spoken; of a Japanese type (str_param): word, priority, phonetic, accent"
DELETED_TEXTS = "nothing; or, of a Japanese type (str_param), the word"
TAGGED = "the words or animations of the tag, one or more"
SIDE = "-1 (left), 0 or 1 (right)"
SOUND_ID = "as loadFile answers it, or 0 for the one in str_param"


def range_of(parameter: str) -> str:
    """What a parameter of the voice may be, in words."""
    lowest, highest = PARAMETERS[parameter]
    return f"{'0 (off) or ' if parameter in EFFECTS else ''}{lowest:g}..{highest:g}"


def _require_parameters(field: str, names: Sequence[str]) -> None:
    for name in names:
        require_known(field, name, tuple(PARAMETERS), "parameter of the voice")


def _require_word_texts(field: str, texts: Sequence[str]) -> None:
    if len(texts) not in (1, 4) or not all(text.strip() for text in texts):
        raise BadGoal(field, list(texts), WORD_TEXTS)


def _require_deleted_texts(field: str, texts: Sequence[str]) -> None:
    if len(texts) > 1:
        raise BadGoal(field, list(texts), DELETED_TEXTS)


def _require_tagged(field: str, texts: Sequence[str]) -> None:
    if not texts or not all(text.strip() for text in texts):
        raise BadGoal(field, list(texts), TAGGED)


def _require_address(field: str, value: str) -> None:
    address = require_text(field, value, "the address of a stream")
    try:
        parts = urlsplit(address)
        good = parts.scheme in STREAMS and bool(parts.hostname) and not CONTROL.search(address)
    except ValueError:
        good = False
    if not good:
        raise BadGoal(field, value, ADDRESS)


def _require_side(field: str, pan: float) -> None:
    if pan not in SIDES:
        raise BadGoal(field, pan, SIDE)


def _require_id(field: str, sound_id: int) -> None:
    if sound_id < 0:
        raise BadGoal(field, sound_id, SOUND_ID)


_VOICE = text("the name of a voice", "name of the voice").but(asked=VOICES)
_SHARE = number("share", "volume of this text only; 0: as the robot is set")
_PAN = number((-1.0, 1.0), "direction: -1 left, 1 right", allowed="-1 (left) .. 1 (right)")
_ID = free(
    "sound that is loaded; 0: the one of `str_param`, or else loaded last",
    allowed=SOUND_ID,
    minimum=0.0,
    check=_require_id,
)
_LOADED = free("name of a file that is loaded; empty: the one loaded last", allowed="a file that is loaded, or nothing")
_TIME = number("recording", "time after which the sound is ended; 0: at its own end", zero="")
_END = _TIME.but(allowed=f"{_TIME.allowed}; 0 for a sound in the background")
_POSITION = number("recording", "where the sound begins, from the start of the file", zero="")
_TEXTS = free("words of the tag", allowed=TAGGED, check=_require_tagged)

# Speech

SpokenText = Annotated[str, text("the text to say", "text to say")]
TextLanguage = Annotated[
    str,
    free("language of this text only", allowed="a language that the robot speaks, or nothing", asked=LANGUAGES),
]
TextVoice = Annotated[str, free("voice of this text only", allowed="a voice of the robot, or nothing", asked=VOICES)]
TextVolume = Annotated[float, _SHARE]
TextSpeed = Annotated[
    float, number("speech rate", "speed of this text only; 100 is normal", zero=" for the robot's own")
]
TextPitch = Annotated[
    float, number("speech pitch", "pitch of this text only; 100 is normal", zero=" for the robot's own")
]
Background = Annotated[bool, flag("whether the next function begins at once, and the sound goes on beyond the goal")]
WrittenFile = Annotated[str, file_of_kind((".wav",), "file to write", WRITTEN)]
Overwrite = Annotated[bool, flag("whether a file that is there may be replaced")]
TextGestures = Annotated[str, word(BODY_LANGUAGE, "gestures with this text", empty="those of the mode that is set")]
Gestures = Annotated[str, word(BODY_LANGUAGE, "gestures with texts from now on")]
Tag = Annotated[str, text("the tag", "tag")]
TagWords = Annotated[List[str], _TEXTS]
TagAnimations = Annotated[List[str], _TEXTS.but(help="animations of the tag")]
Package = Annotated[str, text("the name of a package of animations", "name of the package of animations")]

# Settings of the voice

Voice = Annotated[str, _VOICE]
VoiceOfLanguage = Annotated[str, _VOICE.but(help="name of the voice that the language is spoken with")]
Language = Annotated[str, text("the name of a language", "name of the language").but(asked=LANGUAGES)]
Preference = Annotated[str, text("the name of a voice preference", "name of the voice preference")]
ParameterNames = Annotated[
    List[str],
    free(
        "parameters of the voice; empty: `str_param` names one",
        allowed=VOICE_PARAMETERS,
        choices=tuple(PARAMETERS),
        check=_require_parameters,
    ),
]
SetParameter = Annotated[
    str,
    free(
        "parameter of the sound card, where `names` is empty",
        allowed=f"one of {', '.join(SET_PARAMETERS)}",
        choices=SET_PARAMETERS,
    ),
]
ReadParameter = Annotated[
    str,
    free(
        "parameter of the voice or of the sound card, where `names` is empty",
        allowed=f"one of {', '.join(ALL_PARAMETERS)}",
        choices=ALL_PARAMETERS,
    ),
]
ParameterValues = Annotated[
    List[float],
    free(
        "values: one for each of `names`, or the one of the sound card",
        allowed=f"{', '.join(f'{name} {range_of(name)}' for name in PARAMETERS)}; {SET_PARAMETERS[0]} {RATES}",
    ),
]
Word = Annotated[str, text("the word", "word; or a Japanese type")]
WordTexts = Annotated[List[str], free("how the word is spoken", allowed=WORD_TEXTS, check=_require_word_texts)]
DeletedTexts = Annotated[
    List[str], free("word, of a Japanese type", allowed=DELETED_TEXTS, check=_require_deleted_texts)
]

# Sounds

SoundFile = Annotated[str, file_of_kind(SOUND_FILES, "sound file on the robot")]
Address = Annotated[str, free("address of the stream", allowed=ADDRESS, check=_require_address)]
SoundVolume = Annotated[float, _SHARE.but(help="volume of this sound only; 0: as the robot is set")]
FullVolume = Annotated[float, _SHARE.but(help="volume of this sound only; 0: full")]
SetVolume = Annotated[float, _SHARE.but(help="volume of speech, or of the sound")]
MasterVolume = Annotated[float, _SHARE.but(help="volume of all sounds")]
Pan = Annotated[float, _PAN]
TonePan = Annotated[float, _PAN.but(allowed=SIDE, check=_require_side)]
Panorama = Annotated[float, _PAN.but(help="direction of all sounds: -1 left, 1 right")]
EndTime = Annotated[float, _END]
LoopTime = Annotated[float, _END.but(help="time after which the sound is ended; 0: it goes on beyond the goal")]
SetFileTime = Annotated[
    float, _END.but(help="time after which the sound is ended; 0: at its own end, or never where it is repeated")
]
ToneLength = Annotated[float, number("recording", "length of the tone")]
Frequency = Annotated[float, whole(TONE.lowest, TONE.highest, "frequency of the tone", "(Hz)").but(unit="Hz")]
StartPosition = Annotated[float, _POSITION]
Position = Annotated[float, _POSITION.but(help="where the sound goes on, from the start of the file")]
SoundId = Annotated[int, _ID]
VolumeId = Annotated[int, _ID.but(help="sound that is loaded; 0: the one of `str_param`, or speech")]
LoadedFile = Annotated[str, _LOADED]
VolumeFile = Annotated[str, _LOADED.but(help="name of a file that is loaded; empty, without `sound_id`: speech")]
PitchLevel = Annotated[float, number("setting", "level of pitch")]
SoundSet = Annotated[str, text("the name of a sound set", "name of the sound set")]
OptionalSet = Annotated[
    str,
    free("name of the sound set; empty: any that is loaded", allowed="a sound set of the robot, or nothing"),
]
SetFile = Annotated[str, text("the name of a file of the sound set", "file of the sound set")]
Loop = Annotated[bool, flag("whether the sound is played again and again")]
