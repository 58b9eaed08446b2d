"""The dialogue in README.md's picture: a person calls, the robot turns to the voice, asks, listens, answers and nods.

It does over libqi what the example dialogue.py does with goals, so that drawing it needs no ROS.
"""

from __future__ import annotations

import math
import threading
from pathlib import Path
from typing import Any

import qi

from nao_library_modules.dialogue_record import DOES, HEARS, PERSON, ROBOT, SAYS, Turn
from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene

CALL, QUESTION, REPLY, THANKS = "Hello, robot!", "Shall we play?", "Yes!", "Great!"
WORDS = ["yes", "no", "maybe", "later"]
# Where the person's mouth is, in world, m.
PLACE = [1.0, 0.4, 0.6]
VOICE = "rms"
# Which of left, right, front, rear are recorded, and at which rate, Hz.
FRONT, RATE = [0, 0, 1, 0], 16000
LOCATED, RECOGNISED = "ALSoundLocalization/SoundLocated", "WordRecognized"
# From readiness to the first word of a person, and after the last turn, s.
REACTION, END = 0.8, 0.5
SURE = 0.5
NOD = ([0.3, -0.2, 0.3, 0.0], [0.4, 0.8, 1.2, 1.6])
LIMIT = 30.0


class Dialogue:
    """A dialogue in a simulator, with its recording.

    Attributes:
        turns: What has been said, heard and done, in s from the beginning of the recording.

    Args:
        folder: Where the recording goes.
    """

    def __init__(self, folder: Path) -> None:
        self.turns: list[Turn] = []
        # Slow, for between calls time goes on; but faster than real, for then it waits until a voice is synthesised.
        self._server = SimulatorServer(ServerOptions(Scene(), port=0, speed=2.0, record_dir=folder))
        self._session = qi.Session()
        self._began = 0.0

    def record(self, name: str) -> None:
        """Have the dialogue, and write what the front microphones hear to a file."""
        self._server.start()
        try:
            self._session.connect(f"tcp://127.0.0.1:{self._server.broker.port}")
            self._session.service("ALRobotPosture").goToPosture("Stand", 0.8)
            self._session.service("ALSpeechRecognition").setVocabulary(WORDS, False)
            recorder = self._session.service("ALAudioRecorder")
            recorder.startMicrophonesRecording(name, "wav", RATE, FRONT)
            self._began = self._server.runner.snapshot.time
            self._talk()
            self._pass(END)
            recorder.stopMicrophonesRecording()
        finally:
            self._session.close()
            self._server.stop()

    def _talk(self) -> None:
        motion, speech = self._session.service("ALMotion"), self._session.service("ALTextToSpeech")
        located, _ = self._hear("ALSoundLocalization", LOCATED, CALL, lambda value: value[1][2] >= SURE)
        azimuth = located[1][0]
        self._turn(ROBOT, HEARS, f"a voice at {math.degrees(azimuth):.0f}°", located[1][2])
        self._during(DOES, "turns its head", lambda: motion.angleInterpolation("HeadYaw", azimuth, 0.8, True))
        self._during(SAYS, QUESTION, lambda: speech.say(QUESTION))
        (word, confidence, *_), _ = self._hear("ALSpeechRecognition", RECOGNISED, REPLY, lambda value: value[0] != "")
        self._turn(ROBOT, HEARS, word, confidence)
        self._during(SAYS, THANKS, lambda: speech.say(THANKS))
        self._during(DOES, "nods", lambda: motion.angleInterpolation("HeadPitch", *NOD, True))

    def _hear(self, module: str, event: str, text: str, good: Any) -> tuple[Any, float]:
        """Subscribe a module, have the person speak, and wait for an event; its value and when it came, s."""
        heard, values = threading.Event(), []

        def take(value: Any) -> None:
            if good(value) and not heard.is_set():
                values.append((value, self._now()))
                heard.set()

        subscriber = self._session.service("ALMemory").subscriber(event)
        link = subscriber.signal.connect(take)
        listener = self._session.service(module)
        listener.subscribe("picture")
        self._pass(REACTION)
        began = self._now()
        self._session.service("NaoSimulation").personSays(text, PLACE, VOICE, 0.0)
        self._turn_between(PERSON, SAYS, text, began)
        if not heard.wait(LIMIT):
            raise SystemExit(f"the robot did not hear {text!r}")
        listener.unsubscribe("picture")
        subscriber.signal.disconnect(link)
        self._last = values[0][1]
        return values[0]

    def _during(self, what: str, text: str, action: Any) -> None:
        began = self._now()
        action()
        self._turn_between(ROBOT, what, text, began)

    def _turn(self, who: str, what: str, text: str, confidence: float) -> None:
        self.turns.append(Turn(who, what, text, self._last, self._last, confidence))

    def _turn_between(self, who: str, what: str, text: str, began: float) -> None:
        self.turns.append(Turn(who, what, text, began, self._now()))

    def _pass(self, seconds: float) -> None:
        self._server.runner.advance(seconds).result(LIMIT)

    def _now(self) -> float:
        return self._server.runner.snapshot.time - self._began
