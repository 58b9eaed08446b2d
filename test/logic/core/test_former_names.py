"""What programs of others import is there under the names that they know, and is the same thing."""

from __future__ import annotations

from importlib import import_module

import pytest

from nao_library_modules import FORMER, process_modules, vision
from nao_library_modules.core.lazy import door

LIBRARY = "nao_library_modules"
SERVERS = {
    "lights": "NaoLights",
    "motion": "NaoMotion",
    "audio_out": "NaoAudioOutput",
    "audio_in": "NaoAudioInput",
    "vision": "NaoVision",
    "tactile": "NaoTactile",
    "nao_audio": "NaoAudio",
    "nao_basic": "NaoBasic",
}


def test_a_module_with_a_former_name_is_the_same_module():
    for former, name in FORMER.items():
        module = import_module(f"{LIBRARY}.{name}")
        assert import_module(f"{LIBRARY}.{former}") is module
        assert (module.__name__, module.__spec__.name) == (f"{LIBRARY}.{name}",) * 2


@pytest.mark.parametrize("module", SERVERS)
def test_servers_are_imported_from_their_folders(module):
    assert getattr(import_module(f"{LIBRARY}.{module}"), SERVERS[module]).__name__ == SERVERS[module]


def test_both_modules_for_sound_inherit_nao_audio_and_have_its_functions():
    nao_audio = import_module(f"{LIBRARY}.nao_audio").NaoAudio
    for module in (import_module(f"{LIBRARY}.{name}") for name in ("audio_out", "audio_in")):
        kind = getattr(module, SERVERS[module.__name__.rpartition(".")[2]])
        assert issubclass(kind, nao_audio)
        assert kind.declared_functions().items() >= nao_audio.functions.items()


def test_what_packages_load_when_it_is_asked_for_is_there():
    assert all(getattr(vision, name) for name in vision.__all__)
    assert process_modules.StartProcessModules is process_modules.start_process_modules
    for name in ("Manipulation", "Navigation", "Speech"):
        assert getattr(process_modules, f"{name}ProcessModule").__name__ == name


def test_a_name_that_no_module_has_is_told():
    with pytest.raises(AttributeError, match="module 'nao_library_modules.lights' has no attribute 'NaoLamps'"):
        door("nao_library_modules.lights", {"NaoLights": "lights_server"})("NaoLamps")
