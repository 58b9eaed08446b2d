"""What audio goals answer, set and put back, refuse before anything sounds, and tell of a robot that lacks a module."""

from __future__ import annotations

import io
import json
import math

from genpy import Duration
from goal_functions import audio_out as f
from sounds import played, tone, write

from nao_library_modules.core.memory_functions import MemoryFunctions
from nao_library_msgs.msg import AudioOutFunction

NAN = math.nan


BIP, SET = "nao_library/bip.ogg", "nao_library"
ONCE = {"file_name": "bip", "volume": 0.5}
# Every function once, in an order in which each finds what it needs, and its answers.
EVERY = [
    (f("getAvailableVoices"), None),
    (f("getAvailableLanguages"), None),
    (f("getSupportedLanguages"), None),
    (f("getVoice"), ["naoenu"]),
    (f("setVoice", "rms", revert=True), []),
    (f("getLanguage"), ["English"]),
    (f("setLanguage", "French"), []),
    (f("getVoice"), ["naofrf"]),
    (f("locale"), ["fr_FR"]),
    (f("setLanguage", "English"), []),
    (f("setLanguageDefaultVoice", "English", voice="naoenu"), []),
    (f("setParameter", names=["pitchShift", "speed"], values=[1.5, 80], revert=True), []),
    (f("setParameter", names=["speed"], values=[150]), []),
    (f("getParameter", names=["speed", "pitchShift"]), ["150.0", "1.0"]),
    (f("setParameter", "outputSampleRate", values=[16000]), []),
    (f("getParameter", "outputSampleRate"), ["16000"]),
    (f("resetSpeed"), []),
    (f("addToDictionary", "NAO", texts=["now"]), ["True"]),
    (f("addToDictionary", "noun", texts=["ab", "1", "another one", "0"]), ["True"]),
    (f("showDictionary"), []),
    (f("deleteFromDictionary", "NAO"), ["True"]),
    (f("deleteFromDictionary", "noun", texts=["ab"]), ["True"]),
    (f("loadVoicePreference", "mine"), []),
    (f("getVolume"), ["0.3"]),
    (f("setVolume", volume=0.5, revert=True), []),
    (f("getVolume"), ["0.3"]),
    (f("setBodyLanguageMode", body_language="random", revert=True), []),
    (f("getBodyLanguageMode"), ["contextual"]),
    (f("declareTagForAnimations", "hello", texts=["animations/Stand/Gestures/Hey_1"]), []),
    (f("addTagsToWords", "hello", texts=["hi"]), []),
    (f("declareAnimationsPackage", "mine"), []),
    (f("reset"), []),
    (f("say", "Yes."), []),
    (f("animatedSay", "Yes."), []),
    (f("sayToFile", "Yes.", file_name="yes.wav"), None),
    (f("sayToFile", "No.", file_name="yes.wav", overwrite=True), None),
    (f("sayToFileAndPlay", "Yes."), []),
    (f("playFile", BIP), []),
    (f("playFileFromPosition", BIP, position=0.05), []),
    (f("playFileInLoop", BIP), []),
    (f("playSine", frequency=440, duration=0.1), []),
    (f("stopAll"), []),
    (f("waitUntilSilent"), []),
    (f("loadFile", BIP), None),
    (f("getLoadedFilesIds"), None),
    (f("getLoadedFilesNames"), [BIP]),
    (f("getFileLength"), None),
    (f("goTo", position=0.01), []),
    (f("getCurrentPosition"), ["0.01"]),
    (f("setPitch", pitch=1.5), []),
    (f("disablePitch"), []),
    (f("play"), []),
    (f("playInLoop"), []),
    (f("pause"), []),
    (f("setPanorama", pan=0.0), []),
    (f("setMasterVolume", volume=0.5, revert=True), []),
    (f("getMasterVolume"), ["1.0"]),
    (f("unloadFile"), []),
    (f("unloadAllFiles"), []),
    (f("getLoadedFilesIds"), []),
    (f("getInstalledSoundSetsList"), None),
    (f("isSoundSetInstalled", SET), ["True"]),
    (f("loadSoundSet", SET), []),
    (f("isSoundSetLoaded", SET), ["True"]),
    (f("getLoadedSoundSetsList"), [SET]),
    (f("getSoundSetFileNames", SET), None),
    (f("isSoundSetFileInstalled", SET, file_name="bip"), ["True"]),
    (f("isSoundSetFileInstalled", SET, file_name="bop"), ["False"]),
    (f("playSoundSetFile", SET, **ONCE), []),
    (f("playSoundSetFile", **ONCE), []),
    (f("unloadSoundSet", SET), []),
    (f("isSoundSetLoaded", SET), ["False"]),
    (f("setOutputVolume", volume=80, revert=True), []),
    (f("getOutputVolume"), ["100"]),
    (f("muteAudioOut", enable=True, revert=True), []),
    (f("isAudioOutMuted"), ["False"]),
    (f("flushAudioOutputs"), []),
    (f("closeAudioOutputs"), []),
    (f("isOutputClosed"), ["True"]),
    (f("openAudioOutputs"), []),
    (f("isOutputClosed"), ["False"]),
    (f("closeAudioInputs"), []),
    (f("isInputClosed"), ["True"]),
    (f("openAudioInputs"), []),
    (f("isInputClosed"), ["False"]),
    (f("listOutputs"), ["loudspeakers"]),
    (f("listInputs"), ["microphones"]),
]


def test_every_function_is_carried_out_and_answers(robot, audio):
    write(robot, BIP, tone(440.0, 0.1))
    folder, lift = robot.server.files.folder, {"times": [1.0], "angles": [0.0]}
    (folder / "ALTextToSpeech_Voice_mine.json").write_text(json.dumps({"volume": 0.3}))
    (folder / "mine.json").write_text(
        json.dumps({"animations": {"mine/Lift": {"length": 2.0, "joints": {"LHand": lift}}}})
    )
    known = set(audio.module.function_table)
    assert {each.function for each, _ in EVERY} == known - set(MemoryFunctions.functions) - {"playWebStream"}
    result = audio.succeed(*(each for each, _ in EVERY))
    assert [done.function for done in result.results] == [each.function for each, _ in EVERY]
    for (each, expected), done in zip(EVERY, result.results):
        assert expected is None or list(done.values) == expected, each.function
    answers = {done.function: list(done.values) for done in result.results}
    assert {"naoenu", "rms"} <= set(answers["getAvailableVoices"]) and "bip" in answers["getSoundSetFileNames"]
    assert float(answers["getFileLength"][0]) > 0.05 and SET in answers["getInstalledSoundSetsList"]


def test_a_file_is_not_replaced_unasked(audio):
    write = f("sayToFile", "Yes.", file_name="kept.wav")
    for chain in ([write, write], [write]):  # the second of a chain, or of two goals
        text = audio.refused(*chain)
        assert f"function {len(chain)} (sayToFile): field file_name: kept.wav is there already" in text
        assert text.endswith("another name, or overwrite")


def test_what_is_set_goes_back_after_the_wait_also_when_that_is_cancelled(robot, audio):
    device, speech, player = robot.ALAudioDevice, robot.ALTextToSpeech, robot.ALAudioPlayer

    def now():
        volume, voice, master = speech.getVolume(), speech.getVoice(), player.getMasterVolume()
        return device.getOutputVolume(), device.isAudioOutMuted(), voice, round(volume, 3), round(master, 3)

    before, wait = now(), 0.5
    assert before == (100, False, "naoenu", 1.0, 1.0)
    for function, changed in [
        (f("setOutputVolume", volume=20, revert=True, time=wait), (20, False, "naoenu", 1.0, 1.0)),
        (f("muteAudioOut", enable=True, revert=True, time=wait), (100, True, "naoenu", 1.0, 1.0)),
        (f("setVoice", "rms", revert=True, time=wait), (100, False, "rms", 1.0, 1.0)),
        (f("setLanguage", "French", revert=True, time=wait), (100, False, "naofrf", 1.0, 1.0)),
        (f("setVolume", volume=0.1, revert=True, time=wait), (100, False, "naoenu", 0.1, 1.0)),
        (f("setMasterVolume", volume=0.2, revert=True, time=wait), (100, False, "naoenu", 1.0, 0.2)),
    ]:
        for end in ("succeeded", "preempted"):
            goal = audio.send(function)
            robot.advance(0.3)
            assert now() == changed, function.function
            (goal.cancel if end == "preempted" else goal.finish)()
            assert (goal.state, now()) == (end, before)
    result = audio.succeed(f("setOutputVolume", volume=20), f("setLanguage", "French"), f("getOutputVolume"))
    assert now() == (20, False, "naofrf", 1.0, 1.0) and (result.memList, result.volume) == (["20"], 20.0)


# Function, its fields, and for each of some fields: values that are refused, and the words of the text.
HI, WAV = {"str_param": "Hi"}, {"str_param": "a.wav"}
EMPTY = ("str_param", ["", " \n\t"], "field str_param: it is empty")
LEVEL = ("volume", [1.5, -0.1, NAN], "is not allowed: 0..1")
LASTS = ("duration", [-1, NAN, 3601], "3600 s")
OUT = ("str_param", ["/etc/a.wav", "/home/nao/../a.wav", "../a.wav"], "leads out of the folders for sounds")
KIND = ("str_param", ["sounds", "a.txt"], "is not a file of a known kind")
SINE = {"frequency": 440, "duration": 1}
UNLOADED = ("str_param", ["a.wav"], "'a.wav' is not loaded: loadFile comes first")
NONE_LOADED = ("sound_id", [0], "field sound_id: no sound is loaded: loadFile comes first")
LANGUAGE = ("language", ["Klingon"], "'Klingon' is no language that the robot speaks: one of English")
VOICE = ("voice", ["naoenx"], "'naoenx' is no voice of the robot: did you mean 'naoenu'")
STYLE = [LEVEL, LANGUAGE, VOICE, ("speed", [20, 401], "50..400 %"), ("pitch", [300, 49], "50..200 %")]
REFUSED = [
    ("sya", {}, [("volume", [0.0], "unknown function 'sya': did you mean 'say'")]),
    ("say", HI, [EMPTY, *STYLE, ("time", [-1], "field time: -1.0")]),
    ("say", {**HI, "background": True}, [("voice", ["naofrf"], "nothing"), ("volume", [0.5], "nothing")]),
    ("animatedSay", HI, [EMPTY, *STYLE, ("body_language", ["wild"], "'wild' is not known: one of disabled, random")]),
    ("sayToFile", HI, [("file_name", [""], "field file_name: it is empty"), ("file_name", ["hi.mp3"], "known kind")]),
    ("setVoice", {}, [EMPTY, ("str_param", ["Microsoft Sam"], "'Microsoft Sam' is no voice of the robot")]),
    ("setLanguageDefaultVoice", {"str_param": "English"}, [("voice", [""], "field voice: it is empty"), VOICE]),
    ("setVolume", {"volume": 0.5}, [UNLOADED, ("sound_id", [-1], "field sound_id: -1 is not allowed")]),
    ("setMasterVolume", {}, [LEVEL]),
    ("setOutputVolume", {}, [("volume", [101, 0.5, -1, NAN, 1e300], "is not allowed: a whole number 0..100 (%)")]),
    ("setParameter", {"values": [1]}, [("names", [["pich"]], "no parameter of the voice: did you mean 'pitch'")]),
    ("setParameter", {"names": ["speed"]}, [("values", [[]], "field values: [] is not allowed: 1: one for each")]),
    ("setParameter", {"names": ["speed"]}, [("values", [[10], [1000], [NAN]], "speed is 50..400")]),
    ("setParameter", {"str_param": "outputSampleRate"}, [("values", [[8000]], "one of 16000, 22050, 44100, 48000")]),
    ("getParameter", {}, [("str_param", ["loudness"], "no parameter")]),
    ("addToDictionary", {"str_param": "NAO"}, [("texts", [[], [" "]], "is not allowed: how it is spoken")]),
    ("setBodyLanguageMode", {}, [("body_language", ["", "wild"], "is not known: one of disabled, random, contextual")]),
    ("addTagsToWords", {"str_param": "hello"}, [("texts", [[]], "field texts: [] is not allowed")]),
    ("playFile", WAV, [EMPTY, OUT, KIND, LEVEL, LASTS, ("pan", [-2, NAN], "is not allowed: -1 (left) .. 1 (right)")]),
    ("playFile", {**WAV, "background": True}, [("duration", [1], "0 for a sound in the background")]),
    ("playFileFromPosition", WAV, [EMPTY, LEVEL, LASTS, ("position", [-1, NAN], "field position")]),
    ("playSine", SINE, [("frequency", [0, 440.5, NAN, 1e6], "is not allowed: a whole number 20..20000 (Hz)"), LEVEL]),
    ("playSine", SINE, [("duration", [0, -1, NAN], "0.001..3600 s"), ("pan", [0.5], "-1 (left), 0 or 1")]),
    ("playWebStream", {}, [("str_param", ["file:///a", "ftp://x/y"], "begins with http:// or https://")]),
    *((name, {}, [NONE_LOADED, UNLOADED]) for name in ("play", "pause", "unloadFile", "goTo", "setPitch")),
    ("goTo", {"sound_id": 7}, [("position", [NAN, -1], "field position")]),
    ("setPitch", {"sound_id": 7}, [("pitch", [NAN], "field pitch")]),
    ("setPanorama", {}, [("pan", [1.5, NAN], "is not allowed")]),
    (
        "playSoundSetFile",
        {"file_name": "x"},
        [("str_param", ["nao_libary"], "no sound set of the robot: did you mean")],
    ),
    ("loadSoundSet", {}, [EMPTY, ("str_param", ["Bops"], "'Bops' is no sound set of the robot")]),
]


def as_it_arrives(name, fields):
    """A message with numbers of the types that its fields have."""
    message = AudioOutFunction(function=name, **{**fields, "time": Duration.from_sec(fields.get("time", 0))})
    wire = io.BytesIO()
    message.serialize(wire)
    return AudioOutFunction().deserialize(wire.getvalue())


def test_what_is_wrong_is_told_and_nothing_sounds(robot, audio):
    begun = robot.now.time
    assert audio.refused().startswith("field functions: the chain is empty")
    for name, fields, wrong in REFUSED:
        for field, values, words in wrong:
            for value in values:
                text = audio.refused(f("say", "Hello"), as_it_arrives(name, {**fields, field: value}))
                assert text.startswith(f"function 2 ({name}): ") and words in text, (name, field, value, text)
    robot.advance(0.3)
    assert not played(robot, begun).any() and robot.ALAudioDevice.getOutputVolume() == 100
    assert audio.succeed(f("getVoice")).memList == ["naoenu"]
