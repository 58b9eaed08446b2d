"""What behaviours are made of."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from nao_library_modules.behaviors.model import Step


def test_a_kind_of_step_that_does_not_say_what_it_is_cannot_be_made():
    @dataclass(frozen=True)
    class Jump(Step):
        height: float = 0.1

    with pytest.raises(TypeError, match="abstract.*what"):
        Jump(("do", 0))
