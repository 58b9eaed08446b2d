"""What the robot does with its body by itself: it breathes, moves while it speaks, and nods to who speaks to it.

Simulation thread only, but for `SpeakingMovement`'s and `ListeningMovement`'s ears.
"""

from __future__ import annotations

import random
from typing import Any

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.control.joints.idle import Mode
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.speech import body_language, speaker
from nao_sim_bridge.speech.animations import Animation, AnimationLibrary, KeyFrames
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.clips import SpokenWord
from nao_sim_bridge.speech.speaker import Speaker, SpeechEvent
from nao_sim_bridge.tracking.geometry import HEAD

BODY = "Body"
NONE, BACK_TO_NEUTRAL = "none", "backToNeutral"
STRATEGIES = (NONE, BACK_TO_NEUTRAL)
VOICE = "SpeechDetected"
NOD = Animation("nod", 1.0, (), {"HeadPitch": KeyFrames((0.4,), (0.1,))})
# Who speaks gets a nod so often at most, s.
NOD_PAUSE = 3.0


class BackgroundMovement:
    """What chains do that nobody moves: they breathe, or go back to the posture of the robot, or nothing.

    Attributes:
        strategy: One of `STRATEGIES`: what they do while they do not breathe.
    """

    def __init__(self, simulation: Any) -> None:
        self.strategy = NONE
        self._simulation = simulation
        self._breathes = False

    def start(self) -> None:
        self._breathes = True
        self.update()

    def stop(self) -> None:
        """Breathe no longer."""
        self._breathes = False
        self.update()

    def update(self) -> None:
        mode = Mode.BREATH if self._breathes else Mode.POSTURE if self.strategy == BACK_TO_NEUTRAL else Mode.NOTHING
        self._simulation.robot.reflexes.idle.set_mode(BODY, mode)


class SpeakingMovement:
    """Moves arms and head while ALTextToSpeech speaks; gestures that ALAnimatedSpeech plans replace these."""

    def __init__(self, mouth: Speaker, animator: Animator, library: AnimationLibrary, seed: int) -> None:
        self._animator = animator
        self._library = library
        self._chance = random.Random(seed)
        self._on = False
        mouth.listeners.insert(0, self._hear)

    def start(self) -> None:
        self._on = True

    def stop(self) -> None:
        """Speak without gestures."""
        if self._on:
            self._animator.drop_plans()
        self._on = False

    def _hear(self, event: SpeechEvent) -> None:
        if not self._on or event.kind != speaker.SENTENCE or self._animator.busy:
            return
        clip = event.value
        words = [(time, mark.text) for time, mark in clip.marks if isinstance(mark, SpokenWord)]
        self._animator.plan(
            body_language.plan(clip.sound.duration, words, body_language.CONTEXTUAL, self._library, self._chance)
        )


class ListeningMovement:
    """Nods when somebody speaks to the robot, which speech recognition tells while it runs.

    Attributes:
        enabled: Whether it does so when it is switched on.
    """

    def __init__(self, simulation: Any, runner: SimulationRunner, memory: MemoryStore, animator: Animator) -> None:
        self.enabled = True
        self._simulation = simulation
        self._runner = runner
        self._animator = animator
        self._on = False
        self._next = 0.0
        memory.listen(VOICE, self._hear)

    def start(self) -> None:
        self._on = True

    def stop(self) -> None:
        """Listen without a movement."""
        self._on = False

    def _hear(self, voice: Any) -> None:
        if not (self._on and self.enabled and voice):
            return
        try:
            self._runner.execute(self._nod, "listening")
        except SimulationStopped:
            pass

    def _nod(self) -> None:
        robot, now = self._simulation.robot, self._simulation.time
        head = [robot.model.joint_index[name] for name in HEAD]
        if now < self._next or robot.motion.busy(head) or not self._animator.can(NOD):
            return
        self._next = now + NOD_PAUSE
        self._animator.start(NOD)
