"""The module for hearing: recordings, recognition of words, sounds and their directions, energies."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

from nao_library_actions.msg import NaoAudioInAction
from naoqi.errors import NaoError

from .answers import Outcome
from .audio import NaoAudio
from .audio_checks import DEVICE_PARAMETERS
from .audio_in_base import subscriber_name
from .audio_in_checks import SENSES, check_parameter, check_setting
from .audio_in_contexts import ContextFunctions
from .audio_in_energy import EnergyFunctions
from .audio_in_heard import Heard
from .audio_in_recognition import RECOGNITION, RecognitionFunctions
from .audio_in_recording import RecordingFunctions
from .audio_in_sounds import SoundFunctions
from .function_chain import checked_by
from .launcher import LaunchPath
from .nao_basic import NaoBasic

log = logging.getLogger(__name__)


class NaoAudioInput(
    NaoBasic,
    NaoAudio,
    RecordingFunctions,
    RecognitionFunctions,
    ContextFunctions,
    SoundFunctions,
    EnergyFunctions,
):
    """Hearing goals: recordings, words, sounds and where they come from, and NAOqi's sound card.

    What a function begins ends with it, however it ends; only what startRecording, startRecognition,
    enableEnergyComputation and pause begin goes on beyond the goal, until they are stopped or the server ends.

    Attributes:
        heard: What the chain heard so far.
        subscriber: What NAOqi knows this server by.
        frame_prefix: Prefix of the robot's frames, with its slash; may be empty.

    ROS API:
        Action `nao_audio_in` (nao_library_actions/NaoAudioInAction) and what NaoBasic offers.
    """

    typed_answers = frozenset(
        {
            "listen",
            "record",
            "stopRecording",
            "stopMicrophonesRecording",
            "detectSound",
            "localizeSound",
            "getEnergy",
            "getLeftMicEnergy",
            "getRightMicEnergy",
            "getFrontMicEnergy",
            "getRearMicEnergy",
        }
    )

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
        self.heard = Heard()
        self.subscriber = subscriber_name(str(self._edge.namespace))
        self.frame_prefix = self._edge.frame_prefix()
        self._took_over = False
        for functions in (
            self.audio_functions(),
            self.recording_functions(),
            self.recognition_functions(),
            self.context_functions(),
            self.sound_functions(),
            self.energy_functions(),
            {"setParameter": self.set_parameter, "getParameter": self.get_parameter},
        ):
            self.function_table.update(functions)
        self.serve("nao_audio_in", NaoAudioInAction)

    # Functions that two of NAOqi's modules have

    @checked_by(check_setting)
    def set_parameter(self, str_param: str, values: Sequence[float], revert: bool) -> None:
        """Set a parameter of the speech recognition (Sensitivity, NbHypotheses, ...) or of the sound card."""
        name = str_param.strip()
        if name in DEVICE_PARAMETERS:
            self.set_device_parameter(name, list(values), revert)
            return
        proxy = self.robot.proxy(RECOGNITION)
        if revert:
            self.put_back(RECOGNITION, "setParameter", name, float(self.call(proxy, "getParameter", name)))
        self.call(proxy, "setParameter", name, float(values[0]))

    @checked_by(check_parameter)
    def get_parameter(self, str_param: str) -> float:
        """A parameter of the speech recognition (Sensitivity, NbHypotheses, ...) or of the sound card."""
        name = str_param.strip()
        if name in DEVICE_PARAMETERS:
            return self.get_device_parameter(name)
        return float(self.call(self.robot.proxy(RECOGNITION), "getParameter", name))

    # The life of a goal

    def begin_chain(self) -> None:
        """Forget what the last chain heard."""
        self.heard = Heard()
        if not self._took_over:
            self._took_over = self._end_leftovers()

    def tell(self, status: str, words: Sequence[str] = (), confidences: Sequence[float] = ()) -> None:
        """Publish what is heard meanwhile. Called from the thread that executes goals.

        Args:
            status: What the robot is doing.
            words: What was heard last.
            confidences: 0..1, one a word.
        """
        self.publish_feedback(status=status, words=list(words), confidences=list(confidences))

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what was heard."""
        super().fill_result(result, outcomes)
        self.heard.fill(result)

    def shut_down(self) -> None:
        """As NaoBasic does; what goals have left going ends."""
        super().shut_down()
        if self.robot.connection.state == "connected":
            self.drop_recording()
            self.drop_recognition()
            self.drop_energy_computation()

    def _end_leftovers(self) -> bool:
        """End what a server of this name could not end, for it was killed; tells whether the robot was asked."""
        for module in SENSES.values():
            try:
                proxy = self.robot.proxy(module)
                for name, *_ in self.call_now(proxy, "getSubscribersInfo"):
                    if name.startswith(self.subscriber_for("")):
                        self.call_now(proxy, "unsubscribe", name)
            except NaoError as error:
                log.debug("%s may work for nobody: %s", module, error)
        return self.robot.connection.state == "connected"

    def _connection_changed(self, *args: Any) -> None:
        super()._connection_changed(*args)
        if self.robot.connection.state == "connected" and self.robot.connection.generation > 1:
            self.renew_recognition()
