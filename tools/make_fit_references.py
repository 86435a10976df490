#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/curves/fits.inc: data, and the splines that scipy and numpy make of them.

An oracle from outside: interpolation by scipy.interpolate.make_interp_spline on the knots of (9.8),
least squares with fixed ends by numpy.linalg.lstsq on scipy's design matrix over the knots of (9.69),
both worked out here from The NURBS Book. Needs numpy and scipy (Debian: python3-scipy).

    tools/make_fit_references.py            writes the file
    tools/make_fit_references.py --check    exit 1 if a number is off by more than 1e-9
"""
import pathlib
import re
import sys

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/fits.inc"


def interpolated(t, values, p):
    inner = [np.mean(t[j:j + p]) for j in range(1, len(t) - p)]
    knots = np.concatenate([[t[0]] * (p + 1), inner, [t[-1]] * (p + 1)])
    return knots, make_interp_spline(t, values, p, knots).c


def approximated(t, values, p, count):
    step = len(t) / (count - p)
    inner = []
    for j in range(1, count - p):
        i = int(j * step)
        inner.append((1 - (j * step - i)) * t[i - 1] + (j * step - i) * t[i])
    knots = np.concatenate([[t[0]] * (p + 1), inner, [t[-1]] * (p + 1)])
    basis = BSpline.design_matrix(t, knots, p).toarray()
    rest = values - basis[:, :1] * values[0] - basis[:, -1:] * values[-1]
    middle = np.linalg.lstsq(basis[1:-1, 1:-1], rest[1:-1], rcond=None)[0]
    return knots, np.concatenate([values[:1], middle, values[-1:]])


def numbers(values):
    return "{" + ", ".join(repr(float(x)) for x in np.ravel(values)) + "}"


def text():
    rng = np.random.default_rng(7)
    lines = ["// Made by tools/make_fit_references.py: {dim, degree, point_count, parameters, values, knots, points}."]
    for p, dim, n, count in [(1, 1, 5, 5), (2, 1, 7, 7), (3, 1, 12, 12), (3, 2, 9, 9), (5, 1, 14, 14),
                             (7, 2, 20, 20), (1, 1, 9, 5), (2, 2, 20, 6), (3, 1, 50, 9),
                             (3, 3, 40, 12), (5, 1, 60, 20), (4, 1, 12, 5)]:
        t = np.cumsum(rng.uniform(0.2, 1, n))
        values = rng.uniform(-1, 1, (n, dim))
        fit = interpolated if count == n else approximated
        knots, points = fit(t, values, p, *([] if count == n else [count]))
        lines.append(f"{{{dim}, {p}, {count},\n {numbers(t)},\n {numbers(values)},\n"
                     f" {numbers(knots)},\n {numbers(points)}}},")
    return "\n".join(lines) + "\n"


def main():
    if "--check" not in sys.argv[1:]:
        TARGET.write_text(text())
        return 0
    found = [[float(x) for x in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", part)]
             for part in (TARGET.read_text(), text())]
    same = len(found[0]) == len(found[1]) and np.allclose(*found, rtol=0, atol=1e-9)
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
