"""The module for what can be heard: speech, sound files, tones, volumes."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

from nao_library_actions.msg import NaoAudioOutAction
from naoqi.errors import NaoError

from ..core.memory_functions import MemoryFunctions, Outcome
from ..core.processes import LaunchPath
from ..nao_audio import DEVICE, NaoAudio
from .played_sounds import PlayerFunctions, Sounds
from .speech import SpeechFunctions, SpokenWords, Synthesiser, VoiceFunctions

log = logging.getLogger(__name__)

UNKNOWN_VOLUME = -1.0


class NaoAudioOutput(NaoAudio):
    """Audio goals: ALTextToSpeech, ALAnimatedSpeech, ALAudioPlayer, and of ALAudioDevice what NaoAudio offers.

    A function ends when what it plays has ended, unless it is in the `background`. A goal that fails or is preempted
    silences what it began, and nothing else. The feedback has each word as it is spoken.

    ROS API:
        Action `nao_audio_out` (nao_library_actions/NaoAudioOutAction) and what NaoBasic offers.
    """

    part_types = (SpeechFunctions, VoiceFunctions, PlayerFunctions)

    def __init__(
        self, ip: str, port: int, autostart: bool = False, launchpath: LaunchPath | None = None, **options: Any
    ) -> None:
        """Start the server; arguments as NaoBasic takes them."""
        super().__init__(ip, port, autostart, launchpath, **options)
        self.sounds = Sounds(self)
        self.synthesiser = Synthesiser(self)
        self.words = SpokenWords(self)
        self.player = PlayerFunctions(self, self.sounds)
        speech = SpeechFunctions(self, self.synthesiser, self.sounds, self.words)
        voice = VoiceFunctions(self, self.synthesiser)
        self.add_parts(self.sounds, self.synthesiser, speech, voice, self.player)
        self.at_end(self.words.close, self.with_robot(self.sounds.silence))
        self.serve("nao_audio_out", NaoAudioOutAction)

    # Functions: parameters are fields of AudioOutFunction

    def stop_all(self) -> None:
        """Silence all speech and all sounds of the robot, whoever began them."""
        try:
            self.synthesiser.call("stopAll")
        finally:  # also on a robot that only plays
            self.player.call("stopAll")

    def wait_until_silent(self) -> None:
        """Wait for the end of what goals of this server have left in the background."""
        self.sounds.wait_for_background()

    function_table = {"stopAll": stop_all, "waitUntilSilent": wait_until_silent}

    # The life of a goal

    def begin_chain(self) -> None:
        self.sounds.begin_chain()

    def end_chain(self, end: str) -> None:
        """See that only a chain that succeeded leaves something to be heard."""
        self.words.stop()
        if end != "succeeded":
            self.sounds.silence_chain()

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add the files that the chain played or wrote, and how loud the robot is."""
        super().fill_result(result, outcomes)
        result.files = self.sounds.file_names
        result.durations = self.sounds.durations
        result.volume = UNKNOWN_VOLUME
        if any(outcome.function not in MemoryFunctions.functions for outcome in outcomes):
            try:
                result.volume = float(self.call_now(self.robot.proxy(DEVICE), "getOutputVolume"))
            except NaoError as error:
                log.debug("the output volume is not known: %s", error)  # the chain is done all the same

    def connected(self, again: bool) -> None:
        if again:
            self.words.renew()
