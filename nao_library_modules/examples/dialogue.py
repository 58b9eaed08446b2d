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

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point

import nao_library_actions.msg as actions
from nao_library_modules.dialogue_record import DOES, HEARS, PERSON, ROBOT, SAYS, Turn, save
from nao_library_msgs.msg import AudioInFunction, AudioOutFunction, MotionFunction
from nao_library_msgs.srv import PersonSays

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
            name: actionlib.SimpleActionClient(name, getattr(actions, f"{action}Action"))
            for name, action in (("nao_audio_out", "NaoAudioOut"), ("nao_audio_in", "NaoAudioIn"), ("NaoMotion",) * 2)
        }
        for name, client in self._clients.items():
            if not client.wait_for_server(LIMIT):
                raise RuntimeError(f"there is no server {name}: start one with roslaunch nao_library nao_sim.launch")

    def play(self, name: str, goal: Any, meanwhile: Callable[[], None] | None = None) -> Any:
        """Play a goal to its end; its result.

        Args:
            name: Name of the server.
            goal: What to do.
            meanwhile: What is done once the robot listens.
        """
        client = self._clients[name]
        if meanwhile is None:
            client.send_goal_and_wait(goal, LIMIT)
        else:
            self._play_with(client, goal, meanwhile)
        if client.get_state() != GoalStatus.SUCCEEDED:
            raise RuntimeError(client.get_goal_status_text() or f"no result of {name}")
        return client.get_result()

    def _play_with(self, client: Any, goal: Any, meanwhile: Callable[[], None]) -> None:
        moment = threading.Event()

        def follow(feedback: Any) -> None:
            if feedback.status == "ListenOn" or feedback.function == "localizeSound":
                moment.set()

        client.send_goal(goal, done_cb=lambda *_: moment.set(), feedback_cb=follow)
        try:
            if moment.wait(LIMIT.to_sec()) and client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
                meanwhile()
        except Exception:
            client.cancel_goal()
            raise
        if not client.wait_for_result(LIMIT):
            client.cancel_goal()


class Notes:
    """What happens in a dialogue, in ROS time from now on."""

    def __init__(self) -> None:
        """Begin."""
        self.turns: list[Turn] = []
        self._began = rospy.get_time()

    def now(self) -> float:
        """Time since the beginning, s."""
        return rospy.get_time() - self._began

    def add(self, who: str, what: str, text: str, began: float, confidence: float | None = None) -> None:
        """Note, and tell, what has just ended and began at a time, s."""
        turn = Turn(who, what, text, began, self.now(), confidence)
        print(f"heard: {turn.title}" if what == HEARS else f"{who}: {text}" if what == SAYS else f"{who} {text}")
        self.turns.append(turn)


class Person:
    """Somebody in the simulated world, at a place (x, y, z) in it, m."""

    def __init__(self, place: list[float], notes: Notes) -> None:
        """Find the world."""
        self._place = Point(*place)
        self._notes = notes
        self._says = rospy.ServiceProxy("nao_sim/person_says", PersonSays)
        try:
            self._says.wait_for_service(5.0)
        except rospy.ROSException as error:
            raise RuntimeError(
                "there is no simulator to put a person in (no service nao_sim/person_says): leave out --person, and "
                "answer the robot yourself"
            ) from error

    def say(self, text: str) -> None:
        """Say something, after a moment."""
        rospy.sleep(REACTION)
        began = self._notes.now()
        try:
            answer = self._says(text, self._place, VOICE, 0.0)
        except rospy.ServiceException as error:
            raise RuntimeError(f"the person cannot speak: {error}") from error
        if not answer.success:
            raise RuntimeError(f"the person cannot speak: {answer.message}")
        self._notes.add(PERSON, SAYS, text, began)


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
        self._notes.add(ROBOT, SAYS, text, began)

    def turn_to_call(self) -> None:
        """Wait for a voice and turn the head there."""
        sounds = self._listen(CALL, function="localizeSound", confidence=0.3).sounds
        if not sounds:
            print("nobody calls")
            return
        self._yaw = max(-FARTHEST, min(FARTHEST, sounds[0].base_azimuth))
        text = f"a voice at {math.degrees(sounds[0].base_azimuth):.0f}°"
        self._notes.add(ROBOT, HEARS, text, self._notes.now(), sounds[0].confidence)
        self._move("turns its head", "HeadYaw", [self._yaw], [0.8])

    def ask(self, question: str, answer: str | None) -> str:
        """Ask, and listen; what was heard, empty if nothing was."""
        self.say(question)
        heard = self._listen(answer, function="listen", vocabulary=list(ANSWERS), confidence=0.3)
        if not heard.words:
            return ""
        self._notes.add(ROBOT, HEARS, heard.words[0], self._notes.now(), heard.confidences[0])
        return heard.words[0]

    def gesture(self, joint: str, angle: float) -> None:
        """Nod, or shake the head."""
        around = self._yaw if joint == "HeadYaw" else 0.0
        angles = [around + part * angle for part in (1.0, -1.0, 1.0, 0.0)]
        text = "shakes its head" if joint == "HeadYaw" else "nods"
        self._move(text, joint, angles, [0.4, 0.8, 1.2, 1.6])

    def _listen(self, text: str | None, **fields: Any) -> Any:
        goal = actions.NaoAudioInGoal([AudioInFunction(timeout=self._timeout, **fields)])
        person = self._person
        return self._servers.play("nao_audio_in", goal, person and (lambda: person.say(text)))

    def _move(self, text: str, joint: str, angles: list[float], times: list[float]) -> None:
        began = self._notes.now()
        turn = MotionFunction(function="angleInterpolation", names=[joint], stiffness=1.0, angles=angles, times=times)
        self._servers.play("NaoMotion", actions.NaoMotionGoal([turn]))
        self._notes.add(ROBOT, DOES, text, began)


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
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("dialogue", anonymous=True, disable_signals=True)  # Ctrl-C leaves time to end the recording
    rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
    try:
        return talk(Servers(), options)
    except (RuntimeError, OSError) as error:
        print(error)
        return 1
    except KeyboardInterrupt:
        return 130


def talk(servers: Servers, options: argparse.Namespace) -> int:
    """Have the dialogue, and keep of it what is wanted; the exit status."""
    if options.record:
        start = AudioInFunction(function="startRecording", str_param=options.record)
        servers.play("nao_audio_in", actions.NaoAudioInGoal([start]))
    notes = Notes()
    try:
        person = Person(options.place, notes) if options.person else None
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
        if options.log:
            save(notes.turns, options.log)
        if options.record:
            servers.play("nao_audio_in", actions.NaoAudioInGoal([AudioInFunction(function="stopRecording")]))


if __name__ == "__main__":
    sys.exit(main())
