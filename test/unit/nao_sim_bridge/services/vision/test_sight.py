"""The event of an extractor that sees something, and then does not."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.services.vision.sight import Sight


@pytest.mark.parametrize("tell_end, told", [(True, [["a"], ["b"], [], ["c"]]), (False, [["a"], ["b"], ["c"]])])
def test_what_is_seen_is_told_each_time_and_its_end_once_or_not_at_all(tell_end, told):
    memory = MemoryStore(lambda: 0.0)
    sight = Sight(memory, "Seen", tell_end)
    heard = []
    memory.listen("Seen", heard.append)
    assert memory.get("Seen") == []
    sight.nothing()
    sight.show(["a"])
    sight.show(["b"])
    assert memory.get("Seen") == ["b"]
    sight.nothing()
    sight.nothing()
    assert memory.get("Seen") == []
    sight.show(["c"])
    assert heard == told
