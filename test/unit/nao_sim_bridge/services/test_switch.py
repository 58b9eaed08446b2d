"""What works while somebody is subscribed and it is not paused."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.switch import Switch


class Lamp(Switch):
    """Notes whether it works."""

    def __init__(self):
        super().__init__()
        self.shone = []

    def _update(self):
        self.shone.append(self._works)


def test_it_works_while_it_is_wanted_and_not_paused():
    lamp = Lamp()
    lamp.start()
    lamp.pause(True)
    assert lamp.paused
    lamp.pause(False)
    lamp.stop()
    assert lamp.shone == [True, False, True, False]


def test_a_switch_that_does_nothing_cannot_be_made():
    class Blind(Switch):
        pass

    with pytest.raises(TypeError, match="abstract.*_update"):
        Blind()
