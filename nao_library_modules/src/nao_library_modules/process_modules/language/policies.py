"""Policies: run a plan while a condition is watched.

with_policy(timeout_policy(10.0), do(walk_to, table))
with_policy(Policy("upright", check=robot_has_fallen, recover=stop_walking), do(walk_to, table))

A policy with a name can be used without its function:

@define_policy("near")
def near(place, distance):
    return Policy(f"within {distance} m", check=lambda: place_of_robot().distance_to(place) > distance)

with_named_policy("near", (table, 2.0), do(look_around))
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Type, Union

from ...base.suggestion import of_those
from .control import Branch, Step, do, pursue, subtask, wait_for
from .failures import PlanTimedOut, PolicyCheckConditionMet, PolicyInitFailed, PolicyNotFound
from .flow import sleep, uninterrupted
from .fluents import AnyFluent

PERIOD = 0.1


@dataclass(frozen=True)
class Policy:
    """A condition to watch while a body runs."""

    name: str
    check: Union[AnyFluent, Callable[[], Any]]  # a fluent, or a function that is polled; the body ends when it is true
    init: Callable[[], Any] | None = None  # runs first; the body does not begin when it returns False
    recover: Callable[[], Any] | None = None  # runs when the condition has come true, after the end of the body
    clean_up: Callable[[], Any] | None = None  # runs at the end in any case, uninterrupted
    period: float = PERIOD  # between two polls, s
    failure: Type[PolicyCheckConditionMet] = PolicyCheckConditionMet


_named: dict[str, Callable[..., Policy]] = {}


def define_policy(name: str) -> Callable[[Callable[..., Policy]], Callable[..., Policy]]:
    """Register a function that returns a policy under a name; it replaces an earlier one."""

    def keep(function: Callable[..., Policy]) -> Callable[..., Policy]:
        _named[name] = function
        return function

    return keep


def named_policy(name: str) -> Callable[..., Policy]:
    """The function of a policy's name."""
    if name not in _named:
        raise PolicyNotFound(f"no policy {name!r}{of_those(name, sorted(_named))}", policy=name)
    return _named[name]


@define_policy("timeout")
def timeout_policy(time: float) -> Policy:
    """Limits the time of the body, s of the plan's clock."""

    def over() -> bool:
        sleep(time)
        return True

    return Policy(f"at most {time:g} s", over, failure=PlanTimedOut)


def with_policy(policy: Policy, body: Branch) -> Any:
    """Run a body while a policy watches; the answer of the body.

    Raises:
        PolicyInitFailed: `init` returned False.
        PolicyCheckConditionMet: The condition came true; the body has been ended.
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
    """As `with_policy`, with the policy of a name for these parameters; PolicyNotFound if there is none."""
    return with_policy(named_policy(name)(*parameters), body)


def with_policies(policies: Iterable[Policy], body: Branch) -> Any:
    """As `with_policy` for several policies, the first one outermost."""
    inner = body
    for policy in reversed(list(policies)):
        inner = do(with_policy, policy, inner)
    return subtask(inner)


def with_named_policies(policies: Iterable[tuple[str, Iterable[Any]]], body: Branch) -> Any:
    """As `with_policies`, with pairs of a name and parameters; PolicyNotFound if there is none of a name."""
    return with_policies([named_policy(name)(*parameters) for name, parameters in policies], body)
