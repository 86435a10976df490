# SPDX-License-Identifier: MIT
"""Curves in exact fractions, independent of the library: the textbook's recursion."""
from fractions import Fraction


def number(double):
    return Fraction(float(double))


def basis(knots, degree, i, u, last):
    """N_{i,degree}(u) (The NURBS Book, (2.5)); spans are half-open but the last."""
    if degree == 0:
        inside = knots[i] <= u < knots[i + 1] or (u == last and knots[i] < u == knots[i + 1])
        return Fraction(int(inside))
    total = Fraction(0)
    if knots[i + degree] > knots[i]:
        total += (u - knots[i]) / (knots[i + degree] - knots[i]) * basis(knots, degree - 1, i, u, last)
    if knots[i + degree + 1] > knots[i + 1]:
        total += ((knots[i + degree + 1] - u) / (knots[i + degree + 1] - knots[i + 1])
                  * basis(knots, degree - 1, i + 1, u, last))
    return total


def value(degree, points, weights, knots, u):
    """C(u) of a scalar curve whose numbers are doubles."""
    points, weights, knots = ([Fraction(float(x)) for x in all_] for all_ in (points, weights, knots))
    u, last = Fraction(float(u)), knots[len(points)]
    shares = [weights[i] * basis(knots, degree, i, u, last) for i in range(len(points))]
    return sum(s * p for s, p in zip(shares, points)) / sum(shares)
