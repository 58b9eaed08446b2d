"""Who may import whom: the layers of the stack point one way. Read from the sources, without importing them."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator
from xml.etree import ElementTree

import pytest
from graphlib import TopologicalSorter

ROOT = Path(__file__).resolve().parents[2]
SOURCES = {name: ROOT / name / "src" for name in ("nao_library_modules", "nao_sim_bridge")}
IMPORTED_LATER = re.compile(r"(\w+(?:\.\w+)+):\w*")
"""How files of the simulator name what they import when they need it; see `nao_sim_bridge.base.imports`."""

# Import names that stand for ROS: of its Python libraries, and of every message package but our own.
ROS_LIBRARIES = set(
    "actionlib cv_bridge diagnostic_updater dynamic_reconfigure genpy rosbag rosgraph roslaunch roslib rosnode rospy "
    "rosservice rostest rostopic tf tf2_ros".split()
)
OWN_DEFINITIONS = {"nao_library_msgs": "definitions", "nao_library_actions": "definitions"}
# What scripts for the robot maker's SDK import beside naoqi.
SDK = {"almath", "motion", "vision_definitions"}


@dataclass(frozen=True)
class Layer:
    """A part of the stack, and the parts it may import besides itself and what this rule is not about.

    Attributes:
        name: What others call it.
        folder: Where its files are, below one of the source folders.
        may_import: Names of layers, of "ros", "qi", "pybullet" or "definitions" (our messages and actions).
        nested: Files and folders inside that are of other layers.
    """

    name: str
    folder: str
    may_import: frozenset[str]
    nested: tuple[str, ...] = ()


ROOMS = {
    "nao_library_modules": """
    . core ros nao_basic nao_audio lights audio_out audio_in motion vision tactile
    driver.base driver.joints driver.walk driver.path_follower driver.camera driver.audio driver.memory driver.sensors
    driver.life driver.teleop driver
    process_modules
    behaviors sweeps studies cli
    console.robots console.access console.timeline console.view console.wizard console.pages console cli.commands
    """.split(),
    "nao_sim_bridge": """
    base model model.urdf world.painting world body.sensors body
    control.joints control.whole_body control.balance control walk
    cameras render.scene render.opengl render sound hearing.grammars hearing speech vision behaviors tracking core
    naoqi.binding naoqi.memory naoqi.motion naoqi.body naoqi.speech naoqi.sound naoqi.vision naoqi.cameras
    naoqi.behaviors naoqi.tracker naoqi.navigation naoqi.system naoqi.life naoqi.users naoqi
    server library . envs sweep ros testing
    """.split(),
}
"""Folders of a package from the ground up: each imports only what stands before it; the dot is the package itself."""
MOST_FILES = 25
"""In one folder: a reader sees at a glance what is there."""
LIBRARY = "nao_library_modules/src/nao_library_modules"
SIMULATOR = "nao_sim_bridge/src/nao_sim_bridge"
# What a user of the simulator imports or starts: it may use everything that needs no ROS.
FRONT = ("library", "envs", "sweep", *(path.name for path in (ROOT / SIMULATOR).glob("*.py")))
# Clients reach the robot through topics and actions only, and share helpers and errors with the servers.
CLIENTS = ("process_modules", "behaviors")
OF_CLIENTS = frozenset({"errors", "definitions", "ros", "library", *CLIENTS})

LAYERS = (
    Layer("naoqi", "nao_library_modules/src/naoqi", frozenset({"qi", "sdk", "errors"})),
    Layer("sdk", "nao_library_modules/src", frozenset(), ("naoqi", "nao_library_modules")),
    Layer(
        "library",
        LIBRARY,
        frozenset({"naoqi", "errors", "definitions", "ros", "sdk"}),
        (*CLIENTS, "sweeps", "studies", "cli", "console"),
    ),
    *(Layer(name, f"{LIBRARY}/{name}", OF_CLIENTS) for name in CLIENTS),
    Layer("sweeps", f"{LIBRARY}/sweeps", OF_CLIENTS | {"front", "sim", "testing"}),
    Layer("studies", f"{LIBRARY}/studies", OF_CLIENTS),
    Layer("cli", f"{LIBRARY}/cli", OF_CLIENTS | {"naoqi", "sweeps", "sim", "studies", "console"}),
    Layer("console", f"{LIBRARY}/console", OF_CLIENTS | {"studies", "cli"}),
    Layer("engine", f"{SIMULATOR}/base/engine.py", frozenset({"pybullet"})),
    Layer("sim", SIMULATOR, frozenset({"engine"}), ("base/engine.py", "naoqi", "server", "ros", "testing", *FRONT)),
    Layer("modules", f"{SIMULATOR}/naoqi", frozenset({"sim", "qi"})),
    Layer("server", f"{SIMULATOR}/server", frozenset({"modules", "sim", "qi"})),
    *(Layer("front", f"{SIMULATOR}/{name}", frozenset({"server", "sim"})) for name in FRONT),
    Layer("ros side", f"{SIMULATOR}/ros", frozenset({"server", "modules", "sim", "ros", "definitions"})),
    Layer("testing", f"{SIMULATOR}/testing", frozenset({"server", "sim", "qi", "ros", "definitions"})),
)


def files_of(layer: Layer) -> list[Path]:
    folder = ROOT / layer.folder
    nested = {folder / name for name in layer.nested}
    files = [folder] if folder.is_file() else sorted(folder.rglob("*.py"))
    return [path for path in files if not nested & {path, *path.parents}]


def imported(path: Path) -> Iterator[str]:
    """Full names of the modules that a file imports, anywhere in it; relative imports made absolute."""
    package = path.relative_to(next(source for source in SOURCES.values() if source in path.parents)).parent.parts
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = [*package[: len(package) - node.level + 1]] if node.level else []
            base += node.module.split(".") if node.module else []
            # "from package import part" may name a module as well as something inside one.
            yield from (".".join([*base, alias.name]) for alias in node.names)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and package[:1] == ("nao_sim_bridge",):
            later = IMPORTED_LATER.fullmatch(node.value)
            yield from [f"nao_sim_bridge.{later[1]}"] if later else []


def layer_of(module: str) -> str | None:
    """The layer a module belongs to; None for what the rule is not about."""
    root, *inner = module.split(".")
    if root == "naoqi" and inner[:1] == ["errors"]:
        return "errors"
    if root in SDK:
        return "sdk"
    if root in OWN_DEFINITIONS:
        return OWN_DEFINITIONS[root]
    if root in ROS_LIBRARIES or root.endswith(("_msgs", "_srvs")):
        return "ros"
    if root == "nao_sim_bridge":
        own = {"naoqi": "modules", "server": "server", "ros": "ros side", "testing": "testing"}
        first = inner[0] if inner else "__init__"
        if inner[:2] == ["base", "engine"]:
            return "engine"
        return "front" if {first, f"{first}.py"} & {*FRONT} else own.get(first, "sim")
    if root == "nao_library_modules":
        return inner[0] if inner[:1] and inner[0] in (*CLIENTS, "sweeps", "studies", "cli", "console") else "library"
    return root if root in ("naoqi", "qi", "pybullet") else None


def room_of(module: str) -> str:
    """The room of a module; a dot for the package itself and its programs."""
    package, *inner = module.split(".")
    rooms = ROOMS[package]
    return next((room for n in (2, 1) for room in [".".join(inner[:n])] if room in rooms), ".")


def imports_of(package: str) -> dict[str, set[str]]:
    """Module of a package -> those of it that it imports, in functions and for types as well."""
    source = SOURCES.get(package, SOURCES["nao_library_modules"])
    paths = {
        ".".join(path.relative_to(source).with_suffix("").parts).removesuffix(".__init__"): path
        for path in (source / package).rglob("*.py")
    }
    found: dict[str, set[str]] = {}
    for name, path in paths.items():
        names = [other if other in paths else other.rpartition(".")[0] for other in imported(path)]
        found[name] = {other for other in names if other in paths and other != name}
    return found


@pytest.mark.parametrize("package", SOURCES)
def test_a_room_imports_only_what_stands_below_it(package):
    rank = {room: number for number, room in enumerate(ROOMS[package])}
    imports = imports_of(package)
    assert {room_of(name) for name in imports} == {*ROOMS[package], "."}
    wrong = [
        f"{name} imports {other}"
        for name, others in imports.items()
        for other in others
        if room_of(name) != "." and rank[room_of(other)] > rank[room_of(name)]
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("package", [*SOURCES, "naoqi", "almath"])
def test_no_module_imports_itself_by_way_of_others(package):
    assert tuple(TopologicalSorter(imports_of(package)).static_order())  # raises CycleError, with the circle


@pytest.mark.parametrize("package", SOURCES)
def test_no_folder_is_crowded(package):
    folders = Counter(path.parent for path in (SOURCES[package] / package).rglob("*.py"))
    assert max(folders.values()) <= MOST_FILES, folders.most_common(1)


@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.name)
def test_imports_point_one_way(layer):
    files = files_of(layer)
    assert files, f"{layer.folder} is empty: the rule checks nothing"
    wrong = [
        f"{path.relative_to(ROOT)} imports {module} ({found})"
        for path in files
        for module in imported(path)
        for found in [layer_of(module)]
        if found not in (None, layer.name) and found not in layer.may_import
    ]
    assert not wrong, "\n".join(wrong)


def test_every_file_belongs_to_a_layer():
    files = [path for layer in LAYERS for path in files_of(layer)]
    everything = {path for source in SOURCES.values() for path in source.rglob("*.py")}
    assert everything == set(files)
    assert len(files) == len(set(files))


def test_modules_are_told_apart_and_relative_imports_followed(monkeypatch, tmp_path):
    known = {
        "nao_sim_bridge.core.runner": "sim",
        "nao_sim_bridge.naoqi.body.leds": "modules",
        "nao_sim_bridge.server.simulator_server.SimulatorServer": "server",
        "nao_library_modules.lights.NaoLights": "library",
        "geometry_msgs.msg.Pose": "ros",
        "nao_library_msgs.msg.LedFunction": "definitions",
        "motion": "sdk",
        "numpy.linalg": None,
    }
    assert {module: layer_of(module) for module in known} == known
    monkeypatch.setitem(SOURCES, "nao_library_modules", tmp_path)
    file = tmp_path / "nao_library_modules" / "driver" / "node.py"
    file.parent.mkdir(parents=True)
    file.write_text("from . import led\nfrom ..lights import NaoLights\nif True:\n    import qi.path\n")
    found = ["nao_library_modules.driver.led", "nao_library_modules.lights.NaoLights", "qi.path"]
    assert list(imported(file)) == found


def test_the_package_of_the_simulator_alone_loads_neither_the_engine_nor_arrays():
    program = "import sys, nao_sim_bridge; print(sorted({'pybullet', 'numpy'} & {*sys.modules}), nao_sim_bridge.NaoSim)"
    told = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=True).stdout
    assert told.endswith("[] <class 'nao_sim_bridge.library.nao_sim.NaoSim'>\n")


def test_who_knows_the_errors_of_naoqi_alone_loads_neither_libqi_nor_motion():
    program = (
        "import sys, naoqi, nao_library_modules.ros.type_names\n"
        "print(sys.modules.keys() & {'qi', 'motion'}, naoqi.ALProxy, naoqi.motion.FRAME_ROBOT)"
    )
    told = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=True).stdout
    assert told == "set() <class 'naoqi.proxy.ALProxy'> 2\n"


def test_no_message_class_is_made_from_a_definition_of_others():
    """A definition may be a program. rosbag runs those of a bag, so one module reads bags, which keeps it from that."""
    folders = (*SOURCES.values(), *(ROOT / name for name in OWN_DEFINITIONS), ROOT / "nao_library_modules/examples")
    texts = {path.relative_to(ROOT).as_posix(): path.read_text() for top in folders for path in top.rglob("*.py")}
    assert len(texts) > 800
    assert [path for path, text in texts.items() if "generate_dynamic" in text] == []
    readers = re.compile(r"^\s*(?:import|from) (?:rosbag|rostopic|rosmsg|genpy\.dynamic)\b", re.MULTILINE)
    assert [path for path, text in texts.items() if readers.search(text)] == [f"{LIBRARY}/ros/bag_types.py"]


def test_messages_and_actions_are_apart():
    kinds = {
        name: {path.suffix for path in ROOT.glob(f"{name}/*/*")} & {".msg", ".srv", ".action"}
        for name in OWN_DEFINITIONS
    }
    assert kinds == {"nao_library_msgs": {".msg", ".srv"}, "nao_library_actions": {".action"}}


def test_the_three_packages_have_their_names_and_depend_on_each_other_one_way():
    needed = {
        "nao_library_msgs": set(),
        "nao_library_actions": {"nao_library_msgs"},
        "nao_library_modules": {"nao_library_msgs", "nao_library_actions", "actionlib"},
    }
    for name, others in needed.items():
        package = ElementTree.parse(ROOT / name / "package.xml").getroot()
        depends = {each.text for each in package.iter() if each.tag in ("depend", "exec_depend")}
        assert package.findtext("name") == name
        assert depends & {"actionlib", *needed} == others
