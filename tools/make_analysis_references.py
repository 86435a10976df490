#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/curves/analysis.txt: curves with their ranges, roots, variation, nearest
places, areas and lengths, right to 30 digits and then rounded to the nearest double.

An oracle from outside: each span becomes a fraction of polynomials by the Cox-de Boor recursion in
rationals (exact_curves.py); roots are those of mpmath's polyroots at 40 digits, areas under weights
and lengths those of its tanh-sinh quadrature. Needs mpmath.

    tools/make_analysis_references.py            writes the file
    tools/make_analysis_references.py --check    exit 1 if the file is not what would be written

Format, one record a line, numbers as hexadecimal floats:
    curve DEGREE DIM PERIODIC      starts a curve; then knots, points, weights (may be empty), jumps
    range LOW HIGH                 of coordinate 0
    variation X                    of coordinate 0
    roots VALUE U...               where coordinate 0 takes VALUE
    nearest POINT... DISTANCE U
    area A B X                     of coordinate 0
    length A B X                   of the path; of the graph (u, C(u)) for one coordinate
"""
import itertools
import pathlib
import random
import sys
from fractions import Fraction

import mpmath

from exact_curves import basis_series, curve_records, expanded, hexes, random_knots, write_or_check

mpmath.mp.dps = 40
TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/analysis.txt"


def big(x):
    return mpmath.mpf(x.numerator) / x.denominator if isinstance(x, Fraction) else mpmath.mpf(x)


class Span:
    """Over [low, high]: coordinate c is tops[c] / bottom, powers of h = u - low, lowest first."""

    def __init__(self, curve, knots, index, points, weights):
        degree, dim = curve["degree"], curve["dim"]
        self.low, self.high = knots[index], knots[index + 1]
        known = {}
        self.tops = [[Fraction(0)] * (degree + 1) for _ in range(dim)]
        self.bottom = [Fraction(0)] * (degree + 1)
        for i in range(index - degree, index + 1):
            series = basis_series(knots, i, degree, self.low, index, known, degree)
            for k in range(degree + 1):
                self.bottom[k] += weights[i] * series[k]
                for c in range(dim):
                    self.tops[c][k] += weights[i] * series[k] * points[i * dim + c]

    def length(self):
        return self.high - self.low

    def at(self, h, c=0):
        return value(self.tops[c], h) / value(self.bottom, h)

    def slope_top(self, c):
        """Of the derivative, over bottom^2."""
        return minus(times(slope(self.tops[c]), self.bottom), times(self.tops[c], slope(self.bottom)))


def value(p, h):
    return mpmath.polyval([big(c) for c in reversed(p)], h)


def slope(p):
    return [k * c for k, c in enumerate(p)][1:] or [Fraction(0)]


def times(a, b):
    out = [Fraction(0)] * (len(a) + len(b) - 1)
    for i, j in itertools.product(range(len(a)), range(len(b))):
        out[i + j] += a[i] * b[j]
    return out


def plus(a, b):
    return [x + y for x, y in itertools.zip_longest(a, b, fillvalue=Fraction(0))]


def minus(a, b):
    return plus(a, [-y for y in b])


def roots_in(p, length):
    """Real roots strictly inside (0, length)."""
    while p and p[-1] == 0:
        p = p[:-1]
    if len(p) < 2:
        return []
    found = mpmath.polyroots([big(c) for c in reversed(p)], maxsteps=2000, extraprec=300)
    real = [mpmath.re(r) for r in found if abs(mpmath.im(r)) < mpmath.mpf(10) ** -25]
    return sorted(r for r in real if 0 < r < big(length))


def spans_of(curve):
    degree = curve["degree"]
    knots, points, weights = expanded(curve)
    return [Span(curve, knots, i, points, weights)
            for i in range(degree, len(weights)) if knots[i] < knots[i + 1]]


def ups_and_downs(spans):
    """Values of coordinate 0 in order, limits at knots and turns."""
    for span in spans:
        turns = roots_in(span.slope_top(0), span.length())
        for h in [mpmath.mpf(0)] + turns + [big(span.length())]:
            yield span.at(h)


def crossings(spans, level):
    for span in spans:
        p = minus(span.tops[0], [Fraction(level) * w for w in span.bottom])
        for h in roots_in(p, span.length()):
            yield big(span.low) + h


def nearest(spans, point):
    best = None
    for span in spans:
        foot = [Fraction(0)]
        offsets = [minus(top, [Fraction(q) * w for w in span.bottom])
                   for top, q in zip(span.tops, point)]
        for c, d in enumerate(offsets):
            foot = plus(foot, times(d, span.slope_top(c)))
        for h in [mpmath.mpf(0)] + roots_in(foot, span.length()) + [big(span.length())]:
            far = mpmath.sqrt(sum((value(d, h) / value(span.bottom, h)) ** 2 for d in offsets))
            if best is None or far < best[0]:
                best = far, big(span.low) + h
    return best


def sum_over(spans, a, b, amount):
    """Of amount(span, from, to) over the spans' parts between a and b."""
    total = mpmath.mpf(0)
    for span in spans:
        low, high = max(Fraction(a), span.low), min(Fraction(b), span.high)
        if low < high:
            total += amount(span, big(low - span.low), big(high - span.low))
    return total


def area(span, low, high):
    if any(span.bottom[1:]):
        return mpmath.quad(span.at, [low, high])
    powers = [Fraction(0)] + [c / span.bottom[0] / (k + 1) for k, c in enumerate(span.tops[0])]
    return value(powers, high) - value(powers, low)


def length(span, low, high):
    tops = [span.slope_top(c) for c in range(len(span.tops))]

    def speed(h):
        square = sum(value(top, h) ** 2 for top in tops) / value(span.bottom, h) ** 4
        return mpmath.sqrt(square + 1 if len(tops) == 1 else square)

    return mpmath.quad(speed, mpmath.linspace(low, high, 9))


def some_curves():
    rng = random.Random(11)
    kinds = ["random", "multiple", "unclamped", "jump", "periodic", "random"]
    for degree in (1, 2, 3, 4, 6):
        for turn, kind in enumerate(kinds):
            dim = 1 + (degree + turn) % 3
            count = degree + 2 + rng.randrange(4)
            if kind == "jump":
                count = max(count, 2 * degree + 2)
            curve = {"degree": degree, "dim": dim, "periodic": kind == "periodic",
                     "jumps": [0.5] if kind == "jump" else []}
            if kind == "periodic":
                curve["knots"] = [0.0] + sorted(rng.random() for _ in range(count - 1)) + [1.0]
            else:
                curve["knots"] = random_knots(rng, degree, count, kind)
            curve["points"] = [2 * rng.random() - 1 for _ in range(count * dim)]
            curve["weights"] = [0.25 + 2 * rng.random() for _ in range(count)] if turn % 2 else []
            yield curve, rng


def text():
    lines = ["# Made by tools/make_analysis_references.py; its head explains the format."]
    for curve, rng in some_curves():
        lines += curve_records(curve)
        spans = spans_of(curve)
        values = list(ups_and_downs(spans))
        lines.append("range " + hexes([min(values), max(values)]))
        lines.append("variation " + hexes([sum(abs(b - a) for a, b in zip(values, values[1:]))]))
        low, high = float(min(values)), float(max(values))
        for part in (0.15, 0.5, 0.8):
            level = low + (high - low) * part
            found = list(crossings(spans, level))
            for left, right in zip(spans, spans[1:]):
                before, after = left.at(big(left.length())), right.at(mpmath.mpf(0))
                if (before - level) * (after - level) < 0 and abs(before - after) > 1e-9:
                    found.append(big(right.low))
            lines.append("roots " + hexes([level] + sorted(found)))
        for _ in range(3):
            point = [3 * rng.random() - 1.5 for _ in range(curve["dim"])]
            lines.append("nearest " + hexes(point + list(nearest(spans, point))))
        for a, b in [(0, 1), tuple(sorted([rng.random(), rng.random()]))]:
            lines.append("area " + hexes([a, b, sum_over(spans, a, b, area)]))
            lines.append("length " + hexes([a, b, sum_over(spans, a, b, length)]))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check(TARGET, text()))
