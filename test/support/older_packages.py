"""The packages of the older stack, naoqi_bridge_msgs and humanoid_nav_msgs, made of our definitions as genpy does."""

from __future__ import annotations

import importlib
import re
from collections import defaultdict

import genpy.generator
from rospkg import RosPack

from nao_library_modules.ros.type_names import type_names

NEEDED = ("actionlib_msgs", "geometry_msgs", "nav_msgs", "sensor_msgs", "std_msgs", "trajectory_msgs")
MANIFEST = """<package format="2"><name>{}</name><version>0.0.1</version><description>Made for a test.</description>
<maintainer email="nobody@localhost">nobody</maintainer><license>BSD</license></package>
"""


def make_older_packages(folder):
    """Write both packages into a folder: packages of ROS, and in `python` what genpy makes of them.

    Returns the folder for PYTHONPATH.
    """
    texts = _texts()
    packages = RosPack()
    search = {name: [f"{packages.get_path(name)}/msg"] for name in NEEDED}
    for package, kinds in texts.items():
        search[package] = [str(folder / package / "msg")]
        for (kind, name), text in kinds.items():
            file = folder / package / kind / f"{name}.{kind}"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        (folder / package / "package.xml").write_text(MANIFEST.format(package))
    makers = {"msg": genpy.generator.MsgGenerator(), "srv": genpy.generator.SrvGenerator()}
    for package, kinds in texts.items():
        for kind, maker in makers.items():
            target = folder / "python" / package / kind
            target.mkdir(parents=True, exist_ok=True)
            names = [name for other, name in kinds if other == kind]
            files = [str(folder / package / kind / f"{name}.{kind}") for name in names]
            assert maker.generate_messages(package, files, str(target), search) == 0
            (target / "__init__.py").write_text("".join(f"from ._{name} import *\n" for name in sorted(names)))
        (folder / "python" / package / "__init__.py").touch()
    return folder / "python"


def _texts():
    """Package -> (msg or srv, name) -> the file's text, with our names replaced by theirs."""
    table = type_names()
    ours = re.compile("|".join(sorted((re.escape(name) for name in table.theirs), key=len, reverse=True)) + r"\b")
    texts = defaultdict(dict)
    for own, name in table.theirs.items():
        package, _, word = name.partition("/")
        kind, text = _text(own)
        if kind:
            fields = table.definitions.get(name, ours.sub(lambda found: table.theirs[found[0]], text))
            texts[package][kind, word] = fields
    return texts


def _text(own):
    """Kind and text of a definition; nothing for the halves of a service, which are in its file."""
    package, _, word = own.partition("/")
    for kind in ("srv", "msg") if package == "nao_library_msgs" else ("msg",):
        found = getattr(importlib.import_module(f"{package}.{kind}"), word, None)
        if found is None:
            continue
        if kind == "msg":
            return kind, _root(found)
        if hasattr(found, "_request_class"):
            return kind, f"{_root(found._request_class)}\n---\n{_root(found._response_class)}"
        return "", ""
    raise KeyError(own)


def _root(message):
    return message._full_text.partition("=" * 80)[0]
