#!/usr/bin/env python3
"""A NAO in ten lines: walks, looks around, is pushed, sees a ball. Needs `pip install ./nao_sim_bridge` and no ROS."""

from nao_sim_bridge import NaoSim

with NaoSim(posture="Stand", seed=1) as nao:
    nao.walk_to(0.5, 0.0, 0.3)
    nao.set_angles("HeadYaw", 0.5)
    nao.step(1.0)
    print(nao.angles["HeadYaw"], nao.pose_torso_in_world, nao.imu.angles, nao.feet.center_of_pressure)
    image = nao.camera("top").picture(320, 240)
    nao.push("Torso", force=(20, 0, 0), duration=0.1)
    nao.place("ball", at=(1, 0, 0.03))
    nao.save_picture("nao.png")
