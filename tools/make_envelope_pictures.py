#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The two pictures of docs/envelopes.md, as SVG: places on a curve, and a join.

The curve is the cubic of tests/dsp/envelope_test.cpp's kind: attack, decay, sustain, release in
three Bezier spans. Only the standard library. Run: tools/make_envelope_pictures.py
"""
import os

OUT = os.path.join(os.path.dirname(__file__), "..", "docs", "pictures")
SPANS = [  # start, length in seconds, points
    (0.0, 0.3, (0, 0, 1, 1)),
    (0.3, 0.4, (1, 1, 0.6, 0.6)),
    (0.7, 0.6, (0.6, 0.6, 0, 0)),
]
INK, SOFT, RED, BLUE = "#222222", "#999999", "#c0392b", "#2566a8"


def bezier(p, t):
    w = 1 - t
    return p[0] * w**3 + 3 * p[1] * w * w * t + 3 * p[2] * w * t * t + p[3] * t**3


def slope(p, length, t):
    w = 1 - t
    d = 3 * (w * w * (p[1] - p[0]) + 2 * w * t * (p[2] - p[1]) + t * t * (p[3] - p[2]))
    return d / length


class Picture:
    def __init__(self, seconds, width=720, height=300):
        self.seconds, self.width, self.height, self.parts = seconds, width, height, []
        self.axes()

    def xy(self, t, y):
        return 50 + t / self.seconds * (self.width - 70), self.height - 40 - y * (self.height - 80)

    def line(self, points, color, width=2.0, dash=""):
        text = " ".join("%.1f,%.1f" % self.xy(t, y) for t, y in points)
        dash = ' stroke-dasharray="%s"' % dash if dash else ""
        self.parts.append('<polyline points="%s" fill="none" stroke="%s" stroke-width="%g"%s/>'
                          % (text, color, width, dash))

    def dot(self, t, y, color, label="", dx=8, dy=-8):
        x, z = self.xy(t, y)
        self.parts.append('<circle cx="%.1f" cy="%.1f" r="4" fill="%s"/>' % (x, z, color))
        if label:
            self.text(x + dx, z + dy, label, color)

    def text(self, x, y, label, color=INK, anchor="start"):
        self.parts.append('<text x="%.1f" y="%.1f" fill="%s" text-anchor="%s">%s</text>'
                          % (x, y, color, anchor, label))

    def mark(self, t, label):
        self.line([(t, 0), (t, 1.04)], SOFT, 1, "3 4")
        x, y = self.xy(t, 1.04)
        self.text(x, y - 4, label, INK, "middle")

    def axes(self):
        self.line([(0, 0), (self.seconds, 0)], SOFT, 1)
        self.line([(0, 0), (0, 1)], SOFT, 1)
        for y in (0, 1):
            x, z = self.xy(0, y)
            self.text(x - 8, z + 4, str(y), INK, "end")
        x, y = self.xy(self.seconds, 0)
        self.text(x, y + 18, "time", INK, "end")

    def save(self, name, title):
        head = ('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif"'
                ' font-size="13">\n<title>%s</title>\n<rect width="100%%" height="100%%" fill="white"/>'
                % (self.width, self.height, title))
        with open(os.path.join(OUT, name), "w", encoding="utf-8") as file:
            file.write(head + "\n" + "\n".join(self.parts) + "\n</svg>\n")


def span_path(span, start, first=0.0, last=1.0):
    begin, length, p = span
    steps = 60
    ts = [first + (last - first) * i / steps for i in range(steps + 1)]
    return [(start + t * length, bezier(p, t)) for t in ts]


def places():
    picture = Picture(1.9)
    hold = 0.5
    picture.line(span_path(SPANS[0], 0.0), BLUE)
    picture.line(span_path(SPANS[1], 0.3), BLUE)
    picture.line([(0.7, 0.6), (0.7 + hold, 0.6)], RED)
    picture.line(span_path(SPANS[2], 0.7 + hold), BLUE)
    picture.mark(0.0, "gate on")
    picture.mark(0.7, "sustain")
    picture.mark(0.7 + hold, "gate off")
    x, y = picture.xy(0.95, 0.6)
    picture.text(x, y - 10, "the place stands, time goes on", RED, "middle")
    picture.dot(1.8, 0, BLUE, "idle", -4, -10)
    picture.save("envelope-places.svg", "An envelope held at its sustain knot and released")


def join():
    picture = Picture(1.25)
    _, length, attack = SPANS[0]
    fall_slope = slope(SPANS[1][2], SPANS[1][1], 0.6)
    value = bezier(SPANS[1][2], 0.6)
    again = 0.3 + 0.6 * SPANS[1][1]
    picture.line(span_path(SPANS[0], 0.0), SOFT)
    picture.line(span_path(SPANS[1], 0.3, 0, 0.6), SOFT)
    picture.line(span_path(SPANS[0], again), SOFT, 1.5, "5 4")
    joined = (value, value + fall_slope * length / 3, attack[2], attack[3])
    polygon = [(again + i * length / 3, p) for i, p in enumerate(joined)]
    picture.line(polygon, RED, 1, "2 3")
    picture.line(span_path((again, length, joined), again), BLUE, 2.5)
    picture.line(span_path(SPANS[1], again + length), BLUE, 2.5)
    picture.mark(again, "gate on again")
    picture.dot(polygon[0][0], joined[0], RED, "P0: the value", 6, -12)
    picture.dot(polygon[1][0], joined[1], RED, "P1: the slope", 8, 16)
    picture.dot(polygon[2][0], joined[2], RED, "P2", -6, -10)
    picture.dot(polygon[3][0], joined[3], RED, "P3", 4, -10)
    x, y = picture.xy(again + 0.14, 0.16)
    picture.text(x, y, "the attack from rest", SOFT)
    picture.save("envelope-join.svg", "A retrigger moves the first two control points")


if __name__ == "__main__":
    os.makedirs(OUT, exist_ok=True)
    places()
    join()
