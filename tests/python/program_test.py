# SPDX-License-Identifier: MIT
"""Programs, surfaces and files from Python; what the module tells of itself."""
import ast
import inspect
import pathlib

import numpy as np
import pytest

import knotwave as kw


@pytest.fixture
def bell():
    return kw.Curve([0, 0.25, 1, 0.5, -0.25, 0], weights=[1, 1, 4, 1, 0.5, 1],
                    knots=[0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1], name="bell")


def test_a_program_is_within_its_error_of_the_curve(bell):
    program = kw.compile_function(bell, max_error=1e-9)
    u = np.linspace(0, 1, 1001)
    assert program.max_error <= 1e-9
    assert np.max(np.abs(program(u) - bell(u))) <= 1e-9
    assert np.isscalar(program(0.5)) and program(np.zeros((2, 3))).shape == (2, 3)
    assert program.range() == (-0.25, 1)
    assert program.breaks.tolist() == [0, 0.5, 1] and program.piece_count == 2
    t = 0.5
    above, below = (np.polyval(program.coefficients(0, k)[::-1], t) for k in (0, 1))
    assert above / below == pytest.approx(program(0.25))
    with pytest.raises(kw.Error):
        program.coefficients(2)
    with pytest.raises(kw.Error):
        program(0, coordinate=1)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_blocks_of_any_size_give_the_same_samples(bell, kind):
    program = kw.compile_function(bell)
    whole = np.empty(257, kind)
    assert program.render(-0.1, 1 / 200, out=whole) is whole
    for size in range(1, 70):
        parts = np.empty(257, kind)
        for first in range(0, 257, size):
            program.render(-0.1, 1 / 200, first=first, out=parts[first:first + size])
        assert np.array_equal(parts, whole)
    if kind == np.float64:
        assert np.array_equal(program.render(-0.1, 1 / 200, 257), whole)


def test_what_cannot_be_rendered_into_is_refused(bell):
    program = kw.compile_function(bell)
    for out in (np.empty(8, np.int32), np.empty(8)[::2], np.empty((2, 4)), bell.points):
        with pytest.raises(kw.Error, match="writable contiguous"):
            program.render(0, 1, out=out)
    with pytest.raises(kw.Error):
        program.render(0, 1)
    with pytest.raises(kw.Error):
        program.render(0, 1, -1)


def test_a_grid_has_exact_ends(bell):
    grid = kw.compile_function(bell).grid(0.1, 0.9, 8)
    assert grid.dtype == np.float32 and grid.shape == (9,)
    assert grid[-1] == np.float32(kw.compile_function(bell)(0.9))
    with pytest.raises(kw.Error):
        kw.compile_function(bell).grid(n=0)


def test_controls_move_what_was_declared(bell):
    program = kw.compile_function(bell, controls=[kw.Control("weight", 2, 0.5, 8)])
    assert program.control_count == 1
    assert program(0.25, controls=[1]) < program(0.25) < program(0.25, controls=[8])
    assert program(0.25, controls=[4]) == program(0.25)
    with pytest.raises(kw.Error):
        program(0.25, controls=[1, 2])


def test_orbits_and_polynomial_forms():
    arc = kw.arc(1, 0, 0.25)
    orbit, pieces = kw.compile_parametric(arc), kw.compile_polynomial(arc)
    u = np.linspace(0, 1, 9)
    assert np.hypot(orbit(u, 0), orbit(u, 1)) == pytest.approx(1, abs=1e-15)
    assert orbit.is_rational and not pieces.is_rational
    assert np.max(np.abs(pieces(u, 1) - orbit(u, 1))) <= 1e-7


def test_surfaces():
    rng = np.random.default_rng(2)
    points = rng.uniform(-1, 1, (3, 5))
    hill = kw.Surface(points, degree_u=3, degree_v=2, name="hill")
    assert hill.points.shape == (3, 5) and not hill.points.flags.writeable
    u, v = np.linspace(0, 1, 7), np.linspace(0, 1, 4)
    grid = hill.grid(u, v)
    assert grid.shape == (4, 7)
    assert np.array_equal(grid, hill(u[None, :], v[:, None]))
    np.testing.assert_allclose(grid[1], hill.iso_curve_at_v(v[1])(u), atol=1e-15)
    np.testing.assert_allclose(grid[:, 2], hill.iso_curve_at_u(u[2])(v), atol=1e-15)
    assert np.isscalar(hill(0.5, 0.5)) and hill.derivatives(0.5, 0.5, 2).shape == (3, 3)
    assert kw.Surface(**hill.spec()) == hill
    path = kw.Surface(rng.uniform(-1, 1, (2, 2, 3)), 1, 1)
    assert path.grid(u, v).shape == (4, 7, 3) and path(0, 0).shape == (3,)
    with pytest.raises(kw.Error, match="axes"):
        kw.Surface([1, 2])


def test_files_hold_what_was_written(bell, tmp_path):
    hill = kw.Surface([[0, 1], [2, 3]], 1, 1, name="hill")
    path = str(tmp_path / "all.toml")
    kw.write_curves(path, [bell, hill])
    assert kw.read_curves(path) == {"bell": bell, "hill": hill}
    assert kw.parse_curves(kw.curves_text([bell])) == {"bell": bell}
    with pytest.raises(kw.Error) as caught:
        kw.parse_curves('format = 1\nkind = "curve"\n[curves.a]\npoints = [0, x]\n', "a.toml")
    error = caught.value
    assert (error.code, error.source, error.line) == ("syntax", "a.toml", 4)
    assert str(error).startswith("a.toml:4:")
    with pytest.raises(kw.Error) as caught:
        kw.read_curves(str(tmp_path / "none.toml"))
    assert caught.value.code == "file_not_found"
    for items in ([bell, bell], [kw.Curve([0, 1], 1)]):
        with pytest.raises(kw.Error):
            kw.curves_text(items)
    with pytest.raises(TypeError, match="no int"):
        kw.curves_text([7])


def public(owner):
    return {name for name in vars(owner) if not name.startswith("_")}


def test_the_stub_names_what_is_there_and_nothing_else():
    tree = ast.parse((pathlib.Path(kw.__file__).parent / "__init__.pyi").read_text())
    stub = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(stub) == set(kw.__all__)
    for name, node in stub.items():
        made = getattr(kw, name)
        if not isinstance(node, ast.ClassDef):
            first = made.__doc__.splitlines()[0]
            words = [argument.arg for argument in node.args.args]
            assert [word for word in words if f"{word}:" not in first] == []
        elif name != "Error":
            members = {part.name for part in node.body if not part.name.startswith("_")}
            assert members == public(made)


def test_every_function_has_a_page_that_tells_its_arguments():
    for name in kw.__all__:
        made = getattr(kw, name)
        assert made.__doc__ and made.__module__ == "knotwave", name
        for member in public(made) if inspect.isclass(made) and name != "Error" else ():
            text = getattr(made, member).__doc__
            if callable(getattr(made, member)):
                assert text and len(text.splitlines()) > 2, f"{name}.{member}"
    assert "u [...] gives [...]" in kw.Curve.__call__.__doc__


def test_it_is_the_version_of_the_project():
    assert kw.__version__.count(".") == 2
