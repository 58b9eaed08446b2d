"""What sound costs: the pace of the physics while the robot speaks and listens, and how fast it recognises words."""

from __future__ import annotations

import time

from ..row import Figures, Row, at_least
from ..simulator import Simulator
from ..stack import Stack
from ..stats import Sample

ROUNDS = 4
# s of wall time, of each round.
LOOK = 3.0
# s of simulated time.
HEARD = 30.0
VOCABULARY = ["yes", "no", "hello", "goodbye", "stop", "stand up", "sit down", "red", "green", "blue"]
TEXT = "I speak for as long as it takes, and while I speak I listen to what I say, which is not polite. " * 40
LISTENER = "benchmarks"


def listen(simulator: Simulator) -> None:
    """Have the robot listen for words."""
    simulator.ask("ALSpeechRecognition", "setVocabulary", VOCABULARY, False)
    simulator.ask("ALSpeechRecognition", "subscribe", LISTENER)


class PhysicsWithSound(Row):
    """Simulated seconds per wall second in real time, speaking and listening, next to silence."""

    name = "physics_with_sound"
    subject = "simulated s per s in real time, speaking and recognising"
    against = "the same in silence"
    unit = "x"
    bound = at_least(0.98)

    def measure(self, stack: Stack) -> Figures:
        """Look at the clock of a robot that stands, with and without sound in turns."""
        with Simulator.plain("--posture", "Stand") as simulator:
            simulator.wake_up()
            loud, silent = [], []
            for _ in range(ROUNDS):
                silent.append(simulator.pace(LOOK))
                listen(simulator)
                talk = simulator.session.service("ALTextToSpeech").call("say", TEXT, _async=True)
                simulator.ask("NaoSimulation", "advance", 0.5)
                loud.append(simulator.pace(LOOK))
                simulator.ask("ALTextToSpeech", "stopAll")
                talk.wait(int(1000 * LOOK))
                simulator.ask("ALSpeechRecognition", "unsubscribe", LISTENER)
        return Figures.compared(Sample(tuple(loud)), Sample(tuple(silent)), scale=1.0)


class RecognitionSpeed(Row):
    """Seconds of speech that are recognised in a second, with the physics of the robot beside it. Absolute."""

    name = "recognition_speed"
    subject = "s of speech recognised per s, physics included"
    unit = "x"
    bound = at_least(2.0)

    def measure(self, stack: Stack) -> Figures:
        """Let a robot that hears itself talk run as fast as it can; time waits for the recogniser."""
        with Simulator.plain("--posture", "Stand", "--paused") as simulator:
            listen(simulator)
            talk = simulator.session.service("ALTextToSpeech").call("say", TEXT, _async=True)
            simulator.ask("NaoSimulation", "advance", 1.0)
            began = time.perf_counter()
            simulator.ask("NaoSimulation", "advance", HEARD)
            taken = time.perf_counter() - began
            simulator.ask("ALTextToSpeech", "stopAll")
            talk.wait(int(1000 * LOOK))
        return Figures(HEARD / taken)
