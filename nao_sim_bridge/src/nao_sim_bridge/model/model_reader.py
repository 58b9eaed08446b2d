"""Turns the tables of `config/nao_h25.json` into a `RobotModel`; every key it does not know is an error."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from nao_sim_bridge.base.config import array, check_keys, config_file, read_json, vector
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.model.robot_model import (
    FILE,
    VERSIONS,
    Camera,
    CollisionShape,
    CoupledLimit,
    Finger,
    Joint,
    Link,
    Motor,
    Place,
    RobotModel,
    SimulatedHand,
    frozen_mapping,
)

SECTIONS = (
    "_meta robot almotion_body_order chains effectors effector_note main_lengths_m links V5_link_differences "
    "joints joint_notes coupled_limits motors fingers simulated_hand feet fsr imu sonars cameras tactile "
    "microphones_V6 loudspeakers infrared_V5 battery_V6 collision_shapes fk_check_zero_posture_torso_frame"
).split()
LINK_KEYS = ("name", "parent_joint", "alt_name", "mass_kg", "com_xyz_m", "inertia_kg_m2")
REVOLUTE_KEYS = (
    "name type parent_link child_link origin_xyz_m origin_rpy_rad axis lower_rad upper_rad "
    "max_velocity_rad_s max_torque_Nm doc_lower_rad doc_upper_rad"
).split()
HAND_KEYS = (
    "name type parent_link child_link origin_xyz_m origin_rpy_rad axis lower upper max_velocity_per_s "
    "max_torque_Nm note"
).split()
SONAR_KEYS = (
    "frame_note transducers_doc2x parent_link frequency_kHz cone_deg update_period_s range_m resolution_m "
    "alsonar_threshold_m"
).split()
FEET_NOTES = (
    "sole_contour_note foot_body_outline_left_bbox_m almotion_foot_box_left_xy_m "
    "almotion_foot_box_right_xy_m foot_box_note robocup_dimension"
).split()
CAMERA_SECTION_OF = {"V6": "V6", "V5": "V5_V4"}


def at(*steps: object) -> str:
    """File and path of an entry for error texts."""
    return f"{FILE}: " + ".".join(map(str, steps))


def read_place(entry: Any, where: str, extra: Iterable[str] = (), parent: str = "") -> Place:
    """A frame on a link; `parent` is the link where the entry does not say it."""
    required = ["name", "xyz_m"] + ([] if parent else ["parent_link"])
    check_keys(entry, where, required, ["rpy_rad", "parent_link", *extra])
    return Place(
        name=entry["name"],
        parent_link=entry.get("parent_link", parent),
        position=vector(entry["xyz_m"], f"{where}.xyz_m"),
        rpy=vector(entry.get("rpy_rad", (0.0, 0.0, 0.0)), f"{where}.rpy_rad"),
    )


def read_places(entries: list[Any], where: str) -> tuple[Place, ...]:
    return tuple(read_place(entry, f"{where}[{index}]") for index, entry in enumerate(entries))


class ModelReader:
    """Reads one version of the robot out of the tables."""

    def __init__(self, tables: dict[str, Any], version: str) -> None:
        self.tables = check_keys(tables, FILE, SECTIONS)
        self.version = version

    def read(self) -> RobotModel:
        tables = self.tables
        joints = self.joints()
        links = self.links()
        feet = self.section("feet", ("sole_height_below_ankle_m", "sole_contour_left_xy_m"), FEET_NOTES)
        imu = self.section("imu", ("accelerometer", "gyrometer"), ("note",))
        sensor_extra = ("range", "unit")
        return RobotModel(
            version=self.version,
            joints=joints,
            joint_index=frozen_mapping({joint.name: index for index, joint in enumerate(joints)}),
            chains=frozen_mapping(self.chains()),
            chain_names=tuple(tables["chains"]),
            links=links,
            coupled_limits=frozen_mapping(self.coupled_limits()),
            effectors=frozen_mapping({p.name: p for p in read_places(tables["effectors"], at("effectors"))}),
            fsr=self.frames("fsr", ("range_N", "unit_in_ALMemory", "note")),
            imu=frozen_mapping(
                {
                    name: read_place({"name": name, **imu[name.lower()]}, at("imu", name.lower()), sensor_extra)
                    for name in ("Accelerometer", "Gyrometer")
                }
            ),
            sonars=self.frames("sonars", SONAR_KEYS),
            cameras=self.cameras(),
            touch=read_places(tables["tactile"], at("tactile")),
            microphones=read_places(tables["microphones_V6"], at("microphones_V6")),
            loudspeakers=read_places(tables["loudspeakers"], at("loudspeakers")),
            infrared=read_places(tables["infrared_V5"], at("infrared_V5")),
            fingers=self.fingers(),
            simulated_hand=self.simulated_hand(),
            collision_shapes=self.collision_shapes(),
            motors=self.motors(),
            sole_height=float(feet["sole_height_below_ankle_m"]),
            sole_contour=array(feet["sole_contour_left_xy_m"], at("feet", "sole_contour_left_xy_m"), (-1, 2)),
            total_mass=sum(link.mass for link in links),
        )

    def section(self, name: str, required: Iterable[str], optional: Iterable[str] = ()) -> Mapping[str, Any]:
        return check_keys(self.tables[name], at(name), required, optional)

    def links(self) -> tuple[Link, ...]:
        """The links, with the head of the version asked for."""
        differences = self.section("V5_link_differences", ("note", "links"))
        changed = {entry["name"]: entry for entry in differences["links"]} if self.version == "V5" else {}
        links = []
        for index, entry in enumerate(self.tables["links"]):
            where = at(f"links[{index}]")
            check_keys(entry, where, LINK_KEYS)
            entry = {**entry, **changed.get(entry["name"], {})}
            check_keys(entry, at("V5_link_differences", entry["name"]), LINK_KEYS)
            inertia = array(entry["inertia_kg_m2"], f"{where}.inertia_kg_m2", (3, 3))
            if not np.allclose(inertia, inertia.T, rtol=0.0, atol=1e-12) or np.linalg.eigvalsh(inertia)[0] <= 0.0:
                raise ConfigError(f"{where}.inertia_kg_m2", "is not symmetric and positive definite")
            links.append(
                Link(
                    name=entry["name"],
                    alt_name=entry["alt_name"],
                    parent_joint=entry["parent_joint"],
                    mass=float(entry["mass_kg"]),
                    com=vector(entry["com_xyz_m"], f"{where}.com_xyz_m"),
                    inertia=inertia,
                )
            )
        return tuple(links)

    def joints(self) -> tuple[Joint, ...]:
        """The joints in Body order, whatever their order in the file."""
        read = (self.joint(entry, at(f"joints[{index}]")) for index, entry in enumerate(self.tables["joints"]))
        joints = {joint.name: joint for joint in read}
        order = self.tables["almotion_body_order"]
        if sorted(order) != sorted(joints):
            raise ConfigError(at("almotion_body_order"), "does not name the same joints as the table of joints")
        return tuple(joints[name] for name in order)

    def joint(self, entry: Any, where: str) -> Joint:
        """One joint; a hand gets the axis of the simulated finger body."""
        is_hand = "lower" in entry
        check_keys(entry, where, HAND_KEYS if is_hand else REVOLUTE_KEYS, () if is_hand else ("mimic",))
        if np.any(vector(entry["origin_rpy_rad"], f"{where}.origin_rpy_rad")):
            raise ConfigError(f"{where}.origin_rpy_rad", "is not zero; link frames must be parallel at zero posture")
        axis = vector(self.tables["simulated_hand"]["axis"] if is_hand else entry["axis"], f"{where}.axis")
        lower = float(entry["lower" if is_hand else "lower_rad"])
        upper = float(entry["upper" if is_hand else "upper_rad"])
        if not lower < upper:
            raise ConfigError(where, f"lower limit {lower} is not below upper limit {upper}")
        return Joint(
            name=entry["name"],
            parent_link=entry["parent_link"],
            child_link=entry["child_link"],
            origin=vector(entry["origin_xyz_m"], f"{where}.origin_xyz_m"),
            axis=axis,
            lower=lower,
            upper=upper,
            max_velocity=float(entry["max_velocity_per_s" if is_hand else "max_velocity_rad_s"]),
            max_torque=float(entry["max_torque_Nm"]),
            is_hand=is_hand,
        )

    def chains(self) -> dict[str, tuple[str, ...]]:
        """Chains and groups of joints as ALMotion names them.

        Body is all joints and actuators; Joints are those with an angle, Actuators the hands. BodyJoints and
        BodyActuators are the older spellings of the two.
        """
        chains = {name: tuple(joints) for name, joints in self.tables["chains"].items()}
        body = tuple(self.tables["almotion_body_order"])
        hands = tuple(name for name in body if name.endswith("Hand"))
        joints = tuple(name for name in body if name not in hands)
        chains.update(Arms=chains["LArm"] + chains["RArm"], Legs=chains["LLeg"] + chains["RLeg"])
        chains.update(Body=body, JointActuators=body)
        chains.update(Joints=joints, BodyJoints=joints, Actuators=hands, BodyActuators=hands)
        return chains

    def coupled_limits(self) -> dict[str, CoupledLimit]:
        """Tables called `<joint>_by_<other joint>`."""
        order, limits = self.tables["almotion_body_order"], {}
        for name, rows in self.tables["coupled_limits"].items():
            if name == "note":
                continue
            joint, by_joint = name.split("_by_")
            table = array(rows, at("coupled_limits", name), (-1, 3))
            if np.any(np.diff(table[:, 0]) <= 0.0):
                raise ConfigError(at("coupled_limits", name), "first column does not ascend")
            limits[joint] = CoupledLimit(order.index(joint), order.index(by_joint), [*map(tuple, table.tolist())])
        return dict(sorted(limits.items(), key=lambda entry: entry[1].joint))

    def frames(self, name: str, described: Iterable[str]) -> tuple[Place, ...]:
        """The frames of a section that has them, and other keys which are not read."""
        return read_places(self.section(name, ("frames",), described)["frames"], at(f"{name}.frames"))

    def cameras(self) -> tuple[Camera, ...]:
        """The two cameras with the field of view of the version."""
        section = self.tables["cameras"]
        optics = section[CAMERA_SECTION_OF[self.version]]
        cameras = []
        for index, entry in enumerate(section["frames"]):
            place = read_place(entry, at(f"cameras.frames[{index}]"), ("index",))
            view = (math.radians(optics["hfov_deg"]), math.radians(optics["vfov_deg"]))
            cameras.append(Camera(place.name, int(entry["index"]), place, *view))
        return tuple(cameras)

    def fingers(self) -> tuple[Finger, ...]:
        keys = "per_hand parent_link base_xyz_m base_rpy_rad phalanx_length_m phalanx_travel_rad axis".split()
        section = self.section("fingers", keys, ("source", "relation", "axis_note"))
        fingers = []
        for name, phalanges in section["per_hand"].items():
            first = phalanges[0]
            base = {"name": first, "xyz_m": section["base_xyz_m"][first], "rpy_rad": section["base_rpy_rad"][first]}
            fingers.append(
                Finger(
                    name=name,
                    phalanges=tuple(phalanges),
                    base=read_place(base, at("fingers", first), parent="WristYaw"),
                    length=float(section["phalanx_length_m"]),
                    axis=vector(section["axis"], at("fingers.axis")),
                    travel=float(section["phalanx_travel_rad"]),
                )
            )
        return tuple(fingers)

    def simulated_hand(self) -> SimulatedHand:
        where = at("simulated_hand")
        keys = "note origin_xyz_m axis mass_kg com_xyz_m inertia_kg_m2 travel_rad phalanx_mass_kg".split()
        section = self.section("simulated_hand", keys)
        return SimulatedHand(
            origin=vector(section["origin_xyz_m"], f"{where}.origin_xyz_m"),
            axis=vector(section["axis"], f"{where}.axis"),
            mass=float(section["mass_kg"]),
            com=vector(section["com_xyz_m"], f"{where}.com_xyz_m"),
            inertia=array(section["inertia_kg_m2"], f"{where}.inertia_kg_m2", (3, 3)),
            travel=float(section["travel_rad"]),
            phalanx_mass=float(section["phalanx_mass_kg"]),
        )

    def collision_shapes(self) -> tuple[CollisionShape, ...]:
        """Spheres and cylinders of the self-collision model."""
        shapes = []
        for index, entry in enumerate(self.section("collision_shapes", ("note", "shapes"))["shapes"]):
            where = at(f"collision_shapes.shapes[{index}]")
            place = read_place(entry, where, ("shape", "radius_m", "length_m"))
            if entry["shape"] not in ("sphere", "cylinder"):
                raise ConfigError(f"{where}.shape", f"is {entry['shape']!r} (allowed: sphere, cylinder)")
            shapes.append(CollisionShape(place, entry["shape"], float(entry["radius_m"]), entry.get("length_m")))
        return tuple(shapes)

    def motors(self) -> tuple[Motor, ...]:
        """Motor types with the gear ratio of each kind of joint."""
        motors = []
        for index, entry in enumerate(self.section("motors", ("types",), ("source", "position_sensor"))["types"]):
            required = "type model no_load_rpm stall_torque_mNm nominal_torque_mNm_max gear_ratio_A joints_A".split()
            check_keys(entry, at(f"motors.types[{index}]"), required, ("gear_ratio_B", "joints_B"))
            ratios = {
                joint: float(entry[f"gear_ratio_{group}"])
                for group in "AB"
                for joint in entry.get(f"joints_{group}", ())
            }
            motors.append(
                Motor(
                    model=entry["model"],
                    no_load_speed=entry["no_load_rpm"] * math.tau / 60.0,
                    stall_torque=entry["stall_torque_mNm"] / 1000.0,
                    gear_ratio_of=frozen_mapping(ratios),
                )
            )
        return tuple(motors)


def load_model(version: str = "V6") -> RobotModel:
    """The model of a robot version, read once: `V6` (NAOqi 2.8) or `V5` (NAOqi 2.1), with another head and cameras.

    Raises:
        ConfigError: If the version is unknown or the file has a wrong, unknown or missing entry.
    """
    if version not in VERSIONS:
        raise ConfigError(FILE, f"no robot version {version!r} (allowed: {', '.join(VERSIONS)})")
    return _load(version)


@lru_cache(maxsize=None)
def _load(version: str) -> RobotModel:  # by itself, for the cache takes load_model() and load_model("V6") for two
    return ModelReader(read_json(config_file(FILE)), version).read()
