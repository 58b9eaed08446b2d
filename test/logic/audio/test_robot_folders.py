"""Folders of the robot, as servers know them: by each name that a simulated robot answers to."""

import pytest

from nao_library_modules.core.nao_facts import READ, full_path, is_in
from nao_library_modules.nao_audio import require_file
from nao_sim_bridge.base import record_dir


@pytest.mark.parametrize("place", record_dir.load_places(), ids=lambda place: place.path)
def test_files_are_found_by_every_name_of_their_folder(place):
    assert all(is_in(f"{name}/a.wav", READ) for name in (place.path, *place.other_names))


@pytest.mark.parametrize(
    "name", ["a.wav", "~/a.wav", "~nao/a.wav", "/data/home/nao/a.wav", "/var/persistent/home/nao/a.wav"]
)
def test_the_home_has_one_path_whatever_it_is_called(name):
    assert require_file("str_param", name, (".wav",)) == name and full_path(name) == "/home/nao/a.wav"


@pytest.mark.parametrize("name", ["/data/home/naomi/a.wav", "/tmp/data/home/nao", "~naomi/a.wav", "/data/a"])
def test_paths_that_begin_like_the_home_are_others(name):
    assert full_path(name) == record_dir.full_path(name)
