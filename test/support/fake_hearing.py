"""Stand-ins for NAOqi's modules that hear. What they hear is told by the test, through the events of the memory."""

from __future__ import annotations

from fake_subscriptions import FakeSubscriptions

from naoqi.errors import RobotError, UnknownMethod


class FakeExtractor(FakeSubscriptions):
    """Works for its subscribers.

    Attributes:
        parameters: Name -> value.
    """

    def __init__(self):
        super().__init__()
        self.parameters = {"Sensitivity": 0.9}

    def setParameter(self, name, value):
        self.parameters[name] = value

    def getParameter(self, name):
        if name not in self.parameters:
            raise RobotError(self.name, "getParameter", f"no parameter {name}")
        return self.parameters[name]


class FakeRecognition(FakeExtractor):
    """Refuses what NAOqi refuses: a vocabulary while it runs, words that it cannot pronounce.

    Attributes:
        vocabulary: Words and whether they are spotted.
        stack: Vocabularies that were pushed.
        unknown: Words that it cannot pronounce.
        paused: Whether it is paused.
        keeps: Whether it has pushContexts.
    """

    name = "ALSpeechRecognition"

    def __init__(self, memory):
        super().__init__()
        self._memory = memory
        self.vocabulary = ([], False)
        self.stack = []
        self.unknown = {"qxzt"}
        self.paused = False
        self.keeps = True
        self.language = "English"
        self.audio_expression = True
        self._tell()

    @property
    def runs(self):
        return bool(self.subscribers) and not self.paused

    def _tell(self):
        self._memory.data["ALSpeechRecognition/IsRunning"] = self.runs

    def _require_idle(self, method):
        if self.runs:
            raise RobotError(self.name, method, "the engine runs: pause it")

    def subscribe(self, name):
        if not self.vocabulary[0]:
            raise RobotError(self.name, "subscribe", "there is no vocabulary")
        super().subscribe(name)
        self._tell()

    def unsubscribe(self, name):
        super().unsubscribe(name)
        self._tell()

    def pause(self, pause):
        self.paused = pause
        self._tell()

    def setVocabulary(self, words, spotting):
        self._require_idle("setVocabulary")
        for word in words:
            if word in self.unknown:
                raise RobotError(self.name, "setVocabulary", f"no pronunciation for {word}")
        self.vocabulary = (words, spotting)

    def pushContexts(self):
        if not self.keeps:
            raise UnknownMethod(self.name, "pushContexts", [], ["setVocabulary"])
        self.stack.append(self.vocabulary)

    def popContexts(self):
        self._require_idle("popContexts")
        self.vocabulary = self.stack.pop()

    def getLanguage(self):
        return self.language

    def setLanguage(self, language):
        self.language = language

    def getAvailableLanguages(self):
        return ["English", "French"]

    def setAudioExpression(self, on):
        self.audio_expression = on

    def getAudioExpression(self):
        return self.audio_expression

    def setVisualExpression(self, on):
        return None


class FakeRecorder:
    """Records nothing; one recording at a time.

    Attributes:
        running: Arguments of the recording that runs.
        done: Files that were closed.
    """

    def __init__(self):
        self.running = None
        self.done = []

    def startMicrophonesRecording(self, file, kind, rate, flags):
        if self.running:
            raise RobotError("ALAudioRecorder", "startMicrophonesRecording", "a recording runs already")
        self.running = (file, kind, rate, flags)

    def stopMicrophonesRecording(self):
        if self.running:
            self.done.append(self.running[0])
        self.running = None


class FakeSoundCard:
    """ALAudioDevice, as far as it hears. Energies count the blocks while they are computed."""

    def __init__(self):
        self.computing = False
        self.blocks = 0
        self.file = None
        self.volume = 60
        self.parameters = {"outputSampleRate": 48000}

    def _energy(self, share):
        if self.computing:
            self.blocks += 1
        return float(100 * share + self.blocks)

    def getLeftMicEnergy(self):
        return self._energy(1)

    def getRightMicEnergy(self):
        return self._energy(2)

    def getFrontMicEnergy(self):
        return self._energy(3)

    def getRearMicEnergy(self):
        return self._energy(4)

    def enableEnergyComputation(self):
        self.computing = True

    def disableEnergyComputation(self):
        self.computing = False

    def setFileAsInput(self, file):
        self.file = file

    def setOutputVolume(self, volume):
        self.volume = volume

    def getOutputVolume(self):
        return self.volume

    def setParameter(self, name, value):
        self.parameters[name] = value

    def getParameter(self, name):
        return self.parameters[name]


class Ears:
    """The stand-ins of one robot."""

    def __init__(self, robot):
        self.memory = robot.memory
        self.recognition = FakeRecognition(robot.memory)
        self.detection, self.localization = FakeExtractor(), FakeExtractor()
        self.recorder, self.card = FakeRecorder(), FakeSoundCard()
        robot.add("ALSpeechRecognition", self.recognition)
        robot.add("ALSoundDetection", self.detection)
        robot.add("ALSoundLocalization", self.localization)
        robot.add("ALAudioRecorder", self.recorder)
        robot.add("ALAudioDevice", self.card)

    def raise_event(self, name, value):
        self.memory.signals[name](value)

    def idle(self):
        """Nobody listens, nothing records, no event is subscribed."""
        extractors = (self.recognition, self.detection, self.localization)
        assert [extractor.subscribers for extractor in extractors] == [[], [], []]
        assert self.recorder.running is None
        assert not self.card.computing
        assert not any(signal.links for signal in self.memory.signals.values())
        return True


class HearingClock:
    """Time that passes only while somebody waits; `script` says what happens in the waits, one after the other.

    Attributes:
        time: s.
        waits: How long it was waited for, s.
        script: Functions, one for each of the next waits; an event in it ends the wait.
    """

    def __init__(self):
        self.time = 100.0
        self.waits = []
        self.script = []

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.waits.append(duration)
        if self.script:
            self.script.pop(0)()
        if interrupt.is_set():
            self.time += min(duration, 0.1)
            return False
        self.time += duration
        return True
