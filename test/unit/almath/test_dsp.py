"""Digital filter and PID controller."""

import numpy
import pytest

import almath


def test_a_fresh_filter_passes_its_input_on():
    plain = almath.DigitalFilter()
    assert [plain.processFilter(sample) for sample in (1.0, -2.0, 3.5)] == [1.0, -2.0, 3.5]


def test_equal_input_weights_are_a_moving_average_once_there_are_enough_samples():
    average = almath.DigitalFilter()
    average.configureFilter([1.0, 1.0, 1.0], [], 3.0)
    assert [average.processFilter(sample) for sample in (3.0, 6.0, 9.0, 12.0)] == [3.0, 6.0, 6.0, 9.0]


def test_filter_is_the_difference_equation(rng):
    filtered = almath.DigitalFilter()
    filtered.configureFilter([0.2, 0.3], [0.1, 0.5], 2.0)
    samples = rng.normal(size=30)
    outputs = [filtered.processFilter(sample) for sample in samples]
    assert outputs[:2] == pytest.approx(samples[:2])
    for now in range(2, 30):
        expected = (0.2 * samples[now - 1] + 0.3 * samples[now]) / 2.0 + 0.1 * outputs[now - 2] + 0.5 * outputs[now - 1]
        assert outputs[now] == pytest.approx(expected)


def test_reset_forgets_the_past():
    smooth = almath.DigitalFilter()
    smooth.configureFilter([0.5], [0.5], 1.0)
    first = [smooth.processFilter(sample) for sample in (1.0, 1.0, 4.0)]
    smooth.resetFilter()
    assert [smooth.processFilter(sample) for sample in (1.0, 1.0, 4.0)] == first


def test_a_filter_needs_a_gain():
    with pytest.raises(almath.AlmathError, match="other than zero"):
        almath.DigitalFilter().configureFilter([1.0], [], 0.0)


def test_proportional_gain_answers_the_error_beyond_the_threshold():
    controller = almath.PIDController(2.0, 0.0, 0.0, 0.5, 0.1, 0.02)
    assert controller.computeFeedback(3.0, 1.0) == pytest.approx(2.0 * 1.5 + 0.1)
    assert controller.computeFeedback(1.0, 3.0) == pytest.approx(-2.0 * 1.5 + 0.1)
    assert controller.computeFeedback(1.0, 1.4) == pytest.approx(0.1)


def test_a_fresh_controller_answers_nothing_until_it_has_gains():
    controller = almath.PIDController()
    assert [controller.computeFeedback(error, 0.0) for error in (1.0, -2.0)] == [0.0, 0.0]
    controller.initialize()
    controller.setGains(1.0, 1.0, 1.0)
    # Without a set period a second passes with each call.
    assert [controller.computeFeedback(error, 0.0) for error in (0.1, -0.1)] == pytest.approx([0.2, -0.3])


def test_integral_and_derivative_of_a_ramp():
    controller = almath.PIDController()
    controller.initialize(0.0, 1.0, 1.0, 0.0, 0.0, 0.5)
    errors = numpy.arange(0.0, 3.0, 0.5)
    answers = [controller.computeFeedback(error, 0.0) for error in errors]
    slopes = [0.0, *numpy.diff(errors) / 0.5]
    assert answers == pytest.approx(slopes + numpy.cumsum(errors) * 0.5)


def test_a_period_given_with_the_call_counts():
    controller = almath.PIDController(0.0, 1.0, 0.0, 0.0, 0.0, 0.5)
    controller.computeFeedback(0.0, 0.0)
    assert controller.computeFeedback(1.0, 0.0, 0.1) == pytest.approx(10.0)


def test_size_of_a_deviation_has_a_slope_without_sign():
    controller = almath.PIDController(0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    assert [controller.computeFeedbackAbsolute(size) for size in (0.0, 3.0, 1.0)] == [0.0, 3.0, 2.0]


def test_size_of_a_deviation_counts_from_the_threshold():
    controller = almath.PIDController(2.0, 0.0, 0.0, 0.5, 0.0, 1.0)
    assert [controller.computeFeedbackAbsolute(size) for size in (0.4, 0.75)] == [0.0, 0.5]


def test_initialize_forgets_and_gains_can_change():
    controller = almath.PIDController(1.0, 0.0, 1.0, 0.0, 0.0, 1.0)
    first = controller.computeFeedback(1.0, 0.0)
    assert controller.computeFeedback(1.0, 0.0) != first
    controller.initialize()
    assert controller.computeFeedback(1.0, 0.0) == first
    controller.setGains(0.0, 0.0, 0.0)
    assert controller.computeFeedback(1.0, 0.0) == 0.0


@pytest.mark.parametrize(
    "settings, told",
    [
        ((1.0, 0.0, 0.0), "6 settings, got 3"),
        ((-1.0, 0.0, 0.0, 0.0, 0.0, 1.0), "gains of zero or more"),
        ((1.0, 0.0, 0.0, -0.1, 0.0, 1.0), "threshold"),
        ((1.0, 0.0, 0.0, 0.0, 0.0, 0.0), "period above zero"),
    ],
)
def test_wrong_settings_are_named(settings, told):
    with pytest.raises(almath.AlmathError, match=told):
        almath.PIDController(*settings)
