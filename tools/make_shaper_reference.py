#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Exact means of a shaper curve over [x0, x1], for tests/dsp/shaper_test.cpp.

The curve is a cubic B-spline with uneven knots, one of them double. Points, knots and inputs are
doubles taken as exact fractions; each span becomes a polynomial by Cox - de Boor over fractions,
the integral is taken piece by piece and divided by x1 - x0, and the result is rounded once. Gaps
run from the smallest denormal to 2, on one span, across knots, and past the ends of the domain.
Run: tools/make_shaper_reference.py > tests/dsp/shaper_reference.inc
"""
import random
from fractions import Fraction as F

DEGREE = 3
KNOTS = [F(k) for k in (-1.0, -1.0, -1.0, -1.0, -0.4, 0.0, 0.3, 0.3, 1.0, 1.0, 1.0, 1.0)]
POINTS = [F(p) for p in (-0.9, -1.0, -0.2, 0.35, -0.5, 0.8, 0.95, 0.6)]


def times(p, q):
    out = [F(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            out[i + j] += a * b
    return out


def plus(p, q):
    n = max(len(p), len(q))
    return [(p[i] if i < len(p) else F(0)) + (q[i] if i < len(q) else F(0)) for i in range(n)]


def basis(i, p, span):
    """Coefficients in x of N_i,p on the span."""
    if p == 0:
        return [F(1)] if i == span else [F(0)]
    out = [F(0)]
    left, right = KNOTS[i + p] - KNOTS[i], KNOTS[i + p + 1] - KNOTS[i + 1]
    if left:
        out = plus(out, times([-KNOTS[i] / left, 1 / left], basis(i, p - 1, span)))
    if right:
        out = plus(out, times([KNOTS[i + p + 1] / right, -1 / right], basis(i + 1, p - 1, span)))
    return out


def pieces():
    for span in range(DEGREE, len(POINTS)):
        if KNOTS[span] < KNOTS[span + 1]:
            sum_ = [F(0)]
            for i in range(span - DEGREE, span + 1):
                sum_ = plus(sum_, times([POINTS[i]], basis(i, DEGREE, span)))
            yield KNOTS[span], KNOTS[span + 1], sum_


PIECES = list(pieces())


def value(x):
    if x <= KNOTS[0]:
        return POINTS[0]
    if x >= KNOTS[-1]:
        return POINTS[-1]
    for low, high, p in PIECES:
        if low <= x < high:
            return sum(c * x**k for k, c in enumerate(p))


def mean(x0, x1):
    a, b = min(x0, x1), max(x0, x1)
    if a == b:
        return value(a)
    area = max(F(0), min(b, KNOTS[0]) - a) * POINTS[0] + max(F(0), b - max(a, KNOTS[-1])) * POINTS[-1]
    for low, high, p in PIECES:
        s, t = max(a, low), min(b, high)
        if s < t:
            area += sum(c * (t ** (k + 1) - s ** (k + 1)) / (k + 1) for k, c in enumerate(p))
    return area / (b - a)


def rows():
    draw = random.Random(1)
    for gap in (0.0, 5e-324, 1e-310, 1e-300, 1e-100, 1e-30, 1e-20):
        for x0 in (0.0, gap, -gap / 2, 0.25 if gap == 0.0 else 0.0):
            yield x0, x0 + gap
    for exponent in range(-17, 1):
        for _ in range(6):
            x0 = draw.uniform(-1.1, 1.1)
            yield x0, x0 + draw.uniform(0.5, 2) * 10.0**exponent
        for knot in (-1.0, -0.4, 0.0, 0.3, 1.0):  # across each knot
            x0 = knot - draw.uniform(0.1, 1) * 10.0**exponent
            yield x0, knot + draw.uniform(0.1, 1) * 10.0**exponent
    for _ in range(40):
        yield draw.uniform(-1.5, 1.5), draw.uniform(-1.5, 1.5)


print("// SPDX-License-Identifier: MIT")
print("// Written by tools/make_shaper_reference.py: x0, x1, mean of the curve over [x0, x1].")
for x0, x1 in rows():
    print("{%s, %s, %s}," % (x0.hex(), x1.hex(), float(mean(F(x0), F(x1))).hex()))
