"""A robot's description (URDF) as what a browser draws: shapes, joints, meshes by address. Pure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any, Callable, Tuple
from xml.etree import ElementTree

from naoqi.errors import NaoError

Vector = Tuple[float, ...]
PACKAGE = "package://"
DRAWN = ".stl"
"""Ending of the meshes that the page can draw; others are left out."""
LARGEST = 4_000_000
"""Characters of a description, at most."""
GREY: Vector = (0.6, 0.6, 0.6, 1.0)
JOINT_KINDS = ("fixed", "revolute", "continuous", "prismatic")
LED = "_led"
"""Ending of the links that are a light, after its name."""
TOUCH_FRAMES: Mapping[str, str] = {
    **{f"HeadTouch{part}_frame": f"Head/Touch/{part}" for part in ("Front", "Middle", "Rear")},
    **{
        f"{side}HandTouch{part}_frame": f"{side}Hand/Touch/{part}"
        for side in "LR"
        for part in ("Back", "Left", "Right")
    },
    **{f"{side}FootBumper{part}_frame": f"{side}Foot/Bumper/{part}" for side in "LR" for part in ("Left", "Right")},
    "ChestButton_frame": "ChestBoard/Button",
}
"""Link of a description -> the touch sensor that is there, by its name in the robot's memory."""


@dataclass(frozen=True)
class Visual:
    """Something to be seen of a link, in its frame.

    Attributes:
        kind: box, sphere, cylinder or mesh.
        size: Box: edges; sphere: radius; cylinder: radius and length, along Z; in m. Mesh: scales.
        mesh: Package and path of the file, `nao_sim_bridge/urdf/meshes/unit_pillow.stl`; empty for others.
        xyz, rpy: Its place, m and fixed-axis angles in rad.
        color: r, g, b, a in 0..1.
    """

    kind: str
    size: Vector
    mesh: str
    xyz: Vector
    rpy: Vector
    color: Vector


@dataclass(frozen=True)
class ModelJoint:
    """What holds a link to another.

    Attributes:
        kind: One of JOINT_KINDS.
        xyz, rpy: Of the child in the parent at angle 0, m and rad.
        mimic: Name of the joint that it follows, factor and offset; none for most.
    """

    name: str
    kind: str
    parent: str
    child: str
    xyz: Vector
    rpy: Vector
    axis: Vector
    mimic: Tuple[str, float, float] | None = None


@dataclass(frozen=True)
class RobotModel:
    """A description as it is drawn.

    Attributes:
        links: Name -> what is to be seen of it.
        left_out: Files of meshes that cannot be drawn.
    """

    links: Mapping[str, Tuple[Visual, ...]]
    joints: Tuple[ModelJoint, ...]
    left_out: Tuple[str, ...] = field(default=())

    @property
    def meshes(self) -> frozenset[str]:
        """Package and path of each mesh that is drawn."""
        return frozenset(visual.mesh for visuals in self.links.values() for visual in visuals if visual.mesh)

    @property
    def root(self) -> str:
        children = {joint.child for joint in self.joints}
        return next(link for link in self.links if link not in children)

    def to_json(self) -> dict[str, Any]:
        """For the page: values of JSON."""
        return {
            "root": self.root,
            "links": {name: [vars(visual) for visual in visuals] for name, visuals in self.links.items()},
            "joints": [vars(joint) for joint in self.joints],
            "lights": {name: name[: -len(LED)] for name in self.links if name.endswith(LED)},
            "touch": {link: device for link, device in TOUCH_FRAMES.items() if link in self.links},
            "left_out": list(self.left_out),
        }


def read_model(text: str) -> RobotModel:
    """A description from its XML.

    Raises NaoError if it is too long, no XML, or no description of a robot that hangs together.
    """
    if len(text) > LARGEST:
        raise NaoError(f"the robot's description has {len(text)} characters: {LARGEST} at most")
    if "<!DOCTYPE" in text:
        raise NaoError("the robot's description has a DOCTYPE: a description has none")
    try:
        robot = ElementTree.fromstring(text)
        colours = {m.get("name", ""): _rgba(m) for m in robot.findall("material") if m.find("color") is not None}
        left_out: dict[str, None] = {}
        links = {link.attrib["name"]: tuple(_visuals(link, colours, left_out)) for link in robot.findall("link")}
        joints = tuple(_joint(joint) for joint in robot.findall("joint"))
    except (ElementTree.ParseError, KeyError, ValueError, AttributeError) as error:
        raise NaoError(f"the robot's description cannot be read: {error!r}") from error
    loose = [end for joint in joints for end in (joint.parent, joint.child) if end not in links]
    if loose:
        raise NaoError(f"the robot's description has joints at links that it has not: {', '.join(sorted(set(loose)))}")
    if len(links) != len({joint.child for joint in joints}) + 1:
        raise NaoError("the robot's description is no tree: one link has no parent, each other one has one joint above")
    return RobotModel(links, joints, tuple(left_out))


def _visuals(link: ElementTree.Element, colours: Mapping[str, Vector], left_out: dict[str, None]) -> Iterator[Visual]:
    for visual in link.findall("visual"):
        shape = next(iter(visual.find("geometry")))
        mesh = ""
        if shape.tag == "mesh":
            name = shape.attrib["filename"]
            if not (name.startswith(PACKAGE) and name.lower().endswith(DRAWN)):
                left_out[name] = None
                continue
            mesh = name[len(PACKAGE) :]
        xyz, rpy = _origin(visual)
        yield Visual(shape.tag, _size(shape), mesh, xyz, rpy, _color(visual, colours))


def _size(shape: ElementTree.Element) -> Vector:
    if shape.tag == "box":
        return _floats(shape.attrib["size"], 3)
    if shape.tag == "sphere":
        return (float(shape.attrib["radius"]),)
    if shape.tag == "cylinder":
        return float(shape.attrib["radius"]), float(shape.attrib["length"])
    if shape.tag == "mesh":
        return _floats(shape.get("scale", "1 1 1"), 3)
    raise ValueError(f"{shape.tag} is no shape: box, sphere, cylinder or mesh")


def _color(visual: ElementTree.Element, colours: Mapping[str, Vector]) -> Vector:
    material = visual.find("material")
    if material is None:
        return GREY
    return _rgba(material) if material.find("color") is not None else colours.get(material.get("name", ""), GREY)


def _rgba(material: ElementTree.Element) -> Vector:
    return _floats(material.find("color").attrib["rgba"], 4)


def _joint(joint: ElementTree.Element) -> ModelJoint:
    xyz, rpy = _origin(joint)
    axis, mimic = joint.find("axis"), joint.find("mimic")
    kind = joint.attrib["type"]
    return ModelJoint(
        joint.attrib["name"],
        kind if kind in JOINT_KINDS else "fixed",
        joint.find("parent").attrib["link"],
        joint.find("child").attrib["link"],
        xyz,
        rpy,
        (1.0, 0.0, 0.0) if axis is None else _floats(axis.attrib["xyz"], 3),
        None
        if mimic is None
        else (mimic.attrib["joint"], float(mimic.get("multiplier", 1.0)), float(mimic.get("offset", 0.0))),
    )


def _origin(element: ElementTree.Element) -> tuple[Vector, Vector]:
    origin = element.find("origin")
    if origin is None:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    return _floats(origin.get("xyz", "0 0 0"), 3), _floats(origin.get("rpy", "0 0 0"), 3)


def _floats(text: str, count: int) -> Vector:
    values = tuple(float(word) for word in text.split())
    if len(values) != count:
        raise ValueError(f"{text!r} has {len(values)} numbers, not {count}")
    return values


def mesh_path(name: str, allowed: frozenset[str], package_path: Callable[[str], str]) -> Path:
    """The file of a mesh.

    Args:
        name: Package and path, as RobotModel has it.
        allowed: Meshes of the descriptions that are shown.
        package_path: Gives the folder of a package.

    Raises FileNotFoundError if it is none of them, is not there, or leads out of its package.
    """
    if not name or name not in allowed:
        raise FileNotFoundError(f"no robot that is shown has a mesh {name!r}")
    package, *inner = PurePosixPath(name).parts
    folder = Path(package_path(package)).resolve()
    path = folder.joinpath(*inner).resolve()
    if folder not in path.parents or path.suffix.lower() != DRAWN or not path.is_file():
        raise FileNotFoundError(f"{name!r} is no mesh in its package")
    return path
