"""A stand-in for a robot with sound: texts, files and recordings take as long as the test says."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from fake_robot import FakeConnection, FakeSignal

from naoqi.errors import ConnectionLost, RobotError, RobotUnreachable, UnknownModule


class Memory:
    """ALMemory: events and a few values."""

    def __init__(self):
        self.signals = {}
        self.values = {}

    def subscriber(self, name):
        return SimpleNamespace(signal=self.signals.setdefault(name, FakeSignal()))

    def raise_event(self, name, value):
        if name in self.signals:
            self.signals[name](value)

    def getListData(self, names):
        return [self.values.get(name) for name in names]


class Voice:
    """ALTextToSpeech; every text is pending until the test ends it.

    Attributes:
        texts: (text, language, voice, volume) of each that was begun.
        pending: Its calls.
        begun: Counts what was begun.
    """

    VOICES = {"English": "naoenu", "French": "naofrf"}

    def __init__(self, make_call):
        self._make_call = make_call
        self.language, self.voice, self.volume = "English", "naoenu", 0.5
        self.texts = []
        self.pending = []
        self.begun = threading.Semaphore(0)
        self.deaf = False

    def say(self, text):
        call = self._make_call("ALTextToSpeech.say")
        self.texts.append((text, self.language, self.voice, self.volume))
        self.pending.append(call)
        self.begun.release()
        return call

    def stopAll(self):
        for call in self.pending:
            call.end()

    def getLanguage(self):
        return self.language

    def setLanguage(self, language):
        self.language = self._known(language, self.VOICES, "language")
        self.voice = self.VOICES[language]

    def getVoice(self):
        return self.voice

    def setVoice(self, voice):
        self.voice = self._known(voice, [*self.VOICES.values(), "slt"], "voice")

    def getVolume(self):
        return self.volume

    def setVolume(self, volume):
        self.volume = volume

    @staticmethod
    def _known(name, known, kind):
        if name not in known:
            raise RobotError("ALTextToSpeech", "set", f"no {kind} {name}")
        return name


class Words:
    """ALSpeechRecognition."""

    def __init__(self):
        self.calls = []
        self.subscribers = []
        self.paused = False
        self.vocabulary = ()
        self.unknown = set()
        self.beeps = True

    def getSubscribersInfo(self):
        return [[name, 30, 0.0] for name in self.subscribers]

    def subscribe(self, name):
        self.calls.append("subscribe")
        self.subscribers.append(name)

    def unsubscribe(self, name):
        self.calls.append("unsubscribe")
        self.subscribers.remove(name)

    def pause(self, paused):
        self.paused = paused

    def setVocabulary(self, words, spotting):
        if self.subscribers and not self.paused:
            raise RobotError("ALSpeechRecognition", "setVocabulary", "it runs")
        for word in words:
            if word in self.unknown:
                raise RobotError("ALSpeechRecognition", "setVocabulary", f"cannot say {word}")
        self.calls.append(("setVocabulary", tuple(words), spotting))
        self.vocabulary = tuple(words)

    def getAudioExpression(self):
        return self.beeps

    def setAudioExpression(self, beeps):
        self.beeps = beeps

    def setVisualExpression(self, shows):
        self.shows = shows


class Robot:
    """A robot with the modules of `services`: their methods answer at once, or with a call that the test ends."""

    address = "10.0.0.7:9559"

    def __init__(self, make_call, **services):
        self._make_call = make_call
        self.connection = FakeConnection()
        self.services = services
        self.pending = []

    def proxy(self, name):
        return SimpleNamespace(
            call_async=lambda method, *arguments: self._call(name, method, arguments),
            subscriber=lambda event: self._service(name).subscriber(event),
        )

    def lose(self, reason="cable pulled"):
        """The connection breaks: calls under way fail."""
        for call in self.pending:
            call.end(error=ConnectionLost("10.0.0.7", 9559, reason, call.name))
        self.connection.become("lost", reason)

    def come_back(self):
        self.connection.become("connected")

    def _service(self, name):
        if self.connection.state != "connected":
            raise RobotUnreachable("10.0.0.7", 9559, "not there")
        if name not in self.services:
            raise UnknownModule(name, self.address, [], list(self.services))
        return self.services[name]

    def _call(self, name, method, arguments):
        service = self._service(name)
        call = self._make_call(f"{name}.{method}")
        if method == "ping":
            call.end(True)
            return call
        try:
            result = getattr(service, method)(*arguments)
        except RobotError as error:
            call.end(error=error)
            return call
        if hasattr(result, "add_done_callback"):
            self.pending.append(result)
            return result
        call.end(result)
        return call
