"""Answers to NAOqi's questions about a module, from what libqi knows of it.

A service written against libqi alone lacks the methods that every NAOqi module has; these fill in.
"""

from __future__ import annotations

from typing import Any, Dict, List

from .remote import RemoteModule
from .signatures import readable_call, readable_parameters, readable_type


def method_help(module: RemoteModule, method: str) -> List[Any]:
    """What is known of a method: `[name, [[parameter, description], ...], return type, return description]`.

    Of several overloads, the one with the most parameters. Parameters without a name are named by their type.

    Raises:
        UnknownMethod: If the module has no such method.
    """
    description = max(_overloads(module, method), key=lambda each: len(each["parametersSignature"]))
    parameters = [[name, text] for name, text in map(_pair, description["parameters"])]
    if not parameters:
        parameters = [[words, ""] for words in readable_parameters(description["parametersSignature"])]
    returned = readable_type(description["returnSignature"])
    return [method, parameters, returned, description["returnDescription"]]


def module_help(module: RemoteModule) -> List[Any]:
    """What is known of a module: `[description, [[language, example], ...]]`."""
    return [module.service().metaObject()["description"], []]


def usage(module: RemoteModule, method: str) -> str:
    """How to call a method: one line for each overload, and what the module says of it.

    Raises:
        UnknownMethod: If the module has no such method.
    """
    lines = []
    for each in _overloads(module, method):
        returned = readable_type(each["returnSignature"])
        line = f"{readable_call(method, each['parametersSignature'])} -> {returned}"
        description = each["description"]
        lines.append(line if description in ("", "None") else f"{line}: {description}")
    return "\n".join(lines)


def _overloads(module: RemoteModule, method: str) -> List[Dict[str, Any]]:
    found = module.overloads(method)
    if not found:
        module.find(method)  # names what comes closest
    return found


def _pair(parameter: Any) -> List[str]:
    """Name and description; libqi gives them as a structure or a dictionary, depending on its version."""
    if isinstance(parameter, dict):
        return [parameter["name"], parameter["description"]]
    return [parameter[0], parameter[1]]
