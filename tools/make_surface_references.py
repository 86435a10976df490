#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/curves/surfaces.txt: surfaces, curves they are made from, and exact values.

An oracle from outside: no edit is carried out, no surface built. What must come out at (u, v) is computed
in rationals from what went in: from the surface before the edit, or from the border curves by the
formula that defines the surface; then rounded once. Partial derivatives come from power series in two
variables. The recursion is that of exact_curves.py, curves are those of make_edit_references.py. Standard
library only.

    tools/make_surface_references.py            writes the file
    tools/make_surface_references.py --check    exit 1 if the file is not what would be written

Format, one record a line, numbers as hexadecimal floats:
    make NAME ARGUMENTS...         starts a case; one that names no operands has those of the last
    surface PU PV DIM NU NV PER    degrees, coordinates, points written along u and v, periodic along
    knots_u ...                    u; then knots, points (rows of u, one a v) and weights (may be
    knots_v ...                    empty)
    curve DEGREE DIM PERIODIC      operands that are curves, as make_edit_references.py has them
    at U SIDE V SIDE VALUES...     DIM numbers of the result; of `partials` all with k + l <= 3, k first
"""
import math
import pathlib
import random
import sys
from fractions import Fraction

import make_edit_references as edits
from exact_curves import (basis_series, curve_records, expanded_knots, hexes, rounded, span_at,
                          weighted_series, write_or_check)

TARGET = pathlib.Path(__file__).resolve().parent.parent / "tests/golden/curves/surfaces.txt"
ORDER = 3


def partials(surface, u, side_u, v, side_v, order=0):
    """[k][l][c] for k + l <= order."""
    directions = []
    for letter, at, side in (("u", u, side_u), ("v", v, side_v)):
        degree = surface["degree_" + letter]
        knots = expanded_knots(surface["knots_" + letter], degree,
                               letter == "u" and surface["periodic_u"])
        span = span_at(knots, degree, Fraction(at), side)
        known = {}
        directions.append([(i, basis_series(knots, i, degree, Fraction(at), span, known, order))
                           for i in range(span - degree, span + 1)])
    dim, count = surface["dim"], surface["count_u"]
    size = range(order + 1)
    sums = [[[Fraction(0)] * (dim + 1) for _ in size] for _ in size]
    for j, series_v in directions[1]:
        for i, series_u in directions[0]:
            place = j * count + i % count
            weight = Fraction(surface["weights"][place]) if surface["weights"] else Fraction(1)
            point = [Fraction(x) for x in surface["points"][place * dim:(place + 1) * dim]]
            for k in size:
                for l in size:
                    share = weight * series_u[k] * series_v[l]
                    for c in range(dim):
                        sums[k][l][c] += share * point[c]
                    sums[k][l][dim] += share
    out = [[[Fraction(0)] * dim for _ in size] for _ in size]
    for k in size:
        for l in range(order + 1 - k):
            for c in range(dim):
                rest = sums[k][l][c] - sum(
                    sums[i][j][dim] * out[k - i][l - j][c]
                    for i in range(k + 1) for j in range(l + 1) if i + j > 0)
                out[k][l][c] = rest / sums[0][0][dim]
    return [[[x * math.factorial(k) * math.factorial(l) for x in out[k][l]]
             for l in range(order + 1 - k)] for k in size]


def value(surface, u, v, side_u="R", side_v="R"):
    return partials(surface, u, side_u, v, side_v)[0][0]


KINDS = ["segment", "random", "multiple", "unclamped", "near", "periodic"]


def random_knots(rng, degree, kind, spans=3):
    """Over [0, 1], on a grid of 2^-10 but for `near`."""
    if kind == "periodic":
        return [0.0] + sorted(edits.dyadic(rng) for _ in range(degree + spans - 1)) + [1.0]
    if kind == "near":
        return [0.0] * (degree + 1) + [0.25, 0.25 + 1e-9] + [1.0] * (degree + 1)
    return edits.random_curve(rng, degree, 1, kind, spans=spans)["knots"]


def random_surface(rng, degree_u, degree_v, dim, kind_u="random", kind_v="random", rational=False,
                   decades=0):
    knots_u, knots_v = (random_knots(rng, degree_u, kind_u), random_knots(rng, degree_v, kind_v))
    periodic = kind_u == "periodic"
    count_u = len(knots_u) - (1 if periodic else degree_u + 1)
    count_v = len(knots_v) - degree_v - 1
    total = count_u * count_v
    weights = [0.25 + 4 * rng.random() for _ in range(total)] if rational else []
    if decades:
        weights = [10 ** (decades * (2 * rng.random() - 1)) for _ in range(total)]
    return {"degree_u": degree_u, "degree_v": degree_v, "dim": dim, "count_u": count_u,
            "count_v": count_v, "periodic_u": periodic, "knots_u": knots_u, "knots_v": knots_v,
            "points": [2 * rng.random() - 1 for _ in range(total * dim)], "weights": weights}


def varied(rng):
    """Surfaces of all kinds of knots in both directions, with and without weights."""
    turn = 0
    for degree_u, degree_v in ((1, 1), (2, 1), (3, 3), (2, 5), (7, 2), (4, 4), (1, 3)):
        for _ in range(3):
            kinds = [KINDS[turn % 6], KINDS[(turn // 2) % 5]]
            if degree_u == 1 and kinds[0] == "multiple":
                kinds[0] = "random"
            if degree_v == 1 and kinds[1] == "multiple":
                kinds[1] = "random"
            yield random_surface(rng, degree_u, degree_v, 1 + turn % 4, *kinds,
                                 rational=turn % 2 == 1)
            turn += 1


def inner(surface, letter):
    low, high = domain(surface, letter)
    return sorted({k for k in surface["knots_" + letter] if low <= k <= high})


def domain(surface, letter):
    knots, degree = surface["knots_" + letter], surface["degree_" + letter]
    if letter == "u" and surface["periodic_u"]:
        return knots[0], knots[-1]
    return knots[degree], knots[-1 - degree]


def places(rng, knots_u, knots_v, count=6):
    """Corners, knots of either direction, and between."""
    (low_u, high_u), (low_v, high_v) = (knots_u[0], knots_u[-1]), (knots_v[0], knots_v[-1])
    chosen = [(low_u, low_v), (high_u, high_v), (rng.choice(knots_u), rng.choice(knots_v))]
    while len(chosen) < count:
        u = low_u + (high_u - low_u) * rng.random()
        v = low_v + (high_v - low_v) * rng.random()
        chosen += [(u, v), (rng.choice(knots_u), v), (u, rng.choice(knots_v))]
    return chosen


def looks(rng, surface, map_place=lambda u, v: (u, v)):
    """(u, v) of the result, and the value of the surface that went in, at its own (u, v)."""
    out = []
    for u, v in places(rng, inner(surface, "u"), inner(surface, "v")):
        to = map_place(Fraction(u), Fraction(v))
        if to and all(Fraction(float(x)) == x for x in to):
            side_u = "L" if u == domain(surface, "u")[1] and not surface["periodic_u"] else "R"
            out.append((to[0], "R", to[1], "R", value(surface, wrapped(surface, u), v, side_u)))
    return out


def wrapped(surface, u):
    low, high = domain(surface, "u")
    return low if surface["periodic_u"] and u == high else u


def derivative_cases(rng):
    extreme = [random_surface(rng, 3, 2, 2, "multiple", "multiple", decades=3),
               random_surface(rng, 5, 3, 1, "random", "random", decades=6),
               random_surface(rng, 2, 2, 3, "periodic", "multiple", decades=2)]
    for surface in list(varied(rng)) + extreme:
        shown = []
        knots_u, knots_v = inner(surface, "u"), inner(surface, "v")
        for u, v in places(rng, knots_u, knots_v):
            for sides in ("RR", "LL", "LR"):
                ends = [(u, *domain(surface, "u"), sides[0]), (v, *domain(surface, "v"), sides[1])]
                if any((at == low and side == "L") or (at == high and side == "R")
                       for at, low, high, side in ends):
                    continue
                all_orders = partials(surface, u, sides[0], v, sides[1], ORDER)
                flat = [x for row in all_orders for point in row for x in point]
                shown.append((u, sides[0], v, sides[1], flat))
        yield "partials", [], [surface], shown


def edit_cases(rng):
    for surface in varied(rng):
        degrees = [surface["degree_u"], surface["degree_v"]]
        for d in (0, 1):
            low, high = domain(surface, "uv"[d])
            knots = inner(surface, "uv"[d])
            new = [0.3] * (1 + degrees[d] // 2) + [rng.random() for _ in range(3)]
            yield "refine", [d] + new, [surface], looks(rng, surface)
            yield "elevate_degree", [d, 1 + rng.randrange(3)], [surface], looks(rng, surface)
            yield "insert_and_remove", [d, 0.3, degrees[d]], [surface], looks(rng, surface)
            yield "elevate_and_reduce", [d], [surface], looks(rng, surface)
            a, b = sorted([edits.dyadic(rng), rng.choice(knots)])
            a, b = (a, b) if a < b else (low, high)

            def part(u, v, d=d, a=a, b=b):
                return (u, v) if a <= (u, v)[d] <= b and (u, v)[d] != 1 else None
            yield "sub_surface", [d, a, b], [surface], looks(rng, surface, part)

            def mirrored(u, v, d=d):
                return (1 - u, v) if d == 0 else (u, 1 - v)

            def stretched(u, v, d=d):
                return (8 * u - 3, v) if d == 0 else (u, 8 * v - 3)
            if all(k * 2.0 ** 40 % 1 == 0 for k in surface["knots_" + "uv"[d]]):
                yield "reverse", [d], [surface], looks(rng, surface, mirrored)
                yield "reparametrize", [d, -3.0, 5.0], [surface], looks(rng, surface, stretched)
            at = rng.random()
            fixed = [(u, side, v, other, value(surface, at, v) if d == 0 else value(surface, u, at))
                     for u, side, v, other, _ in looks(rng, surface)]
            yield "iso_curve", [d, at], [surface], fixed
        if not surface["periodic_u"]:
            yield "transpose", [], [surface], looks(rng, surface, lambda u, v: (v, u))


def weighted(curve, u):
    """(w x, ..., w) at u in [0, 1] of the curve's domain."""
    low, high = edits.domain(curve)
    u = low + (Fraction(high) - Fraction(low)) * Fraction(u)
    sums, total = weighted_series(curve, u, "R", 0)
    return [s[0] for s in sums] + [total[0]]


def blended(*shares):
    """Sum of factor * point."""
    return [sum(factor * point[c] for factor, point in shares) for c in range(len(shares[0][1]))]


def projected(point):
    return [x / point[-1] for x in point[:-1]]


def shape_cases(rng):
    kinds = ["segment", "random", "multiple", "unclamped"]
    for turn in range(16):
        p, q = 1 + turn % 5, 1 + turn % 3
        kind, other = kinds[turn % 4], kinds[turn % 3]
        dim = 1 + turn % 4
        a = edits.random_curve(rng, p, dim, "random" if p == 1 else kind, rational=turn % 3 == 1)
        b = edits.random_curve(rng, q, dim, "random" if q == 1 else other, rational=turn % 3 != 0)
        if turn % 4 == 3:
            b["knots"] = [8 * k - 3 for k in b["knots"]]
        grid = places(rng, [0.0, 0.5, 1.0], [0.0, 0.5, 1.0], 9)
        yield "ruled", [], [a, b], [
            (u, "R", v, "R", projected(blended((1 - Fraction(v), weighted(a, u)),
                                               (Fraction(v), weighted(b, u))))) for u, v in grid]
        corners = [2 * rng.random() - 1 for _ in range(4 * dim)]
        parts = [[Fraction(x) for x in corners[i * dim:(i + 1) * dim]] for i in range(4)]
        yield "bilinear", [dim] + corners, [], [
            (u, "R", v, "R", blended(((1 - u) * (1 - v), parts[0]), (u * (1 - v), parts[1]),
                                     ((1 - u) * v, parts[2]), (u * v, parts[3])))
            for u, v in [(Fraction(x), Fraction(y)) for x, y in grid]]
        yield coons_case(rng, dim, (p, q), (kind, other), turn % 3 == 1, grid)
        yield loft_case(rng, dim, turn)


def coons_case(rng, dim, degrees, kinds, rational, grid):
    """Clamped borders; where they are rational, with weights of 1 at their ends."""
    kinds = ["random" if kind == "unclamped" or degree == 1 else kind
             for kind, degree in zip(kinds, degrees)]
    borders = [edits.random_curve(rng, degrees[i // 2], dim, kinds[i // 2], rational=rational)
               for i in range(4)]  # bottom, top, left, right
    corner = [[2 * rng.random() - 1 for _ in range(dim)] for _ in range(4)]  # 00 10 01 11
    for border, (first, last) in zip(borders, [(0, 1), (2, 3), (0, 2), (1, 3)]):
        border["points"][:dim], border["points"][-dim:] = corner[first], corner[last]
        if rational:
            border["weights"] = [1.0] + [1 + rng.random() for _ in border["weights"][2:]] + [1.0]
    shown = []
    for u, v in grid:
        u, v = Fraction(u), Fraction(v)
        at_u = [weighted(border, u) for border in borders[:2]]
        at_v = [weighted(border, v) for border in borders[2:]]
        flat = [[Fraction(x) for x in point] + [Fraction(1)] for point in corner]
        shown.append((u, "R", v, "R", projected(blended(
            (1 - v, at_u[0]), (v, at_u[1]), (1 - u, at_v[0]), (u, at_v[1]),
            (-(1 - u) * (1 - v), flat[0]), (-u * (1 - v), flat[1]), (-(1 - u) * v, flat[2]),
            (-u * v, flat[3])))))
    return "coons", [], borders, shown


def loft_case(rng, dim, turn):
    """At the position of a row the surface is that row."""
    count = 3 + turn % 5
    degree = min(1 + turn % 4, count - 1)
    rows = [edits.random_curve(rng, 1 + (turn + i) % 3, dim, "random", spans=1 + i % 3)
            for i in range(count)]
    if turn % 2:  # weights that stay positive between rows
        for row in rows:
            row["weights"] = [1 + 0.1 * rng.random() for _ in range(len(row["points"]) // dim)]
    positions = sorted((i + 0.5 * rng.random()) / count for i in range(count))
    shown = [(u, "R", v, "R", projected(weighted(row, u)))
             for v, row in zip(positions, rows) for u in (0.0, 1.0, rng.random(), rng.random())]
    return "lofted", [degree] + positions, rows, shown


def cases():
    yield from derivative_cases(random.Random(11))
    yield from edit_cases(random.Random(12))
    yield from shape_cases(random.Random(13))


def operand_lines(operand):
    if "count_u" not in operand:
        return list(curve_records(operand))
    head = [operand[key] for key in ("degree_u", "degree_v", "dim", "count_u", "count_v")]
    return ["surface " + " ".join(str(x) for x in head + [int(operand["periodic_u"])])] + [
        f"{part} {hexes(operand[part])}".rstrip()
        for part in ("knots_u", "knots_v", "points", "weights")]


def text():
    lines = ["# Made by tools/make_surface_references.py; its head explains the format."]
    last = []
    for name, arguments, operands, shown in cases():
        lines.append(f"make {name} {hexes(arguments)}".rstrip())
        for operand in operands if operands != last else []:
            lines += operand_lines(operand)
        last = operands or last
        for u, side_u, v, side_v, numbers in shown:
            values = hexes(rounded(Fraction(x)) for x in numbers)
            lines.append(f"at {float(u).hex()} {side_u} {float(v).hex()} {side_v} {values}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check(TARGET, text()))
