"""The module for what can be heard: speech, sound files, tones, volumes."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

from nao_library_actions.msg import NaoAudioOutAction
from naoqi.errors import NaoError

from ..audio.sound_card import DEVICE
from ..base.answers import Outcome
from ..functions.memory_functions import MemoryFunctions
from ..processes.launcher import LaunchPath
from ..server.nao_basic import NaoBasic
from .files import FileNotes, LoadedSounds
from .player import PlayerFunctions
from .speech import SpeechFunctions
from .voices import Voices
from .words import SpokenWords

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

    left_by_goals = frozenset({"loaded"})

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
        self.words = SpokenWords(self.robot, self.clock, self.robot_clock, self.call, self._tell_word)
        self.loaded = LoadedSounds(self.robot.connection)
        self.files = FileNotes()
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

    function_table = {"stopAll": stop_all, "waitUntilSilent": wait_until_silent}

    # The life of a goal

    def view_for_checks(self) -> Any:
        """As NaoBasic gives it; with voices of its own, which may be asked for while a goal runs."""
        view = super().view_for_checks()
        view.voices = Voices(self.robot, self.call)
        return view

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
        if any(outcome.function not in MemoryFunctions.functions for outcome in outcomes):
            try:
                result.volume = float(self.call_now(self.robot.proxy(DEVICE), "getOutputVolume"))
            except NaoError as error:
                log.debug("the output volume is not known: %s", error)  # the chain is done all the same

    def shutdown_steps(self) -> list[Callable[[], Any]]:
        """As NaoBasic has them; and nothing sounds any more that goals have left in the background."""
        return [*super().shutdown_steps(), self.words.close, self.with_robot(self.silence)]

    # Inside

    def _tell_word(self, word: str, sentence: str, when: float) -> None:
        """Called from a thread of libqi."""
        self.publish_feedback(stamp=when, word=word, sentence=sentence)

    def _connection_changed(self, *args: Any) -> None:
        super()._connection_changed(*args)
        if self.robot.connection.state == "connected" and self.robot.connection.generation > 1:
            self.words.renew()
