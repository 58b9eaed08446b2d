"""Many runs over seeds and parameters, on this computer or on a Ray cluster: how often does my behaviour fall?

    from nao_sim_bridge.sweep import sweep

    def pushed(seed, push):
        with NaoSim(seed=seed, noise=1.0) as nao:
            nao.push("Torso", (10.0 * push, 0.0, 0.0), 0.1)
            nao.step(3.0)
            return {"fell": nao.fallen}

    print(sweep(pushed, seeds=50, push=[0.0, 1.0, 2.0]))

Needs the extra `[sweep]`.
"""

from __future__ import annotations

from nao_sim_bridge.sweep.ray_start import NoWorkers, ray_running
from nao_sim_bridge.sweep.run import sweep
from nao_sim_bridge.sweep.table import Rate, Table

__all__ = ["NoWorkers", "Rate", "Table", "ray_running", "sweep"]
