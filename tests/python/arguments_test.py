# SPDX-License-Identifier: MIT
"""What is no argument is refused: wrong shapes, lost digits, masked values, objects that were never made."""
import pathlib
from fractions import Fraction

import numpy as np
import pytest

import knotwave as kw


@pytest.fixture
def bell():
    return kw.Curve([0, 0, 1, 0, 0], weights=[1, 1, 4, 1, 1], name="bell")


@pytest.mark.parametrize("call, shapes", [
    (lambda: kw.Surface(np.arange(20.).reshape(4, 5), weights=np.arange(1., 21).reshape(5, 4)),
     r"weights.*\[5, 4\].*\[4, 5\]"),
    (lambda: kw.Surface(np.arange(20.).reshape(4, 5), weights=np.arange(1., 21)), r"weights.*\[20\].*\[4, 5\]"),
    (lambda: kw.Curve(np.zeros((4, 2)), weights=np.ones((2, 2))), r"weights.*\[2, 2\].*\[4\]"),
    (lambda: kw.Curve([0, 1], 1, knots=[[0, 0], [1, 1]]), r"knots.*\[2, 2\].*\[4\]"),
    (lambda: kw.Curve([0, 1, 2, 3], 1, jumps=[[.5]]), r"jumps.*\[1, 1\].*\[1\]"),
    (lambda: kw.interpolate_at([[0, 1], [2, 3]], [0, 1, 0, 1]), r"parameters.*\[2, 2\].*\[4\]"),
    (lambda: kw.approximate([[0, 1], [2, 3]], [0, 1, 0, 1], 1, 2), r"parameters.*\[2, 2\].*\[4\]"),
    (lambda: kw.reduce_data([[0, 1], [2, 3]], [0, 1, 0, 1], .1), r"times.*\[2, 2\].*\[4\]"),
    (lambda: kw.Curve([0, 1], 1).closest_point([[.5]]), r"point.*\[1, 1\].*\[1\]"),
    (lambda: kw.Curve([0, 1], 1).refine([[.25, .5]]), r"knots.*\[1, 2\].*\[2\]"),
    (lambda: kw.conic([[1, 0]], [1, 1], [0, 1], 1), r"p0.*\[1, 2\].*\[2\]"),
    (lambda: kw.hermite([0, 1], [0, 1], [[0, 0]], [0, 0]), r"slopes_in.*\[1, 2\].*\[2\]")])
def test_a_wrong_shape_is_refused_beside_the_right_one(call, shapes):
    with pytest.raises(ValueError, match=shapes) as caught:
        call()
    assert caught.value.code == "dimension_mismatch"


@pytest.mark.parametrize("nothing", [None, [None], [0.5, None], "0.5", [b"0"], 1j, np.datetime64(1, "s")])
def test_what_is_no_number_is_a_type_error(bell, nothing):
    with pytest.raises(TypeError):
        bell(nothing)


def test_masked_values_are_refused(bell):
    masked = np.ma.array([0.25, 0.5], mask=[False, True])
    with pytest.raises(TypeError, match="filled"):
        bell(masked)
    with pytest.raises(TypeError, match="filled"):
        kw.Curve(masked, 1)
    assert np.array_equal(bell(masked.filled(0)), bell([0.25, 0]))
    assert np.array_equal(bell(np.ma.array([0.25])), bell([0.25]))


@pytest.mark.parametrize("lossy", [[2**53 + 1], np.array([-(2**53) - 1]), np.array([2**64 - 1], np.uint64),
                                   [2**70 + 1], [Fraction(1, 3)], [10**400], [0.5, -(10**400)],
                                   [Fraction(10**400, 3)]])
def test_numbers_that_no_double_holds_are_refused(bell, lossy):
    with pytest.raises(kw.Error, match="no double holds") as caught:
        bell(lossy)
    assert caught.value.code == "value_out_of_range"


@pytest.mark.parametrize("exact", [[2**53], np.array([2**60]), np.array([2**63], np.uint64), [2**70], [True],
                                   [Fraction(1, 4)], np.array([1], np.int8), np.array([.5], np.longdouble),
                                   np.array([np.nan], np.longdouble), np.array([.25], ">f8"), []])
def test_numbers_that_a_double_holds_are_taken(bell, exact):
    assert np.array_equal(bell(exact), bell(np.asarray(exact).astype(float)))


def test_what_was_never_made_is_refused(bell):
    for kind, use in ((kw.Surface, lambda it: it.dim), (kw.Program, lambda it: it.dim),
                      (kw.MapSet, lambda it: it.evaluate(0)), (kw.MapKey, repr),
                      (kw.TrimRegion, lambda it: it.is_unbounded), (kw.Extremum, lambda it: it.u)):
        with pytest.raises(TypeError, match="never made"):
            use(kind.__new__(kind))
    with pytest.raises(TypeError, match="never made"):
        kw.Curve.__new__(kw.Curve)(.5)


def test_files_have_any_kind_of_path(bell, tmp_path):
    path = tmp_path / "bell.toml"
    kw.write_curves(path, [bell])
    for place in (path, str(path), pathlib.PurePath(path)):
        assert kw.read_curves(place) == {"bell": bell}
    with pytest.raises(TypeError):
        kw.read_curves(7)


@pytest.mark.parametrize("size", [(-1, 5), (63, 100), (100, 16385)])
def test_pictures_have_a_size(bell, size):
    with pytest.raises(kw.Error, match=f"{size[0]} by {size[1]} pixels: each must be 64 to 16384"):
        bell.plot_svg(*size)


def test_paths_of_data_are_reduced_together():
    t = np.linspace(0, 1, 101)
    path = kw.reduce_data(t, np.stack([t, t * t], axis=1), 1e-3)
    assert path.curve.dim == 2 and path.max_error <= 1e-3
    assert np.allclose(path.curve(t)[:, 1], t * t, rtol=0, atol=2e-3)
