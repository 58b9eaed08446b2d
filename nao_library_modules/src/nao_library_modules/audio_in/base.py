"""What the groups of hearing functions share: what was heard, feedback, names, and the use of NAOqi's extractors."""

from __future__ import annotations

from collections.abc import Callable

from ..server import extractor_use
from ..server.extractor_use import Events as Events
from ..server.extractor_use import ExtractorUse
from .heard import Heard

DEFAULT_TIMEOUT = 10.0
"""s that functions wait for something to be heard, where a message leaves it to us."""


class AudioInBase(ExtractorUse):
    """To be mixed into NaoBasic.

    Attributes:
        heard: What the chain heard so far; new for each goal.
    """

    heard: Heard
    happened: tuple[float, float]  # of NaoBasic
    remark: Callable[[str], None]  # of NaoBasic
    tell: Callable[..., None]  # of NaoAudioInput: feedback


def subscriber_name(namespace: str) -> str:
    """A name for the server's subscriptions that no other server has: of this computer, in this namespace."""
    return extractor_use.subscriber_name("nao_audio_in", namespace)


def timeout_of(timeout: float) -> float:
    """How long a function waits, s."""
    return timeout or DEFAULT_TIMEOUT
