# SPDX-License-Identifier: MIT
"""Surfaces edited and made from curves, joins, moving points and regions from Python."""
import numpy as np
import pytest

import knotwave as kw


@pytest.fixture
def hill():
    rng = np.random.default_rng(1)
    return kw.Surface(rng.uniform(-1, 1, (4, 5)), 3, 2, weights=rng.uniform(0.5, 2, (4, 5)), name="hill")


PLACES = np.linspace(0, 1, 9)


def test_edits_keep_the_surface(hill):
    same = hill.grid(PLACES, PLACES)
    for edited in (hill.insert_knot("u", 0.3), hill.refine("v", [0.2, 0.7]), hill.elevate_degree("v", 2),
                   hill.transpose().transpose(), hill.reverse("u").reverse("u")):
        assert np.allclose(edited.grid(PLACES, PLACES), same, rtol=0, atol=1e-15)
    assert np.array_equal(hill.transpose().grid(PLACES, PLACES), same.T)
    assert np.array_equal(hill.reparametrize("v", 2, 3).grid(PLACES, PLACES + 2)[0], same[0])
    low, high = hill.split("u", 0.5)
    assert low.u_max == high.u_min == 0.5
    assert np.allclose(hill.sub_surface("u", 0, 0.5).grid([0.25], [0.5]), hill(0.25, 0.5), rtol=0, atol=1e-15)


def test_what_was_put_in_comes_out_again(hill):
    back = hill.insert_knot("u", 0.3).remove_knot("u", 0.3, 1, 1e-13)
    assert back.removed == 1 and back.max_error <= 1e-13
    assert np.array_equal(back.surface.knots_u, hill.knots_u)
    lower = hill.elevate_degree("v").reduce_degree("v", 1e-12)
    assert lower.surface.degree_v == 2 and lower.max_error <= 1e-12


def test_faults_name_the_direction(hill):
    with pytest.raises(kw.Error, match="direction is 'w'"):
        hill.insert_knot("w", 0.5)
    with pytest.raises(kw.Error, match="along v"):
        hill.insert_knot("v", 7)
    with pytest.raises(kw.Error, match="0..15"):
        hill.derivatives(0.5, 0.5, order=16)


def test_shapes_go_through_their_curves():
    a, b = kw.Curve([0, 1, 0], 2), kw.Curve([1, 3, 2], 2)
    assert kw.ruled(a, b)(0.5, 0.5) == (a(0.5) + b(0.5)) / 2
    rows = [a, b, kw.Curve([0, 0, 1], 2)]
    loft = kw.lofted(rows, 2, positions=[0, 0.25, 1])
    for row, v in zip(rows, (0, 0.25, 1)):
        assert np.allclose(loft(PLACES, v), row(PLACES), rtol=0, atol=2e-15)
    assert kw.lofted(rows, 1).degree_v == 1
    tube = kw.revolved(kw.Curve([[2, 0], [2, 1]], 1))
    assert np.allclose(np.hypot(*tube(PLACES, 0.5)[:, :2].T), 2, rtol=0, atol=1e-15)
    assert kw.bilinear([0, 1, 2, 5])(0.5, 0.5) == 2
    line = lambda *ends: kw.Curve(ends, 1)
    assert kw.coons(line(0, 1), line(2, 5), line(0, 2), line(1, 5))(0.5, 0.5) == 2


def test_a_join_starts_where_it_is_told():
    bell = kw.Curve([0, 0.25, 1, 0.5, -0.25, 0])
    program, join = kw.compile_function(bell), kw.compile_join(bell, 0.2)
    assert join.u_join == 0.2 and join.moves_p1
    dp0, dp1, limited = join.start(0.4, 0.5)
    heard = program(0.2) + dp0 * join.basis(0.2, 0) + dp1 * join.basis(0.2, 1)
    assert heard == pytest.approx(0.4, abs=1e-12) and not limited
    assert join.basis(join.u_basis_end + 0.01, 1) == 0 or join.u_basis_end == 1
    assert join.start(0.4)[1] != dp1


def test_a_fast_program_keeps_its_proved_error():
    bell = kw.Curve([0, 0.25, 1, 0.5, -0.25, 0])
    fast = kw.FastProgram(kw.compile_function(bell))
    heard = fast.render(0, 1 / 200, 201)
    assert heard.dtype == np.float32 and fast.fast_piece_count() > 0
    assert np.max(np.abs(heard - bell(np.arange(201) / 200))) <= fast.max_error() < 1e-5
    assert np.array_equal(fast.render(0, 1 / 200, 101, first=100), heard[100:])
    with pytest.raises(kw.Error):
        fast.render(0, 1, -1)
    with pytest.raises(kw.Error):
        fast.max_error(1)


def test_moving_points_are_the_curve_of_that_moment():
    ease = kw.css_cubic_bezier(0.42, 0, 0.58, 1)
    moving = kw.MovingCurve(ease)
    assert moving.degree == 3 and moving.point_count == 4 and moving.halvings == 26
    times = np.array([0.25, 0.5])
    still = kw.compile_function(ease)(times)
    assert np.allclose(moving(times, ease.points), still, rtol=0, atol=2**-24)
    sets = np.stack([ease.points, ease.points * [1, 2]])
    assert moving(times, sets) == pytest.approx(still * [1, 2], abs=2**-23)
    with pytest.raises(kw.Error, match=r"\[4, 2\]"):
        moving(times, ease.points[:3])


def test_a_region_keeps_what_lies_left_of_its_loops():
    hole = [curve.reverse() for curve in kw.rectangle_loop(1, 2, 1, 2)]
    region = kw.TrimRegion([kw.rectangle_loop(0, 4, 0, 4), hole])
    assert region.contains([1.5, 3], 1.5).tolist() == [False, True]
    assert region.contains(5, 1) == False  # noqa: E712 (numpy's)
    assert region.intervals_at_v(1.5).tolist() == [[0, 1], [2, 4]]
    assert region.intervals_at_u(3).tolist() == [[0, 4]]
    assert not region.is_unbounded and kw.TrimRegion([]).is_unbounded
    with pytest.raises(kw.Error):
        kw.TrimRegion([[kw.Curve([[0, 0], [1, 1]], 1)]])


def test_any_number_of_curves_becomes_compatible():
    curves = [kw.Curve([0, 1], 1), kw.Curve([0, 1, 2, 3, 4]), kw.Curve([0, 1, 0], 2)]
    alike = kw.make_all_compatible(curves)
    assert len({(c.degree, tuple(c.knots)) for c in alike}) == 1
    assert all(np.allclose(a(PLACES), c(PLACES), rtol=0, atol=4e-15) for a, c in zip(alike, curves))


def test_a_control_may_be_a_knot():
    hat = kw.Curve([0, 1, 0, 1], 2)
    program = kw.compile_function(hat, controls=[kw.Control("knot", 3, 0.25, 0.75)])
    assert program(0.4, controls=[0.3]) != program(0.4) == pytest.approx(hat(0.4))
