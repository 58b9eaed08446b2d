"""What the fields of AudioInFunction mean to the functions of hearing."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import List

from ..core.describe import HEARD_LANGUAGES
from ..core.errors import BadGoal
from ..core.fields import Annotated, Field, flag, free, limit, number, numbers, require_known, text, word
from ..core.nao_facts import WRITTEN
from ..nao_audio import DEVICE_PARAMETERS, RATES, SET_PARAMETERS, SOUND_FILES, file_of_kind

MICROPHONES = ("left", "right", "front", "rear")
"""In the order in which NAOqi has them in recordings."""
ONE_CHANNEL, ALL_CHANNELS = 16000, 48000
"""Rates in Hz of recordings of one microphone, and of all."""
CHANNELS = f"one of {', '.join(MICROPHONES)} at {ONE_CHANNEL} Hz, or all of them at {ALL_CHANNELS} Hz"
DEFAULT_MICROPHONE = "front"
FILE_TYPES = ("wav", "ogg")
PHRASES = "at least one word or phrase"
PHRASES_OR_SET = f"{PHRASES}, here or by setVocabulary before"
PHRASE = "words of letters, digits, apostrophes, hyphens, with blanks in between"
LONGEST_PHRASE = 200
# What grammars of speech recognisers are written with, and what nobody can say.
STRANGE = re.compile(r"[<>|{}\[\]()*+=;:#$%^~_@\"/\\\x00-\x1f\x7f]")
SENSES = {"speech": "ALSpeechRecognition", "detection": "ALSoundDetection", "localization": "ALSoundLocalization"}
"""What hears, and its NAOqi module."""
DEFAULT_TIMEOUT = 10.0
"""s that functions wait for something to be heard, where a message leaves it to us."""
ABOVE_ZERO = "above 0 to 1"
RECORDING_RATES = f"{ONE_CHANNEL}, {ALL_CHANNELS} (Hz), or 0: as the channels need"
RECOGNITION_PARAMETERS = ("Sensitivity", "NbHypotheses")
RULE_TYPES = ("start", "active", "activatable", "slot")
RULE_TYPE = f"{', '.join(RULE_TYPES[:-1])} or {RULE_TYPES[-1]}"


def require_phrases(vocabulary: Sequence[str]) -> list[str]:
    """Words and phrases that can be said, at least one, without blanks around them."""
    if not vocabulary:
        raise BadGoal("vocabulary", [], PHRASES, problem="it is empty")
    return [_phrase(phrase) for phrase in vocabulary]


def _phrase(phrase: str) -> str:
    bare = " ".join(phrase.split())
    if not bare:
        raise BadGoal("vocabulary", phrase, PHRASE, problem="there is an empty phrase in it")
    if len(bare) > LONGEST_PHRASE:
        problem = f"{bare[:20]!r}... is too long"
        raise BadGoal("vocabulary", phrase, f"phrases of up to {LONGEST_PHRASE} characters", problem=problem)
    strange = STRANGE.search(bare)
    if strange or any(unicodedata.category(character) in ("Cc", "Cs", "Co", "Cn", "So") for character in bare):
        what = f"{strange.group()!r} in {bare!r}" if strange else f"a character of {bare!r}"
        raise BadGoal("vocabulary", phrase, PHRASE, problem=f"{what} cannot be said")
    if not any(character.isalnum() for character in bare):
        raise BadGoal("vocabulary", phrase, PHRASE, problem=f"there is nothing to say in {bare!r}")
    return bare


def recording_format(rate: int, channels: Sequence[str]) -> tuple[int, list[str]]:
    """Rate in Hz and microphones of a recording, in NAOqi's order.

    The robot records one microphone at 16000 Hz, or all at 48000 Hz.
    """
    if not channels:
        channels = MICROPHONES if rate == ALL_CHANNELS else (DEFAULT_MICROPHONE,)
    wanted = {1: ONE_CHANNEL, len(MICROPHONES): ALL_CHANNELS}.get(len(channels))
    if wanted is None or rate not in (0, wanted):
        at = f" at {rate} Hz" if rate else ""
        raise BadGoal("channels", list(channels), CHANNELS, problem=f"{len(channels)} channel(s){at}")
    return wanted, [name for name in MICROPHONES if name in channels]


def recording_file(name: str, file_type: str) -> tuple[str, str]:
    """Name of a recording and what kind of file it is: wav or ogg."""
    path, wanted = name.strip(), file_type.strip()
    kind = PurePosixPath(path).suffix.lower()[1:]
    if wanted and wanted != kind:
        raise BadGoal("file_type", file_type, f"{kind}, as the file's name ends", problem=f"{path!r} is no {wanted}")
    return path, kind


def _require_rate(name: str, rate: int) -> None:
    if rate not in (0, ONE_CHANNEL, ALL_CHANNELS):
        raise BadGoal(name, rate, RECORDING_RATES)


def _require_microphones(name: str, channels: Sequence[str]) -> None:
    for channel in channels:
        if channel not in MICROPHONES:
            require_known(name, channel, MICROPHONES, "microphone")
            raise BadGoal(name, channel, f"one of {', '.join(MICROPHONES)}")
    if len(set(channels)) != len(channels):
        raise BadGoal(name, list(channels), "each microphone once")


def _require_sensitivity(name: str, sensitivity: float) -> None:
    if not 0.0 < sensitivity <= 1.0:
        raise BadGoal(name, sensitivity, ABOVE_ZERO)


def _require_rule_type(name: str, types: Sequence[str]) -> None:
    if len(types) != 1:
        raise BadGoal(name, list(types), RULE_TYPE)
    require_known(name, types[0], RULE_TYPES, "type of rules")


def _names(wanted: str, meaning: str, least: int = 1, more: bool = False) -> Field:
    """Names in NAOqi's order, none of them empty.

    Args:
        wanted: What they name, as a refusal says it.
        meaning: The help.
        least: How many there are.
        more: Whether further ones may follow.
    """

    def check(name: str, names: Sequence[str]) -> None:
        if len(names) < least or (len(names) > least and not more) or not all(names):
            raise BadGoal(name, list(names), wanted)

    return free(meaning, allowed=wanted, check=check)


def _setting(wanted: str, meaning: str) -> Field:
    """A list with the value of one parameter of the robot; `wanted` says so in a refusal."""
    each = numbers("setting", meaning)

    def check(name: str, values: Sequence[float]) -> None:
        if len(values) != 1:
            raise BadGoal(name, list(values), wanted)
        each.require(name, values)

    return each.but(allowed=f"{wanted}; {each.allowed}", check=check)


_CAN_BE_SAID = f"{PHRASE}; up to {LONGEST_PHRASE} characters each"
_LANGUAGE = text("a language by NAOqi's name, such as English", "language by NAOqi's name").but(asked=HEARD_LANGUAGES)
_NAME = text("a name", "name of the context")
_PARAMETER = text("the name of a parameter", "parameter of the recognition or of the sound card")
_PHRASES = free(
    "words and phrases to recognise",
    allowed=f"{PHRASES}; {_CAN_BE_SAID}",
    check=lambda _, phrases: require_phrases(phrases),
)
_WAITS = f"up to {limit('timeout').highest:g} s, or 0 for the default"
_TIME = number("timeout", "time of the mean; 0: the latest value")

# Recordings
RecordingFile = Annotated[str, file_of_kind([f".{kind}" for kind in FILE_TYPES], "file to write", WRITTEN)]
HeardFile = Annotated[str, file_of_kind(SOUND_FILES, "file to hear")]
RecordingRate = Annotated[
    int, free("sample rate; 0: as the channels need", "Hz", allowed=RECORDING_RATES, check=_require_rate)
]
Channels = Annotated[
    List[str],
    free(
        f"microphones; empty: {DEFAULT_MICROPHONE}, or all of them where the rate is {ALL_CHANNELS} Hz",
        allowed=CHANNELS,
        choices=MICROPHONES,
        check=_require_microphones,
    ),
]
FileType = Annotated[str, word(FILE_TYPES, "type of the file", "type of recordings", empty="as the file's name ends")]
Length = Annotated[float, number("recording", "length of the recording")]
Overwrite = Annotated[
    bool, flag("whether a file that is there may be replaced; one that only the robot sees always is")
]

# Recognition
Phrases = Annotated[List[str], _PHRASES]
PhrasesOrSet = Annotated[
    List[str],
    _PHRASES.but(
        help="words and phrases to recognise; empty: those of setVocabulary",
        allowed=f"{PHRASES_OR_SET}; {_CAN_BE_SAID}",
        check=lambda _, phrases: phrases and require_phrases(phrases),
    ),
]
WordSpotting = Annotated[bool, flag("whether the words are also found within longer sentences")]
Language = Annotated[str, _LANGUAGE]
LanguageMeanwhile = Annotated[
    str, _LANGUAGE.but(help="language for this time, by NAOqi's name; empty: the one that is set", check=None)
]
AudioExpression = Annotated[bool, flag("whether the robot bips when it begins and ends to listen")]
VisualExpression = Annotated[bool, flag("whether the eyes show that the robot listens")]

# What is waited for
Timeout = Annotated[
    float,
    number("timeout", f"longest wait, in the robot's time; 0: {DEFAULT_TIMEOUT:g} s", allowed=_WAITS),
]
Confidence = Annotated[float, number("share", "least confidence that counts")]
BetterTime = Annotated[float, _TIME.but(help="further wait for a direction of more confidence")]

# Energies
MeanTime = Annotated[float, _TIME]

# Grammars
Context = Annotated[str, _NAME]
ContextSet = Annotated[str, _NAME.but(help="name of the saved contexts")]
GrammarLanguage = Annotated[str, _NAME.but(help="language of the grammar, by NAOqi's name", asked=HEARD_LANGUAGES)]
GrammarFiles = Annotated[
    List[str],
    _names(
        "file of the grammar, file to write", "file of the grammar (BNF), and the one that it is compiled to", least=2
    ),
]
CompiledGrammar = Annotated[List[str], _names("file of the compiled grammar", "file that compile has written")]
RuleType = Annotated[
    List[str], _names(RULE_TYPE, "type of the rules").but(choices=RULE_TYPES, check=_require_rule_type)
]
Rule = Annotated[List[str], _names("name of the rule", "rule of the context")]
SlotWords = Annotated[
    List[str], _names("name of the slot, words", "slot of the context, and what it takes", least=2, more=True)
]
Slot = Annotated[List[str], _names("name of the slot", "slot of the context")]
ContextParameter = Annotated[List[str], _names("name of the parameter", "parameter of the context")]
ContextValue = Annotated[List[float], _setting("the value of the parameter", "value of the parameter")]
ReplacedSet = Annotated[bool, flag("whether contexts that this server saved under the name may be replaced")]

# Settings
Sensitivity = Annotated[
    float, number("share", "sensitivity; 1: the greatest", allowed=ABOVE_ZERO).but(check=_require_sensitivity)
]
Sense = Annotated[str, word(tuple(SENSES), "what becomes so sensitive", "sense", empty="all three")]
Parameter = Annotated[str, _PARAMETER.but(choices=(*RECOGNITION_PARAMETERS, *DEVICE_PARAMETERS))]
SetParameter = Annotated[str, _PARAMETER.but(choices=(*RECOGNITION_PARAMETERS, *SET_PARAMETERS))]
Value = Annotated[List[float], _setting("one number", f"value of the parameter; of {SET_PARAMETERS[0]}: {RATES}")]


def timeout_of(timeout: float) -> float:
    """How long a function waits, s."""
    return timeout or DEFAULT_TIMEOUT
