"""Gymnasium environments: NaoStand-v0, NaoWalk-v0, NaoReach-v0, NaoFollowBall-v0, NaoGetUp-v0.

    import gymnasium
    import nao_sim_bridge.envs

    env = gymnasium.make("NaoStand-v0")

Needs the extra `[rl]`. `gymnasium.make("nao_sim_bridge.envs:NaoStand-v0")` does it in one line.
"""

from __future__ import annotations

from gymnasium.envs.registration import register, registry

STEPS = {"NaoStand": 400, "NaoWalk": 800, "NaoReach": 200, "NaoFollowBall": 300, "NaoGetUp": 400}
"""Environments, and after how many steps an episode is over."""


def register_all() -> None:
    """Let `gymnasium.make` know the environments, as importing this does; older Gymnasium finds it by itself."""
    for name, steps in STEPS.items():
        module = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in name[3:]).lstrip("_")
        if f"{name}-v0" not in registry:
            entry = f"nao_sim_bridge.envs.{module}:{name}Env"
            register(id=f"{name}-v0", entry_point=entry, max_episode_steps=steps)


register_all()
