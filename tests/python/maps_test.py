# SPDX-License-Identifier: MIT
"""Maps and few straight steps from Python."""
import numpy as np
import pytest

import knotwave as kw


@pytest.fixture
def bell():
    return kw.Curve([0, 0.25, 1, 0.5, -0.25, 0], weights=[1, 1, 4, 1, 0.5, 1],
                    knots=[0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1], name="bell")


@pytest.fixture
def hill():
    return kw.Surface([[0, 1, 0], [0.5, 2, -1], [0, 1, 0.25]], degree_u=2, degree_v=2, name="hill")


def test_enabled_maps_are_evaluated_at_one_coordinate(bell, hill):
    maps = kw.MapSet()
    amp = maps.define("amp", bell, u=(0, 2), max_error=1e-9)
    orbit = maps.define("position", kw.arc(1, 0, 0.25), u=(0, 2))
    wave = maps.define("wave_position", hill, v=(3, 1))
    assert repr(amp) == "MapKey('amp', parameters=1, width=1, rational=True)"
    assert amp == kw.MapKey("amp", rational=True) and amp != orbit
    assert maps.evaluate(1) == {} and not maps.is_enabled(amp)
    for key in (amp, orbit, wave):
        assert maps.enable(key) and maps.is_enabled(key)
    values = maps.evaluate(0.6)
    assert set(values) == {"amp", "position"}
    assert values["amp"] == pytest.approx(bell(0.3), abs=1e-9)
    assert values["position"].shape == (2,) and np.hypot(*values["position"]) == pytest.approx(1)
    assert maps.evaluate(0.6, 2.5) == {"wave_position": pytest.approx(hill(0.6, 0.25), abs=1e-12)}
    slope = maps.slopes(0.6)["amp"]
    assert slope == pytest.approx(bell.derivatives(0.3)[1] / 2, abs=1e-5)
    by_u, by_v = maps.slopes(0.6, 2.5)["wave_position"]
    jet = hill.derivatives(0.6, 0.25)
    assert (by_u, by_v) == (pytest.approx(jet[1, 0]), pytest.approx(-jet[0, 1] / 2))
    assert maps.enable(amp, False) and "amp" not in maps.evaluate(0.6)
    assert not maps.enable(kw.MapKey("amp", width=2))


def test_grids_are_evaluate_to_the_bit_in_any_split(bell, hill):
    maps = kw.MapSet()
    maps.enable(maps.define("amp", bell, u=(0, 2)))
    maps.enable(maps.define("amp", hill))
    whole = maps.grid("amp", 100, u=(0, 2))
    assert whole.shape == (101,) and whole[-1] == maps.evaluate(2)["amp"]
    assert whole[37] == maps.evaluate(37 * (2 / 100))["amp"]
    parts = [maps.grid("amp", 100, u=(0, 2), first=i, count=min(7, 101 - i)) for i in range(0, 101, 7)]
    assert np.array_equal(np.concatenate(parts), whole)
    mesh = maps.mesh("amp", 4, 2)
    assert mesh.shape == (3, 5) and mesh[1, 3] == maps.evaluate(0.75, 0.5)["amp"]


def test_current_values_are_where_no_map_is(bell):
    maps = kw.MapSet()
    maps.set_current("pan", 0.25)
    maps.set_current("position", [1, 2])
    assert maps.current("pan").tolist() == [0.25] and maps.current("position").tolist() == [1, 2, 0]
    assert maps.grid("pan", 3).tolist() == [0.25] * 4
    maps.enable(maps.define("pan", bell))
    assert maps.grid("pan", 3)[0] == bell(0) and maps.current("pan").tolist() == [0.25]


def test_what_was_defined_is_given_back(bell, hill):
    maps = kw.MapSet()
    assert maps.defined(maps.define("amp", bell, (2, 1))) == (bell, (2, 1))
    assert maps.defined(maps.define("amp", hill, v=(3, 4))) == (hill, (0, 1), (3, 4))
    assert maps.defined(kw.MapKey("pitch")) is None


def test_faults_are_told(bell):
    maps = kw.MapSet()
    with pytest.raises(kw.Error, match="the target is 'amb', none of .*did you mean 'amp'"):
        maps.define("amb", bell)
    with pytest.raises(kw.Error, match="u1 and u2 are both 1"):
        maps.define("amp", bell, (1, 1))
    with pytest.raises(kw.Error, match="n = 0"):
        maps.grid("amp", 0)
    with pytest.raises(kw.Error, match="count = -1"):
        maps.grid("amp", 4, first=6)
    with pytest.raises(kw.Error, match="n_v = -1"):
        maps.mesh("amp", 4, -1)


def test_few_straight_steps(bell):
    [(u, values, slopes)] = kw.tessellate(bell, error_db=-60)
    dense = np.linspace(0, 1, 20001)
    assert np.max(np.abs(np.interp(dense, u, values) - bell(dense))) <= 1e-3
    assert len(u) < 80 and np.all(np.diff(u) > 0) and slopes.shape == u.shape
    [(u, values, _)] = kw.tessellate(bell, max_step=0.01)
    assert np.max(np.abs(np.diff(values))) <= 0.01
    [(u, values, _)] = kw.tessellate(kw.arc(1, 0, 0.25), steps_per_u=8)
    assert len(u) == 9 and values.shape == (9, 2)
    jump = kw.Curve([0, 2, 7, 9], degree=1, knots=[0, 0, 1, 1, 2, 2], jumps=[1])
    assert [(u.tolist(), v.tolist()) for u, v, _ in kw.tessellate(jump, error_db=-90)] == [
        ([0, 1], [0, 2]), ([1, 2], [7, 9])]


def test_a_policy_is_chosen(bell):
    for policies in ({}, {"error_db": -60, "max_step": 1}):
        with pytest.raises(kw.Error, match="one of steps_per_u, error_db and max_step"):
            kw.tessellate(bell, **policies)
    with pytest.raises(kw.Error, match="max_step|size = 0"):
        kw.tessellate(bell, max_step=0)
    with pytest.raises(kw.Error) as told:
        kw.tessellate(bell, error_db=-200, max_values=10)
    assert told.value.code == "too_many_points"
