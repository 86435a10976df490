#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The two constants of the equal-power law (dsp/src/crossfade.cpp).

The rational quarter circle, seen from its middle, is tan(angle / 2) = k v with k = sqrt(2) - 1 and
v in -1..1, where angle runs from -45 to 45 degrees. Its angle is linear in x when v is
tan(pi x / 8) / k. This script fits v = x (1 + (x^2 - 1) (c + b x^2)), exact at -1, 0 and 1, so that
the largest error of the angle is least (equal ripple), and prints c, b and that error.
Needs mpmath. Run: tools/make_arc_constants.py
"""
from mpmath import mp, mpf, tan, atan, sqrt, pi, degrees, findroot, diff

mp.dps = 40
K = sqrt(mpf(2)) - 1


def angle_error(x, c, b):
    """Degrees of the whole quarter circle (0..90) too far at x."""
    v = x * (1 + (x * x - 1) * (c + b * x * x))
    return degrees(2 * atan(K * v)) - 45 * x


def extrema(c, b, n=2000):
    """Local extrema of the error over 0..1."""
    xs = [mpf(i) / n for i in range(n + 1)]
    es = [angle_error(x, c, b) for x in xs]
    found = []
    for i in range(1, n):
        if (es[i] - es[i - 1]) * (es[i + 1] - es[i]) < 0:
            x = findroot(lambda t: diff(lambda s: angle_error(s, c, b), t), xs[i])
            found.append((x, angle_error(x, c, b)))
    return found


def main():
    c, b = mpf("0.0519"), mpf("0.0034")
    for _ in range(6):  # Remez: the three ripples get the same size, with signs in turn
        x = [place for place, _ in extrema(c, b)]
        ripples = lambda p, q, e: [angle_error(x[i], p, q) - (-1) ** i * e for i in range(3)]
        c, b, e = findroot(ripples, (c, b, mpf("1e-4")))
    print("c (x^3 and x^5 together) =", mp.nstr(c, 20), float(c).hex())
    print("b (x^5)                  =", mp.nstr(b, 20), float(b).hex())
    print("largest angle error      =", mp.nstr(abs(e), 6), "degrees")


if __name__ == "__main__":
    main()
