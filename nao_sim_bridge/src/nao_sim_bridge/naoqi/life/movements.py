"""What the robot does with its body by itself, and ALAutonomousMoves.

It breathes, moves while it speaks, nods to who speaks to it, and blinks: each is switched on and off. Simulation thread
only, but for `SpeakingMovement`'s and `ListeningMovement`'s ears.
"""

from __future__ import annotations

import random
from contextlib import suppress
from typing import Any

from nao_sim_bridge.base.errors import BadValue, SimulationStopped
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.leds import LedKeyframe
from nao_sim_bridge.control.joints.idle import Mode
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.speech import body_language, speaker
from nao_sim_bridge.speech.animations import AnimationLibrary
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.clips import SpokenWord
from nao_sim_bridge.speech.gesture import Animation, KeyFrames
from nao_sim_bridge.speech.speaker import Speaker, SpeechEvent
from nao_sim_bridge.tracking.geometry import HEAD

NAME = "ALAutonomousMoves"
BODY, EYES = "Body", "FaceLeds"
NONE, BACK_TO_NEUTRAL = "none", "backToNeutral"
STRATEGIES = (NONE, BACK_TO_NEUTRAL)
VOICE = "SpeechDetected"
NOD = Animation("nod", 1.0, (), {"HeadPitch": KeyFrames((0.4,), (0.1,))})
# Who speaks gets a nod so often at most, s.
NOD_PAUSE = 3.0
# Pauses between two blinks, s; how long eyes take to close, stay closed, and take to open, s.
PAUSES = (2.0, 6.0)
CLOSE, CLOSED, OPEN = 0.06, 0.05, 0.1


class BackgroundMovement:
    """What chains do that nobody moves: they breathe, or else follow the strategy, one of `STRATEGIES`."""

    def __init__(self, simulation: Any) -> None:
        self.strategy = NONE
        self._simulation = simulation
        self._breathes = False

    def switch(self, on: bool) -> None:
        """Breathe, or breathe no longer."""
        self._breathes = on
        self.update()

    @property
    def moves(self) -> bool:
        """Whether the robot breathes now."""
        return self._simulation.robot.reflexes.idle.breathes

    def update(self) -> None:
        mode = Mode.BREATH if self._breathes else Mode.POSTURE if self.strategy == BACK_TO_NEUTRAL else Mode.NOTHING
        self._simulation.robot.reflexes.idle.set_mode(BODY, mode)


class SpeakingMovement:
    """Moves arms and head while ALTextToSpeech speaks; gestures that ALAnimatedSpeech plans replace these."""

    def __init__(
        self,
        mouth: Speaker,
        animator: Animator,
        library: AnimationLibrary,
        body_language: body_language.BodyLanguage,
        seed: int,
    ) -> None:
        self._mouth = mouth
        self._animator = animator
        self._library = library
        self._body_language = body_language
        self._chance = random.Random(seed)
        self._on = False
        mouth.listeners.insert(0, self._hear)

    def switch(self, on: bool) -> None:
        if self._on and not on:
            self._animator.drop_plans()
        self._on = on

    @property
    def moves(self) -> bool:
        """Whether the robot speaks, and moves with it."""
        return self._mouth.speaking and (self._animator.busy or self._animator.plans)

    def _hear(self, event: SpeechEvent) -> None:
        if not self._on or event.kind != speaker.SENTENCE or self._animator.busy:
            return
        clip = event.value
        words = [(time, mark.text) for time, mark in clip.marks if isinstance(mark, SpokenWord)]
        self._animator.plan(
            body_language.plan(
                clip.sound.duration,
                words,
                self._body_language.mode,
                self._library,
                self._chance,
                self._animator.posture,
                clip.text,
            )
        )


class ListeningMovement:
    """Nods, if enabled, when somebody speaks to the robot, which speech recognition tells while it runs."""

    def __init__(self, runner: RobotRunner, memory: MemoryStore, animator: Animator) -> None:
        self.enabled = True
        self._runner = runner
        self._animator = animator
        self._on = False
        self._next = 0.0
        memory.listen(VOICE, self._hear)

    def switch(self, on: bool) -> None:
        self._on = on

    @property
    def moves(self) -> bool:
        """Whether the robot nods now."""
        return self._animator.running(NOD) is not None

    def _hear(self, voice: Any) -> None:
        if not (self._on and self.enabled and voice):
            return
        with suppress(SimulationStopped):
            self._runner.execute(self._nod, "listening")

    def _nod(self) -> None:
        robot, now = self._runner.simulation.robot, self._runner.simulation.time
        head = [robot.model.joint_index[name] for name in HEAD]
        if now < self._next or robot.motion.busy(head) or self._animator.limp_joints(NOD):
            return
        self._next = now + NOD_PAUSE
        self._animator.start(NOD)


class Blinking:
    """Blinks while it is switched on, and not while somebody else changes the LEDs of the eyes."""

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self._chance = random.Random(simulation.scene.seed)
        self._next: float | None = None
        self._devices = simulation.led_layout.devices_of(EYES)
        simulation.after_tick.append(self._tick)

    def switch(self, on: bool) -> None:
        self._next = self._simulation.time + self._chance.uniform(*PAUSES) if on else None

    def _tick(self, now: Any) -> None:
        if self._next is None or now.time < self._next:
            return
        self._next = now.time + self._chance.uniform(*PAUSES)
        robot = self._simulation.robot
        if robot.leds.busy(self._devices):
            return
        shown = {i: robot.leds.values[i] for i in self._devices}
        dark = dict.fromkeys(self._devices, 0.0)
        times = (CLOSE, CLOSE + CLOSED, CLOSE + CLOSED + OPEN)
        frames = [LedKeyframe(time, values) for time, values in zip(times, (dark, dark, shown))]
        robot.leds.animate("blink", frames, robot.time)


class ALAutonomousMoves:
    """ALAutonomousMoves as the simulated robot offers it."""

    def __init__(self, background: BackgroundMovement, listening: ListeningMovement, runner: RobotRunner) -> None:
        self._background = background
        self._listening = listening
        self._runner = runner

    def getBackgroundStrategy(self) -> str:
        return self._background.strategy

    def setBackgroundStrategy(self, strategy: str) -> Task:
        if strategy not in STRATEGIES:
            raise BadValue("strategy", strategy, " or ".join(STRATEGIES))

        def change() -> None:
            self._background.strategy = strategy
            self._background.update()

        return self._runner.execute(change, "setBackgroundStrategy")

    def getExpressiveListeningEnabled(self) -> bool:
        return self._listening.enabled

    def setExpressiveListeningEnabled(self, enable: bool) -> None:
        self._listening.enabled = bool(enable)

    def startSmallDisplacements(self) -> Task:
        """Since NAOqi 2.0 this is the breath."""
        return self._runner.execute(lambda: self._background.switch(True), "startSmallDisplacements")

    def stopSmallDisplacements(self) -> Task:
        return self._runner.execute(lambda: self._background.switch(False), "stopSmallDisplacements")
