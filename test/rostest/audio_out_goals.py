#!/usr/bin/env python3
"""Goals that the audio server refuses, over ROS: clear texts, nothing sounds, the server stays."""

import math
import sys
import unittest
from pathlib import Path

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoAudioOutAction, NaoAudioOutGoal
from nao_library_modules.memory_functions import MemoryFunctions
from nao_library_msgs.msg import AudioOutFunction
from nao_sim_bridge.testing import SimulatedRobot, send, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from cases import case  # noqa: E402
from sound_fixture import SILENT, Loudspeakers  # noqa: E402

# Functions, and what the text of the refusal says.
BAD = [
    ([("sya", {})], "function 1 (sya): unknown function 'sya': did you mean 'say'"),
    ([], "field functions: the chain is empty"),
    ([("say", {})], "function 1 (say): field str_param: it is empty"),
    ([("say", {"str_param": "a"}), ("say", {"str_param": " "})], "function 2 (say): field str_param: it is empty"),
    ([("say", {"str_param": "a", "language": "Klingon"})], "'Klingon' is no language that the robot speaks"),
    ([("say", {"str_param": "a", "voice": "HAL"})], "'HAL' is no voice of the robot"),
    ([("say", {"str_param": "a", "volume": 2.0})], "field volume: 2.0 is not allowed: 0..1"),
    ([("say", {"str_param": "a", "speed": math.nan})], "field speed: nan is not allowed"),
    ([("setOutputVolume", {"volume": 150.0})], "field volume: 150.0 is not allowed: a whole number 0..100 (%)"),
    ([("setOutputVolume", {"volume": -1.0})], "field volume: -1.0 is not allowed"),
    ([("sayToFile", {"str_param": "a", "file_name": "../a.wav"})], "leads out of the folder for sounds"),
    ([("sayToFile", {"str_param": "a", "file_name": "/etc/a.wav"})], "leads out of the folder for sounds"),
    ([("playFile", {"str_param": "nowhere.wav"})], "nowhere.wav"),
    ([("playFile", {"str_param": "notes.txt"})], "is not a file of a known kind"),
    ([("play", {"sound_id": 4711})], "no sound is loaded under the id 4711"),
    ([("play", {"str_param": "x.wav"})], "'x.wav' is not loaded: loadFile comes first"),
    ([("playSine", {"frequency": 1e6, "duration": 1.0})], "a whole number 20..20000 (Hz)"),
    ([("playFileInLoop", {"str_param": "a.wav", "duration": -3.0})], "field duration: -3.0 is not allowed"),
    ([("setParameter", {"names": ["speed"], "values": [1000.0]})], "speed is 50..400"),
    ([("playWebStream", {"str_param": "ftp://x/y.ogg"})], "begins with http:// or https://"),
]

TONE, SET = {"str_param": "nao_library/bip.ogg"}, {"str_param": "nao_library"}
# Every function once, in an order that each finds what it needs.
EVERY = [
    ("getAvailableVoices", {}),
    ("getAvailableLanguages", {}),
    ("getSupportedLanguages", {}),
    ("getVoice", {}),
    ("setVoice", {"str_param": "rms", "revert": True}),
    ("getLanguage", {}),
    ("setLanguage", {"str_param": "French", "revert": True}),
    ("setLanguageDefaultVoice", {"str_param": "English", "voice": "naoenu"}),
    ("locale", {}),
    ("setParameter", {"names": ["pitchShift"], "values": [1.2], "revert": True}),
    ("getParameter", {"names": ["pitchShift", "speed"]}),
    ("resetSpeed", {}),
    ("addToDictionary", {"str_param": "NAO", "texts": ["now"]}),
    ("showDictionary", {}),
    ("deleteFromDictionary", {"str_param": "NAO"}),
    ("setBodyLanguageMode", {"body_language": "random", "revert": True}),
    ("getBodyLanguageMode", {}),
    ("addTagsToWords", {"str_param": "hello", "texts": ["hi"]}),
    ("declareTagForAnimations", {"str_param": "hello", "texts": ["animations/Stand/Gestures/Hey_1"]}),
    ("say", {"str_param": "Yes."}),
    ("animatedSay", {"str_param": "Yes."}),
    ("sayToFile", {"str_param": "Yes.", "file_name": "yes.wav"}),
    ("sayToFileAndPlay", {"str_param": "Yes."}),
    ("playFile", TONE),
    ("playFileFromPosition", {**TONE, "position": 0.05}),
    ("playFileInLoop", TONE),
    ("playSine", {"frequency": 440.0, "duration": 0.1}),
    ("loadFile", TONE),
    ("getLoadedFilesIds", {}),
    ("getLoadedFilesNames", {}),
    ("getFileLength", {}),
    ("goTo", {"position": 0.01}),
    ("getCurrentPosition", {}),
    ("setPitch", {"pitch": 1.5}),
    ("disablePitch", {}),
    ("play", {}),
    ("playInLoop", {}),
    ("pause", {}),
    ("setVolume", {"volume": 0.5, "revert": True}),
    ("getVolume", {}),
    ("setMasterVolume", {"volume": 0.5, "revert": True}),
    ("getMasterVolume", {}),
    ("setPanorama", {"pan": 0.0}),
    ("stopAll", {}),
    ("waitUntilSilent", {}),
    ("unloadFile", {}),
    ("unloadAllFiles", {}),
    ("getInstalledSoundSetsList", {}),
    ("isSoundSetInstalled", SET),
    ("loadSoundSet", SET),
    ("isSoundSetLoaded", SET),
    ("getLoadedSoundSetsList", {}),
    ("getSoundSetFileNames", SET),
    ("isSoundSetFileInstalled", {**SET, "file_name": "bip"}),
    ("playSoundSetFile", {**SET, "file_name": "bip", "volume": 0.5}),
    ("unloadSoundSet", SET),
    ("setOutputVolume", {"volume": 80.0, "revert": True}),
    ("getOutputVolume", {}),
    ("muteAudioOut", {"enable": True, "revert": True}),
    ("isAudioOutMuted", {}),
    ("flushAudioOutputs", {}),
    ("closeAudioOutputs", {}),
    ("isOutputClosed", {}),
    ("openAudioOutputs", {}),
    ("closeAudioInputs", {}),
    ("isInputClosed", {}),
    ("openAudioInputs", {}),
    ("listOutputs", {}),
    ("listInputs", {}),
    ("reset", {}),
]
# They need what the simulated robot does not have: a preference, a package, a station on the network.
ELSEWHERE = {"loadVoicePreference", "declareAnimationsPackage", "playWebStream"}
MEMORY = set(MemoryFunctions().memory_functions())

SAID_THEN_FAILED = [("sayToFile", False), ("loadFile", True)]


class AudioOutGoals(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.client = cls.robot.action_client("nao_audio_out", NaoAudioOutAction)
        cls.loudspeakers = Loudspeakers(cls.robot)

    def setUp(self):
        self.robot.reset()

    def play(self, *functions):
        return send(self.client, NaoAudioOutGoal(list(functions))).wait()

    def test_bad_goals_are_refused_with_a_reason_and_nothing_sounds(self):
        began = rospy.get_time()
        for chain, text in BAD:
            with case(chain=chain):
                run = self.play(*(AudioOutFunction(function=name, **fields) for name, fields in chain))
                self.assertEqual(run.state, GoalStatus.ABORTED)
                self.assertIn(text, run.text)
        ended = self.robot.advance(0.5)
        self.assertLess(self.loudspeakers.level(began, ended), SILENT)
        self.assertEqual(self.play(AudioOutFunction(function="getVoice")).state, GoalStatus.SUCCEEDED)

    def test_every_function_is_carried_out(self):
        known = self.play(AudioOutFunction(function="?")).text.partition("known are ")[2].split(", ")
        self.assertEqual({name for name, _ in EVERY}, set(known) - MEMORY - ELSEWHERE)
        run = self.play(*(AudioOutFunction(function=name, **fields) for name, fields in EVERY))
        self.assertEqual(run.state, GoalStatus.SUCCEEDED, run.text)
        self.assertEqual([result.function for result in run.result.results], [name for name, _ in EVERY])

    def test_what_was_done_before_an_error_is_in_the_result(self):
        run = self.play(
            AudioOutFunction(function="sayToFile", str_param="Hello", file_name="hello.wav"),
            AudioOutFunction(function="loadFile", str_param="nowhere.wav"),
            AudioOutFunction(function="say", str_param="never"),
        )
        self.assertEqual(run.state, GoalStatus.ABORTED)
        self.assertIn("function 2 (loadFile)", run.text)
        self.assertEqual([(done.function, bool(done.error)) for done in run.result.results], SAID_THEN_FAILED)
        self.assertEqual(run.result.files, ["hello.wav"])

    def test_a_goal_that_replaces_another_during_its_wait_comes_at_once(self):
        long_wait = AudioOutFunction(function="getVoice", time=rospy.Duration(1000))
        first = send(self.client, NaoAudioOutGoal([long_wait])).wait_for_function(0)
        second = self.play(AudioOutFunction(function="getLanguage"))
        self.assertEqual(first.wait().state, GoalStatus.PREEMPTED)
        self.assertEqual((second.state, second.result.memList), (GoalStatus.SUCCEEDED, ["English"]))

    def test_settings_go_back_after_the_wait(self):
        output = self.robot.module("ALAudioDevice")
        before = output.getOutputVolume()
        quiet = AudioOutFunction(function="setOutputVolume", volume=10, revert=True, time=rospy.Duration(1000))
        run = send(self.client, NaoAudioOutGoal([quiet])).wait_for_function(0)
        wait_until(lambda: output.getOutputVolume() == 10, 10.0, "the low volume")
        run.cancel()
        self.assertEqual(run.wait().state, GoalStatus.PREEMPTED)
        self.assertEqual(output.getOutputVolume(), before)


if __name__ == "__main__":
    rospy.init_node("audio_out_goals_test")
    rostest.rosrun("nao_library_tests", "audio_out_goals", AudioOutGoals)
