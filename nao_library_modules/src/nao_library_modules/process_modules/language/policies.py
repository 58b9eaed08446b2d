"""Policies: a plan under a condition that is watched beside it.

with_policy(timeout_policy(10.0), do(walk_to, table))
with_policy(Policy("upright", check=robot_has_fallen, recover=stop_walking), do(walk_to, table))

One that has a name may be used where its function is not known:

@define_policy("near")
def near(place, distance):
    return Policy(f"within {distance} m", check=lambda: place_of_robot().distance_to(place) > distance)

with_named_policy("near", (table, 2.0), do(look_around))
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Tuple, Type, Union

from ...base.suggestion import of_those
from .control import Branch, Step, do, pursue, subtask
from .failures import PlanTimedOut, PolicyCheckConditionMet, PolicyInitFailed, PolicyNotFound
from .flow import sleep, uninterrupted
from .fluents import AnyFluent
from .waiting import wait_for

PERIOD = 0.1


@dataclass(frozen=True)
class Policy:
    """What is watched while a body runs.

    Attributes:
        name: For people.
        check: A fluent, or a function that is asked again and again; the body ends when it is true.
        init: Run before; the body does not begin when it answers False.
        recover: Run when the condition has come true, after the body has ended.
        clean_up: Run at the end in any case; nothing ends or suspends it.
        period: Time between two calls of a function, s.
        failure: What the body fails with.
    """

    name: str
    check: Union[AnyFluent, Callable[[], Any]]
    init: Callable[[], Any] | None = None
    recover: Callable[[], Any] | None = None
    clean_up: Callable[[], Any] | None = None
    period: float = PERIOD
    failure: Type[PolicyCheckConditionMet] = PolicyCheckConditionMet


_named: dict[str, Callable[..., Policy]] = {}


def define_policy(name: str) -> Callable[[Callable[..., Policy]], Callable[..., Policy]]:
    """Make a function that gives a policy known by a name; a newer one takes the place of an older one."""

    def keep(function: Callable[..., Policy]) -> Callable[..., Policy]:
        _named[name] = function
        return function

    return keep


def named_policy(name: str) -> Callable[..., Policy]:
    """What gives the policy of a name.

    Raises:
        PolicyNotFound: There is none.
    """
    if name not in _named:
        raise PolicyNotFound(f"no policy {name!r}{of_those(name, sorted(_named))}", policy=name)
    return _named[name]


@define_policy("timeout")
def timeout_policy(time: float) -> Policy:
    """The body may take so long, s of the plan's clock."""

    def over() -> bool:
        sleep(time)
        return True

    return Policy(f"at most {time:g} s", over, failure=PlanTimedOut)


def with_policy(policy: Policy, body: Branch) -> Any:
    """Run a body while a policy watches.

    Returns:
        What the body answers.

    Raises:
        PolicyInitFailed: The policy could not begin.
        PolicyCheckConditionMet: The condition came true; the body has been ended.
        PlanFailure: The body failed, or what belongs to the policy did.
    """
    watched = f"policy {policy.name!r}"
    met = object()

    def watch() -> object:
        if isinstance(policy.check, AnyFluent):
            wait_for(policy.check)
        else:
            while not policy.check():
                sleep(policy.period)
        return met

    def run() -> Any:
        if policy.init is not None and policy.init() is False:
            raise PolicyInitFailed(f"{watched} could not begin", policy=policy.name)
        try:
            answer = pursue(body, do(watch, name=watched))
            if answer is not met:
                return answer
            if policy.recover is not None:
                policy.recover()
            raise policy.failure(f"{watched} ended what it watched", policy=policy.name)
        finally:
            if policy.clean_up is not None:
                with uninterrupted():
                    policy.clean_up()

    return subtask(Step("with_policy", run))


def with_named_policy(name: str, parameters: Iterable[Any], body: Branch) -> Any:
    """As `with_policy`, with the policy of a name for these parameters.

    Raises:
        PolicyNotFound: There is none.
    """
    return with_policy(named_policy(name)(*parameters), body)


def with_policies(policies: Iterable[Policy], body: Branch) -> Any:
    """Run a body while several policies watch, the first one outermost; see `with_policy`."""
    inner = body
    for policy in reversed(list(policies)):
        inner = do(with_policy, policy, inner)
    return subtask(inner)


NamedPolicies = Iterable[Tuple[str, Iterable[Any]]]


def with_named_policies(policies: NamedPolicies, body: Branch) -> Any:
    """As `with_policies`, with pairs of a name and parameters.

    Raises:
        PolicyNotFound: There is none of a name.
    """
    return with_policies([named_policy(name)(*parameters) for name, parameters in policies], body)
