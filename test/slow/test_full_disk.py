"""All folders on a small disk that fills up and gets room again; the disk is in a namespace of its own."""

import os
import subprocess
import sys
from pathlib import Path

SIZE = "8m"
LIMIT = 300.0
INSIDE = 'mount -t tmpfs -o size="$1" tmpfs "$2" && shift 2 && exec "$@"'


def run_on_a_small_disk(tmp_path, name):
    disk = tmp_path / "disk"
    disk.mkdir()
    case = Path(__file__).with_name(name)
    inside = [sys.executable, "-m", "pytest", str(case), "-n", "0", "-q", "-s", "-p", "no:cacheprovider"]
    user = [] if os.geteuid() == 0 else ["--map-root-user"]
    done = subprocess.run(
        ["unshare", *user, "--mount", "sh", "-c", INSIDE, "sh", SIZE, str(disk), *inside],
        env={**os.environ, "SMALL_DISK": str(disk), "TMPDIR": str(disk), "ROS_HOME": str(disk / "ros")},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT,
    )  # fmt: skip
    print(done.stdout)
    assert done.returncode == 0, done.stdout[-5000:]
    assert list(disk.iterdir()) == [], "nothing outside has been written to"


def test_a_full_disk_stops_what_it_must_loses_nothing_and_with_room_everything_works_again(tmp_path):
    run_on_a_small_disk(tmp_path, "full_disk.py")


def test_a_disk_that_is_full_for_a_second_takes_nothing_of_a_trial(tmp_path):
    run_on_a_small_disk(tmp_path, "full_disk_trials.py")
