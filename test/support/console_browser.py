"""The console in a headless Chromium, beside the stack of the tests."""

from __future__ import annotations

import os
import re
import resource
import signal
import sys
from pathlib import Path
from urllib.parse import urlencode, urlsplit

import rosgraph
import rosnode
from ros_stack import start_program
from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from nao_sim_bridge.testing import StackNotReady, wait_until

DRIVER = "/usr/bin/chromedriver"
OPTIONS = ("--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--window-size=1400,1000", "--mute-audio")
PROGRAM = Path(__file__).with_name("watched_console.py")
LIMIT = 300.0
"""s of this computer for whatever is waited for."""
LINES = 10
"""Of what browser and console have said, where something does not come."""

SHOWN = """
const [css, text] = arguments, seen = { opacityProperty: true, visibilityProperty: true };
return [...document.querySelectorAll(css)].filter((each) => each.checkVisibility(seen) && each.getClientRects().length
  && each.innerText.toLowerCase().includes(text.toLowerCase()))"""
CONNECTED = "return Boolean(document.querySelector('.nao-stop')?.checkVisibility() && window.socket?.connected);"
CLEAR = "arguments[0].scrollIntoView({ block: 'nearest' });"
"""Scrolls an element clear of the bar and of the strip for notices."""
TEXT = "return document.body?.innerText ?? '';"
STATE = "return `${location.href}, connected: ${window.socket?.connected}`;"


class ConsoleProgram:
    """`nao console`, started for a test, and watched. `master`: URI of its ROS master; that of the tests by default.

    Attributes:
        url: Address with the token of an operator. observer: with that of an observer. base: without, no slash.
    """

    def __init__(self, folder, *options, master=""):
        self.folder = folder
        self.watched = folder / "watched.txt"
        self._options = options
        self._environment = {**os.environ, **({"ROS_MASTER_URI": master} if master else {})}
        self.port = 0  # the first time the system gives it one, which it has again after it was killed
        self._starts = 0
        self.start()

    def start(self):
        self._starts += 1
        self.log = self.folder / f"console_{self._starts}.txt"
        with self.log.open("wb") as output:
            self.process = start_program(
                sys.executable, PROGRAM, self.watched, "console", "--port", str(self.port),
                "--studies", str(self.folder / "studies"), *self._options,
                stdout=output, stderr=output, env=self._environment,
            )  # fmt: skip
        wait_until(self._answers, LIMIT, "the console's pages")
        self.url, self.observer = re.findall(r"http://\S+token=\S+", self.log.read_text())[:2]
        self.port = urlsplit(self.url).port
        self.base = f"http://127.0.0.1:{self.port}"

    def kill(self):
        """As if the computer took it away. The master forgets its node, which nobody else would tell it."""
        self.process.kill()
        self.process.wait(LIMIT)
        name = f"/nao_console_{self.process.pid}_"
        gone = [each for each in rosnode.get_node_names() if each.startswith(name)]
        rosnode.cleanup_master_blacklist(rosgraph.Master("/tests"), gone)

    def limit_files(self, size):
        """How long its files may become, in bytes, as on a disk that is full; None: as long as they like."""
        limits = (resource.RLIM_INFINITY if size is None else size, resource.RLIM_INFINITY)
        resource.prlimit(self.process.pid, resource.RLIMIT_FSIZE, limits)

    def close(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(LIMIT)
        found = self.watched.read_text() if self.watched.exists() else ""
        assert not found, f"in an event loop of the console:\n{found}\n{self.log.read_text()[-4000:]}"

    def _answers(self):
        assert self.process.poll() is None, self.log.read_text()
        return "to look on" in self.log.read_text()  # it is printed when the port is listened on


class ConsoleBrowser:
    """One browser with one page. Elements are found by CSS, waited for, and never kept.

    What is read is read by one script: between two commands a page draws elements anew, and a busy one takes its time
    for each.
    """

    def __init__(self, program):
        self.program = program
        options = webdriver.ChromeOptions()
        for option in OPTIONS:
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service(DRIVER))
        self.driver.command_executor._client_config.timeout = LIMIT  # 120 s by itself

    def enter(self, url=""):
        """Show the token, as who opens the printed address."""
        self.driver.get(url or self.program.url)
        return self

    def open(self, path, robot="/", **more):
        """Open a page, and wait until it is connected. `more`: of its address."""
        self.driver.get(f"{self.program.base}{path}?{urlencode({'robot': robot, **more})}")
        self.until(lambda: self.script(CONNECTED), path)

    def all(self, css, text=""):
        """The elements of a selector that are shown and have a text in them."""
        return self.script(f"{SHOWN};", css, text)

    def texts(self, css):
        """What the elements of a selector say that are shown."""
        return self.script(f"{SHOWN}.map((each) => each.innerText);", css, "")

    def one(self, css, text=""):
        """Wait for an element."""
        return self.until(lambda: (self.all(css, text) or [None])[0], f"{css} {text}")

    def click(self, css, text=""):
        """Click as soon as there is something that can be clicked."""

        def try_it():
            elements = self.all(css, text)
            if not elements:
                return False
            try:
                self.script(CLEAR, elements[0])
                elements[0].click()
            except WebDriverException:
                return False
            return True

        self.until(try_it, f"a click on {css} {text}")

    def type(self, css, text):
        """Replace what a field holds."""

        def try_it():
            (field,) = self.all(css)[:1] or [None]
            if field is None:
                return False
            keys = ActionChains(self.driver).click(field)  # which is in vain where it was drawn anew meanwhile
            try:
                self.script(CLEAR, field)
                keys.key_down(Keys.CONTROL).send_keys("a").key_up(Keys.CONTROL).send_keys(text).perform()
            except WebDriverException:
                return False
            return True

        self.until(try_it, f"a field {css}")

    def keys(self, *keys):
        """Press keys wherever the focus is."""
        ActionChains(self.driver).send_keys(*keys).perform()

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def text(self):
        """What is to be read on the page."""
        return self.script(TEXT)

    def see_all(self):
        """Take away the lines of what has failed, of which more may come."""

        def none_left():
            self.script("document.querySelector('.nao-failed button')?.click()")
            return not self.all(".nao-failed button")

        self.until(none_left, "no line of what has failed")

    def reads(self, *texts):
        """Wait until the page says all of these."""
        self.until(lambda: all(text in self.text() for text in texts), f"the page says {texts}")

    def until(self, condition, what):
        """Wait for something; where it does not come, the error says what is there, and a screenshot is left."""
        found = None

        def holds():
            nonlocal found
            found = condition()
            return bool(found)

        try:
            wait_until(holds, LIMIT, lambda: f"{what}; there is {self._state()}")
        except StackNotReady:
            self.driver.save_screenshot(str(self.program.folder / "page.png"))
            raise
        return found

    def _state(self):
        """The page and what browser and console have to say about it, for people."""
        said = [entry["message"] for entry in self.driver.get_log("browser")]
        told = self.program.log.read_text().splitlines()
        return "\n".join([self.script(STATE), self.text()[:2000], *said[-LINES:], *told[-LINES:]])

    def width(self, width, height):
        """Have a window of this size, in pixels."""
        sizes = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", sizes)

    def online(self, there):
        """Take the network away, or give it back."""
        self.driver.execute_cdp_cmd("Network.enable", {})
        conditions = {"offline": not there, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
        self.driver.execute_cdp_cmd("Network.emulateNetworkConditions", conditions)

    def leave(self):
        """Stop the robot and leave the page; nothing is left of what was typed there."""
        if self.driver.current_url.startswith(self.program.base):
            self.driver.execute_async_script("fetch('/console/stop?robot=/', {method: 'POST'}).finally(arguments[0])")
        self.driver.get("about:blank")
        self.driver.execute_cdp_cmd(
            "Storage.clearDataForOrigin", {"origin": self.program.base, "storageTypes": "local_storage"}
        )

    def complaints(self):
        """What the browser has logged as an error."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def close(self):
        self.driver.quit()
