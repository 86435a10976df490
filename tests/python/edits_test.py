# SPDX-License-Identifier: MIT
"""Edits, analyses, shapes and fits from Python."""
import math

import numpy as np
import pytest

import exact
import knotwave as kw

U = np.linspace(0, 1, 33)
ULP = 4 * math.ulp(1.0)


@pytest.fixture
def bell():
    return kw.Curve([0, 0.25, 1, 0.5, -0.25, 0], weights=[1, 1, 4, 1, 0.5, 1],
                    knots=[0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1], name="bell")


@pytest.fixture
def plain():
    return kw.Curve([0, 0.25, 1, 0.5, -0.25, 0], knots=[0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1], name="plain")


@pytest.mark.parametrize("edit", [
    lambda c: c.insert_knot(0.3, 2), lambda c: c.refine([0.1, 0.7, 0.1]), lambda c: c.elevate_degree(2),
    lambda c: c.reverse().reverse(), lambda c: c.bend(3).bend(1 / 3),
    lambda c: c.reparametrize(2, 5).reparametrize(0, 1), lambda c: kw.Curve.from_bezier(*c.to_bezier()),
    lambda c: kw.join(*c.split(0.3))])
def test_what_keeps_a_curve_keeps_its_exact_values(bell, edit):
    edited = edit(bell)
    for u in U:
        wanted = exact.value(3, bell.points, bell.weights, bell.knots, u)
        assert abs(exact.number(edited(u)) - wanted) <= ULP


def test_parts_have_their_own_domain(bell):
    part = bell.sub_curve(0.25, 0.5)
    assert (part.u_min, part.u_max) == (0.25, 0.5)
    left, right = bell.split(0.25)
    assert left.u_max == right.u_min == 0.25


def test_segments_and_powers_have_the_shapes_that_are_told(bell):
    ends, points, weights = bell.to_bezier()
    assert np.array_equal(ends, [0, 0.5, 1]) and points.shape == weights.shape == (2, 4)
    path = kw.arc(1, 0, 0.5)
    ends, points, weights = path.to_bezier()
    assert points.shape == (2, 3, 2) and weights.shape == (2, 3)
    ends, above, below = bell.to_power_basis()
    t = (0.8 - ends[1]) / (ends[2] - ends[1])
    assert np.polyval(above[1][::-1], t) / np.polyval(below[1][::-1], t) == pytest.approx(bell(0.8), abs=ULP)
    with pytest.raises(kw.Error, match="ends"):
        kw.Curve.from_bezier([0, 1], [0, 1])


def test_smaller_curves_stay_within_the_bound(plain):
    for reduced in (plain.remove_knot(0.5, 2, 0.5), plain.remove_knots(0.5), plain.reduce_degree(0.5)):
        assert reduced.removed > 0 and reduced.max_error <= 0.5
        assert np.max(np.abs(reduced.curve(U) - plain(U))) <= reduced.max_error + ULP
    with pytest.raises(kw.Error) as caught:
        plain.reduce_degree(1e-9)
    assert caught.value.code == "error_bound_missed"


def test_two_curves_make_one(bell, plain):
    ramp = kw.Curve([0, 1], 1)
    np.testing.assert_allclose(kw.sum(plain, ramp)(U), plain(U) + U, atol=2 * ULP)
    np.testing.assert_allclose(kw.product(bell, ramp)(U), bell(U) * U, atol=ULP)
    np.testing.assert_allclose(kw.compose(bell, kw.product(ramp, ramp))(U), bell(U * U), atol=ULP)
    np.testing.assert_allclose(kw.morph(plain, ramp, 0.25)(U), 0.75 * plain(U) + 0.25 * U, atol=ULP)
    first, second = kw.make_compatible(bell, ramp)
    assert first.degree == second.degree == 3 and np.array_equal(first.knots, second.knots)


def test_slopes_and_areas(plain):
    np.testing.assert_allclose(plain.hodograph()(U[1:16]), plain.derivatives(U[1:16])[:, 1], atol=1e-14)
    area = plain.antiderivative(2.0)
    assert area(0) == 2.0
    circle = kw.arc(2, 0, 1)
    assert circle.arc_length(0, 1) == pytest.approx(4 * math.pi, abs=8 * ULP)
    assert circle.parameter_at_length(math.pi) == pytest.approx(0.25, abs=ULP)
    assert plain.integral(0.1, 0.9) == pytest.approx(area(0.9) - area(0.1), abs=ULP)


def test_analyses(bell):
    found = bell.value_range()
    assert found.high.value >= bell(U).max() and bell(found.high.u) == pytest.approx(found.high.value, abs=ULP)
    assert bell.hull_range() == (-0.25, 1)
    places = bell.parameters_at(0.3)
    assert len(places) >= 2 and np.allclose(bell(places), 0.3, atol=1e-15)
    assert bell.parameters_at(5).shape == (0,)
    assert bell.span_hulls().shape == (2, 4) and bell.breaks(3).shape == (1, 3)
    assert bell.greville_abscissae().shape == (6,)
    assert not bell.is_non_decreasing() and kw.Curve([0, 1], 1).is_non_decreasing()
    assert bell.total_variation() > 1
    nearest = kw.arc(1, 0, 0.5).closest_point([0, 3])
    assert (nearest.u, nearest.distance) == pytest.approx((0.5, 2), abs=1e-12)


def test_time_that_goes_back_is_repaired():
    loop = kw.Curve([[0, 0], [1.5, 0.5], [-0.75, 0.5], [1, 1]])
    assert not loop.is_non_decreasing()
    for mode in ("contain", "keep_start", "keep_ratio", "limit_active", "limit_opposite"):
        assert loop.regularize(mode).is_non_decreasing()
    with pytest.raises(kw.Error):
        loop.regularize("none")


def test_shapes():
    x, y = kw.arc(2, 0, 1)(U).T
    np.testing.assert_allclose(np.hypot(x, y), 2, atol=2 * ULP)
    assert kw.ellipse(2, 3)(0.25) == pytest.approx([0, 3], abs=ULP)
    assert kw.bezier([0, 0, 1, 1])(0.5) == 0.5
    assert kw.conic([1, 0], [1, 1], [0, 1], math.sqrt(0.5))(0.5) == pytest.approx([math.sqrt(0.5)] * 2)
    decay = kw.exponential_decay(60)
    db = 20 * np.log10(decay.curve(U))
    assert np.max(np.abs(db + 60 * U)) <= decay.max_error_db < 0.001
    assert kw.css_cubic_bezier(0.25, 0.1, 0.25, 1).dim == 2
    assert kw.hermite([0, 1, 3], [0, 1, 0], [0, 0, 0], [0, 0, 0])(1) == 1
    with pytest.raises(kw.Error, match="slopes_in"):
        kw.hermite([0, 1, 3], [0, 1, 0], [0, 0], [0, 0, 0])
    assert kw.catmull_rom([0, 1, 0.5], closed=True)(1) == 0


def test_fits():
    t = np.arange(40.0)
    y = np.sin(t / 6)
    curve = kw.interpolate_at(t, y)
    np.testing.assert_allclose(curve(t), y, atol=ULP)
    points = np.stack([np.cos(t / 7), y], axis=-1)
    assert np.allclose(kw.interpolate(points, spacing="chord")([0, 1]), points[[0, -1]])
    near = kw.approximate(t, y, 3, 12)
    assert np.max(np.abs(near.curve(t) - y)) <= near.max_error + ULP
    few = kw.reduce_data(t, y, 0.01)
    assert few.max_error <= 0.01 and len(few.curve.points) < 20
    dense = np.linspace(0, 39, 2000)
    assert np.max(np.abs(few.curve(dense) - np.interp(dense, t, y))) <= few.max_error + ULP


def test_svg_paths():
    path, = kw.curves_from_svg_path("M0 0C1 0 1 1 2 1", y="down")
    assert path.name == "path_1" and path(1) == pytest.approx([2, 1])
    d, bound = path.to_svg_path(1e-6, y="down")
    assert d.startswith("M") and bound <= 1e-6
