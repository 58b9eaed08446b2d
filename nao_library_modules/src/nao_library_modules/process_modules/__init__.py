"""Process modules and plans on a NAO: designators, rules, modules, goals and CRAM's plan language.

What plans are written with can be imported from here, and what starts the modules of a NAO. What else needs ROS is in
`low_level`, `nao_goals`, `plan_runner`, `modules` and `robot_link`.
"""

import types

from ..base import doors
from .core.perception import at_location, examine, go_to, perceive
from .core.process_module import AsynchronousProcessModule, ProcessModule, pm_cancel, pm_run, pm_status
from .core.registry import (
    available_process_module,
    matching_process_module,
    monitor_process_module,
    perform,
    pm_execute,
    pm_execute_matching,
    stop_process_modules,
    with_process_module_aliases,
    with_process_modules_running,
)
from .designators.designator import (
    Designator,
    a,
    action,
    all_,
    an,
    current_desig,
    desig_equal,
    designator,
    equate,
    first_desig,
    location,
    motion,
    object_,
    the,
)
from .designators.objects import BELIEFS
from .designators.rules import Command, command, rule
from .language.control import (
    do,
    par,
    par_loop,
    partial_order,
    pursue,
    seq,
    subtask,
    top_level,
    try_all,
    try_each_in_order,
    try_in_order,
    wait_for,
    whenever,
)
from .language.failures import CompositeFailure, PlanError, PlanFailure, SimplePlanFailure, fail
from .language.flow import checkpoint, retry_after_suspension, sleep, uninterrupted, wait_until
from .language.fluents import Fluent, fl_and, fl_eq, fl_funcall, fl_not, fl_or, fl_value_changed, pulsed
from .language.goals import ANY, achieve, declare_goal, def_goal, holds, perceive_state
from .language.handling import (
    do_retry,
    get_counter,
    give,
    reset_counter,
    retry,
    with_failure_handling,
    with_retry_counters,
)
from .language.plans import StartedPlan, def_plan, def_top_level_plan
from .language.policies import (
    Policy,
    define_policy,
    named_policy,
    timeout_policy,
    with_named_policies,
    with_named_policy,
    with_policies,
    with_policy,
)
from .language.space import Point3, Position
from .language.tasks import Task, TaskState, current_task
from .language.trace import Trace, trace_of

# Loaded when it is asked for: plans alone need no ROS.
_LATER = {
    "start_process_modules": "low_level",
    "StartProcessModules": "low_level:start_process_modules",
    # By way of the goals, so that `achieve` knows which of them each means.
    **{name: "nao_goals" for name in "openGripper closeGripper moveHead moveArm goStable walkTo textToSpeech".split()},
    # By way of `low_level`, which imports the rules that resolve what the modules get.
    "ManipulationProcessModule": "low_level:Manipulation",
    "NavigationProcessModule": "low_level:Navigation",
    "SpeechProcessModule": "low_level:Speech",
}
__getattr__ = doors.door(__name__, _LATER)
__all__ = [name for name, value in globals().items() if not (name[0] == "_" or isinstance(value, types.ModuleType))]
__all__ += _LATER
