"""ALAudioRecorder of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.sound.microphone_formats import flags_to_channel, microphone_format
from nao_sim_bridge.naoqi.sound.recorder import KINDS, Recorder, RecordingOrder, kind_of


class ALAudioRecorder:
    """ALAudioRecorder as the simulated robot offers it."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder

    def startMicrophonesRecording(self, filename: str, kind: str, rate: int, channels: Any) -> Task:
        if kind not in KINDS:
            raise BadValue("type", kind, " or ".join(KINDS))
        if kind_of(filename) != kind:
            raise BadValue("filename", filename, f"a name that ends in .{kind}, as the type says")
        heard = microphone_format(rate, flags_to_channel(channels), 0)
        return self._recorder.start(RecordingOrder(filename, kind, heard))

    def stopMicrophonesRecording(self) -> Task:
        return self._recorder.stop()
