"""The page of the library, in a virtual environment of its own without ROS."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run(*command, **options):
    done = subprocess.run(
        [str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options
    )
    assert done.returncode == 0, done.stdout[-4000:]
    return done.stdout


@pytest.mark.timeout(900)
def test_every_example_of_the_library_runs_without_ros(tmp_path):
    venv = tmp_path / "venv"
    run(sys.executable, "-m", "venv", venv)
    python = venv / "bin" / "python"
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "ROS", "CMAKE"))}
    sources = tmp_path / "nao_sim_bridge"
    run("cp", "-r", ROOT / "nao_sim_bridge", sources)  # pip builds in the folder
    run(python, "-m", "pip", "install", "--quiet", f"{sources}[naoqi,rl,sweep]", env=clean)
    blocks = BLOCK.findall((ROOT / "docs" / "library.md").read_text(encoding="utf-8"))
    assert len(blocks) >= 8
    page = tmp_path / "page.py"
    page.write_text("\n".join(blocks), encoding="utf-8")
    told = run(python, page, cwd=tmp_path, env=clean)
    assert (tmp_path / "nao.png").stat().st_size > 10_000 and (tmp_path / "pushes.png").exists()
    assert re.search(r"^ *0\.0 +4 +0 ", told, re.MULTILINE) and re.search(r"^ *4\.0 +4 +1 ", told, re.MULTILINE), told
    checks = "from gymnasium.utils.env_checker import check_env; import gymnasium, warnings, nao_sim_bridge.envs as e;"
    checks += "warnings.simplefilter('error'); "
    checks += "[check_env(gymnasium.make(f'{name}-v0').unwrapped, skip_render_check=True) for name in e.STEPS]"
    run(python, "-c", checks, cwd=tmp_path, env=clean)
    example = sources / "examples" / "train_stand.py"
    told = run(python, example, "--iterations", 1, "--directions", 1, "--episodes", 1, cwd=tmp_path, env=clean)
    assert "own balance" in told and (tmp_path / "train_stand" / "compared.png").exists()
