"""What the extractors that listen to the microphones share: they hear while somebody is subscribed, unless paused."""

from __future__ import annotations

from typing import Any, Callable, Mapping

from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.switch import Switch
from nao_sim_bridge.sound.ears import Ears, Listener, MicrophoneBlock

Hear = Callable[[MicrophoneBlock], None]


class Listening(Switch):
    """Opens and closes the ears of one module. Any thread.

    Args:
        begin: Called each time that listening begins; what it returns gets the blocks, four channels of 48 kHz.
    """

    def __init__(self, ears: Ears, name: str, begin: Callable[[], Hear]) -> None:
        super().__init__()
        self._ears = ears
        self._name = name
        self._begin = begin
        self._listener: Listener | None = None

    @property
    def hears(self) -> bool:
        return self._listener is not None

    def _update(self) -> None:
        if self._works and self._listener is None:
            self._listener = self._ears.listen(self._name, self._begin(), wants="48k4")
        elif not self._works and self._listener is not None:
            self._listener.close()
            self._listener = None


class ListeningModule:
    """Methods that NAOqi's listening extractors have in common. No other methods are public.

    Args:
        setters: What takes the value of a parameter, by its name.
    """

    def __init__(self, listening: Listening, setters: Mapping[str, Callable[[Any], None]]) -> None:
        self.listening = listening
        self._setters = setters

    def pause(self, status: bool) -> None:
        self.listening.pause(status)

    def isPaused(self) -> bool:
        return self.listening.paused

    def isProcessing(self) -> bool:
        return self.listening.hears

    def setParameter(self, parameter: str, value: Any) -> None:
        if parameter not in self._setters:
            raise NaoqiError(f"unknown parameter {parameter!r}; there are {', '.join(self._setters)}")
        self._setters[parameter](value)


def sensitivity_of(value: Any) -> float:
    """A sensitivity 0..1."""
    return number(value, "Sensitivity", 0.0, 1.0)
