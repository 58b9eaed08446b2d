"""ALPreferenceManager and ALPreferences: settings that outlast programs."""

import queue

import pytest
from simulator import PATIENCE

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.preference_manager import FILE, ALPreferenceManager

CHESS, LEVEL = "com.example.chess", "/game/level"
XML = """<ModulePreference name="Games" version="1.0">
<Preference name="player" value="Ada" type="string" description="who plays" memoryName="Games/Player"/>
<Preference name="rules" type="array"><Preference name="clock" value="5" type="int"/>
<Preference name="opening" value="e4" type="string"/></Preference></ModulePreference>"""


@pytest.fixture
def preferences(robot):
    return robot.ALPreferenceManager


def test_a_factory_reset_brings_back_those_of_earlier_runs(robot, preferences):
    robot.server.files.to_keep(FILE).write_text('{"com.example.chess": {"/game/level": "easy"}}')
    assert preferences.getValue(CHESS, LEVEL) == "easy"
    preferences.setValue(CHESS, LEVEL, "hard")
    robot.server.factory_reset()
    assert preferences.getValue(CHESS, LEVEL) == "easy"


def test_preferences_are_kept_changed_and_removed(preferences):
    preferences.setValue(CHESS, LEVEL, "easy")
    preferences.setValues({CHESS: {"depth": "10"}, "other": {"a": "b"}})
    assert preferences.getValue(CHESS, LEVEL) == "easy" and preferences.getDomainList() == [CHESS, "other"]
    assert preferences.getValueList(CHESS) == [[LEVEL, "easy"], ["depth", "10"]]
    assert preferences.getValues() == [[CHESS, LEVEL, "easy"], [CHESS, "depth", "10"], ["other", "a", "b"]]
    preferences.removeValue("other", "a")
    preferences.removeDomainValues(CHESS)
    assert preferences.getValue(CHESS, LEVEL) is None and preferences.getDomainList() == []


def test_another_run_of_the_simulator_knows_them(robot, preferences):
    preferences.setValue(CHESS, LEVEL, "hard")
    files = robot.server.files
    again = ALPreferenceManager(ClientFiles(files.folder), MemoryStore(lambda: 0.0), lambda *_: None)
    assert again.getValue(CHESS, LEVEL) == "hard"
    robot.server.factory_reset()
    assert preferences.getValue(CHESS, LEVEL) is None and not (files.folder / FILE).exists()


def test_events_and_signals_tell_of_each_change(robot, preferences):
    added, changed, removed = (robot.heard(f"preference{what}") for what in ("Added", "Changed", "Removed"))
    signals = queue.Queue()
    preferences.preferenceUpdated.connect(lambda *values: signals.put(values))
    for value in ("easy", "hard", "hard"):
        preferences.setValue(CHESS, LEVEL, value)
    preferences.removeValue(CHESS, LEVEL)
    assert [heard.get(timeout=PATIENCE) for heard in (added, changed, removed)] == [[CHESS, LEVEL]] * 3
    assert signals.get(timeout=PATIENCE) == (CHESS, LEVEL, "hard")
    assert len(robot.ALMemory.getEventHistory("preferenceChanged")) == 1


def test_signals_reach_who_is_connected_also_after_a_factory_reset(robot, preferences):
    signals = queue.Queue()
    preferences.preferenceAdded.connect(lambda *values: signals.put(values))
    robot.server.factory_reset()
    preferences.setValue(CHESS, LEVEL, "hard")
    assert signals.get(timeout=PATIENCE) == (CHESS, LEVEL, "hard")


def test_files_of_older_programs_are_read_written_and_imported(robot, preferences):
    old, folder = robot.ALPreferences, robot.server.files.folder / ".config" / "naoqi"
    folder.mkdir(parents=True)
    (folder / "Games.xml").write_text(XML)
    content = [
        "Games",
        "",
        [
            ["player", "who plays", "Ada", "Games/Player"],
            ["rules", "", [["clock", "", 5, "Games/rules/clock"], ["opening", "", "e4", "Games/rules/opening"]]],
        ],
    ]
    assert old.readPrefFile("Games", True) == content
    assert old.saveToMemory(content) is True
    assert [robot.value(key) for key in ("Games/Player", "Games/rules/clock")] == ["Ada", 5]
    old.writePrefFile("Copy", content, True)
    assert old.readPrefFile("Copy.xml", False)[2][1] == ["rules", "", [["clock", "", 5], ["opening", "", "e4"]]]
    preferences.setValue("games", "player", "Grace")
    preferences.importPrefFile("games", "naoqi", "Games.xml", False)
    assert preferences.getValueList("games") == [["player", "Grace"], ["rules/opening", "e4"]]
    preferences.importPrefFile("games", "naoqi", "Games.xml", True)
    assert preferences.getValue("games", "player") == "Ada"
    old.removePrefFile("Copy")
    assert not (folder / "Copy.xml").exists()


def test_what_cannot_be_kept_is_refused(robot, refuses):
    refuses("ALPreferenceManager", f"""
        setValue('a', 'b', 3) -> value of b is 3, allowed is a text of at most 1000000 bytes
        setValue('', 'b', 'c') -> domain is '', allowed is a text of 1 to 512 bytes
        setValue('a', 513 * 'b', 'c') -> setting is .*, allowed is a text of 1 to 512 bytes
        setValues({{'a': 'b'}}) -> texts by setting by domain
        removeValue('a', 'b') -> unknown setting of 'a' 'b'
        removeDomainValues('a') -> unknown domain 'a'
        importPrefFile('a', 'naoqi', 'No.xml', True) -> no file '.config/naoqi/No.xml'
        importPrefFile('a', '..', 'No.xml', True) -> application is '..', allowed is a name without folders
        update() -> no cloud to synchronize with; preferences are in the robot's own {FILE}
    """)  # fmt: skip
    refuses("ALPreferences", """
        readPrefFile('No', False) -> no file '.config/naoqi/No.xml'
        removePrefFile('../No') -> file is '../No.xml', allowed is a name without folders
        writePrefFile('No', ['No', '', 'text'], False) -> prefs is .*, allowed is .name, description, .preference
        saveToMemory([1]) -> prefs is \\[1\\], allowed is .name, description, value
    """)  # fmt: skip


def test_a_file_that_is_broken_is_put_aside(robot, preferences):
    path = robot.server.files.folder / FILE
    path.parent.mkdir(parents=True)
    path.write_text("{broken")
    robot.server.factory_reset()
    assert preferences.getDomainList() == [] and path.with_name(path.name + ".broken").read_text() == "{broken"
