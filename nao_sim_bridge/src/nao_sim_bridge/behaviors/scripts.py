"""Recognises the boxes of Choregraphe's own library by the words of their scripts.

A script is that of a known box when it uses no word that no version of this box has: whoever has changed a box has
one of their own, which is not played, since the simulator runs nobody's Python. Comments do not count.

Source: scripts of the boxes of Choregraphe 1.14 to 2.8, as they are in projects that are public.
"""

from __future__ import annotations

import re
from enum import Enum
from functools import lru_cache


class Kind(Enum):
    """What the script of a box does."""

    NOTHING = "nothing"  # what Choregraphe writes into a new box
    SAY = "say"  # the parameter "Text", or the text that is sent to it
    ANIMATED_SAY = "animated say"
    POSTURE = "posture"
    WAIT = "wait"  # a start while it waits begins anew
    DELAY = "delay"  # each start has an end of its own
    LANGUAGE = "language"
    OTHER = "other"


COMMENT = re.compile(r"#[^\n]*")
WORD = re.compile(r"[A-Za-z_]\w*|\d+(?:\.\d*)?")
METHOD = re.compile(r"^([ \t]*)def[ \t]+(\w+)[^\n]*\n((?:\1[ \t]+[^\n]*\n|[ \t]*\n)*)", re.MULTILINE)

_NEW = frozenset(
    """False GeneratedClass MyClass True TypeError __init__ bIsRunning class def except if onInput_onStart
 onInput_onStop onLoad onStopped onUnload pass return self try""".split()
)
_SPEECH = """0 0.2 1 ALProxy RSPD RST Speed Text VCT Voice append finally for getParameter id ids import in p pCall post
 remove say sentence service session shaping sleep stop str time tts ttsStop wait while"""
_TIMER = """1 1000 Animation None Timeout Trigger and bRunning cancel cancelled delay duration getParameter import int s
 timerOutput"""
# Words of each kind; the first one is in each script of it.
_WORDS = {
    Kind.SAY: ("ALTextToSpeech", _SPEECH),
    Kind.ANIMATED_SAY: (
        "ALAnimatedSpeech",
        f"""{_SPEECH} Animation Body Speaking animSpeech bodyLanguageMode configuration disabled format language mode
 movement speakingMovementMode start textParam""",
    ),
    Kind.POSTURE: (
        "ALRobotPosture",
        """0 100. ALProxy Crouch LyingBack LyingBelly Maximum Module Name None Posture Sit SitRelax Speed Stand
 StandInit StandZero a cannot else error failure found getParameter goToPosture is library logger nTries not of or part
 posture postureProxy postureService reach result robot service session setMaxTryNumber standard stopMove success the
 tries""",
    ),
    Kind.WAIT: (
        "timerOutput",
        f"{_TIMER} Timer async cancelWaiting isRunning qi rPeriod start startTimer tb threading triggerOutput waiting",
    ),
    Kind.DELAY: (
        "timerOutput",
        f"""{_TIMER} addCallback async bound_clean cancelDelays cancel_list cleanDelay d delay_future delayed for
 functools fut fut_ref in list partial qi remove triggerOutput append""",
    ),
    Kind.LANGUAGE: (
        "setLanguage",
        """ALDialog ALProxy ALSpeechRecognition ALTextToSpeech Cannot Language None RuntimeError and applied asr
 available be cannot dialog error getParameter is lang language logger neither nor not onError onInput_onSet onReady
 raise recognition set setting speech to tts warn""",
    ),
}
# Speeds of postures that the library of positions writes into scripts.
_SPEED_OF_POSTURE = re.compile(r"[01]\.\d*")


@lru_cache(maxsize=256)
def kind_of(script: str) -> Kind:
    """Whose script this is; an empty one is that of a new box."""
    words = words_of(script)
    if words <= _NEW:
        return Kind.NOTHING
    for kind, (needed, more) in _WORDS.items():
        left = words - _NEW - {needed, *more.split()}
        if kind is Kind.POSTURE:
            left = {word for word in left if not _SPEED_OF_POSTURE.fullmatch(word)}
        if needed in words and not left:
            return kind
    return Kind.OTHER


def words_of(script: str) -> set[str]:
    """Words and numbers of a script, without its comments."""
    return set(WORD.findall(COMMENT.sub("", script)))


def sends_stopped(script: str, method: str) -> bool:
    """Whether a method of a script that does nothing else sends the signal of the output onStopped."""
    methods = {name: body for _, name, body in METHOD.findall(COMMENT.sub("", script) + "\n")}
    return "onStopped" in words_of(methods.get(method, ""))
