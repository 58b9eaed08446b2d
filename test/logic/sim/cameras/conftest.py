"""The cameras of a robot without physics."""

from __future__ import annotations

import pytest
from plain_cameras import Head


@pytest.fixture
def head_of():
    """Makes cameras; they are closed after the test."""
    made = []

    def make(**options):
        made.append(Head(**options))
        return made[-1]

    yield make
    for head in made:
        head.close()


@pytest.fixture
def head(head_of):
    return head_of()
