"""Action servers that play chains of NAOqi functions: NaoBasic and the modules that inherit it."""

from .core.lazy import Former

FORMER = {
    "answers": "base.answers",
    "check_client": "ros.check_client",
    "colours": "base.colours",
    "errors": "base.errors",
    "field_checks": "base.field_checks",
    "function_chain": "functions.chain",
    "light_checks": "lights.checks",
    "nao_audio": "audio.sound_card",
    "nao_basic": "server.nao_basic",
    "new_functions": "server.new_functions",
    "node": "ros.node",
    "paths": "base.paths",
    "places": "base.places",
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
    "simple_action_client": "ros.simple_action_client",
    "whole_file": "base.whole_file",
}
"""Module, as programs of others may import it -> where it is; both relative to this package."""

Former.install(__name__, FORMER)
