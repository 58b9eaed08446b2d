#!/usr/bin/env python3
"""Plays a demonstration on a simulated NAO and checks every step against what the robot reports.

Starts a simulator and its action servers on a ROS master of its own: the robot stands up, shows green eyes, finds a
ball, walks to a table while its lights play, greets and hears itself, and plays two behaviours, all faster than real
time. Leaves pictures, sound, a film, a table and the log of the stack in the output folder, which has to be empty
unless --overwrite says that all this may be replaced. The exit status tells whether all of it went as asked.
"""

from __future__ import annotations

import argparse
import sys
import threading
from pathlib import Path
from typing import Mapping

# In the devel space rosrun starts a relay from another folder.
sys.path.insert(0, str(Path(__file__).resolve().parent))
from example_parts.demo_behaviors import BehaviorPlayer, Turn
from example_parts.demo_lights import Step, steps
from example_parts.demo_support import (
    SOUND,
    Film,
    Stack,
    Table,
    announce,
    count_green_pixels,
    loud_time,
    may_fill,
    wait_until,
)

DEVICE = "Device/SubDeviceList/{}/Actuator/Value"
# s of simulated time.
STEP_LIMIT = 30.0
WORLD, FILM = "lab", "demo.mp4"
# Pixels each way and pictures a second: a slow computer should not draw for long.
FILM_SIZE = (240, 8.0)
# m. The near edge of the table is 0.6 m ahead of where the robot starts; an arm needs the rest.
TO_THE_TABLE = 0.3
GREETING = "Hello! I am a NAO that lives in a simulator. Welcome to the laboratory."
# Where the ball lies from where the robot starts, and its radius, m.
BALL, BALL_RADIUS = (0.30, -0.55), 0.05
# What its own camera sees of it.
EYES_PICTURE = "own_eyes.png"
# What the robot listens for while it greets, and its own words of these, one of which it should hear.
WORDS, OWN_WORDS = ("hello", "goodbye", "laboratory", "elephant", "umbrella"), ("hello", "laboratory")
# How long the greeting lasts at least, s.
GREETING_TIME = 2.0
# Of the ten that are bundled; `make film` shows all.
BEHAVIORS = (Turn("dance", length=9), Turn("bow", length=3))
# m: nearer to what the sonars see than a walk comes by itself, 0.4 m.
NEAR, USUAL = 0.15, 0.4
# Pixels of the green eyes in a front view of 640 x 480; without them there are none.
MIN_GREEN_PIXELS = 150


class Demonstration:
    """Client of a running stack: sends goals, reads the robot, takes pictures, keeps the table.

    Args:
        stack: The running stack.
        output: Folder for pictures.
    """

    def __init__(self, stack: Stack, output: Path, table: Table) -> None:

        import nao_library_actions.msg as actions
        from nao_library_msgs.srv import TakePicture
        from naoqi import ALProxy

        self._output = output
        self._report = table.add
        stack.join("nao_library_demo")
        self._lights = stack.client("NaoLights", actions.NaoLedAction)
        self._walker = stack.client("NaoMotion", actions.NaoMotionAction)
        self._speaker = stack.client("nao_audio_out", actions.NaoAudioOutAction)
        self._listener = stack.client("nao_audio_in", actions.NaoAudioInAction)
        self._eyes = stack.client("NaoVision", actions.NaoVisionAction)
        self.film, self.behaviors = Film(stack, FILM, *FILM_SIZE), BehaviorPlayer(stack, table)
        self._take_picture = stack.service("nao_sim/picture", TakePicture)
        self._memory = ALProxy("ALMemory", "127.0.0.1", stack.nao_port)
        self._motion = ALProxy("ALMotion", "127.0.0.1", stack.nao_port)

    def wake_up(self) -> None:
        """Stand up on both feet, and look at the weight on them."""
        self._motion.wakeUp()
        weights = self._memory.getListData(["leftFootTotalWeight", "rightFootTotalWeight"])
        stands = self._motion.robotIsWakeUp() and 5.0 < sum(weights) < 5.7
        self._report("wake up and stand", f"{weights[0]:.2f} + {weights[1]:.2f} kg on its feet", stands)

    def greet(self) -> None:
        """Say something, and hear it with its own microphones; what was said is in a file."""
        import rospy

        import nao_library_actions.msg as actions
        from nao_library_msgs.msg import AudioInFunction, AudioOutFunction

        hear = AudioInFunction(function="listen", vocabulary=list(WORDS), word_spotting=True, timeout=STEP_LIMIT)
        listens = threading.Event()
        goal = actions.NaoAudioInGoal([hear])
        self._listener.send_goal(goal, feedback_cb=lambda feedback: feedback.status and listens.set())
        listens.wait(STEP_LIMIT)
        self._speaker.send_goal(actions.NaoAudioOutGoal([AudioOutFunction(function="say", str_param=GREETING)]))
        if not self._speaker.wait_for_result(rospy.Duration(STEP_LIMIT)):
            self._report("greet, and hear itself", f"no result of nao_audio_out within {STEP_LIMIT:g} s", False)
            return
        self._listener.wait_for_result(rospy.Duration(STEP_LIMIT))
        result = self._listener.get_result()
        words = [word.strip("<.> ") for word in result.words] if result else []
        seconds = loud_time(self._output / SOUND)
        report = f"{seconds:.1f} s of speech in {SOUND}; it heard {', '.join(words[:1]) or 'nothing'}"
        self._report(
            "greet, and hear itself", report, seconds > GREETING_TIME and bool(words) and words[0] in OWN_WORDS
        )

    def find_ball(self) -> None:
        """Look for the ball that lies in the room, and take a picture with its own eyes when it sees it."""
        import rospy

        from nao_library_actions.msg import NaoVisionGoal
        from nao_library_msgs.msg import VisionFunction

        look = VisionFunction(function="lookFor", str_param="ball", size=BALL_RADIUS, timeout=STEP_LIMIT)
        photo = VisionFunction(function="takePicture", str_param=EYES_PICTURE, overwrite=True)
        self._eyes.send_goal(NaoVisionGoal([look, photo]))
        if not self._eyes.wait_for_result(rospy.Duration(2 * STEP_LIMIT)):
            self._report("look for the ball", f"no result within {2 * STEP_LIMIT:g} s", False)
            return
        self._motion.angleInterpolation("Head", [0.0, 0.0], 0.8, True)
        result = self._eyes.get_result()
        if result is None or not result.objects or not (self._output / EYES_PICTURE).exists():
            self._report("look for the ball", self._eyes.get_goal_status_text() or "it saw no ball", False)
            return
        where = result.objects[0].position
        report = f"a ball at x {where.x:.2f} m, y {where.y:.2f} m from its feet, seen in {EYES_PICTURE}"
        off = max(abs(where.x - BALL[0]), abs(where.y - BALL[1]))
        self._report("look for the ball", report, off < 0.05)

    def begin_walk(self) -> None:
        """Send the goal that walks to the table and waves; lights can go on meanwhile."""
        from nao_library_actions.msg import NaoMotionGoal
        from nao_library_msgs.msg import MotionFunction

        go_near = MotionFunction(function="setOrthogonalSecurityDistance", values=[NEAR])
        walk = MotionFunction(function="moveTo", values=[TO_THE_TABLE, 0.0, 0.0], gait=["MaxStepX"], gait_values=[0.06])
        raise_arm = MotionFunction(
            function="setPose", names=["RArm"], angles=[-1.0, -0.3, 1.2, 0.8, 0.0, 1.0], duration=1.0
        )
        wave = MotionFunction(
            function="angleInterpolation", names=["RElbowRoll"], angles=[0.4, 1.2, 0.8], times=[0.5, 1.0, 1.4]
        )
        keep_away = MotionFunction(function="setOrthogonalSecurityDistance", values=[USUAL])
        self._walker.send_goal(NaoMotionGoal([go_near, walk, keep_away, raise_arm, wave]))

    def end_walk(self) -> None:
        """Wait until the robot is at the table, and look at where it says it is."""
        import rospy
        from actionlib_msgs.msg import GoalStatus

        if not self._walker.wait_for_result(rospy.Duration(STEP_LIMIT)):
            self._report("walk to the table and wave", f"no result within {STEP_LIMIT:g} s", False)
            return
        state = self._walker.get_state()
        x, y, theta = self._motion.getRobotPosition(True)
        report = f"at x {x:.3f} m, y {y:.3f} m, theta {theta:.3f} rad of the world"
        if state != GoalStatus.SUCCEEDED:
            report += f"; {GoalStatus.to_string(state)} {self._walker.get_goal_status_text()}"
        there = abs(x - TO_THE_TABLE) < 0.03 and abs(y) < 0.03
        self._report("walk to the table and wave", report, there and state == GoalStatus.SUCCEEDED)

    def play(self, step: Step) -> None:
        """Send one goal, and compare what the robot reports with what was asked."""
        import rospy
        from actionlib_msgs.msg import GoalStatus

        from nao_library_actions.msg import NaoLedGoal
        from nao_library_msgs.msg import LedFunction

        functions = [
            LedFunction(**{**fields, "time": rospy.Duration(float(fields.get("time", 0.0)))})  # type: ignore[arg-type]
            for fields in step.functions
        ]
        self._lights.send_goal(NaoLedGoal(functions))
        reports = []
        if step.during:
            try:
                wait_until(lambda: not self._wrong(step.during), STEP_LIMIT, "the lights")
                reports.append(f"during: {len(step.during)} LEDs as asked")
            except RuntimeError:
                reports.append(f"during: {self._wrong(step.during)}")
        if not self._lights.wait_for_result(rospy.Duration(STEP_LIMIT)):
            self._report(step.title, f"no result within {STEP_LIMIT:g} s", False)
            return
        state = self._lights.get_state()
        wrong = self._wrong(step.after)
        reports.append(f"after: {wrong}" if wrong else f"after: {len(step.after)} LEDs as asked")
        if state != GoalStatus.SUCCEEDED:
            reports.append(f"{GoalStatus.to_string(state)} {self._lights.get_goal_status_text()}")
        good = state == GoalStatus.SUCCEEDED and all("as asked" in text for text in reports)
        self._report(step.title, "; ".join(reports), good)

    def picture(self, name: str, view: str, green_eyes: bool | None = None) -> None:
        """Save a picture; with `green_eyes`, check that green eyes are or are not to be seen in it."""
        answer = self._take_picture(view, 640, 480, f"{name}.png")
        if not answer.success:
            self._report(f"picture {name}", answer.message, False)
            return
        pixels = count_green_pixels(Path(answer.path))
        good = green_eyes is None or (pixels >= MIN_GREEN_PIXELS) == green_eyes
        self._report(f"picture {name}.png", f"{view} view, {pixels} bright green pixels", good)

    def _wrong(self, wanted: Mapping[str, float]) -> str:
        """The first LED that is not as wanted, in words; empty when all are."""
        values = self._memory.getListData([DEVICE.format(name) for name in wanted])
        for (name, value), found in zip(wanted.items(), values):
            if found is None or abs(found - value) > 0.02:
                return f"{name} is {found}, asked was {value}"
        return ""


def play_all(stack: Stack, output: Path, table: Table) -> None:
    """The whole demonstration."""
    demonstration = Demonstration(stack, output, table)
    film = demonstration.film
    demonstration.wake_up()
    demonstration.picture("before", "front", green_eyes=False)
    for number, step in enumerate(steps(), 1):
        if step.walking:
            announce("finding the ball", 10)
            demonstration.find_ball()
            film.start()
            film.caption("walk to the table")
            announce("walking to the table", 6)
            demonstration.begin_walk()
        demonstration.play(step)
        if step.picture:
            name = "green_eyes" if step.title == "both eyes green" else f"step_{number}"
            demonstration.picture(name, step.picture, green_eyes=True if name == "green_eyes" else None)
        if step.walking:
            demonstration.end_walk()
            demonstration.picture("at_the_table", "room")
    demonstration.picture("after", "front", green_eyes=False)
    film.caption("greet, and hear itself")
    announce("greeting", 9)
    demonstration.greet()
    for turn in BEHAVIORS:
        film.caption(turn.title)
        announce(f"playing the behaviour {turn.title}", turn.length)
        demonstration.behaviors.play(turn)
    film.stop(table)


def main() -> int:
    """Run the demonstration; the exit status is 0 when every step went as asked."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--output", type=Path, default=Path("demo_output"), help="folder for pictures and the table")
    options.add_argument("--overwrite", action="store_true", help="replace what an earlier demonstration left there")
    chosen = options.parse_args()
    output = chosen.output.resolve()
    if not may_fill(output, chosen.overwrite):
        return 1
    (output / SOUND).unlink(missing_ok=True)  # of the last demonstration; the simulator would not replace it
    table = Table()
    try:
        with Stack(output, world=WORLD, sound_file=SOUND) as stack:
            play_all(stack, output, table)
    except Exception as error:
        print(f"  FAIL  {error}\n        see {output / 'stack.log'}", flush=True)
        return 1
    table.write(output / "table.md")
    print(f"{table.summary}; pictures, {SOUND}, {FILM} and table.md are in {output}")
    print("`make film` shows all ten behaviours, `scripts/ros-env nao --help` what else there is.")
    return 1 if table.failures else 0


if __name__ == "__main__":
    sys.exit(main())
