"""ALTextToSpeech of the simulated robot: it speaks; `VoiceSettings` has its methods about the voice."""

from __future__ import annotations

from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.speech.speech_events import SpeechEvents
from nao_sim_bridge.naoqi.speech.voice_settings import VoiceSettings
from nao_sim_bridge.sound.files import write_sound
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.speaker import Speaker
from nao_sim_bridge.speech.studio import Studio

# Samples a second in files, as on the robot.
FILE_RATE = 22050
FILE_KINDS = (".wav", ".raw")
PLAYED_FILE = "sayToFileAndPlay.wav"


class ALTextToSpeech:
    """ALTextToSpeech as the simulated robot offers it."""

    def __init__(
        self,
        speaker: Speaker,
        studio: Studio,
        settings: VoiceSettings,
        events: SpeechEvents,
        runner: RobotRunner,
        files: ClientFiles,
    ) -> None:
        self._speaker = speaker
        self._studio = studio
        self._settings = settings
        self._events = events
        self._runner = runner
        self._files = files
        self._stops = 0

    # --- speaking -------------------------------------------------------------------------------------------------

    def say(self, text: str, language: str | None = None) -> Task:
        style = self._settings.style(language)
        items = self._studio.read(text, style)
        return self._runner.execute(lambda: self._speaker.say(items, style), "say")

    def sayToFile(self, text: str, file_name: str) -> Task:
        style = self._settings.style()
        path = self._files.to_write(file_name)
        if path.suffix.lower() not in FILE_KINDS:
            raise BadValue("pFileName", file_name, f"a name that ends in {' or '.join(FILE_KINDS)}")
        return self._studio.in_background(lambda: self._write(text, style, path), "sayToFile")

    def sayToFileAndPlay(self, text: str) -> Task:
        """The file is there when the voice begins."""
        style = self._settings.style()
        items = self._studio.read(text, style)
        path = self._files.to_write(PLAYED_FILE)
        stops = self._stops

        def play() -> Task | None:
            self._write(text, style, path)
            if self._stops != stops:
                return None  # stopAll was meant for this text, too
            return self._runner.execute(lambda: self._speaker.say(items, style, "sayToFileAndPlay"), "sayToFileAndPlay")

        return self._studio.in_background(play, "sayToFileAndPlay")

    def stopAll(self) -> Task:
        self._stops += 1
        return self._runner.execute(self._speaker.stop_all, "stopAll")

    # --- events ---------------------------------------------------------------------------------------------------

    def enableNotifications(self) -> None:
        self._events.enabled = True

    def disableNotifications(self) -> None:
        self._events.enabled = False

    def _write(self, text: str, style: Style, path: Any) -> None:
        sound = self._studio.sound(text, style).at_rate(FILE_RATE)
        if path.suffix.lower() == ".raw":
            write_whole(path, (np.clip(sound.samples[:, 0], -1.0, 1.0) * 32767.0).astype("<i2").tobytes())
        else:
            write_sound(path, sound)
