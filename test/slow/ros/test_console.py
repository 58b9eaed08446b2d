"""The console in a real browser, beside the running stack: what a person clicks is what the robot does."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest
import rospy
from actionlib_msgs.msg import GoalID
from console_browser import LIMIT, ConsoleBrowser
from console_clients import is_sent_here, stopped
from ros_stack import start_program
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from nao_library_actions.msg import (
    NaoAudioOutActionGoal,
    NaoAudioOutActionResult,
    NaoBehaviorActionGoal,
    NaoBehaviorActionResult,
)
from nao_library_modules.console.access.connections import LATE
from nao_library_msgs.srv import SetMemory
from nao_sim_bridge.testing import wait_until

PAGES = {
    "/": "What it does",
    "/wizard": "Conversation",
    "/study": "Start trial",
    "/behaviors": "Search behaviours",
    "/functions": "Search functions",
}
SUCCEEDED, PREEMPTED, ABORTED = 3, 2, 4


class Heard:
    """Messages of a topic since this began to listen, in their order."""

    def __init__(self, topic, kind):
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append)
        wait_until(lambda: is_sent_here(rospy.resolve_name(topic)), LIMIT, topic)

    def wait(self, fits=lambda message: True, what="a message"):
        """Wait for one that fits."""
        wait_until(lambda: any(map(fits, self.messages)), LIMIT, lambda: f"{what} among {self.messages}")
        return next(filter(fits, self.messages))

    def close(self):
        self._subscriber.unregister()


@pytest.fixture
def heard():
    """Topics that a case listens to: (topic, type) -> Heard."""
    made = []

    def listen(topic, kind):
        made.append(Heard(topic, kind))
        return made[-1]

    yield listen
    for each in made:
        each.close()


@pytest.fixture(autouse=True)
def standing_still(stack, browser):
    """Whatever a case has left going ends."""
    yield
    browser.leave()


def texts(message):
    """What the functions of a goal are for: their names and texts."""
    return [(function.function, function.str_param) for function in message.goal.functions]


def test_without_its_token_nobody_gets_in(program):
    stranger = ConsoleBrowser(program)
    try:
        for path in ("/", "/wizard", "/study", "/console/static/frame.js"):
            stranger.driver.get(program.base + path)
            assert "it has a token in it" in stranger.text()
    finally:
        stranger.close()


@pytest.mark.parametrize("path", PAGES)
def test_a_page_is_there_and_complains_of_nothing(browser, path):
    browser.complaints()
    browser.open(path)
    browser.until(lambda: browser.all("body", PAGES[path]) or browser.all(f"[aria-label='{PAGES[path]}']"), PAGES[path])
    assert browser.complaints() == []


READABLE = (Path(__file__).parents[2] / "support" / "readable.js").read_text(encoding="utf-8")


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_everything_can_be_read_and_has_a_name(browser, dark):
    is_dark = "return document.body.classList.contains('body--dark')"
    browser.open("/functions")
    if browser.script(is_dark) != dark:
        browser.click("[aria-label='Light or dark']")
        browser.until(lambda: browser.script(is_dark) == dark, "the other colours")
    hard = {}
    for path, text in PAGES.items():
        browser.open(path)
        browser.until(lambda text=text: text in browser.text() or browser.all(f"[aria-label='{text}']"), text)
        browser.until(lambda: browser.script(is_dark) == dark, "its colours")
        hard[path] = browser.script(READABLE)
    assert hard == {path: [] for path in PAGES}


YAW = """
const view = document.querySelector("nao-robot-view"), joint = view && view.joints && view.joints.get("HeadYaw");
return joint ? 2 * Math.atan2(joint.moved.quaternion.z, joint.moved.quaternion.w) : null;
"""
PICTURES = """
return [...document.querySelectorAll("nao-camera")].map((each) => {
  const picture = each.shadowRoot.querySelector("canvas");
  return Math.max(...picture.getContext("2d").getImageData(0, 0, picture.width, picture.height).data.slice(0, 3));
});
"""


def test_the_robot_is_drawn_as_it_stands_and_what_it_sees(stack, browser):
    browser.open("/")
    browser.reads("connected", "At rest")
    stack.robot.module("ALMotion").setStiffnesses("Head", 1.0)
    stack.robot.module("ALMotion").angleInterpolation("HeadYaw", 0.7, 0.5, True)
    browser.until(lambda: abs((browser.script(YAW) or 0.0) - 0.7) < 0.03, "the head of the drawn robot")
    browser.until(lambda: len(browser.script(PICTURES)) == 2 and all(browser.script(PICTURES)), "two pictures")


BUSY = """
// A graphics processor that is too busy for its pictures, whatever that of this computer does or has lost.
const done = arguments[0], context = WebGL2RenderingContext.prototype;
let state = context.UNSIGNALED, begun = 0, frames = 0;
Object.assign(context, { fenceSync: () => ({}), deleteSync() {} });
Object.assign(context, { isContextLost: () => false, getSyncParameter: () => state });
const view = document.querySelector("nao-robot-view"), { renderer } = view, { render } = renderer;
renderer.render = (...all) => { begun += 1; render.apply(renderer, all); };
const look = () => {
  view.dirty = true;
  frames += 1;
  if (frames < 10) return requestAnimationFrame(look);
  const meanwhile = begun;
  state = context.SIGNALED;
  const again = () => { view.dirty = true; begun > meanwhile ? done(meanwhile) : requestAnimationFrame(again); };
  again();
};
look();
"""


def test_no_picture_of_the_robot_is_begun_before_the_last_is_there(browser):
    browser.open("/")
    browser.until(lambda: browser.script(YAW) is not None, "the drawn robot")
    assert browser.driver.execute_async_script(BUSY) <= 1  # and goes on behind that


def test_a_text_that_is_typed_is_said(browser, heard):
    goals, results = (
        heard("nao_audio_out/goal", NaoAudioOutActionGoal),
        heard("nao_audio_out/result", NaoAudioOutActionResult),
    )
    browser.open("/wizard")
    browser.type("input[aria-label='participant']", "Kim")
    browser.type("input[aria-label='Say']", "Good morning {participant}")
    browser.keys(Keys.ENTER)
    goal = goals.wait(what="what is said")
    assert texts(goal) == [("animatedSay", "Good morning Kim")]
    results.wait(lambda each: each.status.goal_id.id == goal.goal_id.id and each.status.status == SUCCEEDED)


def test_a_key_presses_its_button_but_not_in_a_field(browser, heard):
    goals = heard("nao_audio_out/goal", NaoAudioOutActionGoal)
    browser.open("/wizard")
    browser.one("nao-wizard-buttons button")
    browser.type("input[aria-label='Say']", "3")
    browser.script("document.activeElement.blur()")
    browser.keys("2")
    assert texts(goals.wait()) == [("say", "Yes.")]


def ask_for_yes(browser):
    browser.open("/wizard")
    browser.one("nao-wizard-buttons button")
    return "nao-wizard-buttons button", "Yes"


def ask_for_a_word(browser):
    browser.open("/functions")
    browser.type("input[aria-label='Search functions']", "nao_audio_out.say")
    browser.click(".q-item[aria-label^='nao_audio_out.say:']")
    browser.type("input[aria-label='str_param'], textarea[aria-label='str_param']", "Yes.")
    return "button", "Send"


@pytest.mark.parametrize("prepare", [ask_for_yes, ask_for_a_word])
def test_what_is_pressed_while_the_console_does_not_answer_is_said_and_never_sent(prepare, program, browser, heard):
    goals = heard("nao_audio_out/goal", NaoAudioOutActionGoal)
    css, text = prepare(browser)

    def refused():
        browser.click(css, text)
        return browser.all(".nao-unsent", "not sent")

    with stopped(program.process.pid):
        browser.until(refused, "that it is not sent")
        pressed = time.monotonic()
        # What the page sent before it knew comes late then.
        wait_until(lambda: time.monotonic() > pressed + LATE + 1.0, LIMIT, "the time after which a press is late")
    browser.until(
        lambda: not browser.all(".nao-unsent p") and browser.all(".nao-failed", "not sent"), "what was pressed"
    )
    assert goals.messages == []
    browser.see_all()
    browser.click(css, text)
    assert texts(goals.wait()) == [("say", "Yes.")] and len(goals.messages) == 1


def test_a_goal_that_fails_says_so_on_its_button_until_somebody_has_looked(browser, heard):
    """Cut short by another program."""
    goals, cancels = (
        heard("NaoBehavior/goal", NaoBehaviorActionGoal),
        rospy.Publisher("NaoBehavior/cancel", GoalID, queue_size=1),
    )
    browser.open("/wizard")
    browser.click("nao-wizard-buttons button", "Introduction")
    goal = goals.wait()
    wait_until(lambda: cancels.get_num_connections(), LIMIT, "who cancels it")
    cancels.publish(GoalID(id=goal.goal_id.id))
    failed = "nao-wizard-buttons button[data-failed]"
    browser.until(lambda: browser.all(failed, "Introduction") and browser.all(".nao-failed", "Introduction"), "both")
    browser.open("/functions")
    browser.until(lambda: browser.all(".nao-failed", "Introduction"), "the line on another page")
    browser.see_all()
    browser.open("/wizard")
    browser.one("nao-wizard-buttons button", "Introduction")
    assert not browser.all(failed)


HANGING = """
import threading, actionlib, rospy
from nao_library_actions.msg import PerformDesignatorAction
rospy.init_node("hanging", anonymous=True)
hang = lambda _: print("it hangs", flush=True) or threading.Event().wait()
actionlib.SimpleActionServer("perform_designator", PerformDesignatorAction, hang, auto_start=False).start()
print("it is there", flush=True)
rospy.spin()
"""


def test_a_goal_whose_server_dies_is_lost_and_says_what_died(browser):
    server = start_program(sys.executable, "-c", HANGING, stdout=subprocess.PIPE, text=True)
    try:
        assert any("it is there" in line for line in server.stdout)
        browser.open("/wizard")
        browser.click("nao-wizard-buttons button", "Look to the left")
        assert any("it hangs" in line for line in server.stdout)
        browser.one("nao-wizard-buttons button[data-state=runs]", "Look to the left")
    finally:
        server.kill()
        server.communicate(timeout=LIMIT)
    browser.one("nao-wizard-buttons button[data-failed]", "lost")
    browser.one(".nao-failed", "the server /perform_designator died")
    browser.see_all()


def test_it_walks_while_a_key_is_held_and_no_longer(stack, browser):
    start = stack.robot
    browser.open("/wizard")
    browser.one("nao-wizard-buttons button")
    stack.robot.module("ALRobotPosture").goToPosture("StandInit", 0.8)
    x = start.true_pose().position.x
    browser.script("document.activeElement.blur()")
    ActionChains(browser.driver).key_down("w").perform()
    wait_until(lambda: start.true_pose().position.x > x + 0.03, LIMIT, "a walk ahead")
    ActionChains(browser.driver).key_up("w").perform()
    wait_until(lambda: not stack.robot.module("ALMotion").moveIsActive(), LIMIT, "the end of the walk")


def test_escape_ends_everything_on_every_page(browser, heard):
    goals, results = (
        heard("NaoBehavior/goal", NaoBehaviorActionGoal),
        heard("NaoBehavior/result", NaoBehaviorActionResult),
    )
    browser.open("/wizard")
    browser.one("nao-wizard-buttons button")
    browser.click("button", "Arm again")
    browser.script("document.activeElement.blur()")
    browser.keys("i")
    goal = goals.wait()
    assert texts(goal) == [("runBehavior", "introduce_yourself")]
    browser.open("/functions")
    browser.keys(Keys.ESCAPE)
    end = results.wait(lambda each: each.status.goal_id.id == goal.goal_id.id)
    assert end.status.status in (PREEMPTED, ABORTED)  # aborted, where it sees the end of its own goals first


PLACES = """
const strip = document.querySelector(".nao-strip").getBoundingClientRect();
return [...document.querySelectorAll(".nao-main button, .nao-stop")].map((each) => {
  const { x, y, bottom } = each.getBoundingClientRect();
  return [each.innerText, x, y, bottom <= strip.top || y >= innerHeight];
});
"""


def set_event(key, value):
    assert rospy.ServiceProxy("/nao_memory/set", SetMemory)(key=key, value=value, event=True).success


def test_an_alarm_is_shown_on_every_page_and_covers_and_moves_nothing(browser):
    browser.open("/wizard")
    browser.one("button", "Hello")
    browser.one(".nao-alarms")
    before = browser.script(PLACES)

    def falls():
        set_event("robotHasFallen", "true")  # again, until the console has subscribed
        return browser.all("[data-alarm=fallen]")

    try:
        browser.until(falls, "the alarm")
        assert "Lift the robot" in browser.one("[role=alert] [data-alarm=fallen]", "has fallen, since").text
        assert browser.script(PLACES) == before
        assert all(free for text, *_, free in before if "STOP" in text.upper())
        browser.open("/functions")
        browser.one("[data-alarm=fallen]")
    finally:
        set_event("PostureFamilyChanged", '"Crouching"')  # as it does, limp
    browser.until(lambda: not browser.all("[data-alarm=fallen]"), "the end of the alarm")


def test_an_observer_sees_and_moves_nothing(program, heard):
    goals = heard("nao_audio_out/goal", NaoAudioOutActionGoal)
    other = ConsoleBrowser(program)
    try:
        other.enter(program.observer)
        other.open("/wizard")
        other.click("nao-wizard-buttons button", "Yes")
        other.until(lambda: other.all(".nao-failed", "Yes: not sent: observers look on"), "why nothing happens")
        other.type("input[aria-label='Say']", "Not said")
        other.keys(Keys.ENTER)
        other.reads("observers look on")
        assert goals.messages == []
    finally:
        other.close()


# --- what is typed ----------------------------------------------------------------------------------------------------

DRAFTS = "return Object.keys(localStorage).filter((name) => name.startsWith('nao-draft')).map((n) => localStorage[n]);"
CODE = "return [...document.querySelectorAll('.cm-content')].map((each) => each.innerText).join();"


def kept(browser, text):
    """Wait until the browser keeps a text that is typed."""
    browser.until(lambda: any(text in each for each in browser.script(DRAFTS)), f"a draft with {text}")


def test_a_protocol_that_is_not_saved_is_offered_again_and_its_mistakes_stand_beside_their_lines(browser):
    browser.open("/study", protocol="ten_steps")
    browser.reads("One trial of ten steps")
    browser.click(".q-expansion-item", "Protocol as YAML")
    browser.click(".cm-content")
    chain = ActionChains(browser.driver).key_down(Keys.CONTROL).send_keys(Keys.HOME).key_up(Keys.CONTROL)
    chain.send_keys("nonsense: 3", Keys.ENTER).perform()
    kept(browser, "nonsense")
    browser.click("button", "Check")
    browser.until(lambda: browser.all(".cm-line:has(.nao-wrong)", "nonsense"), "the mistake beside its line")
    browser.reads("cannot be run")
    assert "Nothing wrong" not in browser.text()
    browser.open("/study", protocol="ten_steps")
    browser.click(".nao-draft button", "Show the draft")
    browser.until(lambda: "nonsense: 3" in browser.script(CODE), "the draft")
    browser.open("/study", protocol="ten_steps")
    browser.click(".nao-draft button", "Throw it away")
    browser.until(lambda: not browser.all(".nao-draft p") and browser.script(DRAFTS) == [], "no draft")


def test_buttons_that_were_edited_are_offered_when_the_editor_is_opened_again(browser):
    browser.open("/wizard")
    browser.click("button", "Edit")
    browser.click(".cm-content")
    browser.keys("# typed in vain?")
    browser.click(".nao-close")
    browser.click("button", "Edit")
    browser.click(".nao-draft button", "Show the draft")
    browser.until(lambda: "# typed in vain?" in browser.script(CODE), "the draft")


def test_a_text_that_was_not_said_is_offered_again(browser):
    browser.open("/wizard")
    browser.type("input[aria-label='Say']", "Half a sentence")
    kept(browser, "Half a sentence")
    browser.open("/wizard")
    browser.click(".nao-draft button", "Show the draft")
    said = "return document.querySelector(\"input[aria-label='Say']\").value"
    browser.until(lambda: browser.script(said) == "Half a sentence", "the draft")


# --- behaviours and functions -----------------------------------------------------------------------------------------


def test_a_behaviour_is_edited_and_run(stack, browser, heard):
    results = heard("NaoBehavior/result", NaoBehaviorActionResult)
    browser.open("/behaviors")
    browser.click(".q-item", "nod")
    browser.reads("NaoMotion")
    browser.click("button", "Check")
    browser.reads("It can be run")
    browser.click("button", "Run")
    end = results.wait()
    assert end.status.status == SUCCEEDED


def test_a_function_is_sent_from_its_form_and_copied(stack, browser):
    browser.open("/functions")
    browser.type("input[aria-label='Search functions']", "rest")
    browser.click(".q-item", "rest")
    browser.reads("NaoMotion.rest")
    browser.click("button", "Send")
    browser.reads("NaoMotion: rest", "succeeded")
    browser.click("button", "Command")
    copy = "return (document.querySelector('.q-dialog textarea') || {}).value"
    browser.until(lambda: (browser.script(copy) or "").strip() == "nao call NaoMotion rest", "the copy")
