#!/usr/bin/env python3
"""Asks a question, listens, answers, and nods or shakes its head: `dialogue.py --question "Shall we play?"`.

Without an answer, or with one that it is not sure of, it asks again. In a simulator, `--person yes` puts a person into
the world who calls, so that the head turns there, and answers: then nobody has to speak. `--record a.wav --log a.json`
keeps what was heard, for plot_sound.py.

Needs running servers, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import math
import sys
import threading
from pathlib import Path
from typing import Any, Callable

import rospy
from actionlib import SimpleActionClient
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point

import nao_library_actions.msg as actions

# In the devel space rosrun starts a relay from another folder.
sys.path.insert(0, str(Path(__file__).resolve().parent))
from example_parts.dialogue_record import DOES, PERSON, ROBOT, SAYS, Notes, save
from nao_library_modules.whole_file import require_new
from nao_library_msgs.msg import AudioInFunction, AudioOutFunction, MotionFunction
from nao_library_msgs.srv import AdvanceTime, PersonSays

LIMIT = rospy.Duration(60)
ANSWERS = {
    "yes": ("Great!", "HeadPitch", 0.3),
    "no": ("What a pity.", "HeadYaw", 0.4),
}
"""What is understood -> what the robot says to it, and how its head moves: joint, rad."""
CALL, VOICE = "Hello, robot!", "rms"
REACTION = rospy.Duration.from_sec(0.8)
"""A person does not speak in the very moment in which the robot listens, and the robot bips first."""
FARTHEST = 2.0
"""rad, that the head turns to a side."""


class Servers:
    """The servers that the dialogue needs."""

    def __init__(self) -> None:
        """Find them."""
        self._clients = {
            name: SimpleActionClient(name, getattr(actions, f"{action}Action"))
            for name, action in (("nao_audio_out", "NaoAudioOut"), ("nao_audio_in", "NaoAudioIn"), ("NaoMotion",) * 2)
        }
        for name, client in self._clients.items():
            if not client.wait_for_server(LIMIT):
                raise RuntimeError(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")

    def play(
        self,
        name: str,
        goal: Any,
        meanwhile: Callable[[Callable[[], bool]], None] | None = None,
        at_end: Callable[[], None] = lambda: None,
    ) -> Any:
        """Play a goal to its end; its result.

        Args:
            name: Name of the server.
            goal: What to do.
            meanwhile: What is done once the robot listens for words or the goal for sounds is sent; it is given a
                function that tells whether the goal is over, and may take longer than it.
            at_end: What is done when the goal ends.
        """
        client = self._clients[name]
        if meanwhile is None:
            client.send_goal(goal)
            if not client.wait_for_result(LIMIT):
                client.cancel_goal()
                raise RuntimeError(f"no result of {name} within {LIMIT.to_sec():g} s")
            at_end()
        else:
            self._play_with(client, goal, meanwhile, at_end)
        if client.get_state() != GoalStatus.SUCCEEDED:
            raise RuntimeError(client.get_goal_status_text() or f"no result of {name}")
        return client.get_result()

    def _play_with(self, client: Any, goal: Any, meanwhile: Callable[..., None], at_end: Callable[[], None]) -> None:
        listens, over = threading.Event(), threading.Event()
        if goal.functions[0].function != "listen":
            listens.set()  # only the recogniser tells when it is ready

        def follow(feedback: Any) -> None:
            if feedback.status == "ListenOn":
                listens.set()

        def end(*_: Any) -> None:
            try:
                at_end()
            finally:
                over.set()
                listens.set()

        client.send_goal(goal, done_cb=end, feedback_cb=follow)
        try:
            if listens.wait(LIMIT.to_sec()) and not over.is_set():
                meanwhile(over.is_set)
            over.wait(LIMIT.to_sec())
        finally:
            if not over.is_set():
                client.cancel_goal()


class Person:
    """Somebody in the simulated world.

    Args:
        place: Where the mouth is, x, y, z in world, m.
    """

    def __init__(self, place: list[float]) -> None:
        """Find the world."""
        self._place = Point(*place)
        self._says = rospy.ServiceProxy("nao_sim/person_says", PersonSays)
        self._advance = rospy.ServiceProxy("nao_sim/advance", AdvanceTime)
        try:
            self._says.wait_for_service(5.0)
        except rospy.ROSException as error:
            raise RuntimeError(
                "there is no simulator to put a person in (no service nao_sim/person_says): leave out --person, and "
                "answer the robot yourself"
            ) from error

    def time(self) -> float:
        """Simulated time, s, as in recordings; ROS time is another at speed 1 when the simulator falls behind."""
        return self._advance(rospy.Duration(0)).now.to_sec()

    def say(self, text: str) -> None:
        """Say something."""
        answer = self._says(text, self._place, VOICE, 0.0)
        if not answer.success:
            raise RuntimeError(f"the person cannot speak: {answer.message}")


class Dialogue:
    """A robot that talks to somebody, and a person in the simulated world, or None for somebody in front of it."""

    def __init__(self, servers: Servers, notes: Notes, person: Person | None, timeout: float) -> None:
        """Begin to talk."""
        self._servers = servers
        self._notes = notes
        self._person = person
        self._timeout = timeout
        self._yaw = 0.0

    def say(self, text: str) -> None:
        """Say something."""
        began = self._notes.now()
        self._servers.play("nao_audio_out", actions.NaoAudioOutGoal([AudioOutFunction(function="say", str_param=text)]))
        self._notes.did(ROBOT, SAYS, text, began)

    def turn_to_call(self) -> None:
        """Wait for a voice and turn the head there."""
        heard, when = self._listen(self._call, function="localizeSound", confidence=0.3)
        if not heard.sounds:
            print("nobody calls")
            return
        azimuth = heard.sounds[0].base_azimuth
        self._notes.heard(f"a voice at {math.degrees(azimuth):.0f}°", when, heard.sounds[0].confidence)
        self._yaw = max(-FARTHEST, min(FARTHEST, azimuth))
        self._move("turns its head", "HeadYaw", [self._yaw], [0.8])

    def ask(self, question: str, answer: str | None) -> str:
        """Ask, and listen; what was heard, empty if nothing was."""
        self.say(question)
        say = lambda _: self._person_says(str(answer))  # noqa: E731
        heard, when = self._listen(say, function="listen", vocabulary=list(ANSWERS), confidence=0.3)
        if not heard.words:
            return ""
        self._notes.heard(heard.words[0], when, heard.confidences[0])
        return heard.words[0]

    def gesture(self, joint: str, angle: float) -> None:
        """Nod, or shake the head."""
        around = self._yaw if joint == "HeadYaw" else 0.0
        angles = [around + part * angle for part in (1.0, -1.0, 1.0, 0.0)]
        text = "shakes its head" if joint == "HeadYaw" else "nods"
        self._move(text, joint, angles, [0.4, 0.8, 1.2, 1.6])

    def _listen(self, meanwhile: Callable[..., None], **fields: Any) -> tuple[Any, float]:
        """What is heard, and when that was known, s; if there is a person, of what that does meanwhile."""
        goal = actions.NaoAudioInGoal([AudioInFunction(timeout=self._timeout, **fields)])
        ends: list[float] = []
        at_end = lambda: ends.append(self._notes.now())  # noqa: E731
        result = self._servers.play("nao_audio_in", goal, meanwhile if self._person else None, at_end)
        return result, ends[0]

    def _call(self, is_over: Callable[[], bool]) -> None:
        """Call until the robot notices, as people do."""
        while not is_over():
            self._person_says(CALL)

    def _person_says(self, text: str) -> None:
        rospy.sleep(REACTION)
        began = self._notes.now()
        self._person.say(text)
        self._notes.did(PERSON, SAYS, text, began)

    def _move(self, text: str, joint: str, angles: list[float], times: list[float]) -> None:
        began = self._notes.now()
        turn = MotionFunction(function="angleInterpolation", names=[joint], stiffness=1.0, angles=angles, times=times)
        self._servers.play("NaoMotion", actions.NaoMotionGoal([turn]))
        self._notes.did(ROBOT, DOES, text, began)


def main() -> int:
    """Have the dialogue; the exit status tells whether there was an answer."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--question", default="Shall we play?", help="a question to be answered with yes or no")
    parser.add_argument("--timeout", type=float, default=8.0, help="s to wait for an answer (default: 8)")
    parser.add_argument("--times", type=int, default=3, help="how often to ask (default: 3)")
    parser.add_argument("--person", metavar="ANSWER", help="simulator only: a person calls the robot and answers this")
    parser.add_argument(
        "--place",
        nargs=3,
        type=float,
        default=[1.0, 0.4, 0.6],
        metavar=("X", "Y", "Z"),
        help="where the person's mouth is, m, in the world; the robot begins in its middle (default: 1.0 0.4 0.6)",
    )
    parser.add_argument("--record", metavar="NAME", help="record the front microphones to this file of the robot")
    parser.add_argument("--log", type=Path, metavar="FILE", help="write who said and heard what, and when (JSON)")
    parser.add_argument("--overwrite", action="store_true", help="replace files of these names")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("dialogue", anonymous=True, disable_signals=True)  # Ctrl-C leaves time to end the recording
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        if options.log:
            options.log = require_new(options.log, options.overwrite)
        return talk(Servers(), options)
    except (RuntimeError, OSError, rospy.ServiceException, rospy.ROSException) as error:
        print(error)
        return 1
    except KeyboardInterrupt:
        return 130


def talk(servers: Servers, options: argparse.Namespace) -> int:
    """Have the dialogue, and keep of it what is wanted; the exit status."""
    person = Person(options.place) if options.person else None
    if options.record:
        start = AudioInFunction(function="startRecording", str_param=options.record, overwrite=options.overwrite)
        servers.play("nao_audio_in", actions.NaoAudioInGoal([start]))
    notes = Notes(person.time if person else rospy.get_time)
    try:
        dialogue = Dialogue(servers, notes, person, options.timeout)
        if person:
            dialogue.turn_to_call()
        for _ in range(options.times):
            word = dialogue.ask(options.question, options.person)
            if word:
                break
        else:
            dialogue.say("I did not hear you.")
            return 1
        answer, joint, angle = ANSWERS[word]
        dialogue.say(answer)
        dialogue.gesture(joint, angle)
        return 0
    finally:
        try:
            if options.log:
                save(notes.turns, options.log)
                print(f"written: {options.log}")
        finally:
            if options.record:
                stop = AudioInFunction(function="stopRecording")
                for file in servers.play("nao_audio_in", actions.NaoAudioInGoal([stop])).files:
                    print(f"written: {file.file or f'{file.path}, on the robot'}")


if __name__ == "__main__":
    sys.exit(main())
