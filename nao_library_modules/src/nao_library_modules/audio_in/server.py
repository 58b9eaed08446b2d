"""The module for hearing: recordings, recognition of words, sounds and their directions, energies."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from nao_library_actions.msg import NaoAudioInAction
from naoqi.errors import NaoError

from ..audio.checks import DEVICE_PARAMETERS
from ..audio.fields import Revert
from ..audio.sound_card import NaoAudio
from ..base.answers import Outcome
from ..functions.chain import checked_by
from ..processes.launcher import LaunchPath
from ..server.nao_basic import NaoBasic
from .base import subscriber_name
from .checks import SENSES, check_setting
from .contexts import ContextFunctions
from .energy import EnergyFunctions
from .fields import Parameter, SetParameter, Value
from .heard import Heard, HeardWord, times_of
from .recognition import RECOGNITION, Recognition, RecognitionFunctions
from .recording import Recording, RecordingFunctions
from .sounds import SoundFunctions

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
        Action `nao_audio_in` (nao_library_actions/NaoAudioInAction) and what NaoBasic offers. Parameters `~robot_home`:
        as the constructor takes it; `~speech_onset_delay` and `~speech_end_delay` (0 s, up to 1): how much later than
        the speech the robot's event SpeechDetected says that it began and ended; a simulated robot needs neither.
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

    left_by_goals = frozenset({"vocabulary_is_set", "paused", "recording_runs", "saved_sets"})

    def __init__(
        self,
        ip: str,
        port: int,
        autostart: bool = False,
        launchpath: LaunchPath | None = None,
        robot_home: str = "",
        **options: Any,
    ) -> None:
        """Start the server.

        Args:
            ip: Address of the robot.
            port: Port of its NAOqi.
            autostart: As NaoBasic takes it.
            launchpath: As NaoBasic takes it.
            robot_home: Folder of this computer that is the home of the robot's user, as the `record_dir` of a simulated
                robot is; "~" stands for the home of this computer's user. Empty: it is on the robot alone.
            options: As NaoBasic takes them.
        """
        self._taking_up = threading.Lock()
        super().__init__(ip, port, autostart, launchpath, **options)
        self.heard = Heard()
        self.robot_home = Path(robot_home).expanduser().absolute() if robot_home else None
        self.speech_onset_delay = self._node.seconds("speech_onset_delay", 0.0)
        self.speech_end_delay = self._node.seconds("speech_end_delay", 0.0)
        self.subscriber = subscriber_name(str(self._node.namespace))
        self.frame_prefix = self._node.frame_prefix()
        self.saved_sets = set()
        self._took_over = False
        self._left = self.kept.load()
        self.serve("nao_audio_in", NaoAudioInAction)
        if self._left:
            self.robot.connection.in_background(self._take_up)

    # Functions that two of NAOqi's modules have

    @checked_by(check_setting)
    def set_parameter(self, str_param: SetParameter, values: Value, revert: Revert) -> None:
        """Set a parameter of the speech recognition (Sensitivity, NbHypotheses, ...) or of the sound card."""
        name = str_param.strip()
        if name in DEVICE_PARAMETERS:
            self.set_device_parameter(name, list(values), revert)
            return
        proxy = self.robot.proxy(RECOGNITION)
        if revert:
            self.put_back(RECOGNITION, "setParameter", name, float(self.call(proxy, "getParameter", name)))
        self.call(proxy, "setParameter", name, float(values[0]))

    def get_parameter(self, str_param: Parameter) -> float:
        """A parameter of the speech recognition (Sensitivity, NbHypotheses, ...) or of the sound card."""
        name = str_param.strip()
        if name in DEVICE_PARAMETERS:
            return self.get_device_parameter(name)
        return float(self.call(self.robot.proxy(RECOGNITION), "getParameter", name))

    function_table = {"setParameter": set_parameter, "getParameter": get_parameter}

    # The life of a goal

    def begin_chain(self) -> None:
        """Forget what the last chain heard."""
        self.heard = Heard()
        self._take_up()
        if not self._took_over:
            self._took_over = self._end_leftovers()

    def tell(self, status: str, words: Sequence[HeardWord] = (), stamp: float | None = None) -> None:
        """Publish what is heard meanwhile. Called from the thread that executes goals.

        Args:
            status: What the robot is doing.
            words: What was heard last.
            stamp: ROS time at which it was so, s; None: now.
        """
        onsets, ends = times_of([heard.span for heard in words])
        self.publish_feedback(
            stamp=stamp,
            status=status,
            words=[heard.word for heard in words],
            confidences=[heard.confidence for heard in words],
            onsets=onsets,
            ends=ends,
        )

    def fill_result(self, result: Any, outcomes: Sequence[Outcome]) -> None:
        """Add what was heard."""
        super().fill_result(result, outcomes)
        self.heard.fill(result)

    def shutdown_steps(self) -> list[Callable[[], Any]]:
        """As NaoBasic has them; what goals have left going ends."""
        left = (self.drop_recording, self.drop_recognition, self.drop_energy_computation)
        return [*super().shutdown_steps(), *map(self.with_robot, left)]

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

    # After the death of the node

    _left: dict[str, Any] | None = None  # what goals had left going, which is not taken up yet

    def keep_left(self) -> None:
        """Keep what goals have left going."""
        self.kept.save(
            {
                "recording": self._recording and asdict(self._recording),
                "recognition": self._recognition and asdict(self._recognition),
                "paused": self.paused,
                "vocabulary_is_set": self.vocabulary_is_set,
                "computing": self._computing,
            }
        )

    def _take_up(self) -> None:
        """Go on with what the goals of this node had left going before it died, as soon as the robot is there."""
        with self._taking_up:
            if not self._left or self.robot.connection.state != "connected":
                return
            left, self._left = self._left, None
            self._took_over = self._end_leftovers()
            self.vocabulary_is_set = bool(left.get("vocabulary_is_set"))
            for name, take_up in (
                ("recording", lambda told: self.renew_recording(Recording(**told))),
                ("recognition", lambda told: self.take_up_recognition(Recognition(**told))),
                ("paused", lambda _: self.pause_again()),
                ("computing", lambda _: self.renew_energy_computation()),
            ):
                try:
                    if left.get(name):
                        take_up(left[name])
                except (NaoError, TypeError) as error:
                    log.warning("%s of the server that died does not go on: %s", name, error)
            self.keep_left()

    def _connection_changed(self, *args: Any) -> None:
        super()._connection_changed(*args)
        self._take_up()
        if self.robot.connection.state == "connected" and self.robot.connection.generation > 1:
            self.renew_recognition()
