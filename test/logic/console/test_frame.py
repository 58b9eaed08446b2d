"""What every page has, as far as its sources tell."""

from __future__ import annotations

import re

from console_overlays import OVERLAYS, overlays_in_code, paths_in_code

from nao_library_modules.console.access.connections import PERIOD
from nao_library_modules.core.files import config_file

TOLD_WITHIN = 2.0
"""s, after which a page says that its console does not answer."""


def constant(name):
    """A number of frame.js."""
    text = config_file("console/static/frame.js").read_text(encoding="utf-8")
    return float(re.search(rf"^const {name} = (\d+);", text, re.M)[1])


def test_whatever_opens_over_a_page_is_opened_by_the_case_that_looks_for_stop():
    assert overlays_in_code() == set(OVERLAYS)


def test_every_page_that_something_opens_over_is_a_page():
    assert {each.page for each in OVERLAYS.values() if each is not None} <= paths_in_code()


def test_a_page_says_within_two_seconds_that_its_console_does_not_answer():
    silent, look = constant("SILENT") / 1000, constant("LOOK") / 1000
    assert silent + look < TOLD_WITHIN and silent > 2 * PERIOD
