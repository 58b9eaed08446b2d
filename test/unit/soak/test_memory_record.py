"""Whether memory is flat, from samples."""

from __future__ import annotations

from nao_soak.memory_record import MemoryRecord


def record_of(*samples):
    record = MemoryRecord()
    for sample in samples:
        record.add(sample)
    return record


def test_memory_that_grows_is_told_with_both_figures():
    record = record_of(*({"leaks": 100.0 + i, "flat": 100.0} for i in range(100)))
    (name, (before, after)), *others = record.swollen().items()
    assert (name, others) == ("leaks", [])
    assert 140.0 <= before <= 155.0 and 185.0 <= after <= 199.0


def test_what_is_held_for_a_moment_does_not_count():
    peaks = record_of(*({"server": 300.0 if i % 4 == 0 else 100.0} for i in range(100)))
    assert peaks.growth() == {"server": (100.0, 100.0)}


def test_what_is_needed_at_the_beginning_does_not_count():
    record = record_of(*({"server": min(100.0, 10.0 * i)} for i in range(100)))
    assert record.swollen() == {}


def test_a_process_that_was_gone_for_a_while_has_no_growth():
    record = record_of(*({"stays": 50.0, **({"went": 50.0} if i < 80 else {})} for i in range(100)))
    assert set(record.growth()) == {"stays"}


def test_the_course_has_every_sample_of_every_process():
    record = record_of({"a": 1.04}, {"a": 2.0, "b": 3.0})
    assert record.course() == {"a": [1.0, 2.0], "b": [None, 3.0]}
    assert record_of().course() == {}
