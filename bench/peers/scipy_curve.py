#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""SciPy on the curve of peer_curve.h: prints "name ns-per-point checksum" lines, processor time,
the least of the calls in about 0.3 s. bench/peers/compare_curves.py runs it."""
import time

import numpy as np
from scipy.interpolate import BSpline, PPoly, splev

POINTS, GRID = 16, 65536
i = np.arange(POINTS)
knots = np.clip(np.arange(POINTS + 4) - 3, 0, POINTS - 3) / (POINTS - 3)
points = 0.9 * np.sin(1.7 * i + 0.3)
weights = 1.25 + 0.75 * np.sin(2.9 * i + 1)
u = np.arange(GRID) / GRID


def measure(name, evaluate):
    evaluate()
    least, begin = float("inf"), time.process_time()
    while time.process_time() - begin < 0.3:
        before = time.process_time_ns()
        values = evaluate()
        least = min(least, time.process_time_ns() - before)
    print("%s %.17g %.17g" % (name, least / GRID, values[GRID // 3]))


def quotient(numerator, denominator):
    return lambda: numerator(u) / denominator(u)


plain = BSpline(knots, points, 3)
top, bottom = BSpline(knots, points * weights, 3), BSpline(knots, weights, 3)
measure("cubic/scipy_BSpline/batch", lambda: plain(u))
measure("rational/scipy_BSpline/batch", quotient(top, bottom))
plain_pieces = PPoly.from_spline(plain)
measure("cubic/scipy_PPoly/batch", lambda: plain_pieces(u))
measure("rational/scipy_PPoly/batch", quotient(PPoly.from_spline(top), PPoly.from_spline(bottom)))
measure("cubic/scipy_splev/batch", lambda: splev(u, (knots, points, 3)))
measure("rational/scipy_splev/batch",
        lambda: splev(u, (knots, points * weights, 3)) / splev(u, (knots, weights, 3)))
