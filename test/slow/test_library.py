"""The page of the library, in a virtual environment of its own without ROS."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CHECK = """
import warnings
from gymnasium.utils.env_checker import check_env
warnings.simplefilter("error")
check_env(TiltEnv(), skip_render_check=True)
"""
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run(*command, **options):
    done = subprocess.run(
        [str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    )
    assert done.returncode == 0, done.stdout[-4000:]
    return done.stdout


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """Runs Python in an environment that pip has made, from a copy of the package: (folder of the copy, function)."""
    folder = tmp_path_factory.mktemp("library")
    run(sys.executable, "-m", "venv", folder / "venv")
    python = folder / "venv" / "bin" / "python"
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "ROS", "CMAKE"))}
    sources = folder / "nao_sim_bridge"
    run("cp", "-r", ROOT / "nao_sim_bridge", sources)  # pip builds in the folder
    run(python, "-m", "pip", "install", "--quiet", f"{sources}[naoqi,rl,sweep]", "pytest", env=clean)
    return sources, lambda *arguments, cwd: run(python, *arguments, cwd=cwd, env=clean)


@pytest.mark.timeout(1800)
def test_the_page_of_the_library_and_its_floor_run_without_ros(library, tmp_path):
    sources, python = library
    blocks = BLOCK.findall((ROOT / "docs" / "library.md").read_text(encoding="utf-8"))
    assert len(blocks) >= 8
    assert blocks[0] in (sources / "examples" / "nao_in_ten_lines.py").read_text(encoding="utf-8")
    page = tmp_path / "page.py"
    page.write_text("\n".join(blocks), encoding="utf-8")
    told = python(page, cwd=tmp_path)
    assert (tmp_path / "nao.png").stat().st_size > 10_000 and (tmp_path / "pushes.png").exists()
    assert re.search(r"^ *0\.0 +4 +0 +0 ", told, re.MULTILINE), told
    assert re.search(r"^ *4\.0 +4 +4 +1 ", told, re.MULTILINE), told
    told = python(sources / "examples" / "tilting_floor.py", cwd=tmp_path)
    assert [line.rpartition(" ")[2] for line in told.splitlines() if "fallen" in line] == ["False", "True"]
    assert (tmp_path / "tilting_floor.png").stat().st_size > 10_000


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_a_policy_is_trained_and_compared(library, tmp_path):
    sources, python = library
    example = sources / "examples" / "train_stand.py"
    told = python(example, "--iterations", 1, "--directions", 1, "--episodes", 1, cwd=tmp_path)
    assert "own balance" in told and (tmp_path / "train_stand" / "compared.png").exists()


@pytest.mark.timeout(600)
def test_the_environment_of_its_page_can_be_learned_in(library, tmp_path):
    """Its blocks run, and the observation is as long as the page says."""
    blocks = BLOCK.findall((ROOT / "docs" / "environments.md").read_text(encoding="utf-8"))
    page = tmp_path / "page.py"
    page.write_text("\n".join([*blocks, CHECK]), encoding="utf-8")
    told = library[1](page, cwd=tmp_path)
    assert re.search(r"^76 numbers seen, 7\d\.\d of 80, fallen: False$", told, re.MULTILINE), told


@pytest.mark.timeout(1800)
def test_environments_are_what_their_page_says(library, tmp_path):
    file = tmp_path / "test_environments.py"  # away from the conftest.py of this project
    file.write_text((Path(__file__).parent / "environments.py").read_text(encoding="utf-8"), encoding="utf-8")
    library[1]("-m", "pytest", "-q", file, cwd=tmp_path)


@pytest.mark.long
@pytest.mark.timeout(900)
def test_sweeps_outlive_a_lost_node_and_use_one_that_joins(library, tmp_path):
    told = library[1](Path(__file__).parent / "sweep_cluster.py", "--kills", 1, "--joins", 1, cwd=tmp_path)
    assert "2 of 2 sweeps ended well" in told
