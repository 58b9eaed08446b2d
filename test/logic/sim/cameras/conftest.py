"""The cameras of a robot without physics."""

from __future__ import annotations

import pytest
from plain_cameras import Head


@pytest.fixture
def head():
    made = Head()
    yield made
    made.close()
