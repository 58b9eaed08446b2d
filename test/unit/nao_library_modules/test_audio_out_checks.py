"""What audio goals may not hold: each is refused before anything sounds, with a text that says why."""

from __future__ import annotations

import io
import math

import pytest
from fake_audio_out import FakeAnimatedSpeech, FakeAudioDevice, FakePlayer, FakeSpeech
from genpy import Duration

from nao_library_actions.msg import NaoAudioOutGoal
from nao_library_modules.audio_checks import require_file
from nao_library_modules.errors import BadGoal
from nao_library_modules.field_checks import require_whole
from nao_library_msgs.msg import AudioOutFunction

NAN, INFINITE = math.nan, math.inf

# Function, fields, and what the text says.
REFUSED = [
    ("sya", {}, "unknown function 'sya': did you mean 'say'"),
    ("say", {}, "field str_param: it is empty: the text to say"),
    ("say", {"str_param": " \n\t"}, "field str_param: it is empty"),
    ("say", {"str_param": "Hi", "time": -1}, "field time: -1.0 is not allowed"),
    ("say", {"str_param": "Hi", "volume": 1.5}, "field volume: 1.5 is not allowed: 0..1"),
    ("say", {"str_param": "Hi", "volume": -0.1}, "field volume: -0.1 is not allowed: 0..1"),
    ("say", {"str_param": "Hi", "volume": NAN}, "field volume: nan is not allowed: 0..1"),
    ("say", {"str_param": "Hi", "speed": 20}, "field speed: 20.0 is not allowed: 50..400 %"),
    ("say", {"str_param": "Hi", "speed": INFINITE}, "field speed: inf is not allowed"),
    ("say", {"str_param": "Hi", "pitch": 300}, "field pitch: 300.0 is not allowed: 50..200 %"),
    (
        "say",
        {"str_param": "Hi", "language": "Klingon"},
        "'Klingon' is no language that the robot speaks: one of English",
    ),
    ("say", {"str_param": "Hi", "language": "Englsh"}, "did you mean 'English'"),
    ("say", {"str_param": "Hi", "voice": "naoenx"}, "'naoenx' is no voice of the robot: did you mean 'naoenu'"),
    (
        "say",
        {"str_param": "Hi", "voice": "naofrf", "background": True},
        "field voice: 'naofrf' is not allowed: nothing",
    ),
    ("say", {"str_param": "Hi", "volume": 0.5, "background": True}, "field volume: 0.5 is not allowed: nothing"),
    ("animatedSay", {}, "field str_param: it is empty"),
    ("animatedSay", {"str_param": "Hi", "body_language": "wild"}, "'wild' is not known: one of disabled, random"),
    ("animatedSay", {"str_param": "Hi", "language": "French", "background": True}, "field language: 'French'"),
    ("sayToFile", {"str_param": "Hi"}, "field file_name: it is empty: the name of a file"),
    ("sayToFile", {"str_param": "Hi", "file_name": "hi.mp3"}, "'hi.mp3' is not a file of a known kind"),
    ("sayToFile", {"str_param": "Hi", "file_name": "../hi.wav"}, "'../hi.wav' leads out of the folder for sounds"),
    ("sayToFile", {"str_param": "", "file_name": "hi.wav"}, "field str_param: it is empty"),
    ("sayToFileAndPlay", {}, "field str_param: it is empty"),
    ("setVoice", {}, "field str_param: it is empty: the name of a voice"),
    ("setVoice", {"str_param": "Microsoft Sam"}, "'Microsoft Sam' is no voice of the robot"),
    ("setLanguage", {"str_param": "english"}, "did you mean 'English'"),
    ("setLanguageDefaultVoice", {"str_param": "English"}, "field voice: it is empty"),
    ("setLanguageDefaultVoice", {"str_param": "Elvish", "voice": "naoenu"}, "'Elvish' is no language"),
    ("setVolume", {"volume": 50}, "field volume: 50.0 is not allowed: 0..1"),
    ("setVolume", {"volume": 0.5, "str_param": "one.wav"}, "'one.wav' is not loaded: loadFile comes first"),
    ("getVolume", {"sound_id": -4}, "field sound_id: -4 is not allowed"),
    ("setMasterVolume", {"volume": 1.01}, "field volume: 1.01 is not allowed: 0..1"),
    ("setOutputVolume", {"volume": 101}, "field volume: 101.0 is not allowed: a whole number 0..100 (%)"),
    ("setOutputVolume", {"volume": 0.5}, "field volume: 0.5 is not allowed: a whole number 0..100 (%)"),
    ("setOutputVolume", {"volume": NAN}, "field volume: nan is not allowed"),
    ("setParameter", {}, "field names: nothing is named: one or more of speed"),
    ("setParameter", {"names": ["pich"], "values": [1]}, "'pich' is no parameter of the voice: did you mean 'pitch'"),
    ("setParameter", {"names": ["speed"]}, "field values: [] is not allowed: 1: one for each of speed"),
    ("setParameter", {"names": ["speed"], "values": [10]}, "field values: 10.0 is not allowed: speed is 50..400"),
    ("setParameter", {"names": ["pitchShift"], "values": [0.5]}, "pitchShift is 0 (off) or 1..4"),
    ("setParameter", {"str_param": "outputSampleRate", "values": [8000]}, "one of 16000, 22050, 44100, 48000 (Hz)"),
    ("setParameter", {"str_param": "inputBufferSize", "values": [1]}, "'inputBufferSize' is no parameter"),
    ("getParameter", {"str_param": "loudness"}, "'loudness' is no parameter"),
    ("getParameter", {"names": ["outputSampleRate"]}, "'outputSampleRate' is no parameter of the voice"),
    ("addToDictionary", {"texts": ["now"]}, "field str_param: it is empty: the word"),
    ("addToDictionary", {"str_param": "NAO"}, "field texts: [] is not allowed: how it is spoken"),
    ("addToDictionary", {"str_param": "NAO", "texts": [" "]}, "field texts: [' '] is not allowed"),
    ("deleteFromDictionary", {"str_param": "NAO", "texts": ["a", "b"]}, "field texts: ['a', 'b'] is not allowed"),
    ("loadVoicePreference", {}, "field str_param: it is empty"),
    ("setBodyLanguageMode", {}, "field body_language: '' is not known"),
    ("addTagsToWords", {"str_param": "hello"}, "field texts: [] is not allowed"),
    ("declareTagForAnimations", {"texts": ["x"]}, "field str_param: it is empty: the tag"),
    ("declareAnimationsPackage", {}, "field str_param: it is empty"),
    ("playFile", {}, "field str_param: it is empty: the name of a file"),
    ("playFile", {"str_param": "/etc/passwd"}, "'/etc/passwd' leads out of the folder for sounds"),
    ("playFile", {"str_param": "/home/nao/../root/a.wav"}, "leads out of the folder for sounds"),
    ("playFile", {"str_param": "a\x00.wav"}, "has characters that names do not have"),
    ("playFile", {"str_param": "~/a.wav"}, "is not the name of a file"),
    ("playFile", {"str_param": "sounds"}, "'sounds' is not a file of a known kind"),
    ("playFile", {"str_param": "a" * 300 + ".wav"}, "the name is too long"),
    ("playFile", {"str_param": "a.wav", "volume": 2}, "field volume: 2.0 is not allowed: 0..1"),
    ("playFile", {"str_param": "a.wav", "pan": -2}, "field pan: -2.0 is not allowed: -1 (left) .. 1 (right)"),
    ("playFile", {"str_param": "a.wav", "duration": -1}, "field duration: -1.0 is not allowed: 0..3600 s"),
    ("playFile", {"str_param": "a.wav", "duration": 1, "background": True}, "0 for a sound in the background"),
    ("playFileInLoop", {"str_param": "a.wav", "duration": NAN}, "field duration: nan is not allowed"),
    ("playFileFromPosition", {"str_param": "a.wav", "position": -1}, "field position: -1.0 is not allowed"),
    ("playSine", {"duration": 1}, "field frequency: 0.0 is not allowed: a whole number 20..20000 (Hz)"),
    ("playSine", {"frequency": 440.5, "duration": 1}, "field frequency: 440.5 is not allowed"),
    ("playSine", {"frequency": NAN, "duration": 1}, "field frequency: nan is not allowed"),
    ("playSine", {"frequency": 440}, "field duration: 0.0 is not allowed: more than 0 to 3600 s"),
    ("playSine", {"frequency": 440, "duration": 1, "pan": 0.5}, "field pan: 0.5 is not allowed: -1 (left), 0 or 1"),
    ("playWebStream", {"str_param": "file:///etc/passwd"}, "an address that begins with http:// or https://"),
    ("playWebStream", {"str_param": "http://[bad/x"}, "an address that begins with http:// or https://"),
    ("loadFile", {"str_param": "a.txt"}, "'a.txt' is not a file of a known kind"),
    ("play", {}, "field sound_id: no sound is loaded: loadFile comes first"),
    ("play", {"sound_id": -1}, "field sound_id: -1 is not allowed"),
    ("play", {"str_param": "one.wav"}, "'one.wav' is not loaded: loadFile comes first"),
    ("playInLoop", {"sound_id": 7, "volume": -1}, "field volume: -1.0 is not allowed"),
    ("pause", {}, "field sound_id: no sound is loaded"),
    ("goTo", {"sound_id": 7, "position": NAN}, "field position: nan is not allowed"),
    ("setPitch", {"sound_id": 7, "pitch": NAN}, "field pitch: nan is not allowed"),
    ("setPanorama", {"pan": 1.5}, "field pan: 1.5 is not allowed"),
    ("playSoundSetFile", {"str_param": "Bips"}, "field file_name: it is empty"),
    (
        "playSoundSetFile",
        {"str_param": "Bops", "file_name": "ding"},
        "'Bops' is no sound set of the robot: did you mean",
    ),
    ("loadSoundSet", {"str_param": "Bops"}, "'Bops' is no sound set of the robot"),
    ("unloadSoundSet", {}, "field str_param: it is empty: the name of a sound set"),
    ("isSoundSetFileInstalled", {"str_param": "Bips"}, "field file_name: it is empty"),
]


@pytest.fixture
def audio(robot, edge, make_call):
    from nao_library_modules.audio_out import NaoAudioOutput

    speech = FakeSpeech(make_call)
    robot.add("ALTextToSpeech", speech)
    robot.add("ALAnimatedSpeech", FakeAnimatedSpeech(speech))
    robot.add("ALAudioPlayer", FakePlayer(make_call))
    robot.add("ALAudioDevice", FakeAudioDevice())
    return NaoAudioOutput("10.0.0.7", 9559, robot=robot, edge=edge)


def function(name, fields):
    """A message as it arrives, with numbers of the types that its fields have."""
    message = AudioOutFunction(function=name, **{**fields, "time": Duration.from_sec(fields.get("time", 0))})
    wire = io.BytesIO()
    message.serialize(wire)
    return AudioOutFunction().deserialize(wire.getvalue())


def changing_calls(robot):
    modules = ("ALTextToSpeech", "ALAnimatedSpeech", "ALAudioPlayer", "ALAudioDevice")
    return [call for name in modules for call in robot.proxy(name).calls if not call[0].startswith("get")]


@pytest.mark.parametrize(("name", "fields", "text"), REFUSED)
def test_what_is_wrong_is_told_and_nothing_sounds(audio, robot, name, fields, text):
    server = audio.server.play(NaoAudioOutGoal([function("say", {"str_param": "Hello"}), function(name, fields)]))
    assert server.end == "aborted"
    assert server.text.startswith("function 2 (")
    assert text in server.text
    assert changing_calls(robot) == []


def test_the_table_has_every_function_that_takes_something(audio):
    tested = {name for name, *_ in REFUSED}
    checked = {name for name, each in audio.function_table.items() if hasattr(each, "goal_check")}
    memory = set(audio.memory_functions())
    fine_with_anything = {"muteAudioOut"}
    same_check = {
        "disablePitch",
        "getCurrentPosition",
        "getFileLength",
        "getSoundSetFileNames",
        "isSoundSetInstalled",
        "isSoundSetLoaded",
        "unloadFile",
        "unloadAllFiles",
    }
    assert checked - memory - fine_with_anything - same_check <= tested


def test_a_sound_that_the_chain_unloads_is_not_there_any_more(audio):
    chain = [("loadFile", {"str_param": "a.wav"}), ("unloadFile", {}), ("play", {"str_param": "a.wav"})]
    server = audio.server.play(NaoAudioOutGoal([function(*each) for each in chain]))
    assert server.text == "function 3 (play): field str_param: 'a.wav' is not loaded: loadFile comes first"
    chain = [("loadFile", {"str_param": "a.wav"}), ("unloadAllFiles", {}), ("play", {})]
    server = audio.server.play(NaoAudioOutGoal([function(*each) for each in chain]))
    assert server.text == "function 3 (play): field sound_id: no sound is loaded: loadFile comes first"


def test_a_voice_that_was_installed_meanwhile_is_known(audio, robot):
    audio.server.play(NaoAudioOutGoal([function("setVoice", {"str_param": "naoenu"})]))
    robot.proxy("ALTextToSpeech")._service.voices["naogem"] = "German"
    server = audio.server.play(NaoAudioOutGoal([function("setVoice", {"str_param": "naogem"})]))
    assert server.end == "succeeded", server.text


@pytest.mark.parametrize("name", ["a.wav", " a.WAV ", "sub/b.wav", "/home/nao/c.wav", "été à.wav", "a..b.wav"])
def test_names_of_files_that_will_do(name):
    assert require_file("str_param", name, (".wav",)) == name.strip()


def test_whole_numbers():
    assert require_whole("volume", 30.0, 0, 100) == 30
    with pytest.raises(BadGoal):
        require_whole("volume", 1e300, 0, 100)
