"""How the torso lies in the world when a simulation starts in a posture that is not on the feet."""

from __future__ import annotations

from nao_sim_bridge.model.postures import load_postures

# Pitch of the torso in world, rad, by the family of the posture: near the pose in which the stiff robot comes to rest.
PITCH_OF_FAMILY = {"Sitting": -0.28, "LyingBelly": 1.45, "LyingBack": -1.5}
# Leaning back on the hands, the seat and the heels at once.
PITCH_OF_POSTURE = {"SitRelax": -0.05}


def start_pitch(name: str) -> float | None:
    """Pitch of the torso in world in rad, positive with the face down; None when the posture is on the feet."""
    return PITCH_OF_POSTURE.get(name, PITCH_OF_FAMILY.get(load_postures().by_name[name].family))
