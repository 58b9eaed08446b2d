"""What the groups of hearing functions share: what was heard, feedback, names, and the use of NAOqi's extractors."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from . import extractor_use
from .audio_in_heard import Heard
from .extractor_use import Events as Events
from .extractor_use import ExtractorUse

DEFAULT_TIMEOUT = 10.0
"""s that functions wait for something to be heard, where a message leaves it to us."""


class AudioInBase(ExtractorUse):
    """To be mixed into NaoBasic.

    Attributes:
        heard: What the chain heard so far; new for each goal.
    """

    heard: Heard
    tell: Callable[..., None]  # of NaoAudioInput: feedback


def subscriber_name(namespace: str) -> str:
    """A name for the server's subscriptions that no other server has: of this computer, in this namespace."""
    return extractor_use.subscriber_name("nao_audio_in", namespace)


def timeout_of(timeout: float) -> float:
    """How long a function waits, s."""
    return timeout or DEFAULT_TIMEOUT


def words_of(pairs: Sequence[tuple[str, float]]) -> tuple[list[str], list[float]]:
    """Words and their confidences, apart."""
    return [word for word, _ in pairs], [confidence for _, confidence in pairs]
