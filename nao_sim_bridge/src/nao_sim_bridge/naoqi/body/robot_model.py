"""ALRobotModel of the simulated robot: what it is made of."""

from __future__ import annotations

from xml.etree import ElementTree

from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.naoqi.memory.live_keys import constants

NAME = "ALRobotModel"
PREFERENCES = "RobotConfig/"
KIND = PREFERENCES + "Body/Type"
MICROPHONES = PREFERENCES + "Head/Device/Micro/Version"


class ALRobotModel:
    """ALRobotModel as the simulated robot offers it."""

    def __init__(self, version: str) -> None:
        self._version = version

    def getRobotType(self) -> str:
        return constants(self._version)[KIND]

    def hasArms(self) -> bool:
        return self._has("LArm", "RArm")

    def hasHands(self) -> bool:
        return self._has("LHand", "RHand")

    def hasLegs(self) -> bool:
        return self._has("LLeg", "RLeg")

    def getConfig(self) -> str:
        """Preferences as NAOqi's XML has them: nested by name, each leaf with the key in ALMemory and its value."""
        root = ElementTree.Element("ModulePreference", name="ALRobotModel", domain="com.aldebaran", version="1.0")
        nodes = {"": root}
        for key, value in sorted(self._getConfigMap().items()):
            *groups, name = key.split("/")
            parent = _group(nodes, groups)
            ElementTree.SubElement(parent, "Preference", name=name, memoryName=key, value=value, type="string")
        return '<?xml version="1.0" encoding="UTF-8" ?>\n' + ElementTree.tostring(root, encoding="unicode")

    def _getConfigMap(self) -> dict[str, str]:
        return {key: str(value) for key, value in constants(self._version).items() if key.startswith(PREFERENCES)}

    def _getMicrophoneConfig(self) -> int:
        return int(constants(self._version)[MICROPHONES])

    def _has(self, *parts: str) -> bool:
        """Whether the robot has all of these chains or joints."""
        model = load_model(self._version)
        return all(part in model.chains or part in model.joint_index for part in parts)


def _group(nodes: dict[str, ElementTree.Element], groups: list[str]) -> ElementTree.Element:
    """The element of nested groups, made where it is not there yet."""
    path = ""
    for group in groups:
        parent, path = nodes[path], f"{path}/{group}"
        if path not in nodes:
            nodes[path] = ElementTree.SubElement(parent, "Preference", name=group, type="array")
    return nodes[path]
