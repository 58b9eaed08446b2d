"""The console with two robots: each page is of one of them, and what is pressed there is done by that one."""

from __future__ import annotations

import pytest
import qi
import rosgraph
from console_browser import LIMIT, ConsoleBrowser, ConsoleProgram
from selenium.webdriver.common.keys import Keys

from nao_library_modules.ros.own_stack import OwnStack
from nao_sim_bridge.testing import wait_until

TEXT = "ALTextToSpeech/CurrentSentence"


@pytest.mark.timeout(1800)
def test_each_page_is_of_one_robot(tmp_path):
    with OwnStack(tmp_path / "stack.txt", {"robots": "2", "cameras": "false"}) as stack:
        stack.wait_for_robot(LIMIT)
        master = rosgraph.Master("/test", stack.master_uri)
        sessions = [qi.Session(), qi.Session()]
        for name, session in zip(("nao1", "nao2"), sessions):
            session.connect(f"tcp://127.0.0.1:{master.getParam(f'/{name}/nao_sim/bound_port')}")
        for session in sessions:
            session.waitForService("ALMemory")
        said = [session.service("ALMemory").subscriber(TEXT).signal for session in sessions]
        heard = [[], []]
        for signal, texts in zip(said, heard):
            signal.connect(texts.append)
        program = ConsoleProgram(tmp_path, master=stack.master_uri)
        browser = ConsoleBrowser(program).enter()
        try:
            browser.until(lambda: _names(browser) == ["nao1", "nao2"], "both robots")
            browser.open("/wizard", "nao2")
            browser.type("input[aria-label='Say']", "I am the second")
            browser.keys(Keys.ENTER)
            wait_until(lambda: "I am the second" in str(heard[1]), LIMIT, "what the second one says")
            assert "I am the second" not in str(heard[0])
            browser.open("/", "nao1")
            browser.reads(f"connected 127.0.0.1:{stack.nao_port}")
        finally:
            browser.close()
            program.close()
            for session in sessions:
                session.close()


def _names(browser):
    """What the choice of the robot has."""
    browser.open("/functions", "nao1")
    browser.click(".nao-robot")
    return browser.texts(".q-menu .q-item")
