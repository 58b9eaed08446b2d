"""The command `nao` on the whole stack: each command, its exit status, JSON, Ctrl-C, completion."""

import contextlib
import io
import json
import os
import shlex
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from nao_library_actions.msg import NaoMotionAction, NaoVisionAction
from nao_library_modules.cli.app import main
from nao_sim_bridge.testing import SimulatedRobot, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))  # not beside its relay
from wrong_behaviors import GOOD, LINE, WRONG, wrong_text  # noqa: E402

FRONT = "Head/Touch/Front"
SENSOR = f"Device/SubDeviceList/{FRONT}/Sensor/Value"
BRAIN0 = "Head/Led/Front/Right/1"
LIMIT = 60.0
BEHAVIOR = """\
help: Says something while a light goes on.
parameters:
  text: {default: hello, help: what it says}
do:
  - parallel:
      - nao_audio_out.say: {str_param: "${text}"}
      - NaoLights.setIntensity: {lights: [Brain0], i_values: [0.25]}
"""


class Done:
    """How a command ended: exit status, output, errors."""

    def __init__(self, status, out, err):
        self.status, self.out, self.err = status, out, err

    @property
    def json(self):
        return json.loads(self.out)


def nao(line):
    """Run a command in this process, which is quicker than to start a program for each."""
    out, err = io.StringIO(), io.StringIO()
    handler = signal.getsignal(signal.SIGINT)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = main(shlex.split(line))
    finally:
        signal.signal(signal.SIGINT, handler)
    return Done(status, out.getvalue(), err.getvalue())


class Program:
    """The command as a program of its own, that Ctrl-C can reach."""

    def __init__(self, line, **environment):
        self.process = subprocess.Popen(
            ["nao", *shlex.split(line)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **environment},
        )

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        return self.wait()

    def wait(self):
        out, err = self.process.communicate(timeout=LIMIT)
        return Done(self.process.returncode, out, err)


class CommandLine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        for name, action in (("NaoMotion", NaoMotionAction), ("NaoVision", NaoVisionAction)):
            cls.robot.action_client(name, action)
        cls.folder = Path(tempfile.mkdtemp(prefix="nao_command_"))

    def setUp(self):
        self.robot.reset()

    def ok(self, line):
        done = nao(line)
        self.assertEqual(done.status, 0, f"nao {line}: {done.err}")
        return done

    def start(self, line, **environment):
        program = Program(line, **environment)
        self.addCleanup(program.process.kill)
        return program

    # Doing

    def test_lights_speech_and_postures(self):
        self.ok("leds Brain0 0.5")
        self.assertAlmostEqual(self.robot.led(BRAIN0), 0.5, places=3)
        self.ok("leds Brain0 off --for 0.2 --revert")
        self.robot.wait_for_leds({BRAIN0: 0.5})
        self.assertEqual(self.ok("say hello").out, "")
        self.ok("pose Crouch")
        self.ok("rest")
        self.assertEqual(self.ok("get robotIsWakeUp").out, "false\n")
        self.ok("wake")
        self.assertEqual(self.ok("get robotIsWakeUp").out, "true\n")

    def test_a_robot_that_crouches_stands_up_and_walks(self):
        before = self.robot.true_pose().position
        far = self.ok("walk 0.2").out
        self.assertRegex(far, r"^0\.\d+ m ahead, -?0\.\d+ m to the left, -?0\.\d+ rad to the left\n$")
        after = self.robot.true_pose().position
        self.assertAlmostEqual(after.x - before.x, float(far.split()[0]), delta=0.06)

    def test_functions_are_called_as_one_goal(self):
        read, fade = "getIntensity lights:=Brain0", "fade lights:=Brain0 i_values:=0 duration:=0.5"
        done = self.ok(f"call NaoLights setIntensity lights:=Brain0,Brain1 i_values:=0.5 , {read} , {fade}")
        self.assertIn("getIntensity: 0.5", done.out)
        self.assertIn("3/3 fade", done.err)  # feedback of a function that is over at once may come after the result
        found = self.ok("call motion getAngles names:=Head --json").json
        self.assertEqual((found["state"], found["result"]["name"]), ("succeeded", ["HeadYaw", "HeadPitch"]))

    def test_what_is_not_allowed_is_refused_by_the_server(self):
        """Numbers beyond the limits that the description tells, in messages that are right otherwise."""
        samples = (
            ("NaoMotion", "goToPosture", "speed", "str_param:=Stand"),
            ("NaoMotion", "angleInterpolationWithSpeed", "speed", "names:=HeadYaw angles:=0 stiffness:=1"),
            ("NaoMotion", "recordMotion", "rate", "str_param:=x names:=HeadYaw duration:=1"),
            ("nao_audio_out", "say", "pitch", "str_param:=hello"),
            ("NaoLights", "earLedsSetAngle", "angle", "duration:=1"),
            ("NaoVision", "takePicture", "quality", "camera:=top"),
        )
        for server, function, field, others in samples:
            (described,) = self.ok(f"help {server} {function} --json").json
            (argument,) = [a for a in described["arguments"] if a["name"] == field]
            beyond = argument["maximum"] + 1
            beyond = int(beyond) if argument["type"].startswith("int") else beyond
            done = nao(f"call {server} {function} {others} {field}:={beyond}")
            self.assertEqual(done.status, 1, (server, function, field))
            self.assertIn(f"field {field}:", done.err)

    def test_behaviors_are_listed_and_run(self):
        self.ok(f"call NaoBehavior storeBehavior str_param:=both overwrite:=true text:={shlex.quote(BEHAVIOR)}")
        self.assertIn("Says something while", self.ok("behaviors").out)
        self.assertIn("text=hello  what it says", self.ok("behaviors both").out)
        steps = self.ok("run both 'text=good morning' --json").json["result"]["steps"]
        self.assertIn("nao_audio_out.say", [step["what"] for step in steps])
        self.assertAlmostEqual(self.robot.led(BRAIN0), 0.25, places=3)
        unknown = nao("run bothh")
        self.assertEqual(unknown.status, 1)
        self.assertIn("both", unknown.err)
        self.ok("call NaoBehavior deleteBehavior str_param:=both")

    def test_wrong_behaviours_are_refused_before_the_robot_moves(self):
        for name, (_, told) in WRONG.items():
            file = self.folder / f"{name}.yaml"
            file.write_text(wrong_text(name))
            checked = nao(f"check {file}")
            self.assertEqual((checked.status, checked.out), (1, ""))
            self.assertTrue(checked.err.startswith(f"{file}:{LINE}: {told}"), checked.err)
            run = nao(f"run {file}")
            self.assertEqual(run.status, 1)
            self.assertIn(f"behavior {name}: {file}:{LINE}: {told}", run.err)
        self.assertEqual(self.ok("get robotIsWakeUp").out, "false\n")
        refused = nao("call NaoLights on lights:=FaceLed , off --dry-run")
        self.assertEqual((refused.status, refused.err.count("\n")), (1, 3))
        self.assertEqual(self.ok("call NaoLights on lights:=FaceLeds --dry-run").out, "it can be done\n")

    def test_right_behaviours_pass_with_all_servers(self):
        file = self.folder / "good.yaml"
        file.write_text(GOOD)
        self.assertTrue(self.ok(f"check {file} text=Hi").out.endswith("it can be run\n"))
        shipped = [each["name"] for each in self.ok("behaviors --json").json if each["shipped"]]
        self.assertIn("hello", shipped)
        for name in shipped:
            told = self.ok(f"check {name}").out
            self.assertTrue(told.endswith("it can be run\n") and "not known until they run" not in told, told)
        failing = "help: x\ndo:\n- {wait: 0}\n- {NaoLights.getData: {str_param: No/Such/Key}}\n"
        file.write_text(failing)
        self.ok(f"check {file}")
        failed = nao(f"run {file}")
        self.assertEqual(failed.status, 1)
        self.assertIn(f"{file}:4: step 2 (NaoLights.getData): ", failed.err)

    # Recording

    def test_pictures_videos_sounds_and_motions(self):
        picture, film = self.folder / "photo.png", self.folder / "film.mp4"
        # The nodes of the cameras start with the first goal that needs them.
        wait_until(lambda: nao(f"photo {picture}").out == f"{picture}\n", LIMIT, "a picture of the camera")
        self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")
        outside = self.folder / "outside.png"
        self.ok(f"sim picture {outside} --view face --size 160x120")
        self.assertEqual(outside.read_bytes()[:4], b"\x89PNG")
        with self.robot.at_speed(0.5):  # on a busy machine no frame comes within a quarter of a second
            wait_until(lambda: nao(f"record video {film} --for 1").status == 0, LIMIT, "a video of the camera")
            voice = self.folder / "command.wav"
            sound = self.ok(f"record sound {voice} --for 0.5 --json").json["result"]["files"][0]
        self.assertEqual(film.read_bytes()[4:8], b"ftyp")
        self.assertEqual((sound["path"], voice.read_bytes()[:4]), (str(voice), b"RIFF"))
        self.assertGreater(sound["duration"], 0.4)
        self.ok("record motion command HeadYaw --for 0.5")
        self.assertIn("command", self.ok("call motion listMotions").out.split())
        self.ok("call motion deleteMotion str_param:=command")

    def test_ctrl_c_is_how_a_recording_without_a_time_ends(self):
        until = self.folder / "until.wav"
        program = self.start(f"record sound {until} --json")
        self.wait_until_running("nao_audio_in")
        done = program.interrupt()
        self.assertEqual(done.status, 0, done.err)
        self.assertEqual(json.loads(done.out)["result"]["files"][0]["path"], str(until))

    # Memory

    def test_the_memory_is_read_written_and_watched(self):
        self.ok("set Command/Test '[1, 2.5]'")
        self.assertEqual(self.ok("get Command/Test --json").json, {"Command/Test": [1, 2.5]})
        names = self.ok("get 'Device/SubDeviceList/Head*/Position/Sensor/Value' --json").json
        self.assertEqual(sorted(name.split("/")[2] for name in names), ["HeadPitch", "HeadYaw"])
        missing = nao("get Command/Tset")
        self.assertEqual((missing.status, "did you mean 'Command/Test'" in missing.err), (1, True), missing.err)
        self.assertEqual(nao("get 'Command/*Missing'").status, 1)

        watch = self.start(f"watch FrontTactilTouched '{SENSOR}' --json --count 3")
        first = json.loads(watch.process.stdout.readline())  # what it holds now; then it is known to be watching
        self.assertEqual((first["name"], first["value"]), (SENSOR, 0.0))
        self.ok("sim touch front_head")
        done = watch.wait()
        told = {(entry["name"], entry["value"]) for entry in map(json.loads, done.out.splitlines())}
        self.assertEqual(done.status, 0, done.err)
        self.assertEqual(told, {("FrontTactilTouched", 1.0), (SENSOR, 1.0)})
        self.ok("sim touch")
        wait_until(lambda: self.robot.value(SENSOR) == 0.0, 60.0, "the finger to go away")
        self.assertEqual(nao(f"watch {SENSOR} --timeout 0.5").status, 0)

    def test_files_go_to_the_robot_and_come_back(self):
        there, back = "/home/nao/command/note.txt", self.folder / "back.txt"
        note = self.folder / "note.txt"
        note.write_text("hello")
        self.assertEqual(self.ok(f"files put {note} ~/command/").out, f"{there}\n")
        self.assertEqual(self.ok("files list command --json").json["files"][0]["size"], 5)
        self.assertEqual(nao(f"files put {note} {there}").status, 1)
        self.assertEqual(self.ok(f"files get {there} {back}").out, f"{back}\n")
        self.assertEqual(back.read_text(), "hello")
        self.assertIn("random.wav", self.ok("files list /usr/share/naoqi/wav").out)
        self.assertIn("is not inside the robot's places", nao("files list /etc").err)

    # Asking

    def test_status_tells_robot_and_servers(self):
        found = self.ok("status --json").json
        self.assertTrue(found["connected"])
        self.assertEqual(found["address"], f"127.0.0.1:{self.robot.port}")
        self.assertAlmostEqual(found["battery"], 1.0, delta=0.1)
        self.assertFalse(found["awake"])
        self.assertTrue(all(server["up"] and server["connected"] for server in found["servers"].values()))
        text = self.ok("status").out
        self.assertIn("battery", text)
        self.assertRegex(text, r"NaoLights +idle")

    def test_help_knows_the_names_of_this_robot(self):
        self.assertIn("NaoMotion", self.ok("list").out)
        (described,) = self.ok("help goToPosture --json").json
        self.assertIn("StandZero", described["arguments"][0]["choices"])
        self.assertIn("LeftFaceLeds", self.ok("help setIntensity").out)
        self.assertEqual(nao("help setColour").status, 2)

    # Stopping

    def wait_until_running(self, server):
        def runs():
            return bool(nao("status --json").json["servers"][server]["running"])

        wait_until(runs, LIMIT, f"a goal of {server}")

    def test_ctrl_c_preempts_the_goal_and_waits_for_its_end(self):
        program = self.start("leds Brain0 0.25 --for 1000 --revert")
        self.robot.wait_for_leds({BRAIN0: 0.25}, limit=LIMIT)
        done = program.interrupt()
        self.assertEqual(done.status, 130, done.err)
        self.assertIn("preempted in function 1 (setIntensity)", done.err)
        self.assertEqual(self.robot.led(BRAIN0), 1.0)  # reverted before the program ended

    def test_a_goal_that_takes_too_long_is_cancelled(self):
        done = nao("leds Brain0 0.25 --for 1000 --revert --timeout 1")
        self.assertEqual(done.status, 1)
        self.assertIn("not done within 1 s: cancelled", done.err)
        self.assertEqual(self.robot.led(BRAIN0), 1.0)
        done = nao("leds Brain0 0.25 --for 1000 --revert --timeout 1 --json")
        self.assertEqual((done.status, done.json["state"]), (1, "preempted"), done.err)

    def test_stop_ends_what_others_have_begun(self):
        program = self.start("leds Brain0 0.25 --for 1000 --json")
        self.robot.wait_for_leds({BRAIN0: 0.25}, limit=LIMIT)
        stopped = self.ok("stop --json").json
        self.assertIn("NaoLights", stopped["cancelled"])
        done = program.wait()
        self.assertEqual((done.status, json.loads(done.out)["state"]), (1, "preempted"))

    # The simulator

    def test_a_simulated_robot_is_pushed_and_its_time_passes(self):
        self.ok("sim pause")
        self.addCleanup(self.robot.resume)
        before = float(self.ok("sim advance 0").out)
        self.assertAlmostEqual(float(self.ok("sim advance 0.5").out), before + 0.5, delta=0.01)
        start = self.robot.true_pose().position.x
        self.ok("sim push 60 0 0 --for 0.2")
        self.robot.advance(1.2)
        self.assertGreater(self.robot.true_pose().position.x - start, 0.05)
        self.ok("sim reset")
        self.ok("sim resume")
        self.assertEqual(nao("sim touch Nose").status, 2)

    # Exit status and completion, as a shell sees them

    def test_without_a_master_and_without_a_robot_of_that_name_it_is_status_3(self):
        done = self.start("say hello", ROS_MASTER_URI="http://127.0.0.1:9").wait()
        self.assertEqual((done.status, len(done.err.splitlines())), (3, 1), done.err)
        self.assertEqual(nao("say hello --robot nobody").status, 3)

    def test_a_shell_is_offered_the_names_of_this_robot(self):
        samples = {
            "nao call NaoLights setInt": "setIntensity",
            "nao call NaoLights on lights:=BrainLedsB": "BrainLedsBack",
            "nao pose StandZ": "StandZero",
            "nao leds LeftFaceL": "LeftFaceLeds",
            f"nao get {SENSOR[:-3]}": SENSOR,
        }
        for line, word in samples.items():
            # A robot that is busy for a second is not waited for; one presses the key again.
            wait_until(lambda line=line, word=word: word in self.completions(line), LIMIT, f"{word} for {line!r}")

    def completions(self, line):
        """What the shell offers at the end of a line."""
        done = self.start("", NAO_LINE=line, _NAO_COMPLETE="bash_complete").wait()
        self.assertEqual(done.err, "")
        return done.out.split()
