#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/curves/references.txt: curves with their values and derivatives, exact and
then rounded once to the nearest double.

An oracle from outside: rational arithmetic (fractions.Fraction), and another algorithm than ours.
The Cox-de Boor recursion runs on truncated power series in h = x - u, numerator and denominator are
summed as series and divided as series; k! times coefficient k is the k-th derivative. Standard
library only.

    tools/make_curve_references.py            writes the file
    tools/make_curve_references.py --check    exit 1 if the file is not what would be written

Format, one record a line, numbers as hexadecimal floats:
    curve DEGREE DIM PERIODIC      starts a curve; then knots, points, weights (may be empty) and
    knots ...                      jumps, as a curve file has them
    at U SIDE VALUES...            SIDE L or R; value, then derivatives, DIM numbers each
"""
import itertools
import math
import pathlib
import random
import sys
from fractions import Fraction

ORDER = 3  # derivatives in the file
TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/references.txt"


def series_times_linear(series, constant, slope):
    """series * (constant + slope h), cut off after h^ORDER."""
    out = [constant * c for c in series]
    for k in range(ORDER):
        out[k + 1] += slope * series[k]
    return out


def basis_series(knots, i, degree, u, span, known):
    """N_{i,degree} as a power series around u, on the polynomial piece of span `span`."""
    if (i, degree) in known:
        return known[i, degree]
    if degree == 0:
        series = [Fraction(int(i == span))] + [Fraction(0)] * ORDER
    else:
        series = [Fraction(0)] * (ORDER + 1)
        width = knots[i + degree] - knots[i]
        if width:
            left = basis_series(knots, i, degree - 1, u, span, known)
            part = series_times_linear(left, (u - knots[i]) / width, 1 / width)
            series = [a + b for a, b in zip(series, part)]
        width = knots[i + degree + 1] - knots[i + 1]
        if width:
            right = basis_series(knots, i + 1, degree - 1, u, span, known)
            part = series_times_linear(right, (knots[i + degree + 1] - u) / width, -1 / width)
            series = [a + b for a, b in zip(series, part)]
    known[i, degree] = series
    return series


def series_quotient(numerator, denominator):
    out = []
    for k in range(ORDER + 1):
        rest = numerator[k] - sum(denominator[k - j] * out[j] for j in range(k))
        out.append(rest / denominator[0])
    return out


def exact_derivatives(curve, u, side):
    """[(ORDER + 1)][dim] exact values."""
    degree, dim = curve["degree"], curve["dim"]
    knots = [Fraction(x) for x in curve["knots"]]
    points = [Fraction(x) for x in curve["points"]]
    count = len(points) // dim
    weights = [Fraction(x) for x in curve["weights"]] or [Fraction(1)] * count
    if curve["periodic"]:
        period = knots[-1] - knots[0]
        before = [k - period for k in knots[-1 - degree:-1]]
        after = [k + period for k in knots[1:1 + degree]]
        knots = before + knots + after
        points += points[:degree * dim]
        weights += weights[:degree]
        count += degree
    u = Fraction(u)
    spans = [i for i in range(degree, count) if knots[i] < knots[i + 1]]
    if side == "L":
        span = [i for i in spans if knots[i] < u][-1]
    else:
        span = [i for i in spans if knots[i] <= u][-1]
    known = {}
    total = [Fraction(0)] * (ORDER + 1)
    sums = [[Fraction(0)] * (ORDER + 1) for _ in range(dim)]
    for i in range(span - degree, span + 1):
        series = basis_series(knots, i, degree, u, span, known)
        for k in range(ORDER + 1):
            share = weights[i] * series[k]
            total[k] += share
            for c in range(dim):
                sums[c][k] += share * points[i * dim + c]
    quotients = [series_quotient(s, total) for s in sums]
    return [[quotients[c][k] * math.factorial(k) for c in range(dim)] for k in range(ORDER + 1)]


def random_knots(rng, degree, count, kind):
    inner = count - degree - 1
    if kind == "uniform":
        step = [Fraction(i, inner + 1) for i in range(1, inner + 1)]
        middle = [float(x) for x in step]
    else:
        middle = sorted(rng.random() for _ in range(inner))
    if kind == "near" and inner >= 2:
        middle[1] = middle[0] + 1e-9  # nearer than the absolute epsilons some libraries use
    if kind == "multiple" and inner >= 2:
        for i in range(1, min(inner, degree)):
            middle[i] = middle[0]
        middle.sort()
    if kind == "jump":
        for i in range(degree + 1):
            middle[i] = 0.5
        middle.sort()
    if kind == "unclamped":
        before = sorted(-rng.random() for _ in range(degree))
        after = sorted(1 + rng.random() for _ in range(degree))
        return before + [0.0] + middle + [1.0] + after
    return [0.0] * (degree + 1) + middle + [1.0] * (degree + 1)


def random_curves():
    rng = random.Random(1)
    kinds = ["random", "uniform", "near", "multiple", "unclamped", "jump", "periodic"]
    for degree in range(1, 16):
        for turn in range(3):
            kind = kinds[(degree * 3 + turn) % len(kinds)]
            dim = 1 + (degree + turn) % 4
            count = degree + 1 + rng.randrange(5)
            if kind == "jump":
                count = max(count, 2 * degree + 2)
            curve = {"degree": degree, "dim": dim, "periodic": kind == "periodic", "jumps": []}
            if kind == "periodic":
                curve["knots"] = [0.0] + sorted(rng.random() for _ in range(count - 1)) + [1.0]
            else:
                curve["knots"] = random_knots(rng, degree, count, kind)
            if kind == "jump":
                curve["jumps"] = [0.5]
            size = 10.0 ** rng.randrange(-6, 7)
            curve["points"] = [size * (2 * rng.random() - 1) for _ in range(count * dim)]
            curve["weights"] = []
            if turn == 1:
                curve["weights"] = [0.25 + rng.random() for _ in range(count)]
            if turn == 2:
                curve["weights"] = [min(1e6, max(1e-6, 10.0 ** (12 * rng.random() - 6)))
                                    for _ in range(count)]
            yield curve, rng


def seam_curves():
    """Periodic curves whose knots no period shifts to a double, some of them beside the seam."""
    rng = random.Random(2)
    for degree in range(1, 16):
        count = degree + 1 + rng.randrange(5)
        low = 2 * rng.random() - 1
        knots = [low] + sorted(low + 3 * rng.random() for _ in range(count - 1)) + [low + 3]
        if degree % 3 == 1:
            knots[1] = low + 1e-9
        if degree % 2 == 0:
            knots[-2] = knots[-1] - 1e-12
        yield {"degree": degree, "dim": 1, "periodic": True, "jumps": [], "knots": knots,
               "points": [2 * rng.random() - 1 for _ in range(count)],
               "weights": [0.25 + rng.random() for _ in range(count)]}, rng


def hexes(numbers):
    return " ".join(float(x).hex() for x in numbers)


def rounded(value):
    return value.numerator / value.denominator  # true division of ints rounds once


def text():
    lines = ["# Made by tools/make_curve_references.py; its head explains the format."]
    for curve, rng in itertools.chain(random_curves(), seam_curves()):
        lines.append(f"curve {curve['degree']} {curve['dim']} {int(curve['periodic'])}")
        for part in ("knots", "points", "weights", "jumps"):
            lines.append(f"{part} {hexes(curve[part])}".rstrip())
        low = curve["knots"][0 if curve["periodic"] else curve["degree"]]
        high = curve["knots"][-1 if curve["periodic"] else -1 - curve["degree"]]
        inner = [k for k in curve["knots"] if low < k < high]
        places = [(low, "R"), (high, "L"), (low + (high - low) * rng.random(), "R"),
                  (low + (high - low) * rng.random(), "R")]
        if inner:
            places += [(inner[0], "L"), (inner[0], "R")]
        for u, side in places:
            flat = [x for row in exact_derivatives(curve, u, side) for x in row]
            lines.append(f"at {float(u).hex()} {side} {hexes(rounded(x) for x in flat)}")
    return "\n".join(lines) + "\n"


def main():
    if sys.argv[1:] == ["--check"]:
        if TARGET.read_text() != text():
            print(f"{TARGET} is not what {sys.argv[0]} writes", file=sys.stderr)
            return 1
        return 0
    TARGET.write_text(text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
