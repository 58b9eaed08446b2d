"""Process modules and plans on a NAO: designators, rules, modules, goals and CRAM's plan language.

What plans are written with can be imported from here, and what starts the modules of a NAO. What else needs ROS is in
`low_level`, `plan_runner`, `nao_modules` and `robot_link`.
"""

import types

from ..core import lazy
from .control import (
    Policy,
    define_policy,
    do,
    do_retry,
    get_counter,
    give,
    named_policy,
    par,
    par_loop,
    partial_order,
    pursue,
    reset_counter,
    retry,
    seq,
    subtask,
    timeout_policy,
    top_level,
    try_all,
    try_each_in_order,
    try_in_order,
    wait_for,
    whenever,
    with_failure_handling,
    with_named_policies,
    with_named_policy,
    with_policies,
    with_policy,
    with_retry_counters,
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
from .designators.objects_and_locations import BELIEFS, Point3, Position
from .designators.rules import Command, command, rule
from .failures import CompositeFailure, PlanError, PlanFailure, SimplePlanFailure, fail
from .fluents import (
    Fluent,
    checkpoint,
    fl_and,
    fl_eq,
    fl_funcall,
    fl_not,
    fl_or,
    fl_value_changed,
    pulsed,
    retry_after_suspension,
    sleep,
    uninterrupted,
    wait_until,
)
from .perception import at_location, examine, go_to, perceive
from .plans import (
    ANY,
    StartedPlan,
    achieve,
    declare_goal,
    def_goal,
    def_plan,
    def_top_level_plan,
    holds,
    perceive_state,
)
from .process_module import (
    AsynchronousProcessModule,
    ProcessModule,
    available_process_module,
    matching_process_module,
    monitor_process_module,
    perform,
    pm_cancel,
    pm_execute,
    pm_execute_matching,
    pm_run,
    pm_status,
    stop_process_modules,
    with_process_module_aliases,
    with_process_modules_running,
)
from .tasks import Task, TaskState, current_task
from .trace import Trace, trace_of

# Loaded when it is asked for: plans alone need no ROS.
_LATER = {
    "start_process_modules": "low_level",
    "StartProcessModules": "low_level:start_process_modules",
    **{name: "low_level" for name in "openGripper closeGripper moveHead moveArm goStable walkTo textToSpeech".split()},
    # By way of `low_level`, which imports the rules that resolve what the modules get.
    "ManipulationProcessModule": "low_level:Manipulation",
    "NavigationProcessModule": "low_level:Navigation",
    "SpeechProcessModule": "low_level:Speech",
}
__getattr__ = lazy.door(__name__, _LATER)
__all__ = [name for name, value in globals().items() if not (name[0] == "_" or isinstance(value, types.ModuleType))]
__all__ += _LATER
