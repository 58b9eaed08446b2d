"""The container file, step by step in a bare Debian 12, without a container engine."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import socket
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SUITE = "bookworm"
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
# How this computer reaches its package registries, which a new tree does not know.
OF_THIS_COMPUTER = ["etc/apt", "etc/ssl", "etc/resolv.conf", "usr/local/share/ca-certificates"]
OF_THIS_COMPUTER += ["etc/pip.conf", "etc/xdg/pip", "root/.config/pip"]
# Its client takes the eyes' colour, waits for the result and prints the battery's charge.
CLIENT = "nao_library_modules/examples/green_eyes.py"
SCRIPT = """
set -eu
mount --make-rprivate /
for bound in "$@"; do
    mkdir -p "$TREE$bound"
    mount --bind --read-only "$bound" "$TREE$bound"
done
mount --bind /dev "$TREE/dev"
mount --bind "$TREE" "$TREE"
mount -t proc proc "$TREE/proc"
$LOOPBACK
exec chroot "$TREE" /bin/bash -euc "$COMMANDS"
"""


def instructions() -> list[tuple[str, str]]:
    """Names and arguments of the container file's instructions."""
    lines = (ROOT / "Containerfile").read_text().splitlines()
    return [tuple(line.split(maxsplit=1)) for line in lines if line and not line.startswith("#")]


def pip_folders() -> list[str]:
    """Folders of this computer that pip takes packages from."""
    told = subprocess.run([sys.executable, "-m", "pip", "config", "list"], capture_output=True, text=True, check=True)
    words = told.stdout.replace("file://", "").replace("'", " ").split()
    return [word for word in dict.fromkeys(words) if word.startswith("/") and Path(word).is_dir()]


def inside(tree: Path, commands: str, *, network: bool) -> str:
    """Run commands in the tree, with its own processes and mounts; everything ends with them."""
    own = ["unshare", "--mount", "--pid", "--fork", "--kill-child", *([] if network else ["--net"])]
    kept = {name: value for name, value in os.environ.items() if name.startswith(("PIP_", "SSL_", "http", "HTTP"))}
    loopback = "true" if network else "ip link set lo up"  # a network namespace of its own begins without
    environment = {**kept, "LOOPBACK": loopback, "PATH": PATH, "HOME": "/root", "TREE": str(tree), "COMMANDS": commands}
    done = subprocess.run(
        [*own, "bash", "-c", SCRIPT, "bash", *pip_folders()],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout[-4000:]
    return done.stdout


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_the_steps_of_the_container_file_make_a_robot_in_a_bare_debian(tmp_path):
    tree = tmp_path / "tree"
    wanted = ["--format", "$(REPO_URI)", "Created-By: Packages", f"Codename: {SUITE}", "Component: main"]
    mirror = subprocess.run(
        ["apt-get", "indextargets", *wanted], stdout=subprocess.PIPE, text=True, check=True
    ).stdout.split()[0]
    subprocess.run(["debootstrap", "--variant=minbase", SUITE, tree, mirror], check=True, stdout=subprocess.DEVNULL)
    for place in filter(Path.exists, map(Path("/").joinpath, OF_THIS_COMPUTER)):
        copy = shutil.copyfile if place.is_file() else partial(shutil.copytree, symlinks=True, dirs_exist_ok=True)
        target = tree / place.relative_to("/")
        target.parent.mkdir(parents=True, exist_ok=True)
        copy(place, target)
    (tree / "etc/hosts").write_text(f"127.0.0.1 localhost {socket.gethostname()}\n")  # as container engines do
    folder, entry, command = "/", [], []
    for name, told in instructions():
        if name == "FROM":
            assert told == "debian:12"
        elif name == "WORKDIR":
            folder = told
            (tree / told.lstrip("/")).mkdir(parents=True)
        elif name == "COPY":
            source, target = told.split()
            left_out = [
                line for line in (ROOT / ".containerignore").read_text().splitlines() if not line.startswith("#")
            ]
            ignored = shutil.ignore_patterns(*(line.replace("**/", "") for line in left_out))
            shutil.copytree(ROOT / source, tree / target.lstrip("/"), ignore=ignored, dirs_exist_ok=True, symlinks=True)
        elif name == "RUN":
            inside(tree, f"cd {folder}; {told}", network=True)
        else:
            (entry if name == "ENTRYPOINT" else command).extend(json.loads(told))
    launch, client = (shlex.join([*entry, *words]) for words in (command, ["python3", CLIENT]))
    # No network: the stack needs none but its own loopback.
    told = inside(tree, f"cd {folder}; {launch} > /launch.log 2>&1 & cd {folder}; {client}", network=False)
    assert 0.0 <= float(json.loads(told.strip().splitlines()[-1].replace("'", '"'))[0]) <= 1.0, told
