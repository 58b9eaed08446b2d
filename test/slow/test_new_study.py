"""A study of one's own, from `nao new study` to its test: in a package outside of this project, as its page says."""

import os
import subprocess
from pathlib import Path

import pytest
from launch_lines import launch_lines, missing, without_launch_lines
from programs import Program, shell
from samples import samples

SCRIPTS = Path(__file__).parents[2] / "scripts"
ROS_ENV = str(SCRIPTS / "ros-env")
LIMIT = 900.0


@pytest.mark.timeout(LIMIT + 40.0)
def test_a_new_study_passes_its_own_test(tmp_path, monkeypatch):
    written, tested = (block.text for block in samples("docs/your_own.md") if "run by" in block.marks)
    folders = {name: str(tmp_path / name) for name in ("ROS_TEST_RESULTS_DIR", "ROS_LOG_DIR", "ROS_HOME", "HOME")}
    (tmp_path / "HOME").mkdir()
    environment = {**os.environ, **folders, "NAO_PORT": "0"}

    def typed(text):
        return Program([ROS_ENV, *shell(f"set -e\n{text}")], tmp_path, environment).end(LIMIT)

    study = tmp_path / "HOME" / "studies"
    made = typed(written)
    assert made.output.splitlines()[0] == f"{study}/greeting", str(made)
    again = typed(written)
    assert again.status == 1 and "is there already" in again.output, str(again)
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{study}:{os.environ['ROS_PACKAGE_PATH']}")
    assert [missing(line) for line in launch_lines(tested)] == [[]]
    ended = typed(without_launch_lines(tested))
    assert ended.status == 0, str(ended)
    assert "RESULT: SUCCESS" in ended.output and "TESTS: 1" in ended.output, str(ended)


def test_a_workspace_that_was_sourced_stays_and_what_is_left_out_is_told(tmp_path):
    python = tmp_path / "devel" / "lib" / "python3" / "dist-packages"
    python.mkdir(parents=True)
    (tmp_path / "devel" / ".catkin").touch()
    (python / "theirs.py").touch()
    (python / "nao_library_modules.py").write_text("raise ImportError('ours comes before')")
    (python / "sitecustomize.py").write_text("print('their messages are found')")
    sourced = {"CMAKE_PREFIX_PATH": str(tmp_path / "devel"), "PYTHONPATH": f"{python}:{tmp_path}/other"}
    command = [
        ROS_ENV,
        "python3",
        "-c",
        "import theirs, nao_library_modules, os; print(os.environ['CMAKE_PREFIX_PATH'])",
    ]
    ran = subprocess.run(command, env={**os.environ, **sourced}, capture_output=True, text=True)
    assert ran.stdout.strip().endswith(f":{tmp_path}/devel"), ran.stderr
    assert f"PYTHONPATH is left out, for it could hide modules of this project: {tmp_path}/other" in ran.stderr
    helped = subprocess.run(
        [SCRIPTS / "bin/nao", "--help"], env={**os.environ, **sourced}, capture_output=True, text=True
    )
    assert helped.stdout.startswith("their messages are found\nUsage: nao"), helped.stdout + helped.stderr
