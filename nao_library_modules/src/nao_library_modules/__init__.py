"""Action servers that play chains of NAOqi functions: NaoBasic and the modules that inherit it."""

from .core.lazy import Former, door

__all__ = ["FORMER", "NaoBasic"]
__getattr__ = door(__name__, {"NaoBasic": "nao_basic"})

FORMER = {
    "answers": "core.memory_functions",
    "base": "core",
    "base.errors": "core.errors",
    "base.suggestion": "core.errors",
    "base.whole_file": "core.files",
    "check_client": "ros.goal_client",
    "colours": "core.lights_and_colours",
    "errors": "core.errors",
    "field_checks": "core.fields",
    "function_chain": "core.chain",
    "functions": "core",
    "functions.fields": "core.fields",
    "light_checks": "lights.light_fields",
    "lights.fields": "lights.light_fields",
    "nao": "core",
    "nao.touch_names": "core.nao_facts",
    "new_functions": "core.new_functions",
    "node": "ros.node",
    "paths": "core.files",
    "places": "core.geometry",
    "process_modules.designators.locations": "process_modules.designators.objects_and_locations",
    "process_modules.designators.objects": "process_modules.designators.objects_and_locations",
    "process_modules.designators.patterns": "process_modules.designators.rules",
    "process_modules.flow": "process_modules.fluents",
    "process_modules.goals": "process_modules.plans",
    "process_modules.handling": "process_modules.control",
    "process_modules.nao_goals": "process_modules.low_level",
    "process_modules.policies": "process_modules.control",
    "process_modules.registry": "process_modules.process_module",
    "process_modules.space": "process_modules.designators.objects_and_locations",
    "process_modules.waiting": "process_modules.control",
    "processes": "ros",
    "processes.own_stack": "ros.own_stack",
    "simple_action_client": "ros.goal_client",
    "vision.capture": "vision",
    "vision.capture.pictures": "vision.pictures",
    "vision.capture.video": "vision.video",
    "whole_file": "core.files",
}
"""Module, as programs of others may import it -> where it is; both relative to this package."""

Former.install(__name__, FORMER)
