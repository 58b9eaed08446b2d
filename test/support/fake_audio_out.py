"""Stand-ins for what the robot is heard with: sounds last until the test ends them."""

from __future__ import annotations

import threading

from naoqi.errors import RobotError, UnknownModule


class Sounding:
    """Calls that last as long as something sounds.

    Attributes:
        started: Set when one begins.
        pending: Those that have begun, in order.
        quick: Whether a sound is over as soon as it begins.
        stops: How often everything was silenced.
    """

    def __init__(self, module, make_call):
        self._module = module
        self._make_call = make_call
        self.started = threading.Event()
        self.pending = []
        self.quick = True
        self.stops = 0

    def last(self, method):
        if self.quick:
            return None
        call = self._make_call(f"{self._module}.{method}")
        self.pending.append(call)
        self.started.set()
        return call

    def stopAll(self):
        self.stops += 1
        for call in self.pending:
            call.end()


class FakeSpeech(Sounding):
    """ALTextToSpeech with two voices."""

    def __init__(self, make_call):
        super().__init__("ALTextToSpeech", make_call)
        self.voices = {"naoenu": "English", "naofrf": "French"}
        self.voice = "naoenu"
        self.volume = 0.75
        self.parameters = {"speed": 100.0, "pitchShift": 1.0}
        self.words = {}
        self.said = []

    def getAvailableVoices(self):
        return list(self.voices)

    def getAvailableLanguages(self):
        return list(self.voices.values())

    def getSupportedLanguages(self):
        return [*self.voices.values(), "Klingon"]

    def say(self, *text):
        self.said.append((text, self.voice, self.volume))
        return self.last("say")

    def sayToFile(self, text, file):
        self.said.append(((text, file), self.voice, self.volume))

    def sayToFileAndPlay(self, text):
        return self.say(text)

    def getVoice(self):
        return self.voice

    def setVoice(self, voice):
        self.voice = voice

    def getLanguage(self):
        return self.voices[self.voice]

    def setLanguage(self, language):
        self.voice = next(voice for voice, spoken in self.voices.items() if spoken == language)

    def setLanguageDefaultVoice(self, language, voice):
        pass

    def locale(self):
        return "en_US"

    def getVolume(self):
        return self.volume

    def setVolume(self, volume):
        self.volume = volume

    def getParameter(self, name):
        return self.parameters.get(name, 0.0)

    def setParameter(self, name, value):
        self.parameters[name] = value

    def resetSpeed(self):
        self.parameters["speed"] = 100.0

    def reset(self):
        self.volume = 1.0

    def loadVoicePreference(self, name):
        raise RobotError("ALTextToSpeech", "loadVoicePreference", f"there is no preference {name}")

    def addToDictionary(self, *words):
        self.words[words[0]] = words[1:]
        return True

    def deleteFromDictionary(self, *words):
        return self.words.pop(words[0], None) is not None

    def showDictionary(self):
        pass


class FakeAnimatedSpeech:
    """ALAnimatedSpeech: speaks through ALTextToSpeech."""

    def __init__(self, speech):
        self._speech = speech
        self.mode = "contextual"
        self.tags = {}

    def say(self, *arguments):
        return self._speech.say(*arguments)

    def getBodyLanguageModeToStr(self):
        return self.mode

    def setBodyLanguageModeFromStr(self, mode):
        self.mode = mode

    def addTagsToWords(self, tags):
        self.tags.update(tags)

    declareTagForAnimations = addTagsToWords

    def declareAnimationsPackage(self, package):
        pass


class FakePlayer(Sounding):
    """ALAudioPlayer; each file is 1.5 s long, except `missing.wav`."""

    def __init__(self, make_call):
        super().__init__("ALAudioPlayer", make_call)
        self.ids = {}
        self.volumes = {}
        self.master = 1.0

    def loadFile(self, name):
        self._require(name)
        number = len(self.ids) + 7
        self.ids[number] = name
        return number

    def unloadFile(self, number):
        del self.ids[number]

    def unloadAllFiles(self):
        self.ids.clear()

    def getLoadedFilesIds(self):
        return list(self.ids)

    def getLoadedFilesNames(self):
        return list(self.ids.values())

    def getFileLength(self, number):
        return 1.5

    def getCurrentPosition(self, number):
        return 0.5

    def playFile(self, name, *_):
        self._require(name)
        return self.last("playFile")

    playFileInLoop = playFileFromPosition = playFile

    def playWebStream(self, *_):
        return self.last("playWebStream")

    def playSine(self, *_):
        return self.last("playSine")

    def playSoundSetFile(self, *_):
        return self.last("playSoundSetFile")

    def play(self, number, *_):
        if number not in self.ids:
            raise RobotError("ALAudioPlayer", "play", f"no sound {number}")
        return self.last("play")

    playInLoop = play

    def pause(self, number):
        pass

    goTo = setPitch = setPanorama = lambda *_: None
    disablePitch = loadSoundSet = unloadSoundSet = pause

    def getVolume(self, number):
        return self.volumes.get(number, 1.0)

    def setVolume(self, number, volume):
        self.volumes[number] = volume

    def getMasterVolume(self):
        return self.master

    def setMasterVolume(self, volume):
        self.master = volume

    def getInstalledSoundSetsList(self):
        return ["Bips"]

    getLoadedSoundSetsList = getInstalledSoundSetsList

    def getSoundSetFileNames(self, name):
        return ["ding.wav"]

    def isSoundSetInstalled(self, name):
        return name == "Bips"

    isSoundSetLoaded = isSoundSetInstalled

    def isSoundSetFileInstalled(self, name, file):
        return file == "ding.wav"

    def _require(self, name):
        if name == "missing.wav":
            raise RobotError("ALAudioPlayer", "loadFile", f"no file {name}")


class FakeAudioDevice:
    """ALAudioDevice as far as it is heard."""

    def __init__(self):
        self.volume = 60
        self.muted = False
        self.closed = {"input": False, "output": False}
        self.parameters = {"outputSampleRate": 48000, "inputBufferSize": 8160}

    def getOutputVolume(self):
        return self.volume

    def setOutputVolume(self, volume):
        self.volume = volume

    def isAudioOutMuted(self):
        return self.muted

    def muteAudioOut(self, mute):
        self.muted = mute

    def flushAudioOutputs(self):
        pass

    def openAudioOutputs(self):
        self.closed["output"] = False

    def closeAudioOutputs(self):
        self.closed["output"] = True

    def isOutputClosed(self):
        return self.closed["output"]

    def openAudioInputs(self):
        self.closed["input"] = False

    def closeAudioInputs(self):
        self.closed["input"] = True

    def isInputClosed(self):
        return self.closed["input"]

    def listOutputs(self):
        return [["speakers", 2]]

    def listInputs(self):
        return [["microphones", 4]]

    def getParameter(self, name):
        return self.parameters[name]

    def setParameter(self, name, value):
        self.parameters[name] = value


class NoModule:
    """A module that the robot does not have."""

    def __init__(self, name):
        self.__dict__["name"] = name

    def __getattr__(self, method):
        raise UnknownModule(self.name, "10.0.0.7:9559", [], ["ALMemory", "ALMotion"])
