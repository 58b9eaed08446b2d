"""Behaviours that begin with a robot that gets up, and end with a mistake; and one that uses all modules rightly."""

from __future__ import annotations

START = """help: Gets up, and then does something wrong.
parameters:
  light: {default: FaceLeds, help: which light}
  turn: {default: 0.1, help: of the head, min: -1.0, max: 1.0, unit: rad}
do:
  - NaoMotion.goToPosture: {str_param: Stand}
"""
WRONG = {
    "colour": (
        'NaoLights.setColor: {lights: ["${light}"], str_param: grean}',
        "step 2: field str_param: unknown colour 'grean': did you mean 'green'?",
    ),
    "angles": (
        "NaoMotion.angleInterpolation: {names: [HeadYaw, HeadPitch], angles: [0.1, 0.2, 0.3], times: [1.0, 2.0]}",
        "step 2: field angles: 2 times need 2 angles for all of the 2 joints, or 4: 2 for HeadYaw, then 2 for "
        "HeadPitch: here are 3",
    ),
    "limit": (
        "NaoMotion.setAngles: {names: [HeadYaw], angles: [5.5], stiffness: 1.0}",
        "step 2: field angles: HeadYaw cannot go to 5.5000 rad: -2.0857 to 2.0857 rad; 5.5 degrees are 0.0960 rad",
    ),
    "light": (
        "NaoLights.on: {lights: [FaceLed]}",
        "step 2: field lights: unknown light 'FaceLed': did you mean 'FaceLeds'",
    ),
    "parameter": (
        "{behavior: bow, parameters: {depth: deeep}}",
        "step 2: field depth: 'deeep' is not allowed: did you mean 'deep'?",
    ),
}
"""Name -> the step in line 7, and what is told of it."""
LINE = 7
GOOD = """help: All modules, and what earlier steps make.
parameters: {text: {default: Hello, help: what it says}}
do:
  - NaoMotion.goToPosture: {str_param: Stand}
  - NaoMotion.angleInterpolation: {names: [Head], angles: [0.1], times: [1.0]}
  - NaoLights.createGroup: {str_param: Mine, lights: [Brain0, Brain1]}
  - NaoMotion.recordMotion: {str_param: checked_before, names: [Head], duration: 0.5, overwrite: true}
  - nao_audio_in.setVocabulary: {vocabulary: [yes please, no]}
  - parallel:
      - NaoLights.off: {lights: [Mine]}
      - NaoMotion.playMotion: {str_param: checked_before}
      - nao_audio_out.say: {str_param: "${text}"}
      - nao_audio_in.listen: {timeout: 1.0}
      - NaoVision.takePicture: {timeout: 1.0}
      - NaoTactile.waitForTouch: {sensors: [front head], timeout: 1.0}
  - NaoMotion.deleteMotion: {str_param: checked_before}
"""


def wrong_text(name):
    """The text of a wrong behaviour."""
    return f"{START}  - {WRONG[name][0]}\n"
