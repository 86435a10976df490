# SPDX-License-Identifier: MIT
"""Curves in exact rationals, for the references that tests are held to. Standard library only.

The Cox-de Boor recursion runs on truncated power series in h = x - u, numerator and denominator are
summed as series and divided as series; k! times coefficient k is the k-th derivative: another
algorithm than the library's. A curve is a dict of what a curve file has: degree, dim, periodic,
knots, points, weights (may be empty), jumps.
"""
import math
import sys
from fractions import Fraction


def series_times_linear(series, constant, slope):
    """series * (constant + slope h), as long as series."""
    out = [constant * c for c in series]
    for k in range(len(series) - 1):
        out[k + 1] += slope * series[k]
    return out


def basis_series(knots, i, degree, u, span, known, order):
    """N_{i,degree} as a power series around u to h^order, on the polynomial piece of span `span`."""
    if (i, degree) in known:
        return known[i, degree]
    if degree == 0:
        series = [Fraction(int(i == span))] + [Fraction(0)] * order
    else:
        series = [Fraction(0)] * (order + 1)
        width = knots[i + degree] - knots[i]
        if width:
            left = basis_series(knots, i, degree - 1, u, span, known, order)
            part = series_times_linear(left, (u - knots[i]) / width, 1 / width)
            series = [a + b for a, b in zip(series, part)]
        width = knots[i + degree + 1] - knots[i + 1]
        if width:
            right = basis_series(knots, i + 1, degree - 1, u, span, known, order)
            part = series_times_linear(right, (knots[i + degree + 1] - u) / width, -1 / width)
            series = [a + b for a, b in zip(series, part)]
    known[i, degree] = series
    return series


def series_quotient(numerator, denominator):
    out = []
    for k in range(len(numerator)):
        rest = numerator[k] - sum(denominator[k - j] * out[j] for j in range(k))
        out.append(rest / denominator[0])
    return out


def expanded_knots(knots, degree, periodic):
    """In rationals; those of a period go on to both sides."""
    knots = [Fraction(x) for x in knots]
    if not periodic:
        return knots
    period = knots[-1] - knots[0]
    before = [k - period for k in knots[-1 - degree:-1]]
    after = [k + period for k in knots[1:1 + degree]]
    return before + knots + after


def expanded(curve):
    """Knots, points and weights in rationals; those of a periodic curve as if it were not."""
    degree, dim = curve["degree"], curve["dim"]
    points = [Fraction(x) for x in curve["points"]]
    weights = [Fraction(x) for x in curve["weights"]] or [Fraction(1)] * (len(points) // dim)
    if curve["periodic"]:
        points += points[:degree * dim]
        weights += weights[:degree]
    return expanded_knots(curve["knots"], degree, curve["periodic"]), points, weights


def span_at(knots, degree, u, side):
    """Index of the span that begins at or before u, or (side L) before it."""
    spans = [i for i in range(degree, len(knots) - degree - 1) if knots[i] < knots[i + 1]]
    if side == "L":
        return [i for i in spans if knots[i] < u][-1]
    return [i for i in spans if knots[i] <= u][-1]


def weighted_series(curve, u, side, order):
    """Numerators [dim][order + 1] and weight [order + 1] as power series around u."""
    degree, dim = curve["degree"], curve["dim"]
    knots, points, weights = expanded(curve)
    u = Fraction(u)
    span = span_at(knots, degree, u, side)
    known = {}
    total = [Fraction(0)] * (order + 1)
    sums = [[Fraction(0)] * (order + 1) for _ in range(dim)]
    for i in range(span - degree, span + 1):
        series = basis_series(knots, i, degree, u, span, known, order)
        for k in range(order + 1):
            share = weights[i] * series[k]
            total[k] += share
            for c in range(dim):
                sums[c][k] += share * points[i * dim + c]
    return sums, total


def exact_derivatives(curve, u, side, order):
    """[order + 1][dim] exact values."""
    sums, total = weighted_series(curve, u, side, order)
    quotients = [series_quotient(s, total) for s in sums]
    return [[quotient[k] * math.factorial(k) for quotient in quotients] for k in range(order + 1)]


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


def hexes(numbers):
    return " ".join(float(x).hex() for x in numbers)


def rounded(value):
    return value.numerator / value.denominator  # true division of ints rounds once


def curve_records(curve):
    """The lines of a curve in tests/golden/curves/*.txt."""
    yield f"curve {curve['degree']} {curve['dim']} {int(curve['periodic'])}"
    for part in ("knots", "points", "weights", "jumps"):
        yield f"{part} {hexes(curve[part])}".rstrip()


def write_or_check(target, text):
    """Writes the file, or with --check compares it; what the program exits with."""
    if sys.argv[1:] != ["--check"]:
        target.write_text(text)
    elif target.read_text() != text:
        print(f"{target} is not what {sys.argv[0]} writes", file=sys.stderr)
        return 1
    return 0
