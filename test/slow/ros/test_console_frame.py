"""Stop in every state of every page, and pages whose console is gone, in a real browser."""

from __future__ import annotations

import time
from pathlib import Path

import rospy
from console_browser import LIMIT, ConsoleBrowser
from console_clients import stopped
from console_overlays import OVERLAYS, paths_in_code
from selenium.webdriver.common.keys import Keys

from nao_library_actions.msg import NaoAudioOutActionGoal
from nao_library_modules.console.access.connections import LATE
from nao_sim_bridge.testing import wait_until

READY = {
    **{"/wizard": "nao-wizard-buttons button", "/behaviors": ".q-item", "/functions": ".q-item"},
    "/study/replay": "canvas",
}
"""Pages that ask for what they show -> what is there then."""
WIDTHS = (1440, 1024, 390)
HEIGHT = 900
STOP = (Path(__file__).parents[2] / "support" / "stop_button.js").read_text(encoding="utf-8")
NOTICES = """
for (const type of ["positive", "negative", "warning", "info"])
  Quasar.Notify.create({ type, message: `${type}: ${"a long notice ".repeat(20)}`, multiLine: true, timeout: 0 });
"""
CLOSE_NOTICES = "document.querySelectorAll('.q-notification').forEach((each) => each.remove());"
PLACES = """
return [...document.querySelectorAll(".nao-main button, .nao-main .q-field, .nao-header button")]
  .map((each) => each.getBoundingClientRect()).map(({ x, y, width, height }) => [x, y, width, height].join(" "));
"""
COUNT_STOPS = "window.stops = 0; window.addEventListener('nao-stop', () => (window.stops += 1));"
RING = """
const stop = document.querySelector(".nao-stop");
stop.focus({ focusVisible: true });
const { outlineStyle, outlineWidth } = getComputedStyle(stop);
return [stop.matches(":focus-visible"), outlineStyle, parseFloat(outlineWidth) > 0];
"""


class StopLooks:
    """Looks at Stop at all widths, and what was wrong."""

    def __init__(self, browser):
        self.browser, self.wrong = browser, []

    def look(self, what):
        for width in WIDTHS:
            self.browser.width(width, HEIGHT)
            self.wrong += [f"{what}, {width} pixels wide: {each}" for each in self.browser.script(STOP)]
        self.browser.width(WIDTHS[0], HEIGHT)


def test_nothing_covers_stop_on_any_page(browser):
    looks = StopLooks(browser)
    paths = sorted(paths_in_code(), key=lambda path: (path.startswith("/study"), path))
    for path in paths:
        more = {"trial": "ten_steps/P01-1"} if path == "/study/replay" else {}
        open_page(browser, path, more)
        looks.look(path)
        if path != "/":  # whose robot moves, and what is told of it
            before = browser.script(PLACES)
            browser.script(NOTICES)
            assert browser.script(PLACES) == before, f"{path}: a notice moves what is there"
        else:
            browser.script(NOTICES)
        looks.look(f"{path} with notices")
        for name, overlay in OVERLAYS.items():
            if overlay is not None and overlay.page == path:
                open_page(browser, path, more)
                for verb, css, text in overlay.steps:
                    getattr(browser, verb)(css, text)
                browser.one(overlay.shown)
                browser.script(NOTICES)
                looks.look(f"{path} with {name}")
                for _ in range(overlay.escapes):
                    browser.keys(Keys.ESCAPE)
                if overlay.closes:
                    browser.until(lambda overlay=overlay: not browser.all(overlay.shown), f"the end of {name}")
                assert browser.script("return window.stops") == 0, f"{name}: Escape closes it, and stops nothing"
    open_page(browser, "/study", {})
    browser.click("button", "Abort")
    browser.click("button", "Abort the trial")
    browser.reads("is aborted")
    assert looks.wrong == []


def open_page(browser, path, more):
    """Open a page with what its overlays need: a study needs a participant."""
    if path == "/study":
        more = {"protocol": "ten_steps", "participant": "P01"}
    browser.open(path, **more)
    if path in READY:
        browser.one(READY[path])
    browser.script(COUNT_STOPS)


def test_stop_has_a_name_a_ring_and_states_of_the_console(browser):
    browser.open("/functions")
    assert browser.script("return document.querySelector('.nao-stop').getAttribute('aria-label')") == "Stop the robot"
    assert browser.script(RING) == [True, "solid", True]
    browser.keys(Keys.ESCAPE)
    browser.until(lambda: "Stopped" in browser.texts(".nao-stop-state"), "the end of the stop")


def test_who_looks_on_may_stop(program):
    other = ConsoleBrowser(program)
    try:
        other.enter(program.observer)
        other.open("/functions")
        other.click(".nao-stop")
        other.until(lambda: "Stopped" in other.texts(".nao-stop-state"), "the end of the stop")
    finally:
        other.close()


def test_a_page_whose_console_hangs_says_so_and_sends_nothing_late(program, browser):
    goals = []
    subscriber = rospy.Subscriber("nao_audio_out/goal", NaoAudioOutActionGoal, goals.append)
    browser.open("/wizard")
    browser.one("nao-wizard-buttons button")
    if not browser.all(".nao-holder", "You have the controls"):
        browser.click(".nao-holder")
    browser.until(lambda: browser.all(".nao-holder", "You have the controls"), "the controls")
    try:
        wait_until(subscriber.get_num_connections, LIMIT, "the console")
        with stopped(program.process.pid):
            pressed = time.monotonic()
            browser.script("document.activeElement.blur()")
            browser.keys("2")
            browser.type("input[aria-label='Say']", "Too late")
            browser.keys(Keys.ENTER)
            browser.reads("does not answer", "chest button", "nao stop")
            looks = StopLooks(browser)
            looks.look("a console that hangs")
            assert looks.wrong == [] and not browser.all(".nao-holder", "You have the controls")
            browser.keys(Keys.ENTER)  # not sent: the page knows
            wait_until(lambda: time.monotonic() > pressed + LATE + 1.0, LIMIT, "the time after which a press is late")
        browser.until(lambda: browser.script("return document.body.dataset.console") == "", "the console")
        browser.until(lambda: browser.all(".nao-holder", "controls"), "who holds the controls")
        browser.until(lambda: not browser.all("nao-wizard-buttons .told", "no connection"), "the buttons")
        browser.script("document.activeElement.blur()")
        browser.keys("3")
        wait_until(lambda: goals, LIMIT, "what is pressed now")
        assert [function.str_param for function in goals[0].goal.functions] == ["No."]
    finally:
        subscriber.unregister()


def test_the_same_browser_comes_back_to_a_console_that_was_killed(program, browser):
    browser.open("/functions")
    program.kill()
    browser.reads("does not answer")
    browser.until(lambda: "No connection" in browser.texts(".nao-stop-state"), "Stop says so")
    program.start()
    browser.until(lambda: browser.script("return document.body?.dataset.console") == "", "the page")
    browser.one("[aria-label='Search functions']")
    assert "/functions" in browser.driver.current_url
