"""A console, its browser and the trials in which faults are made on purpose; the page takes the times itself."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress

import rosgraph
import rosnode
import rospy
from actionlib_msgs.msg import GoalID
from console_browser import LIMIT, ConsoleBrowser, ConsoleProgram
from ros_stack import children, start_program
from selenium.webdriver.common.action_chains import ActionChains

from nao_library_modules.core.server_types import ACTIONS
from nao_library_modules.studies.study_files import StudyFiles
from nao_library_modules.studies.trial_log import EVENTS, read_events
from nao_library_msgs.srv import SetMemory
from nao_sim_bridge.testing import wait_until

BUSY = {"slow_simulation", "connection", "old_reports"}
"""Alarms that a busy computer has without any fault."""
CHOICE = "{wizard: Well, choices: [one, two]}"
WIZARD = """
names: {nobody: ""}
groups:
  - group: Faults
    buttons:
      - {label: say, say: "One, two, three, four, five, six, seven, eight, nine, ten, and again from one to ten."}
      - {label: say wrong, say: "{nobody}"}
      - {label: run, run: tai_chi}
      - {label: run wrong, run: nowhere}
      - {label: call, call: NaoLights.setColor, with: {lights: [FaceLeds], str_param: green, time: 600}}
      - {label: call wrong, call: NaoLights.setColor, with: {lights: [Nowhere], str_param: green}}
      - {label: chain, chain: NaoMotion, steps: [{wakeUp: {time: 600}}, {rest: {}}]}
      - {label: chain wrong, chain: NaoMotion, steps: [{wakeUp: {}}, {nowhere: {}}]}
      - {label: posture, posture: LyingBack}
      - {label: posture wrong, posture: Nowhere}
      - {label: walk_to, walk_to: [3.0, 0.0, 0.0]}
      - {label: walk_to wrong, walk_to: [300.0, 0.0, 0.0]}
      - {label: perform, perform: "looking left"}
      - {label: perform wrong, perform: "wrong"}
      - {label: listen, call: nao_audio_in.listen, with: {vocabulary: [tea], timeout: 600}}
      - {label: see, call: NaoVision.detectFaces, with: {timeout: 600}}
      - {label: touch, call: NaoTactile.waitForTouch, with: {sensors: [head], timeout: 600}}
"""
BEHAVIORS = {
    "wrong": "help: It cannot be run.\ndo: [{NaoLights.setColor: {lights: [Nowhere], str_param: green}}]\n",
    "long": "help: It takes long.\ndo: [{NaoLights.setColor: {lights: [FaceLeds], str_param: green, time: 600}}]\n",
}
PLANS = """
import actionlib, rospy
from nao_library_actions.msg import PerformDesignatorAction
rospy.init_node("plans")
take = lambda goal: goal.set_rejected() if goal.get_goal().designator == "wrong" else goal.set_accepted()
server = actionlib.ActionServer("perform_designator", PerformDesignatorAction, take, lambda g: g.set_canceled(), False)
server.start()
print("it is there", flush=True)
rospy.spin()
"""
WATCH = """
const [css, text] = arguments;
const now = () => Date.now() / 1000;
sessionStorage.shown = sessionStorage.pressed = "";  // which outlive a page that is loaded again
const shows = (each) => each.checkVisibility() && text.split("|").some((one) => each.textContent.includes(one));
const look = () => (sessionStorage.shown ||= [...document.querySelectorAll(css)].some(shows) ? now() : "");
const all = { subtree: true, childList: true, characterData: true, attributes: true };
new MutationObserver(look).observe(document, all);
for (const kind of ["pointerdown", "keydown"])
  addEventListener(kind, () => (sessionStorage.pressed ||= now()), { capture: true });
look();
"""
SHOWN = "return [Number(sessionStorage.shown), Number(sessionStorage.pressed)]"
ALARMS = "return [...document.querySelectorAll('[data-alarm]')].map((each) => each.dataset.alarm)"


class FaultLab:
    """What rows of faults do with stack, console and browser.

    Attributes:
        since: Time of the fault, s since 1970: of the press, if it is one.
        seconds: From the time when the fault can be known until the page showed it.
    """

    def __init__(self, stack, folder):
        self.stack, self._killed = stack, set()
        (folder / "wizard.yaml").write_text(WIZARD)
        self.protocols = folder / "studies" / "protocols"
        self.protocols.mkdir(parents=True)
        behaviors = stack.folder / "home" / "test_behaviors"
        behaviors.mkdir(exist_ok=True)
        for name, text in BEHAVIORS.items():
            (behaviors / f"{name}.yaml").write_text(text)
        self.files = StudyFiles(folder / "studies")
        self.program = ConsoleProgram(folder, "--console", str(folder / "wizard.yaml"))
        self.browser = ConsoleBrowser(self.program).enter()

    @property
    def robot(self):
        return self.stack.robot

    def close(self):
        self.browser.close()
        self.program.close()

    # --- trials

    def prepare(self, name):
        """A robot and a page without anything of the row before. `name`: of the study."""
        self.study, self.trial, self.seconds, self.since = name, None, 0.0, 0.0
        while self._killed:
            rospy.wait_for_service(f"{self._killed.pop()}/describe", LIMIT)
        self.module("NaoSimulation").setSpeed(1.0)
        self.robot.press([])
        self.robot.reset()
        self._wait_for_family("Crouching")
        self.browser.open("/wizard")
        self.browser.see_all()
        if "fallen" in self.alarms():
            self.get_up()
        self.browser.until(lambda: not set(self.alarms()) - BUSY, "no alarm of the row before")

    def begin(self, step=CHOICE, record="{}"):
        """Begin the trial of the row. `step`: its first one. `record`: what is recorded."""
        text = f"name: {self.study}\nhelp: For {self.study}.\nphases: [{{steps: [{step}, {CHOICE}, {CHOICE}]}}]\n"
        (self.protocols / f"{self.study}.yaml").write_text(f"{text}record: {record}\n")
        self.browser.open("/study", protocol=self.study, participant="P01")
        self.browser.reads(f"For {self.study}.")
        self.trial = self._press("Start trial", lambda: next(iter(self.files.trials(self.study)), None))
        self.logged("trial", what="step began", path="1.1")
        self.logged("state")
        self.browser.one("button", "Deviation")

    def end(self):
        """End it from the page, as who runs a study does."""
        self.browser.online(True)
        if self.program.process.poll() is not None:
            self.program.start()
        if self.trial is not None:
            self.browser.open("/study")
            self._press("Abort", lambda: self.browser.all(".q-dialog button", "Abort the trial"))
            self._press("Abort the trial", lambda: self.trial.state().over)
        self.browser.leave()

    def _press(self, button, done):
        """Press, and again where the page refuses that on a busy computer; returns what `done` gives."""
        self.browser.click("button", button)

        def is_done():
            if self.browser.all(".nao-failed", f"{button}: not sent"):
                self.browser.see_all()
                self.browser.click("button", button)
            return done()

        return self.browser.until(is_done, button)

    def events(self):
        return read_events(self.trial.path)

    def logged(self, kind, **data):
        """Wait for the newest event of the log with these values; of `text` and of lists a part."""
        return self.logged_one_of((kind, data))

    def logged_one_of(self, *wanted):
        """Wait for the newest event that is one of these, (kind, values)."""

        def found():
            return [
                event
                for event in self.events()
                if any(event["kind"] == kind and _has(event, data) for kind, data in wanted)
            ]

        wait_until(found, LIMIT, lambda: f"{wanted} among\n" + "\n".join(map(str, self.events())))
        return found()[-1]

    # --- faults

    def shows(self, css, text, act, after=0.0):
        """Make a fault with `act`, and take the time until the page shows it.

        `act`: may return when it was made, else it is made at once. `after`: s until it can be known. `text`: one of
        several, with "|" between.
        """
        self.browser.script(WATCH, css, text)
        assert not self.browser.script(SHOWN)[0], f"{text} is there before"
        began = time.time()
        made = act()
        self.browser.until(lambda: self.browser.script(SHOWN)[0], f"{css} {text}")
        shown, pressed = self.browser.script(SHOWN)
        self.since = made if isinstance(made, float) else pressed or began
        self.seconds = shown - self.since - after

    def alarms(self):
        return self.browser.script(ALARMS)

    def run(self, label):
        """Press a button of the wizard's page, and wait until its goal has begun; the event of that."""
        self.browser.open("/wizard")
        self.browser.click("nao-wizard-buttons button", label)
        self.browser.one("nao-wizard-buttons button[data-state=runs]", label)
        return self.logged("sent")

    def open_function(self, name, text):
        """Fill in a form of the page Functions; the button that sends it."""
        self.browser.open("/functions")
        self.browser.type("input[aria-label='Search functions']", f"nao_audio_out.{name}")
        self.browser.click(f".q-item[aria-label^='nao_audio_out.{name}:']")
        self.browser.type("input[aria-label='str_param'], textarea[aria-label='str_param']", text)
        return "Send"

    def open_behavior(self, name):
        """Open one of `BEHAVIORS` on its page; the button that runs it."""
        self.browser.open("/behaviors")
        self.browser.click(f".q-item[aria-label^='Open {name}:']")
        self.browser.reads("NaoLights")
        return "Run"

    def hold_key(self):
        """Hold the key that walks ahead."""
        ActionChains(self.browser.driver).key_down("w").perform()

    def let_go(self):
        ActionChains(self.browser.driver).key_up("w").perform()

    def cancel(self, sent):
        """As another program does. `sent`: event of the goal."""
        topic = rospy.Publisher(f"{sent['data']['server']}/cancel", GoalID, queue_size=1)
        wait_until(topic.get_num_connections, LIMIT, "the server")
        topic.publish(GoalID(id=sent["data"]["goal"]))

    def pid(self, node):
        (pid,) = [pid for pid, name in children(self.stack.stack.pid).items() if name == node]
        return pid

    def kill(self, node):
        os.kill(self.pid(node), signal.SIGKILL)
        if node in ACTIONS:
            self._killed.add(node)

    def module(self, name):
        """A NAOqi module of the robot, which may be starting."""
        found = []

        def there():
            with suppress(Exception):  # whatever a simulator says that is starting
                found.append(self.robot.module(name))
            return found

        wait_until(there, LIMIT, f"the robot's {name}")
        return found[0]

    def fall(self):
        self._set_event("robotHasFallen", "true")

    def get_up(self):
        self._set_event("PostureFamilyChanged", '"Crouching"')

    def go_limp(self):
        """Lose all stiffness while it stands; returns when."""
        self.module("ALRobotPosture").goToPosture("Stand", 1.0)
        self._wait_for_family("Standing")
        began = time.time()
        self.module("ALMotion").setStiffnesses("Body", 0.0)
        return began

    def sit(self):
        self.module("ALRobotPosture").goToPosture("Sit", 1.0)
        return time.time()

    def touch_head(self):
        self.robot.press(["Head/Touch/Front"])  # until the next row

    def kill_bag(self):
        os.kill(self.logged("trial", what="recording began", recording="bag")["data"]["pid"], signal.SIGKILL)

    def _wait_for_family(self, family):
        posture = self.module("ALRobotPosture")
        wait_until(lambda: posture.getPostureFamily() == family, LIMIT, f"a posture of {family}")

    def _set_event(self, key, value):
        assert rospy.ServiceProxy("/nao_memory/set", SetMemory)(key=key, value=value, event=True).success

    def fill_disk(self):
        """The console's files get no longer than the log of the trial is."""
        self.program.limit_files((self.trial.path / EVENTS).stat().st_size)

    def free_disk(self):
        self.program.limit_files(None)


def _has(event, data):
    known = {**event["data"], "text": event["text"]}
    parts = [name for name in data if name == "text" or isinstance(known.get(name), list)]
    return all(data[name] in known[name] if name in parts else known.get(name) == data[name] for name in data)


@contextmanager
def plans(label):
    """The server of plans, for buttons that need it: it takes goals and does nothing; None for the others."""
    if not label.startswith("perform"):
        yield None
        return
    server = start_program(sys.executable, "-c", PLANS, stdout=subprocess.PIPE, text=True)
    try:
        assert any("it is there" in line for line in server.stdout)
        yield server
    finally:
        server.kill()
        server.communicate(timeout=LIMIT)
        rosnode.cleanup_master_blacklist(rosgraph.Master("/tests"), ["/plans"])
