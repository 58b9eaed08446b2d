from __future__ import annotations

import math

import pytest
from nao_benchmarks.row import Figures, at_least, at_most
from nao_benchmarks.stats import Sample


@pytest.mark.parametrize(
    "bound, value, holds",
    [
        (at_most(1.15), 1.15, True),
        (at_most(1.15), 1.16, False),
        (at_least(12.0), 12.0, True),
        (at_least(12.0), 11.9, False),
        (at_most(1.0), math.nan, False),
        (at_least(1.0), math.nan, False),
    ],
)
def test_a_bound_holds_up_to_its_limit_and_never_for_what_is_no_number(bound, value, holds):
    assert bound.holds(value) is holds


def test_a_bound_says_which_side_is_right():
    assert str(at_most(1.25)) == "at most 1.25"
    assert str(at_least(12.0)) == "at least 12"


def test_the_ratio_is_ours_by_reference_and_what_the_bound_is_about():
    figures = Figures(ours=3.0, reference=2.0)
    assert figures.ratio == 1.5
    assert figures.value == 1.5


def test_without_a_reference_the_bound_is_about_our_figure():
    figures = Figures(ours=14.0)
    assert figures.ratio is None
    assert figures.value == 14.0


def test_compared_samples_become_medians_and_quartiles_in_the_unit_of_the_row():
    figures = Figures.compared(Sample((0.001, 0.002, 0.003)), Sample((0.004,)), scale=1e3)
    assert figures.ours == pytest.approx(2.0)
    assert figures.reference == pytest.approx(4.0)
    assert figures.details == pytest.approx(
        {
            "runs": 3,
            "reference runs": 1,
            "ours, first quartile": 1.5,
            "ours, third quartile": 2.5,
            "reference, first quartile": 4.0,
            "reference, third quartile": 4.0,
        }
    )
