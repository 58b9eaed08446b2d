"""ALAnimatedSpeech of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

import random
from typing import Any, Mapping

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import lists_by_tag
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.speech.animated_talk import AnimatedTalk, Caller, PlaySound
from nao_sim_bridge.naoqi.speech.voice_settings import VoiceSettings
from nao_sim_bridge.speech.animations import AnimationLibrary, read_animations
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.body_language import CONTEXTUAL, DISABLED, MODES, BodyLanguage
from nao_sim_bridge.speech.speaker import Speaker
from nao_sim_bridge.speech.studio import Studio

END = "ALAnimatedSpeech/EndOfAnimatedSpeech"
MODE_KEY = "bodyLanguageMode"


class ALAnimatedSpeech:
    """ALAnimatedSpeech as the simulated robot offers it."""

    def __init__(
        self,
        runner: RobotRunner,
        memory: MemoryStore,
        speaker: Speaker,
        studio: Studio,
        settings: VoiceSettings,
        files: ClientFiles,
        call: Caller,
        animator: Animator,
        library: AnimationLibrary,
        body_language: BodyLanguage,
        play_sound: PlaySound,
    ) -> None:
        self._runner = runner
        self._memory = memory
        self._speaker = speaker
        self._studio = studio
        self._settings = settings
        self._files = files
        self._call = call
        self._animator = animator
        self._library = library
        self._play_sound = play_sound
        self._chance = random.Random(runner.simulation.scene.seed)
        self._body_language = body_language
        memory.declare_event(END, "ALAnimatedSpeech")

    def say(self, text: str, configuration: Any = None) -> Task:
        return self._say(text, self._configured(configuration), self._call)

    def say_without_calls(self, text: str) -> Task:
        """What a behaviour says: instructions that call methods are left out."""
        return self._say(text, self._body_language.mode, None)

    def _say(self, text: str, mode: str, call: Caller | None) -> Task:
        talk = AnimatedTalk(
            text,
            self._settings.style(),
            mode,
            self._studio,
            self._library,
            self._chance,
            call,
            self._play_sound,
            lambda: self._animator.posture,
        )

        def start() -> Task:
            task = talk.start(self._runner.simulation, self._speaker, self._animator)
            task.add_done_callback(lambda done: self._memory.raise_event(END, done.task_id))
            return task

        return self._runner.execute(start, "say")

    # --- body language --------------------------------------------------------------------------------------------

    def getBodyLanguageMode(self) -> int:
        return MODES.index(self._body_language.mode)

    def getBodyLanguageModeToStr(self) -> str:
        return self._body_language.mode

    def setBodyLanguageMode(self, mode: int | str) -> None:
        self._body_language.mode = _mode(mode)

    setBodyLanguageModeFromStr = setBodyLanguageMode

    def isBodyLanguageEnabled(self) -> bool:
        return self._body_language.enabled

    def setBodyLanguageEnabled(self, enable: bool) -> None:
        self._body_language.mode = CONTEXTUAL if enable else DISABLED

    isBodyTalkEnabled, setBodyTalkEnabled = isBodyLanguageEnabled, setBodyLanguageEnabled

    # --- animations -----------------------------------------------------------------------------------------------

    def declareAnimationsPackage(self, name: str) -> None:
        """A package is a file of that name with the ending .json in the folder for files of clients."""
        self._library.add(read_animations(self._files.to_read(f"{name}.json")).values())

    def declareTagForAnimations(self, tags: Any) -> None:
        for tag, names in lists_by_tag(tags, "tagsToAnimations").items():
            for name in names:
                if name not in self._library.names:
                    raise UnknownName("animation", name, self._library.names)
            self._library.add_tag(tag, names)

    def addTagsToWords(self, tags: Any) -> None:
        for tag, words in lists_by_tag(tags, "tagsToWords").items():
            self._library.add_words(tag, words)

    def _configured(self, configuration: Any) -> str:
        if configuration is None:
            return self._body_language.mode
        if not isinstance(configuration, Mapping) or set(configuration) - {MODE_KEY}:
            raise BadValue("configuration", configuration, f'a map like {{"{MODE_KEY}": "{CONTEXTUAL}"}}')
        return _mode(configuration[MODE_KEY]) if configuration else self._body_language.mode


def _mode(value: Any) -> str:
    """A mode by its name or its number; a BadValue when there is no such mode."""
    if value in MODES:
        return value
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value < len(MODES):
        return MODES[value]
    names = ", ".join(f"{number} ({name})" for number, name in enumerate(MODES))
    raise BadValue(MODE_KEY, value, f"one of {names}")
