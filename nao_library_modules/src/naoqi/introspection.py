"""Help on a module, composed from libqi's description of it.

Every NAOqi module has help methods; a service written against libqi alone lacks them, and these functions stand in.
"""

from __future__ import annotations

from typing import Any, Dict, List

from .remote import RemoteModule
from .signatures import readable_call, readable_parameters, readable_type


def method_help(module: RemoteModule, method: str) -> List[Any]:
    """Help on a method: `[name, [[parameter, description], ...], return type, return description]`.

    The overload with the most parameters counts. A parameter without a name is named after its type. Raises
    UnknownMethod if the module has no such method.
    """
    description = max(_overloads(module, method), key=lambda each: len(each["parametersSignature"]))
    parameters = [[name, text] for name, text in map(_pair, description["parameters"])]
    if not parameters:
        parameters = [[words, ""] for words in readable_parameters(description["parametersSignature"])]
    returned = readable_type(description["returnSignature"])
    return [method, parameters, returned, description["returnDescription"]]


def module_help(module: RemoteModule) -> List[Any]:
    """Help on a module: `[description, [[language, example], ...]]`."""
    return [module.service().metaObject()["description"], []]


def usage(module: RemoteModule, method: str) -> str:
    """Signature and description of a method, one line for each overload.

    Raises UnknownMethod if the module has no such method.
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
        module.find(method)  # raises UnknownMethod with the closest names
    return found


def _pair(parameter: Any) -> List[str]:
    """Name and description; the version of libqi decides whether they come as a structure or a dictionary."""
    if isinstance(parameter, dict):
        return [parameter["name"], parameter["description"]]
    return [parameter[0], parameter[1]]
