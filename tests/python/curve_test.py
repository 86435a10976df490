# SPDX-License-Identifier: MIT
"""knotwave.Curve: values against exact fractions, shapes, views, faults."""
import math
import pickle
import threading

import numpy as np
import pytest

import exact
import knotwave as kw

KNOTS = [0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1]
POINTS = [0, 0.25, 1, 0.5, -0.25, 0]
WEIGHTS = [1, 1, 4, 1, 0.5, 1]


@pytest.fixture
def bell():
    return kw.Curve(POINTS, weights=WEIGHTS, knots=KNOTS, name="bell")


def test_values_are_the_exact_ones_rounded_once(bell):
    rng = np.random.default_rng(1)
    for degree in range(1, 6):
        count = degree + 4
        inner = np.sort(rng.integers(1, 1000, count - degree - 1) / 1000.0)
        knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
        points, weights = rng.uniform(-1, 1, count), rng.uniform(0.25, 4, count)
        curve = kw.Curve(points, degree, weights, knots)
        for u in np.append(rng.uniform(0, 1, 20), [0, 1]):
            wanted = exact.value(degree, points, weights, knots, u)
            assert abs(exact.number(curve(u)) - wanted) <= math.ulp(max(abs(points))) / 2


def test_shapes_follow_u(bell):
    assert np.isscalar(bell(0.5)) and bell(0.5).dtype == np.float64
    assert bell([0, 0.5, 1]).shape == (3,)
    assert bell(np.zeros((2, 3, 4))).shape == (2, 3, 4)
    assert bell([]).shape == (0,)
    path = kw.arc(1, 0, 0.25)
    assert path(0.5).shape == (2,) and path(np.zeros((3, 5))).shape == (3, 5, 2)
    assert bell.derivatives([0, 0.5], order=2).shape == (2, 3)
    assert path.derivatives(0.5, order=2).shape == (3, 2)
    assert path.derivatives([0, 0.5], order=2).shape == (2, 3, 2)
    assert bell.curvature([0.1, 0.2]).shape == (2,)
    assert kw.Curve([[0], [1]], degree=1).points.shape == (2,)


def test_arrays_of_any_layout_and_kind_are_read(bell):
    u = np.linspace(0, 1, 12).reshape(3, 4)
    assert np.array_equal(bell(u.T), bell(u).T)
    assert np.array_equal(bell(u[:, ::2]), bell(u)[:, ::2])
    assert bell(1) == bell(1.0)
    assert bell(np.float32(0.25)) == bell(0.25)
    with pytest.raises(TypeError):
        bell("a")
    with pytest.raises(TypeError):
        bell(1j)


def test_a_jump_has_two_sides():
    step = kw.Curve([0, 0.25, 0.75, 1], 1, knots=[0, 0, 0.5, 0.5, 1, 1], jumps=[0.5])
    assert step(0.5) == 0.75 and step(0.5, side="left") == 0.25


def test_nan_counts_as_the_start_and_beyond_the_ends_is_clamped(bell):
    assert bell(math.nan) == bell(0) and bell(-1) == bell(0) and bell(7) == bell(1)
    ramp = kw.Curve([0, 1], 1)
    assert list(ramp.evaluate_extrapolated([-1, 2], "linear", "mirror")) == [-1, 0]


def test_derivatives_are_those_of_the_differences(bell):
    d = bell.derivatives(0.3, order=2)
    h = 1e-5
    assert d[1] == pytest.approx((bell(0.3 + h) - bell(0.3 - h)) / (2 * h), rel=1e-8)
    assert d[2] == pytest.approx((bell(0.3 + h) - 2 * bell(0.3) + bell(0.3 - h)) / h**2, rel=1e-4)
    assert np.array_equal(bell.derivatives(0.3, order=0), [bell(0.3)])


def test_properties_are_read_only_views_that_keep_the_curve(bell):
    points = bell.points
    assert points.base is not None and not points.flags.writeable and not points.flags.owndata
    assert points.__array_interface__["data"][0] == bell.points.__array_interface__["data"][0]
    copy = points.copy()
    del bell
    assert np.array_equal(points, copy)
    with pytest.raises(ValueError):
        points[0] = 1


def test_spec_and_pickle_give_it_back(bell):
    wave = kw.Curve([[0, 1], [1, 0], [2, 2], [3, 3]], periodic=True, name="wave")
    for curve in (bell, wave, kw.Curve([0, 1, 1, 0], 1, knots=[0, 0, 0.5, 0.5, 1, 1], jumps=[0.5])):
        assert kw.Curve(**curve.spec()) == curve
        assert pickle.loads(pickle.dumps(curve)) == curve
    assert bell != wave
    assert "bell" in repr(bell) and "rational" in repr(bell) and "periodic" in repr(wave)


def test_a_fault_is_an_exception_with_the_message_of_the_library():
    with pytest.raises(kw.Error) as caught:
        kw.Curve(POINTS, knots=[0, 0, 0, 0, 0.5, 0.25, 1, 1, 1, 1], name="bell")
    assert caught.value.code == "knots_decrease"
    assert "'bell'" in str(caught.value) and "0.25" in str(caught.value) and "0.5" in str(caught.value)
    assert isinstance(caught.value, ValueError) and caught.value.line == 0
    with pytest.raises(kw.Error, match="did you mean 'left'"):
        kw.Curve([0, 1], 1)(0, side="lefft")
    with pytest.raises(kw.Error, match="no coordinate 1"):
        kw.Curve([0, 1], 1).value_range(1)
    with pytest.raises(kw.Error, match="shape"):
        kw.Curve(np.zeros((2, 2, 2)))
    with pytest.raises(kw.Error):
        kw.Curve([0, 1], 1).derivatives(0, order=-1)


def test_other_threads_go_on_while_a_curve_is_evaluated(bell):
    u = np.linspace(0, 1, 100_000)
    wanted, results = bell(u), [None] * 4

    def work(i):
        results[i] = bell(u)
    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(result, wanted) for result in results)


def test_pictures(bell):
    assert bell.plot_svg(320, 200).startswith("<svg") and bell._repr_svg_().startswith("<svg")
    assert len(bell.plot_text(40, 8).splitlines()) >= 8
