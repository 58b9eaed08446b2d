"""ALTextToSpeech of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.naoqi.speech.speech_events import SpeechEvents
from nao_sim_bridge.naoqi.speech.voice_settings import VoiceSettings
from nao_sim_bridge.sound.files import write_sound
from nao_sim_bridge.speech.clips import Style
from nao_sim_bridge.speech.speaker import Speaker
from nao_sim_bridge.speech.studio import Studio

log = logging.getLogger("nao_sim.speech")

# Samples a second in files, as on the robot.
FILE_RATE = 22050
FILE_KINDS = (".wav", ".raw")
PLAYED_FILE = "sayToFileAndPlay.wav"
PREFERENCE = "ALTextToSpeech_Voice_{}.json"


class ALTextToSpeech:
    """ALTextToSpeech as the simulated robot offers it.

    Args:
        speaker: The robot's mouth; touched in the simulation thread only.
    """

    def __init__(
        self,
        speaker: Speaker,
        studio: Studio,
        settings: VoiceSettings,
        events: SpeechEvents,
        runner: SimulationRunner,
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

    # --- the voice ------------------------------------------------------------------------------------------------

    def getAvailableLanguages(self) -> list[str]:
        return self._settings.voices.available_languages(self._studio.engines)

    def getSupportedLanguages(self) -> list[str]:
        return list(self._settings.voices.languages)

    def getAvailableVoices(self) -> list[str]:
        return self._settings.voices.available_voices(self._studio.engines)

    def getLanguage(self) -> str:
        return self._settings.language.name

    def setLanguage(self, language: str) -> None:
        self._settings.set_language(language)

    def getLanguageEncoding(self, language: str) -> str:
        languages = self._settings.voices.languages
        if language not in languages:
            raise BadValue("pLanguage", language, f"one of {', '.join(languages)}")
        return languages[language].encoding

    def locale(self) -> str:
        return self._settings.language.locale

    def getVoice(self) -> str:
        return self._settings.voice

    def setVoice(self, voice: str) -> None:
        self._settings.set_voice(voice)

    def setLanguageDefaultVoice(self, language: str, voice: str) -> None:
        self._settings.set_default_voice(language, voice)

    def getVolume(self) -> float:
        return self._settings.volume

    def setVolume(self, volume: float) -> None:
        self._settings.set_volume(volume)

    def getParameter(self, name: str) -> float:
        return self._settings.parameter(name)

    def setParameter(self, name: str, value: float) -> None:
        self._settings.set_parameter(name, value)

    def resetSpeed(self) -> None:
        self._settings.reset_speed()

    def reset(self) -> None:
        self._settings.reset()

    def loadVoicePreference(self, name: str) -> None:
        self._settings.load(self._files.to_read(PREFERENCE.format(name)))

    # --- pronunciation --------------------------------------------------------------------------------------------

    def addToDictionary(self, *entry: str) -> bool:
        """(word, pronunciation), or (type, word, priority, phonetic, accent) of Japanese."""
        word, spoken = entry if len(entry) == 2 else (entry[1], entry[3])
        return self._settings.add_pronunciation(word, spoken)

    def deleteFromDictionary(self, *entry: str) -> bool:
        """(word), or (type, word) of Japanese."""
        return self._settings.delete_pronunciation(entry[-1])

    def showDictionary(self) -> None:
        entries = self._settings.pronunciations()
        log.info("dictionary of %s, %d words", self._settings.language.name, len(entries))
        for word, spoken in entries:
            log.info("  %s is spoken %s", word, spoken)

    # --- events ---------------------------------------------------------------------------------------------------

    def enableNotifications(self) -> None:
        self._events.enabled = True

    def disableNotifications(self) -> None:
        self._events.enabled = False

    # --- inside ---------------------------------------------------------------------------------------------------

    def _write(self, text: str, style: Style, path: Any) -> None:
        sound = self._studio.sound(text, style).at_rate(FILE_RATE)
        if path.suffix.lower() == ".raw":
            write_whole(path, (np.clip(sound.samples[:, 0], -1.0, 1.0) * 32767.0).astype("<i2").tobytes())
        else:
            write_sound(path, sound)
