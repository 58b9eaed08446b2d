"""Patches for what stands below: each shows the fault without it, and the cure with it."""

import importlib.util
import subprocess
import threading
from pathlib import Path
from types import SimpleNamespace

import actionlib.simple_action_client
import pytest
from actionlib import CommState

PATCH = Path(__file__).parents[2] / "patches" / "actionlib-206.patch"


class EarlyEnds:
    """Stands for actionlib's ActionClient; a goal is over before whoever sent it has noted it."""

    ns = "any"

    def send_goal(self, goal, transition, _feedback):
        handle = SimpleNamespace(
            get_comm_state=lambda: CommState.DONE, get_goal_status=lambda: 3, get_result=lambda: goal
        )
        self.news = threading.Thread(target=transition, args=(handle,), daemon=True)
        self.news.start()
        self.news.join(0.1)  # without the patch it is over by then
        return handle


@pytest.mark.parametrize("patched", [False, True])
def test_actionlib_learns_of_an_end_that_comes_early(tmp_path, monkeypatch, patched):
    source = tmp_path / "src" / "actionlib" / "simple_action_client.py"
    source.parent.mkdir(parents=True)
    source.write_text(Path(actionlib.simple_action_client.__file__).read_text(encoding="utf-8"), encoding="utf-8")
    if patched:
        subprocess.run(["patch", "-p1", "-i", str(PATCH)], cwd=tmp_path, check=True, capture_output=True)
    spec = importlib.util.spec_from_file_location("patched_client", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    below, ends = EarlyEnds(), []
    monkeypatch.setattr(module, "ActionClient", lambda *_: below)
    client = module.SimpleActionClient("any", None)
    client.send_goal("goal", done_cb=lambda *end: ends.append(end))
    below.news.join(60.0)
    assert ends == ([(3, "goal")] if patched else [])
    assert (client.simple_state == module.SimpleGoalState.DONE) == patched
