"""Action servers that play chains of NAOqi functions: NaoBasic and the modules that inherit it."""

from .base.former_names import Former

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
    "process_modules.control": "process_modules.language.control",
    "process_modules.failures": "process_modules.language.failures",
    "process_modules.flow": "process_modules.language.flow",
    "process_modules.fluents": "process_modules.language.fluents",
    "process_modules.goals": "process_modules.language.goals",
    "process_modules.handling": "process_modules.language.handling",
    "process_modules.perception": "process_modules.core.perception",
    "process_modules.plans": "process_modules.language.plans",
    "process_modules.policies": "process_modules.language.policies",
    "process_modules.process_module": "process_modules.core.process_module",
    "process_modules.projection": "process_modules.core.projection",
    "process_modules.registry": "process_modules.core.registry",
    "process_modules.robot_link": "process_modules.robot.robot_link",
    "process_modules.space": "process_modules.language.space",
    "process_modules.trace": "process_modules.language.trace",
    "process_modules.waiting": "process_modules.language.control",
    "simple_action_client": "ros.simple_action_client",
    "whole_file": "base.whole_file",
}
"""Module, as programs of others may import it -> where it is; both relative to this package."""

Former.install(__name__, FORMER)
