"""The module for what can be heard: speech, sound files, tones, volumes."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

from nao_library_actions.msg import NaoAudioOutAction
from naoqi.errors import NaoError

from .answers import Outcome
from .audio import DEVICE
from .audio_out_files import FileNotes, LoadedSounds
from .audio_out_player import PlayerFunctions
from .audio_out_speech import SpeechFunctions
from .audio_out_voices import Voices
from .audio_out_words import SpokenWords
from .launcher import LaunchPath
from .memory_functions import MEMORY
from .nao_basic import NaoBasic

log = logging.getLogger(__name__)

UNKNOWN_VOLUME = -1.0


class NaoAudioOutput(NaoBasic, SpeechFunctions, PlayerFunctions):
    """Audio goals: ALTextToSpeech, ALAnimatedSpeech, ALAudioPlayer, and of ALAudioDevice what NaoAudio offers.

    A function ends when what it plays has ended, unless it is in the `background`. A goal that fails or is preempted
    silences what it began, and nothing else. The feedback tells each word as it is spoken.

    Attributes:
        voices: Voices and languages of the robot.
        words: Words as they are spoken.
        loaded: Sounds that this server has loaded.
        files: Files that the chain played or wrote.

    ROS API:
        Action `nao_audio_out` (nao_library_actions/NaoAudioOutAction) and what NaoBasic offers.
    """

    def __init__(
        self, ip: str, port: int, autostart: bool = False, launchpath: LaunchPath | None = None, **options: Any
    ) -> None:
        """Start the server.

        Args:
            ip: Address of the robot.
            port: Port of its NAOqi.
            autostart: As NaoBasic takes it.
            launchpath: As NaoBasic takes it.
            options: As NaoBasic takes them.
        """
        super().__init__(ip, port, autostart, launchpath, **options)
        self.start_sounds()
        self.voices = Voices(self.robot, self.call)
        self.words = SpokenWords(lambda: self.robot.proxy(MEMORY), self._tell_word)
        self.loaded = LoadedSounds(self.robot.connection)
        self.files = FileNotes()
        self._memory_functions = frozenset(self.function_table)
        self.function_table.update(self.audio_functions())
        self.function_table.update(self.speech_functions())
        self.function_table.update(self.voice_functions())  # its parameters have the sound card's among them
        self.function_table.update(self.player_functions())
        self.function_table.update({"stopAll": self.stop_all, "waitUntilSilent": self.wait_until_silent})
        self.serve("nao_audio_out", NaoAudioOutAction)

    # Functions: parameters are fields of AudioOutFunction

    def stop_all(self) -> None:
        """Silence all speech and all sounds of the robot, whoever began them."""
        try:
            self.speech("stopAll")
        finally:  # also on a robot that only plays
            self.player("stopAll")

    def wait_until_silent(self) -> None:
        """Wait for the end of what goals of this server have left in the background."""
        self.wait_for_sounds()

    # The life of a goal

    def begin_chain(self) -> None:
        """Forget what the last chain did; what it left in the background sounds on."""
        self.files = FileNotes()
        self.begin_sounds()

    def end_chain(self, end: str) -> None:
        """See that only a chain that succeeded leaves something to be heard."""
        self.words.stop()
        self.end_sounds(keep=end == "succeeded")

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add the files that the chain played or wrote, and how loud the robot is."""
        super().fill_result(result, outcomes)
        result.files = self.files.names
        result.durations = self.files.durations
        result.volume = UNKNOWN_VOLUME
        if any(outcome.function not in self._memory_functions for outcome in outcomes):
            try:
                result.volume = float(self.call_now(self.robot.proxy(DEVICE), "getOutputVolume"))
            except NaoError as error:
                log.debug("the output volume is not known: %s", error)  # the chain is done all the same

    def shut_down(self) -> None:
        """As NaoBasic does; and nothing sounds any more that goals have left in the background."""
        super().shut_down()
        self.words.close()
        if self.robot.connection.state == "connected":
            self.silence()

    # Inside

    def _tell_word(self, word: str, sentence: str) -> None:
        """Called from a thread of libqi."""
        self.publish_feedback(word=word, sentence=sentence)

    def _connection_changed(self, *args: Any) -> None:
        super()._connection_changed(*args)
        if self.robot.connection.state == "connected" and self.robot.connection.generation > 1:
            self.words.renew()
