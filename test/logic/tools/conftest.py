"""The programs in `nao_sim_bridge/tools`."""

from tool_fixtures import run, tools

__all__ = ["run", "tools"]
