"""The walk as a chain of functions would leave it: what can be told before anything moves. Pure."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from ..base.errors import BadGoal, CannotWalk

LEGS = ("LLeg", "RLeg")
ARMS = ("LArm", "RArm")
SOFTEST = 0.6
"""A walk needs legs that are stiffer than this; NAOqi ends it otherwise."""
NOT_ON_FEET = ("Sit", "Lying")
"""How names of postures and families begin from which nobody walks."""


class WalkPlan:
    """Where a chain of functions has the walk.

    Args:
        chains: Gives the joints of each chain.
        stiffness: Gives the stiffness of a joint by then, 0..1.
        moved: Tells whether the chain has moved a joint before.
        read_walking: Asks the robot whether it walks.
        read_posture: Asks the robot for the family of its posture.
    """

    def __init__(
        self,
        chains: Callable[[], Mapping[str, Sequence[str]]],
        stiffness: Callable[[str], float],
        moved: Callable[[str], bool],
        read_walking: Callable[[], bool],
        read_posture: Callable[[], str],
    ) -> None:
        self._chains = chains
        self._stiffness = stiffness
        self._moved = moved
        self._read_walking = read_walking
        self._read_posture = read_posture
        self._walking: bool | None = None
        self._posture: str | None = None

    @property
    def walking(self) -> bool:
        """Whether the robot walks by then."""
        if self._walking is None:
            self._walking = self._read_walking()
        return self._walking

    def moved_joints(self) -> list[str]:
        """What a walk moves: legs and arms."""
        chains = self._chains()
        return [joint for chain in LEGS + ARMS for joint in chains.get(chain, ()) if not joint.endswith("Hand")]

    def require_ready(self) -> None:
        """See that a walk can begin: on its feet, with stiff legs.

        Raises:
            CannotWalk: If it cannot.
        """
        softest = min(self._legs(), key=self._stiffness)
        stiffness = self._stiffness(softest)
        if not stiffness > SOFTEST:
            how = f"too soft to walk: {softest} has stiffness {stiffness:.2f}, above {SOFTEST:g} is needed"
            raise CannotWalk("the legs are limp" if stiffness == 0.0 else f"the legs are {how}", "wakeUp first")
        posture = self._posture
        if posture is None and not any(map(self._moved, self._legs())) and not self.walking:
            posture = self._read_posture()
        if posture is not None and posture.startswith(NOT_ON_FEET):
            raise CannotWalk(f"the robot does not stand on its feet (posture {posture})", "goToPosture Stand first")

    def require_free(self, joints: Iterable[str]) -> None:
        """See that the walk does not move the joints.

        Raises:
            BadGoal: If the robot walks by then, and one is in a leg.
        """
        legs = set(self._legs())
        wanted = [joint for joint in joints if joint in legs]
        if wanted and self.walking:
            raise BadGoal(
                "names",
                wanted,
                "stopMove or waitUntilMoveIsFinished first",
                problem=f"the robot walks, and {', '.join(wanted)} with it",
            )

    def goes(self) -> None:
        """The robot walks on when the function is over."""
        self._walking, self._posture = True, None

    def stands(self, posture: str | None = None) -> None:
        """The robot does not walk when the function is over; it is in a posture, if that is known."""
        self._walking, self._posture = False, posture

    def _legs(self) -> list[str]:
        chains = self._chains()
        return [joint for chain in LEGS for joint in chains.get(chain, ())]
