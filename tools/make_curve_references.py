#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/curves/references.txt: curves with their values and derivatives, exact and
then rounded once to the nearest double.

An oracle from outside: the rational arithmetic of exact_curves.py. Standard library only.

    tools/make_curve_references.py            writes the file
    tools/make_curve_references.py --check    exit 1 if the file is not what would be written

Format, one record a line, numbers as hexadecimal floats:
    curve DEGREE DIM PERIODIC      starts a curve; then knots, points, weights (may be empty) and
    knots ...                      jumps, as a curve file has them
    at U SIDE VALUES...            SIDE L or R; value, then derivatives, DIM numbers each
"""
import itertools
import pathlib
import random
import sys

from exact_curves import (curve_records, exact_derivatives, hexes, random_knots, rounded,
                          write_or_check)

ORDER = 3  # derivatives in the file
TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/references.txt"


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


def text():
    lines = ["# Made by tools/make_curve_references.py; its head explains the format."]
    for curve, rng in itertools.chain(random_curves(), seam_curves()):
        lines += curve_records(curve)
        low = curve["knots"][0 if curve["periodic"] else curve["degree"]]
        high = curve["knots"][-1 if curve["periodic"] else -1 - curve["degree"]]
        inner = [k for k in curve["knots"] if low < k < high]
        places = [(low, "R"), (high, "L"), (low + (high - low) * rng.random(), "R"),
                  (low + (high - low) * rng.random(), "R")]
        if inner:
            places += [(inner[0], "L"), (inner[0], "R")]
        for u, side in places:
            flat = [x for row in exact_derivatives(curve, u, side, ORDER) for x in row]
            lines.append(f"at {float(u).hex()} {side} {hexes(rounded(x) for x in flat)}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check(TARGET, text()))
