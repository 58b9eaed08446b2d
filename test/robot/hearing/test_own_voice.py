"""How loud the own loudspeakers are at the microphones, foretold and heard."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.base.samples import RATE, Sound, sine
from nao_sim_bridge.hearing.localiser import OwnVoice


def test_the_own_voice_is_foretold_as_the_microphones_hear_it(bench):
    one = bench(posture="Crouch", stiffness=0.0)
    sound, own = one.simulation.sound, OwnVoice(one.simulation.sound)
    one.run(0.2)
    assert own.power(0.0, 0.15) == 0.0  # nothing plays
    noise = Sound(0.1 * np.random.default_rng(3).standard_normal(RATE // 2).astype(np.float32))
    sound.loudspeakers.play(noise, "noise")
    one.run(0.6)
    heard = sound.microphones.heard(0.3, 0.6).astype(float) * 32768.0
    assert own.power(0.3, 0.6) == pytest.approx(np.mean(heard**2), rel=0.1)
    powers = []
    for pan in (-1.0, 1.0, 0.0):
        playing = sound.loudspeakers.play(sine(500.0, 1.0), "tone", pan=pan)
        one.run(0.3)
        powers.append(own.power(sound.time - 0.2, sound.time))
        playing.stop()
        one.run(0.1)
    assert powers[1] == pytest.approx(powers[0], rel=0.1) and powers[2] > 1.8 * powers[0]
