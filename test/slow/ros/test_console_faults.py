"""Sixty faults made on purpose: the page shows each, the log of the trial has it, and nothing that did not happen.

Each row has a trial of its own. Its times are printed; those that are asserted are generous: computers are slow.
"""

import os
import signal
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import pytest
from console_browser import CONNECTED, LIMIT
from fault_lab import BUSY, CHOICE, FaultLab, plans
from selenium.webdriver.common.keys import Keys

from nao_sim_bridge.testing import wait_until

SOON = 30.0
"""s from the time when a fault can be known until the page shows it."""
SILENT, UNREPORTED, SLOW = 2.0, 6.0, 3.0
"""s after which a robot counts as silent, reports as ended, and a simulation as slow."""
SHORT, LONG = 1.0, 10.0  # s without network
ALWAYS = {"trial", "state", "sent", "ended", "pressed", "alarm"}
"""Kinds of events that any trial may have."""
ONCE = {"failed", "walked", "note"}
"""Kinds of which no row has two."""
RESTARTED = "restarted"
"""In `also` of a row: simulated time begins anew."""
BUTTON = "nao-wizard-buttons button"


@dataclass(frozen=True)
class Row:
    """A fault.

    Attributes:
        name: Of the row, and of its study.
        make: Makes it, after it has begun the trial or before.
        kind, data: The event that the log has then, and values of it.
        also: Kinds of further events that do happen, and codes of alarms.
        timed: Whether the event comes with the fault, not before it.
        alternatives: Further events, one of which the log may have in its place: (kind, data).
    """

    name: str
    make: Callable[[FaultLab], None]
    kind: str
    data: dict[str, Any]
    also: tuple[str, ...] = ()
    timed: bool = True
    alternatives: Sequence[tuple[str, dict[str, Any]]] = ()


def on_button(name, label, word, state, fault=None, also=()):
    """The goal of a button ends as it should not. `fault(lab, sent, server)` ends it; without one it is refused."""

    def make(lab):
        with plans(label) as server:
            lab.begin()
            sent = lab.run(label) if fault else lab.browser.open("/wizard")
            act = (lambda: fault(lab, sent, server)) if fault else lambda: lab.browser.click(BUTTON, label)
            lab.shows(".nao-failed", f"{label}: {word}", act)

    return Row(name, make, "failed", {"state": state, "button": label}, ("said", "felt", *also))


def killed(node, label):
    def die(lab, _, server):
        server.kill() if server else lab.kill(node)

    return on_button(f"kill_{node}", label, "lost", "lost", die)


def refused(form, word="failed", state="aborted"):
    return on_button(f"refuse_{form}", f"{form} wrong", word, state)


def preempted(form):
    return on_button(f"preempt_{form}", form, "stopped", "preempted", lambda lab, sent, _: lab.cancel(sent))


def unplugged(label):
    def lose(lab, *_):
        lab.kill("nao_sim")
        lab.logged("alarm", code="connection", what="began")
        lab.logged("alarm", code="connection", what="ended")

    return on_button(f"unplug_{label}", label, "failed", "aborted", lose, ("fallen", "limp", RESTARTED))


def on_page(name, prepare, *arguments):
    """The goal of another page is refused, or cancelled by another program."""
    cancelled = name.startswith("preempt")

    def make(lab):
        lab.begin()
        button = prepare(lab, *arguments)
        if cancelled:
            lab.browser.click("button", button)
            sent = lab.logged("sent")
            lab.shows(".nao-failed", "stopped", lambda: lab.cancel(sent))
        else:
            lab.shows(".nao-failed", "failed", lambda: lab.browser.click("button", button))

    return Row(name, make, "failed", {"state": "preempted" if cancelled else "aborted"}, ("said", "felt"))


def silent(label):
    """The robot does not answer while a goal of it runs."""

    def make(lab):
        lab.begin()
        lab.run(label)
        robot = lab.pid("nao_sim")
        lab.browser.until(lambda: "connection" not in lab.alarms(), "a connection")
        began = time.monotonic()
        try:
            lab.shows("[data-alarm=connection]", "", lambda: os.kill(robot, signal.SIGSTOP), SILENT)
            wait_until(lambda: time.monotonic() > began + 4.0, LIMIT, "the end of the silence")
        finally:
            os.kill(robot, signal.SIGCONT)
        lab.logged("alarm", code="connection", what="ended")

    return Row(f"silent_{label}", make, "alarm", {"code": "connection", "what": "began"}, ("said", "felt", "failed"))


def console_killed(name, step):
    """The console dies in a step, and is started again."""

    def make(lab):
        lab.begin(step)
        lab.shows(".nao-told", "does not answer", lab.program.kill)
        lab.program.start()
        lab.browser.click("button", "Resume")

    return Row(f"crash_in_{name}", make, "trial", {"what": "resumed"}, ("said", "felt"), timed=False)


def full_disk(name, step, act, kind, **data):
    """The disk is full while something is written."""

    def make(lab):
        lab.begin(step)
        lab.browser.type("input[aria-label='Note']", "looks away")
        lab.fill_disk()
        lab.shows(".nao-main [role=alert]", "wait in memory", lambda: act(lab))
        lab.free_disk()
        lab.logged("deviation", what="log gap")
        lab.browser.reads("were written then")

    return Row(f"full_disk_{name}", make, kind, data, ("note", "deviation", "touched", "log"))


ACTS = {
    "button": ("/wizard", lambda lab: lab.browser.click(BUTTON, "call"), f"{BUTTON}[data-state=runs]", "call"),
    "walk": ("/wizard", FaultLab.hold_key, "nao-wizard-drive .walks", ""),
    "note": ("", lambda lab: lab.browser.keys(Keys.ENTER), ".nao-main", "look %s"),
    "choice": ("", lambda lab: lab.browser.click("button", "one"), ".nao-main", "1.1: done, one"),
}
"""What somebody does without network: the page, how, and where the page has which text when it is done."""
DONE = {
    "button": ("sent", {"server": "NaoLights"}),
    "walk": ("walked", {}),
    "note": ("note", {"text": "look"}),
    "choice": ("trial", {"what": "step ended", "answer": "one"}),
}
"""Events of the log that it is done."""
REFUSED = ("failed", {"state": "not sent"})


def offline(seconds, what):
    """The network is gone for a while. What is done meanwhile is done a moment later, or told as not done."""
    name, is_long, walks = f"offline_{seconds:g}_{what}", seconds > SHORT, what == "walk"
    page, act, css, text = ACTS[what]
    if is_long:
        css, text = (".nao-told", "does not answer") if walks else (".nao-failed", "not sent")
    elif not walks:
        css, text = f"{css}, .nao-unsent", f"{text}|not sent"  # if the page has seen by then that the network is gone

    def make(lab):
        lab.begin()
        browser = lab.browser
        if page:
            browser.open(page)
            browser.one(BUTTON)
            browser.script("document.activeElement.blur()")
        elif what == "note":
            browser.type("input[aria-label='Note']", f"look {name}")
        else:
            browser.one("button", "one")
        if walks and is_long:
            lab.hold_key()
            lab.logged("walked")

        def lose():
            began = time.monotonic()
            browser.online(False)
            if not (walks and is_long):
                act(lab)
            wait_until(lambda: time.monotonic() > began + seconds, LIMIT, "the network")
            browser.online(True)

        lab.shows(css, text.replace("%s", name), lose, 0.0 if is_long else seconds)
        browser.until(lambda: browser.script(CONNECTED), "the page")
        if walks:
            lab.let_go()

    kind, data = REFUSED if is_long and not walks else DONE[what]
    alternatives = [] if walks or is_long else [REFUSED]
    return Row(name, make, kind, data, ("felt", "walked"), timed=not walks, alternatives=alternatives)


def latched(name, css, text, act, **state):
    """A state is there before the trial begins."""

    def make(lab):
        if not css.startswith("[data-alarm"):
            lab.browser.open("/")
        lab.shows(css, text, lambda: act(lab))
        lab.begin()

    return Row(f"before_{name}", make, "state", state, timed=False)


def alarm(code, act, undo=lambda lab: None, record="{}", after=0.0, also=()):
    """An alarm begins in a trial."""

    def make(lab):
        lab.begin(record=record)
        lab.browser.until(lambda: code not in lab.alarms(), f"no {code} before")
        try:
            lab.shows(f"[data-alarm={code}]", "", lambda: act(lab), after)
        finally:
            undo(lab)

    return Row(f"alarm_{code}", make, "alarm", {"code": code, "what": "began"}, ("felt", "deviation", *also))


def reports(number):
    """A signal to the node that reports battery, heat and motors."""
    return lambda lab: os.kill(lab.pid("nao_driver_pictures"), number)


def robot(module, call, *values):
    """A call of the robot."""
    return lambda lab: getattr(lab.module(module), call)(*values)


HEAT = robot("NaoSimulation", "setTemperature", "HeadYaw", 71.0)
DRAIN = robot("NaoSimulation", "setBatteryCharge", 0.15)
SPEAK = robot("ALTextToSpeech", "say", "Before the trial")
FORMS = ("say", "run", "call", "chain", "posture", "walk_to", "perform")
SERVERS = {
    "NaoLights": "call", "NaoMotion": "chain", "nao_audio_out": "say", "nao_audio_in": "listen", "NaoVision": "see",
    "NaoTactile": "touch", "NaoBehavior": "run", "perform_designator": "perform",
}  # fmt: skip
"""Servers, and buttons that have them do something."""
STEPS = {
    "wizard": CHOICE,
    "say": "{say: One two three four five six seven eight nine ten}",
    "wait": "{wait: 600}",
    "touch": "{wait: touch, sensors: [head], timeout: 600}",
    "while": "{while: {do: [{wait: 1}], until: touch}}",
}
"""Kinds of steps in which the console dies."""
ROWS = [
    *(killed(node, label) for node, label in SERVERS.items()),
    refused("say", "not sent", "not sent"),
    *map(refused, FORMS[1:-1]),
    refused("perform", "refused", "rejected"),
    *map(preempted, FORMS),
    on_page("refuse_on_functions", FaultLab.open_function, "playFile", "nowhere.wav"),
    on_page(
        "preempt_on_functions",
        FaultLab.open_function,
        "say",
        "One, two, three, four, five, six, seven.",
    ),
    on_page("refuse_on_behaviors", FaultLab.open_behavior, "wrong"),
    on_page("preempt_on_behaviors", FaultLab.open_behavior, "long"),
    *(silent(label) for label in ("call", "walk_to")),
    *(unplugged(label) for label in ("say", "walk_to")),
    *(console_killed(name, step) for name, step in STEPS.items()),
    full_disk("note", CHOICE, lambda lab: lab.browser.keys(Keys.ENTER), "note", text="looks away"),
    full_disk("end", CHOICE, lambda lab: lab.browser.click("button", "two"), "trial", what="step ended", answer="two"),
    full_disk(
        "answer", STEPS["touch"], lambda lab: lab.touch_head(), "trial", what="step ended", path="1.1", outcome="done"
    ),
    *(offline(seconds, what) for seconds in (SHORT, LONG) for what in ACTS),
    latched("fallen", "[data-alarm=fallen]", "", FaultLab.fall, fallen=True, alarms="fallen"),
    latched("limp", "[data-alarm=limp]", "", FaultLab.go_limp, limp=True, alarms="limp"),
    latched("hot", "[data-alarm=hot_joint]", "", HEAT, hot="HeadYaw"),
    latched("battery", "[data-alarm=battery]", "", DRAIN, alarms="battery"),
    latched("posture", ".nao-main", "Sit", FaultLab.sit, posture="Sit"),
    latched("speech", ".nao-main", "Before the trial", SPEAK),
    alarm("fallen", FaultLab.fall),
    alarm("limp", FaultLab.go_limp, also=("fallen",)),
    alarm("old_reports", reports(signal.SIGSTOP), reports(signal.SIGCONT), after=UNREPORTED),
    alarm("battery", DRAIN),
    alarm("hot_joint", HEAT),
    alarm("recorder_bag", FaultLab.kill_bag, record="{bag: [joint_states]}"),
    alarm("recorder_video", lambda lab: lab.kill("NaoVision"), record="{video: top}", after=5.0),
    alarm("slow_simulation", robot("NaoSimulation", "setSpeed", 200.0), after=SLOW),
]
QUICK = ("kill_NaoLights", "refuse_call", "preempt_call")
"""Rows of the short form."""


@pytest.fixture(scope="module")
def lab(stack, tmp_path_factory):
    stack.ensure()
    made = FaultLab(stack, tmp_path_factory.mktemp("faults"))
    yield made
    made.close()


class TestFaults:
    respawned = (*SERVERS, "nao_sim")

    @pytest.mark.parametrize(
        "row", [pytest.param(row, id=row.name, marks=[] if row.name in QUICK else pytest.mark.long) for row in ROWS]
    )
    def test_the_page_shows_it_and_the_log_has_it_alone(self, lab, row):
        lab.prepare(row.name)
        try:
            row.make(lab)
            event = lab.logged_one_of((row.kind, row.data), *row.alternatives)
            once = sum(each["kind"] in ONCE for each in lab.events())
        finally:
            lab.end()
        late = event["wall"] - lab.since
        print(f"\nROW {row.name}: page {lab.seconds:.2f} s, log {row.kind} {late:.2f} s", flush=True)
        assert lab.seconds < SOON
        assert not row.timed or -1.0 < late < 2.0 * SOON, event
        assert invented(lab.events(), row) == [] and once <= 1


def invented(events, row):
    """Events of a log that did not happen in its trial."""
    before = next(event["data"]["alarms"] for event in events if event["kind"] == "state")  # they may end
    kinds, codes = ALWAYS | {row.kind, *row.also}, BUSY | {row.data.get("code"), *row.also}
    sent = {event["data"]["goal"] for event in events if event["kind"] == "sent"}
    began, ended = (events[0]["stamp"], events[-1]["stamp"]) if RESTARTED not in row.also else (0.0, float("inf"))

    def happened(event):
        about = event["data"]
        here = event["kind"] in kinds and began - 0.1 <= event["stamp"] <= ended + 0.1
        ours = event["kind"] != "ended" or about["goal"] in sent
        alarms = codes if about.get("what") == "began" else codes.union(before)
        refused = event["kind"] == "failed" and about["state"] == "not sent"  # on a busy computer
        return refused or here and ours and (event["kind"] != "alarm" or about["code"] in alarms)

    return [event for event in events if not happened(event)]
