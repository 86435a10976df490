#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes base/include/knotwave/base/gauss_legendre.h and tests/dsp/fourier_reference.inc (needs mpmath).

The reference integrates B-spline curves piece by piece with 60 digits: Cox-de Boor on polynomials
with exact rationals, then integration by parts in mpmath. Run from the repository's root.
"""
from fractions import Fraction
import random

from mpmath import mp, mpf, mpc, findroot, legendre, diff, exp, pi

mp.dps = 60
GAUSS_HEADER = '''\
// SPDX-License-Identifier: MIT
// Gauss-Legendre quadrature. Written by tools/make_fourier_tables.py; do not edit.
#pragma once

namespace knotwave::base {

/// A node above the middle of [0, 1], and its weight; the node as far below has the same.
struct GaussNode {
  double distance = 0;  ///< from 1/2
  double weight = 0;
};

/// 16 nodes: polynomials up to degree 31 are integrated exactly.
inline constexpr GaussNode kGaussLegendre16[8] = {
%s};

}  // namespace knotwave::base
'''
HARMONICS = [0, 1, 2, 3, 5, 8, 13, 32, 64, 128, 300, 512, 1024, 2048]


def gauss_lines(count):
    lines = []
    for k in range(count // 2):
        near = mp.cos(pi * (k + mpf(3) / 4) / (count + mpf(1) / 2))
        x = findroot(lambda z: legendre(count, z), (near - mpf("1e-3"), near + mpf("1e-3")), solver="anderson")
        slope = diff(lambda z: legendre(count, z), x)
        weight = 2 / ((1 - x * x) * slope * slope)
        lines.append("    {%s, %s}" % (mp.nstr(x / 2, 20), mp.nstr(weight / 2, 20)))
    return lines


def poly_mul_linear(p, a, b):
    """p(t) * (a + b t)"""
    out = [Fraction(0)] * (len(p) + 1)
    for k, c in enumerate(p):
        out[k] += a * c
        out[k + 1] += b * c
    return out


def pieces(degree, points, knots):
    """(left, width, ascending powers of the local t) of every span of positive length."""
    for span in range(degree, len(points)):
        left, width = knots[span], knots[span + 1] - knots[span]
        if width == 0:
            continue
        basis = {span: [Fraction(1)]}
        for d in range(1, degree + 1):
            raised = {}
            for i in range(span - d, span + 1):
                total = [Fraction(0)] * (d + 1)
                for j, a, b in ((i, left - knots[i], width), (i + 1, knots[i + d + 1] - left, -width)):
                    gap = knots[i + d] - knots[i] if j == i else knots[i + d + 1] - knots[i + 1]
                    if j in basis and gap != 0:
                        for k, c in enumerate(poly_mul_linear(basis[j], a / gap, b / gap)):
                            total[k] += c
                raised[i] = total
            basis = raised
        poly = [Fraction(0)] * (degree + 1)
        for i, b in basis.items():
            for k, c in enumerate(b):
                poly[k] += points[i] * c
        yield left, width, poly


def coefficient(parts, u0, period, n):
    total = mpc(0)
    for left, width, poly in parts:
        h, start = mpf(width.numerator) / width.denominator / period, (mpf(left.numerator) / left.denominator - u0) / period
        c = [mpf(x.numerator) / x.denominator for x in poly]
        if n == 0:
            total += h * sum(x / (k + 1) for k, x in enumerate(c))
            continue
        s = 2j * pi * n * h
        integral, power = mpc(0), s
        while c:
            integral += (c[0] - sum(c) * exp(-s)) / power
            power *= s
            c = [k * x for k, x in enumerate(c)][1:]
        total += h * exp(-2j * pi * n * start) * integral
    return total


def wrapped(points, knots, degree):
    period, n = knots[-1] - knots[0], len(points)
    full = [knots[n - degree + k] - period for k in range(degree)] + knots + [knots[1 + k] + period for k in range(degree)]
    return points + points[:degree], full


def cases():
    rng = random.Random(1)
    number = lambda: round(rng.uniform(-1, 1), 6)
    yield "saw", 1, False, [-1.0, 1.0], [0, 0, 1, 1]
    yield "periodic cubic, 16 points", 3, True, [number() for _ in range(16)], [k / 16 for k in range(17)]
    yield "periodic cubic, 256 points", 3, True, [number() for _ in range(256)], [k / 256 for k in range(257)]
    inner = sorted(round(rng.random(), 6) for _ in range(14))
    yield "open cubic, uneven knots", 3, False, [number() for _ in range(18)], [0] * 4 + inner + [1] * 4
    yield "degree 7", 7, False, [number() for _ in range(8)], [0] * 8 + [1] * 8
    yield "degree 5, a span of 1e-5, domain 2..5", 5, False, [number() for _ in range(8)], \
        [2] * 6 + [3.5, 3.50001] + [5] * 6
    yield "square with a declared jump", 1, False, [1.0, 1.0, -1.0, -1.0], [0, 0, 0.5, 0.5, 1, 1]


def main():
    with open("base/include/knotwave/base/gauss_legendre.h", "w") as file:
        file.write(GAUSS_HEADER % ",\n".join(gauss_lines(16)))
    with open("tests/dsp/fourier_reference.inc", "w") as file:
        file.write("// SPDX-License-Identifier: MIT\n// Written by tools/make_fourier_tables.py: name, degree, periodic, points, knots, {n, re, im}.\n")
        for name, degree, periodic, points, knots in cases():
            p, k = [Fraction(x) for x in points], [Fraction(x) for x in knots]
            if periodic:
                p, k = wrapped(p, k, degree)
            parts = list(pieces(degree, p, k))
            u0, period = mpf(knots[0]), mpf(knots[-1]) - mpf(knots[0])
            file.write('{"%s", %d, %s,\n {%s},\n {%s},\n {' % (
                name, degree, "true" if periodic else "false", ", ".join(map(repr, points)), ", ".join(map(repr, knots))))
            for n in HARMONICS:
                c = mp.chop(coefficient(parts, u0, period, n), tol=mpf("1e-50"))
                file.write("{%d, %s, %s}, " % (n, mp.nstr(c.real, 20), mp.nstr(c.imag, 20)))
            file.write("}},\n")


if __name__ == "__main__":
    main()
