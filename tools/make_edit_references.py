#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/curves/edits.txt: curves, what is done to them, and exact values of the result.

An oracle from outside: the operation is not carried out at all. What it must give at u is computed
pointwise in rationals from the curves it starts from (the product's value is the product of two
values, that of a bent curve is the value at the bent parameter), with the Cox-de Boor recursion of
exact_curves.py, and rounded once. Standard library only.

    tools/make_edit_references.py            writes the file
    tools/make_edit_references.py --check    exit 1 if the file is not what would be written

Format, one record a line, numbers as hexadecimal floats:
    edit NAME ARGUMENTS...         starts a case
    curve DEGREE DIM PERIODIC      one or two; each then has its knots, points, weights (may be
    knots ...                      empty) and jumps, as a curve file has them
    at U SIDE VALUES...            SIDE L or R; DIM numbers of the result
"""
import pathlib
import random
import sys
from fractions import Fraction

from exact_curves import curve_records, exact_derivatives, hexes, rounded, write_or_check

TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/edits.txt"


def value(curve, u, side="R"):
    return exact_derivatives(curve, u, side, 0)[0]


def domain(curve):
    knots, p = curve["knots"], curve["degree"]
    return (knots[0], knots[-1]) if curve["periodic"] else (knots[p], knots[-1 - p])


def dyadic(rng, bits=10):
    """In (0, 1), and so short that edits shift and mirror it without rounding."""
    return rng.randrange(1, 1 << bits) / (1 << bits)


def random_curve(rng, degree, dim=1, kind="random", rational=False, spans=3, size=1.0):
    """Over [0, 1], knots on a grid of 2^-10. Kinds: segment, random, multiple, jump, unclamped."""
    inner = [] if kind == "segment" else sorted(dyadic(rng) for _ in range(spans - 1))
    if kind == "multiple":
        inner = sorted(inner + [inner[0]] * (degree - 1))
    if kind == "jump":
        inner = sorted([x for x in inner if x != 0.5] + [0.5] * (degree + 1))
    low, high = [0.0] * (degree + 1), [1.0] * (degree + 1)
    if kind == "unclamped":
        low = sorted(-dyadic(rng) for _ in range(degree)) + [0.0]
        high = [1.0] + sorted(1 + dyadic(rng) for _ in range(degree))
    count = len(inner) + degree + 1
    return {
        "degree": degree, "dim": dim, "periodic": False,
        "knots": low + inner + high,
        "points": [size * (2 * rng.random() - 1) for _ in range(count * dim)],
        "weights": [0.25 + 4 * rng.random() for _ in range(count)] if rational else [],
        "jumps": [0.5] if kind == "jump" else [],
    }


def places(rng, *knot_lists):
    """Parameters and sides to look at: ends, both sides of some knots, between."""
    low = max(knots[0] for knots in knot_lists)
    high = min(knots[-1] for knots in knot_lists)
    inner = sorted({k for knots in knot_lists for k in knots if low < k < high})
    chosen = [(low, "R"), (high, "L")]
    chosen += [(low + (high - low) * rng.random(), "R") for _ in range(3)]
    for k in inner[:2] + inner[-1:]:
        chosen += [(k, "L"), (k, "R")]
    return chosen


def inside(curve):
    low, high = domain(curve)
    return [k for k in curve["knots"] if low <= k <= high]


KINDS = ["segment", "random", "multiple", "jump", "unclamped"]


def paces(rng):
    """reverse, reparametrize and bend: cases whose knots move without rounding."""
    for degree in (1, 2, 3, 5, 8, 15):
        for turn, kind in enumerate(KINDS):
            curve = random_curve(rng, degree, 1 + turn % 3, kind, rational=turn % 2 == 1)
            other = {"L": "R", "R": "L"}
            yield ("reverse", [], [curve],
                   [(1 - Fraction(u), other[side], value(curve, u, side))
                    for u, side in places(rng, inside(curve)) if u * 2.0 ** 40 % 1 == 0])
            yield ("reparametrize", [-3.0, 5.0], [curve],
                   [(8 * Fraction(u) - 3, side, value(curve, u, side))
                    for u, side in places(rng, inside(curve)) if u * 2.0 ** 40 % 1 == 0])
        segment = random_curve(rng, degree, 2, "segment", rational=degree % 2 == 0)
        for b in (0.3, 0.75, 1.1, 2.5):
            if b ** degree < 1e-6:
                continue
            yield ("bend", [b], [segment],
                   [(x, side, value(segment, bent(x, b), side))
                    for x, side in places(rng, inside(segment))])
    knots_of_3 = [0.25, 0.5]  # which 3 y / (1 + 2 y) makes 0.5 and 0.75
    for degree in (1, 2, 3, 4):
        curve = random_curve(rng, degree, 1, "segment", rational=degree % 2 == 1)
        curve["knots"][degree + 1:degree + 1] = knots_of_3
        curve["points"] += [rng.random(), rng.random()]
        curve["weights"] += [0.5, 2.5] if curve["weights"] else []
        yield ("bend", [3.0], [curve],
               [(x, side, value(curve, bent(x, 3), side))
                for x, side in places(rng, [0.0, 0.5, 0.75, 1.0])])


def bent(x, b):
    x, b = Fraction(x), Fraction(b)
    return x / (x + b * (1 - x))


def segments(rng):
    """to_bezier and back: the same values."""
    for degree in (1, 2, 4, 7, 15):
        for turn, kind in enumerate(KINDS):
            curve = random_curve(rng, degree, 2, kind, rational=turn % 2 == 0)
            yield ("from_bezier", [], [curve],
                   [(u, side, value(curve, u, side)) for u, side in places(rng, inside(curve))])


def removals(rng):
    """A knot inserted up to degree times and removed as often: the same values."""
    for degree in (1, 2, 3, 6, 10, 15):
        for turn, kind in enumerate(KINDS):
            curve = random_curve(rng, degree, 2, kind, rational=turn % 2 == 0)
            times = 1 + (degree - 1) * turn // 4
            yield ("insert_and_remove", [0.3, times], [curve],
                   [(u, side, value(curve, u, side))
                    for u, side in places(rng, inside(curve) + [0.3])])


def finer(rng):
    """refine and elevate_degree: the same values."""
    for degree in (1, 2, 3, 6, 10):
        for turn, kind in enumerate(KINDS):
            curve = random_curve(rng, degree, 2, kind, rational=turn % 2 == 0)
            knots = [0.3] * (1 + degree // 2) + [rng.random() for _ in range(5)]
            looks = [(u, side, value(curve, u, side))
                     for u, side in places(rng, inside(curve) + knots)]
            yield "refine", knots, [curve], looks
            yield "elevate_degree", [1 + rng.randrange(5)], [curve], looks
            yield "elevate_and_reduce", [], [curve], looks


def combinations(rng):
    """sum, product, join, morph, compose: values from those of the two curves."""
    for turn in range(24):
        p, q = 1 + turn % 5, 1 + turn % 4
        kind, other_kind = KINDS[turn % 5], KINDS[turn % 3]
        dim = 1 + turn % 2
        a = random_curve(rng, p, dim, kind, rational=turn % 4 == 1)
        b = random_curve(rng, q, dim, other_kind, rational=turn % 4 in (1, 2))
        looks = [(u, side) for u, side in places(rng, inside(a), inside(b))]
        both = [(u, side, value(a, u, side), value(b, u, side)) for u, side in looks]
        yield "sum", [], [a, b], [(u, s, [x + y for x, y in zip(v, w)]) for u, s, v, w in both]
        yield "product", [], [a, b], [(u, s, [x * y for x, y in zip(v, w)])
                                      for u, s, v, w in both]
        gain = random_curve(rng, q, 1, other_kind, rational=turn % 3 == 0)
        yield "product", [], [a, gain], [
            (u, side, [x * value(gain, u, side)[0] for x in value(a, u, side)])
            for u, side in places(rng, inside(a), inside(gain))]
        yield "join", [], [a, b], [(u, s, v) for u, s, v, _ in both if u < 1] + [
            (Fraction(u) + 1, s, w) for u, s, _, w in both if u > 0 and u * 2.0 ** 40 % 1 == 0]
        if not (a["weights"] or b["weights"]):
            yield "morph", [0.375], [a, b], [
                (u, s, [x * Fraction(5, 8) + y * Fraction(3, 8) for x, y in zip(v, w)])
                for u, s, v, w in both]


def compositions(rng):
    """Inner curves that cross the outer one's knots at doubles, or nowhere."""
    for turn in range(30):
        p, q = 1 + turn % 4, 1 + turn % 3
        kind = ["segment", "random", "multiple"][turn % 3]
        outer = random_curve(rng, p, 1 + turn % 2, kind, rational=turn % 4 == 1)
        inner = random_curve(rng, q, 1, "segment", rational=turn % 5 == 2)
        if kind == "segment":
            inner = random_curve(rng, q, 1, "multiple" if q > 1 else "random", turn % 5 == 2)
            inner["points"] = [abs(x) for x in inner["points"]]
        else:  # u itself, or 1 - u, or u^2 over dyadic knots
            outer["knots"] = [0.0] * (p + 1) + [0.25] * (len(outer["knots"]) - 2 * p - 2) + (
                [1.0] * (p + 1))
            if len(outer["knots"]) - 2 * p - 2 > p:
                continue
            inner["weights"] = []
            inner["points"] = [[0.0, 1.0], [1.0, 0.0]][turn % 2] if q == 1 else (
                [0.0] * q + [1.0] if q == 2 else [0.0, 0.0, 0.0, 0.125])
        yield "compose", [], [outer, inner], [
            (u, side, value(outer, value(inner, u, side)[0]))
            for u, side in places(rng, inside(inner))]


def cases():
    yield from paces(random.Random(3))
    yield from segments(random.Random(4))
    yield from removals(random.Random(5))
    yield from finer(random.Random(6))
    yield from combinations(random.Random(7))
    yield from compositions(random.Random(8))


def text():
    lines = ["# Made by tools/make_edit_references.py; its head explains the format."]
    for name, arguments, operands, values in cases():
        lines.append(f"edit {name} {hexes(arguments)}".rstrip())
        for curve in operands:
            lines += curve_records(curve)
        for u, side, numbers in values:
            lines.append(f"at {float(u).hex()} {side} {hexes(rounded(x) for x in numbers)}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check(TARGET, text()))
