"""One text that is spoken with gestures. Simulation thread, but for the constructor."""

from __future__ import annotations

import logging
import random
from typing import Any, Callable, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.speech.annotated_text import (
    ANIMATION,
    SOUND,
    Instruction,
    method_call,
    path_and_tag,
    read,
    sound_and_volume,
)
from nao_sim_bridge.speech import body_language, speaker
from nao_sim_bridge.speech.animations import AnimationLibrary
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.clips import Clip, SpokenWord, Style
from nao_sim_bridge.speech.gesture import Animation
from nao_sim_bridge.speech.sentences import Item
from nao_sim_bridge.speech.speaker import Speaker, SpeechEvent
from nao_sim_bridge.speech.studio import Studio
from nao_sim_bridge.speech.tags import Cue, Gate, Piece

log = logging.getLogger("nao_sim.speech")

# Calls a method of a module and ends with its answer: module, method, arguments.
Caller = Callable[[str, str, list], Task]
# Plays a sound of a sound set, "set/file", at a volume, 0..1; the task may end with one that ends with the sound.
PlaySound = Callable[[str, float], Task]


class AnimatedTalk:
    """Reads an annotated text, has it spoken, and moves the robot along.

    `mode` is the body language where no instruction says otherwise; without `call`, instructions that call methods are
    left out. A BadValue when the text is too long, or its pauses are together.
    """

    def __init__(
        self,
        text: str,
        style: Style,
        mode: str,
        studio: Studio,
        library: AnimationLibrary,
        chance: random.Random,
        call: Caller | None,
        play_sound: PlaySound,
        posture: Callable[[], str],
    ) -> None:
        studio.check_length(text)
        self._style = style
        self._mode = mode
        self._library = library
        self._chance = chance
        self._call = call
        self._play_sound = play_sound
        # Sounds that this text has begun, by name.
        self._sounds: dict[str, Task] = {}
        self._posture = posture
        self._animator: Animator | None = None
        self._speech: Task | None = None
        self._began = False
        # Which animation a tag stands for in this text.
        self._of_tag: dict[str, Animation] = {}
        self._told_limp = False
        pieces: list[Piece] = []
        for part in read(text):
            if isinstance(part, Instruction):
                pieces += self._piece(part)
            else:
                pieces += studio.tags.read(part, style.prosody)
        self._items: list[Item] = studio.sentences_of(text, pieces)

    def start(self, simulation: Any, mouth: Speaker, animator: Animator) -> Task:
        """Speak; the task ends when the text is said and the joints are back. Killing it is silence at once."""
        self._animator = animator

        def stop(_: Task) -> None:
            speech.kill()

        def finish(_: Task) -> None:
            mouth.listeners.remove(self._hear)
            if speech.error is not None:  # it cannot be said, or the simulation has ended
                whole.finish(error=speech.error)
            moves = animator.stop_all() if self._began else []
            _after(moves, whole.finish)

        whole = simulation.task_ids.make("say", on_kill=stop)
        mouth.listeners.append(self._hear)
        speech = self._speech = mouth.say(self._items, self._style)
        speech.add_done_callback(finish)
        return whole

    # --- what happens while it is spoken --------------------------------------------------------------------------

    def _hear(self, event: SpeechEvent) -> None:
        if self._speech is None or event.task_id != self._speech.task_id:
            return
        if event.kind == speaker.STARTED:
            self._began = True
        elif event.kind == speaker.SENTENCE:
            self._plan(event.value)

    def _plan(self, clip: Clip) -> None:
        words = [(time, mark.text) for time, mark in clip.marks if isinstance(mark, SpokenWord)]
        # From the first instruction on there are the gestures that it asks for.
        until = min((time for time, mark in clip.marks if isinstance(mark, Cue)), default=clip.sound.duration)
        words = [word for word in words if word[0] < until]
        gestures = body_language.plan(until, words, self._mode, self._library, self._chance, self._posture(), clip.text)
        for gesture in gestures:
            self._tell_limp(gesture.animation)
        self._animator.plan([] if self._animator.busy else gestures)

    def _tell_limp(self, animation: Animation) -> None:
        limp = self._animator.limp_joints(animation)
        if limp and not self._told_limp:
            self._told_limp = True
            alone = "speaks without gestures" if len(limp) > 3 else "moves less than its gestures ask for"
            log.warning("%s: %s... are limp; wakeUp or a stiffness comes first", alone, ", ".join(limp[:3]))

    # --- instructions ---------------------------------------------------------------------------------------------

    def _piece(self, instruction: Instruction) -> list[Piece]:
        """What an instruction becomes: a cue goes by, at a gate the voice waits."""
        act, value = instruction.act, instruction.value
        if act == "mode":
            if value not in body_language.MODES:
                log.warning("^mode(%s) is left out, there are %s", value, ", ".join(body_language.MODES))
                return []
            return [Gate(lambda: self._set_mode(value))]
        if act in ("call", "post"):
            return self._call_piece(instruction)
        if instruction.kind == SOUND:
            return self._sound_piece(act, value)
        animation = self._animation(instruction)
        if animation is None:
            log.warning("there is no animation for %s %r: it is left out", instruction.kind, value)
            return []
        if act == "start":
            return [Cue(lambda: self._begin(animation))]
        if act == "stop":
            return [Cue(lambda: self._animator.stop(animation))]
        if act == "wait":
            return [Gate(lambda: self._animator.running(animation))]
        return [Gate(lambda: self._begin(animation))]

    def _call_piece(self, instruction: Instruction) -> list[Piece]:
        if self._call is None:
            log.warning("^%s is left out: behaviours call no methods", instruction.act)
            return []
        try:
            module, method, arguments = method_call(instruction.value)
        except ValueError as error:
            log.warning("^%s is left out: %s", instruction.act, error)
            return []
        if instruction.act == "call":
            return [Gate(lambda: self._call(module, method, arguments))]
        return [Cue(lambda: self._call(module, method, arguments))]

    def _sound_piece(self, act: str, value: str) -> list[Piece]:
        """A sound goes on when the text is over."""
        try:
            sound, volume = sound_and_volume(value)
        except ValueError as error:
            log.warning("a sound is left out: %s", error)
            return []

        def begin() -> Task:
            task = self._sounds[sound] = until_over(self._play_sound(sound, volume))
            task.add_done_callback(self._tell_silence)
            return task

        if act == "start":
            return [Cue(begin)]
        if act == "run":
            return [Gate(begin)]
        if act == "wait":
            return [Gate(lambda: self._sounds.get(sound))]
        return [Cue(lambda: self._sounds[sound].kill() if sound in self._sounds else None)]

    def _tell_silence(self, done: Task) -> None:
        if done.error is not None:
            log.warning("a sound of a text is not played: %s", done.error)

    def _animation(self, instruction: Instruction) -> Animation | None:
        if instruction.kind == ANIMATION:
            return self._library.find(instruction.value, self._posture())
        path, tag = path_and_tag(instruction.value)
        posture = self._posture()
        tagged = self._library.tagged(tag, posture) if path is None else self._library.below(path, tag, posture)
        if tagged and instruction.value not in self._of_tag:
            self._of_tag[instruction.value] = self._chance.choice(tagged)
        return self._of_tag.get(instruction.value)

    def _begin(self, animation: Animation) -> Task:
        self._animator.drop_plans()
        self._tell_limp(animation)
        return self._animator.start(animation)

    def _set_mode(self, mode: str) -> None:
        self._mode = mode
        if mode == body_language.DISABLED:
            self._animator.drop_plans()


def _after(tasks: Sequence[Task], then: Callable[[], Any]) -> None:
    left = list(tasks)
    if not left:
        then()
        return
    left[0].add_done_callback(lambda _: _after(left[1:], then))


def until_over(command: Task) -> Task:
    """A task that ends when a command and what it has begun have ended; killing it ends that, or what it will begin."""

    def settle(done: Task) -> None:
        if isinstance(done.value, Task):
            done.value.add_done_callback(settle)
        elif not whole.finished:
            whole.finish(error=done.error)

    whole = Task(command.name, 0, on_kill=lambda _: command.request_kill())
    command.add_done_callback(settle)
    return whole
