#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Values of 2-D curves as functions of time, solved with 60 digits (needs python3-mpmath).

Writes tests/golden/curves/inversion.inc: Cox-de Boor recursion and bisection, nothing in common
with the library's pieces. Run from anywhere; the output depends on nothing but this file.
"""
import pathlib
import random

from mpmath import mp, mpf

mp.dps = 60
rng = random.Random(20)


def basis(i, p, u, knots):
    if p == 0:
        last = knots[i + 1] == knots[-1] and knots[i] < knots[i + 1] and u == knots[-1]
        return mpf(1) if knots[i] <= u < knots[i + 1] or last else mpf(0)
    value = mpf(0)
    if knots[i + p] > knots[i]:
        value += (u - knots[i]) / (knots[i + p] - knots[i]) * basis(i, p - 1, u, knots)
    if knots[i + p + 1] > knots[i + 1]:
        value += ((knots[i + p + 1] - u) / (knots[i + p + 1] - knots[i + 1])
                  * basis(i + 1, p - 1, u, knots))
    return value


def bezier(points, weights, t):
    row = [(w * x, w * y, w) for (x, y), w in zip(points, weights)]
    while len(row) > 1:
        row = [tuple((1 - t) * a + t * b for a, b in zip(l, r)) for l, r in zip(row, row[1:])]
    return row[0][0] / row[0][2], row[0][1] / row[0][2]


class Curve:
    def __init__(self, name, degree, points, weights=None, inner=()):
        self.name, self.degree = name, degree
        self.points = [(float(x), float(y)) for x, y in points]
        self.weights = [float(w) for w in weights] if weights else []
        self.knots = [0.0] * (degree + 1) + [float(k) for k in inner] + [1.0] * (degree + 1)
        self.exact = [(mpf(x), mpf(y)) for x, y in self.points]
        self.w = [mpf(w) for w in self.weights] or [mpf(1)] * len(points)

    def at(self, u):
        if len(self.points) == self.degree + 1:
            return bezier(self.exact, self.w, u)
        knots = [mpf(k) for k in self.knots]
        n = [basis(i, self.degree, u, knots) * w for i, w in enumerate(self.w)]
        total = sum(n)
        return (sum(b * x for b, (x, _) in zip(n, self.exact)) / total,
                sum(b * y for b, (_, y) in zip(n, self.exact)) / total)

    def y_at(self, x):
        low, high = mpf(0), mpf(1)
        for _ in range(170):
            middle = (low + high) / 2
            if self.at(middle)[0] < x:
                low = middle
            else:
                high = middle
        return self.at((low + high) / 2)[1]

    def samples(self):
        x0, x1 = self.points[0][0], self.points[-1][0]
        xs = {x0 + (x1 - x0) * rng.random() for _ in range(12)}
        for k in (3, 11, 24, 40, 52):
            xs |= {x0 + (x1 - x0) * 2.0 ** -k, x1 - (x1 - x0) * 2.0 ** -k,
                   x0 + (x1 - x0) * (0.5 + 2.0 ** -k), x0 + (x1 - x0) * (0.5 - 2.0 ** -k)}
        return sorted(x for x in xs if x0 <= x <= x1)


def easing(name, x1, y1, x2, y2):
    return Curve(name, 3, [(0, 0), (x1, y1), (x2, y2), (1, 1)])


def rising(count, lowest_step):
    x, xs = rng.uniform(-1, 1), []
    for _ in range(count):
        xs.append(x)
        x += lowest_step + rng.random()
    return xs


def curves():
    yield easing("ease", .25, .1, .25, 1)
    yield easing("ease_in_out", .42, 0, .58, 1)
    yield easing("late", .9, 0, .1, 1)
    yield easing("vertical_start", 0, 1, 0, 1)
    yield easing("vertical_end", 1, 0, 1, 0)
    yield easing("vertical_inside", 1, 0, 0, 1)
    yield easing("square_root_start", 0, 0, 1 / 3, 1)
    yield easing("cube_root_start", 0, .5, 0, 1)
    yield easing("longest_first_handle", 4 / 3, 0, 2 / 3, 1)
    yield easing("longest_second_handle", 1 / 3, 0, -1 / 3, 1)
    yield Curve("maya", 3, [(1, 1), (1.5, 1.5), (4.5, 2), (5, 2)])
    yield Curve("vertical_degree_7", 7, [(0, k % 3) for k in range(7)] + [(1, 1)])
    yield Curve("shifted_vertical_inside", 3, [(.3, 0), (1.3, 0), (.3, 1), (1.3, 1)])
    yield Curve("quarter_circle", 2, [(0, 1), (1, 1), (1, 0)], [1, .5 ** .5, 1])
    for degree in (2, 3, 4, 5, 7, 10, 15):
        for rational in (False, True):
            xs = rising(degree + 1, 0.02)
            points = [(x, rng.uniform(-1, 1)) for x in xs]
            weights = [rng.uniform(.2, 4) for _ in xs] if rational else None
            yield Curve(f"degree_{degree}{'_rational' if rational else ''}", degree, points, weights)
    for degree in (1, 2, 3, 5):
        for rational in (False, True):
            xs = rising(degree + 4, 0.05)
            points = [(x, rng.uniform(-1, 1)) for x in xs]
            weights = [rng.uniform(.3, 3) for _ in xs] if rational else None
            inner = sorted(rng.uniform(.1, .9) for _ in range(3))
            yield Curve(f"spans_{degree}{'_rational' if rational else ''}", degree, points, weights,
                        inner)


def numbers(values):
    return "{" + ", ".join(repr(v) for v in values) + "}"


def main():
    out = ["// SPDX-License-Identifier: MIT",
           "// Made by tools/make_inversion_golden.py: {name, degree, points, weights, knots, {{x, y}...}}",
           "// clang-format off"]
    for curve in curves():
        rows = ", ".join("{%r, %s}" % (x, mp.nstr(curve.y_at(mpf(x)), 19)) for x in curve.samples())
        out.append('{"%s", %d, %s, %s, %s, {%s}},' % (
            curve.name, curve.degree, numbers(v for p in curve.points for v in p),
            numbers(curve.weights), numbers(curve.knots), rows))
    target = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/inversion.inc"
    target.write_text("\n".join(out) + "\n")


main()
