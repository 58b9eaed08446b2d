"""The module for hearing: recordings, recognition of words, sounds and their directions, energies."""

from __future__ import annotations

import logging
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from nao_library_actions.msg import NaoAudioInAction
from naoqi.errors import NaoError

from ..core.chain import checked_by
from ..core.health import recordings_report
from ..core.memory_functions import Outcome
from ..core.processes import LaunchPath
from ..nao_audio import DEVICE_PARAMETERS, NaoAudio, Revert, check_device_setting, put_back
from .audio_in_fields import SENSES, Parameter, SetParameter, Value
from .heard_sounds import EnergyFunctions, SoundFunctions, SoundRecordingFunctions
from .hearing import Heard, Hearing, LeftGoing, Recognition, Recording
from .word_recognition import RECOGNITION, ContextFunctions, Recogniser, RecognitionFunctions

log = logging.getLogger(__name__)


class NaoAudioInput(NaoAudio):
    """Hearing goals: recordings, words, sounds and where they come from, and NAOqi's sound card.

    What a function begins ends with it, however it ends; only what startRecording, startRecognition,
    enableEnergyComputation and pause begin goes on beyond the goal, until they are stopped or the server ends.

    ROS API:
        Action `nao_audio_in` (nao_library_actions/NaoAudioInAction) and what NaoBasic offers. Parameters `~robot_home`:
        as the constructor takes it; `~speech_onset_delay` and `~speech_end_delay` (0 s, up to 1): how much later than
        the speech the robot's event SpeechDetected says that it began and ended; a simulated robot needs neither.
    """

    typed_answers = frozenset(
        "listen record stopRecording stopMicrophonesRecording detectSound localizeSound "
        "getEnergy getLeftMicEnergy getRightMicEnergy getFrontMicEnergy getRearMicEnergy".split()
    )
    part_types = (
        SoundRecordingFunctions,
        RecognitionFunctions,
        ContextFunctions,
        SoundFunctions,
        EnergyFunctions,
    )

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        robot_home: str = "",
        **options: Any,
    ) -> None:
        """Start the server; arguments as NaoBasic takes them, but for one.

        `robot_home`: folder of this computer that is the home of the robot's user, as the `record_dir` of a simulated
        robot is; "~" stands for the home of this computer's user. Empty: it is on the robot alone.
        """
        super().__init__(ip, port, autostart, launchpath, **options)
        self._taking_up = threading.Lock()
        self._took_over = False
        home = Path(robot_home).expanduser().absolute() if robot_home else None
        delays = [self._node.seconds(name, 0.0) for name in ("speech_onset_delay", "speech_end_delay")]
        self.hearing = Hearing(self, str(self._node.namespace))
        self.left = LeftGoing(self.kept)
        self.recogniser = Recogniser(self, self.hearing, *delays)
        self.recordings = SoundRecordingFunctions(self, self.hearing, self.left, home)
        self.recognition = RecognitionFunctions(self, self.hearing, self.left, self.recogniser)
        self.energies = EnergyFunctions(self, self.hearing, self.left)
        contexts = ContextFunctions(self.recogniser, self.recordings)
        sounds = SoundFunctions(self, self.hearing, self._node.frame_prefix())
        self.add_parts(self.hearing, self.left, self.recogniser)
        self.add_parts(self.recordings, self.recognition, contexts, sounds, self.energies)
        left = (self.recordings.drop, self.recognition.drop, self.energies.drop)
        self.at_end(*map(self.with_robot, left))
        self._unrestored: dict[str, Any] | None = self.kept.load(dict)  # what goals had left going, not taken up yet
        self.own_reports["recordings"] = lambda: recordings_report(self.recordings.running)
        self.serve("nao_audio_in", NaoAudioInAction)
        if self._unrestored:
            self.robot.connection.in_background(self._take_up)

    # Functions that two of NAOqi's modules have

    def _check_setting(self, str_param: str, values: Sequence[float]) -> None:
        """A value that the parameter may have, where it is one of the sound card; others the robot knows."""
        if str_param.strip() in DEVICE_PARAMETERS:
            check_device_setting(str_param, values)

    @checked_by(_check_setting)
    def set_parameter(self, str_param: SetParameter, values: Value, revert: Revert) -> None:
        """Set a parameter of the speech recognition (Sensitivity, NbHypotheses, ...) or of the sound card."""
        name = str_param.strip()
        if name in DEVICE_PARAMETERS:
            self.set_device_parameter(name, list(values), revert)
            return
        if revert:
            put_back(self, RECOGNITION, "setParameter", name, float(self.recogniser.call("getParameter", name)))
        self.recogniser.call("setParameter", name, float(values[0]))

    def get_parameter(self, str_param: Parameter) -> float:
        """A parameter of the speech recognition (Sensitivity, NbHypotheses, ...) or of the sound card."""
        name = str_param.strip()
        if name in DEVICE_PARAMETERS:
            return self.get_device_parameter(name)
        return float(self.recogniser.call("getParameter", name))

    function_table = {"setParameter": set_parameter, "getParameter": get_parameter}

    # The life of a goal

    def begin_chain(self) -> None:
        self.hearing.heard = Heard()
        self._take_up()
        if not self._took_over:
            self._took_over = self.hearing.end_leftovers(SENSES.values())

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        super().fill_result(result, outcomes)
        self.hearing.heard.fill(result)

    # After the death of the node

    def _take_up(self) -> None:
        """Go on with what the goals of this node had left going before it died, as soon as the robot is there."""
        with self._taking_up:
            if not self._unrestored or self.robot.connection.state != "connected":
                return
            left, self._unrestored = self._unrestored, None
            self._took_over = self.hearing.end_leftovers(SENSES.values())
            self.left.vocabulary_is_set = bool(left.get("vocabulary_is_set"))
            for name, take_up in (
                ("recording", lambda kept: self.recordings.renew(Recording(**kept))),
                ("recognition", lambda kept: self.recognition.take_up(Recognition(**kept))),
                ("paused", lambda _: self.recognition.pause_again()),
                ("computing", lambda _: self.energies.renew()),
            ):
                try:
                    if left.get(name):
                        take_up(left[name])
                except (NaoError, TypeError) as error:
                    log.warning("%s of the server that died does not go on: %s", name, error)
            self.left.keep()

    def connected(self, again: bool) -> None:
        self._take_up()
        if again:
            self.recognition.renew()
