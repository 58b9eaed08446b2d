"""The actions. Each message of a function server also has its short name: LedGoal is NaoLedGoal."""

from nao_library_msgs import load_when_asked

msg = load_when_asked(__name__, "msg", prefix="Nao")
