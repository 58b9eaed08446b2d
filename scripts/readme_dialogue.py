"""The dialogue in docs/sound.md's picture: a person calls, the robot turns to the voice, asks, listens, answers, nods.

It does over libqi what the example dialogue.py does with goals, so that drawing it needs no ROS.
"""

from __future__ import annotations

import math
import queue
import sys
from pathlib import Path
from typing import Any, Callable

import qi

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "nao_library_modules" / "examples"))
from example_parts.dialogue_record import DOES, PERSON, ROBOT, SAYS, Notes, Turn
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer

CALL, QUESTION, REPLY, THANKS = "Hello, robot!", "Shall we play?", "Yes!", "Great!"
WORDS, EXPECTED = ["yes", "no", "maybe", "later"], "yes"
SUBSCRIBER = "picture"
# Where the person's mouth is, in world, m.
PLACE = [1.0, 0.4, 0.6]
VOICE = "rms"
# Which of left, right, front, rear are recorded, and at which rate, Hz.
FRONT, RATE = [0, 0, 1, 0], 16000
LOCATED, RECOGNISED = "ALSoundLocalization/SoundLocated", "WordRecognized"
# From readiness to the first word of a person, and after the last turn, s.
REACTION, END = 0.8, 0.5
SURE = 0.3
NOD = ([0.3, -0.2, 0.3, 0.0], [0.4, 0.8, 1.2, 1.6])
LIMIT = 30.0


class Dialogue:
    """A dialogue in a simulator, with its recording.

    Args:
        folder: Where the recording goes.
    """

    def __init__(self, folder: Path) -> None:
        # Slow, for between calls time goes on; but faster than real, for then it waits until a voice is synthesised.
        self._server = SimulatorServer(ServerOptions(Scene(), port=0, speed=2.0, record_dir=folder))
        self._session = qi.Session()
        self._notes = Notes(self._time)

    @property
    def turns(self) -> list[Turn]:
        """What has been said, heard and done, in s from the beginning of the recording."""
        return self._notes.turns

    def record(self, name: str) -> None:
        """Have the dialogue, and write what the front microphones hear to a file."""
        self._server.start()
        try:
            self._session.connect(f"tcp://127.0.0.1:{self._server.broker.port}")
            self._session.service("ALRobotPosture").goToPosture("Stand", 0.8)
            self._session.service("ALSpeechRecognition").setVocabulary(WORDS, False)
            recorder = self._session.service("ALAudioRecorder")
            recorder.startMicrophonesRecording(name, "wav", RATE, FRONT)
            self._notes = Notes(self._time)
            self._talk()
            self._server.runner.advance(END).result(LIMIT)
            recorder.stopMicrophonesRecording()
        finally:
            self._session.close()
            self._server.stop()

    def _talk(self) -> None:
        motion, speech = self._session.service("ALMotion"), self._session.service("ALTextToSpeech")
        when, sounds = self._call("ALSoundLocalization", LOCATED, CALL, lambda value: value[1][2] > SURE)
        azimuth, _, sure, _ = sounds[1]
        self._notes.heard(f"a voice at {math.degrees(azimuth):.0f}°", when, sure)
        self._during(DOES, "turns its head", lambda: motion.angleInterpolation("HeadYaw", azimuth, 0.8, True))
        self._during(SAYS, QUESTION, lambda: speech.say(QUESTION))
        when, (word, sure, *_) = self._call("ALSpeechRecognition", RECOGNISED, REPLY, lambda value: value[0] != "")
        self._notes.heard(word, when, sure)
        if word != EXPECTED:
            raise SystemExit(f"the robot took {REPLY!r} for {word!r}")
        self._during(SAYS, THANKS, lambda: speech.say(THANKS))
        self._during(DOES, "nods", lambda: motion.angleInterpolation("HeadPitch", *NOD, True))

    def _call(self, module: str, event: str, text: str, good: Callable[[Any], bool]) -> tuple[float, Any]:
        """Have a module listen and the person say something; the first event with a good value: time and value."""
        heard: queue.Queue[tuple[float, Any]] = queue.Queue()

        def take(value: Any) -> None:
            if good(value):
                heard.put((self._notes.now(), value))

        signal = self._session.service("ALMemory").subscriber(event).signal
        link, listener = signal.connect(take), self._session.service(module)
        listener.subscribe(SUBSCRIBER)
        self._server.runner.advance(REACTION).result(LIMIT)
        says = self._session.service("NaoSimulation").personSays
        self._during(SAYS, text, lambda: says(text, PLACE, VOICE, 0.0), PERSON)
        try:
            first = heard.get(timeout=LIMIT)
        except queue.Empty:
            raise SystemExit(f"the robot did not hear {text!r}") from None
        listener.unsubscribe(SUBSCRIBER)
        signal.disconnect(link)
        return first

    def _during(self, what: str, text: str, action: Callable[[], Any], who: str = ROBOT) -> None:
        began = self._notes.now()
        action()
        self._notes.did(who, what, text, began)

    def _time(self) -> float:
        return self._server.runner.snapshot.time
