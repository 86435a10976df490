#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes examples/scores/*.mid and examples/musicians/one-note.mid from the notes below. Standard library only; the same bytes each run.

The music is in the public domain and written out here from its notes: J. S. Bach, Prelude in C major
BWV 846 (1722); C. Petzold, Minuet in G, BWV Anh. 114 (before 1725); J. Pachelbel, Canon in D (about
1690). `groove`, `first-light` and `one-note` are Knotwave's own.

usage: make_scores.py EXAMPLES_FOLDER
"""
import os
import struct
import sys

QUARTER = 960


def var_len(n):
    out = [n & 127]
    n >>= 7
    while n:
        out.insert(0, 128 | (n & 127))
        n >>= 7
    return bytes(out)


class Track:
    """Events of one track, by tick."""

    def __init__(self, name, channel=1, program=None):
        self.events = []
        self.channel = channel - 1
        self.meta(0, 3, name.encode())
        if program is not None:
            self.at(0, 0xC0, program)

    def at(self, tick, status, *data):
        self.events.append((round(tick), 1, bytes([status | self.channel, *data])))

    def meta(self, tick, kind, data):
        self.events.append((round(tick), 0, bytes([0xFF, kind]) + var_len(len(data)) + data))

    def note(self, tick, length, key, velocity=80):
        """length in ticks; the note ends one tick before the next so repeated keys sound again."""
        self.at(tick, 0x90, key, velocity)
        self.events.append((round(tick + length) - 1, -1, bytes([0x80 | self.channel, key, 64])))

    def control(self, tick, number, value):
        self.at(tick, 0xB0, number, max(0, min(127, round(value))))

    def ramp(self, tick, length, number, start, end):
        """A controller moved evenly, a message for each new value."""
        steps = abs(round(end) - round(start))
        for i in range(steps + 1):
            self.control(tick + length * i / max(1, steps), number,
                         start + (end - start) * i / max(1, steps))

    def bend(self, tick, value):
        v = max(0, min(16383, round(8192 + value * 8191)))
        self.at(tick, 0xE0, v & 127, v >> 7)

    def bytes(self):
        out, last = bytearray(), 0
        for tick, _, data in sorted(self.events, key=lambda e: (e[0], e[1])):
            out += var_len(tick - last) + data
            last = tick
        out += b"\x00\xff\x2f\x00"
        return b"MTrk" + struct.pack(">I", len(out)) + bytes(out)


def conductor(name, tempos, meter=(4, 2)):
    track = Track(name)
    track.meta(0, 0x58, bytes([*meter, 24, 8]))
    for tick, bpm in tempos:
        track.meta(tick, 0x51, round(60_000_000 / bpm).to_bytes(3, "big"))
    return track


def save(folder, name, tracks):
    head = b"MThd" + struct.pack(">IHHH", 6, 1, len(tracks), QUARTER)
    path = os.path.join(folder, name + ".mid")
    with open(path, "wb") as f:
        f.write(head + b"".join(t.bytes() for t in tracks))
    print(path)


# --- BWV 846 -----------------------------------------------------------------------------------
# Each bar: the two left-hand notes and the three right-hand notes of the figure.
PRELUDE = """
60 64 67 72 76|60 62 69 74 77|59 62 67 74 77|60 64 67 72 76|60 64 69 76 81|60 62 66 69 74
59 62 67 74 79|59 60 64 67 72|57 60 64 67 72|50 57 62 66 72|55 59 62 67 71|55 58 64 67 73
53 57 62 69 74|53 56 62 65 71|52 55 60 67 72|52 53 57 60 65|50 53 57 60 65|43 50 55 59 65
48 52 55 60 64|48 55 58 60 64|41 53 57 60 64|42 48 57 60 63|44 53 59 60 62|43 53 55 59 62
43 52 55 60 64|43 50 55 60 65|43 50 55 59 65|43 51 57 60 66|43 52 55 60 67|43 50 55 60 65
43 50 55 59 65|36 48 55 58 64
"""
PRELUDE_33 = [53, 57, 60, 65, 60, 57, 60, 57, 53, 57, 53, 50, 53, 50]
PRELUDE_34 = [55, 59, 62, 65, 62, 59, 62, 59, 55, 59, 50, 53, 52, 50]


def bwv846(folder):
    sixteenth, bar = QUARTER // 4, 4 * QUARTER
    bars = [[int(k) for k in b.split()] for row in PRELUDE.split("\n") if row for b in row.split("|")]
    last = len(bars) * bar
    lead = conductor("Prelude in C major, BWV 846",
                     [(0, 66), (last, 62), (last + bar, 54), (last + 1.5 * bar, 44),
                      (last + 2 * bar, 40)])
    right, left = Track("right hand", 1, 0), Track("left hand", 2, 0)
    for i, (a, b, *top) in enumerate(bars):
        # A long arch of dynamics: rises to the dominant pedal, falls away at the end.
        swell = round(62 + 26 * (i / 23 if i < 23 else 1 - (i - 23) / 14))
        for half in range(2):
            t = i * bar + half * bar / 2
            left.note(t, 8 * sixteenth, a, swell + (4 if half == 0 else 0))
            left.note(t + sixteenth, 7 * sixteenth, b, swell - 6)
            for j in range(6):
                right.note(t + (2 + j) * sixteenth, sixteenth, top[j % 3], swell - 8 + (j % 3) * 3)
    for i, run in enumerate((PRELUDE_33, PRELUDE_34)):
        t = last + i * bar
        left.note(t, bar, 36, 60)
        left.note(t + sixteenth, bar - sixteenth, 48 - i, 54)
        for j, key in enumerate(run):
            right.note(t + (2 + j) * sixteenth, sixteenth, key, 58 - j)
    for track, key in ((left, 36), (left, 48), (right, 64), (right, 67), (right, 72)):
        track.note(last + 2 * bar, bar, key, 56)
    save(folder, "bwv846_prelude", [lead, right, left])


# --- Minuet in G -------------------------------------------------------------------------------
NOTE = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}


def key_of(word):
    return 12 * (int(word[-1]) + 1) + NOTE[word[0]] + (word[1] == "#") - (word[1] == "b")


def line(track, tick, text, velocity, detach=0.92):
    """`G4:1` is a key and its length in quarters; `+` joins the keys of a chord."""
    for word in text.split():
        keys, beats = word.split(":")
        for k in keys.split("+"):
            track.note(tick, float(beats) * QUARTER * detach, key_of(k), velocity)
        tick += float(beats) * QUARTER
    return tick


MINUET_RH = """
D5:1 G4:.5 A4:.5 B4:.5 C5:.5  D5:1 G4:1 G4:1  E5:1 C5:.5 D5:.5 E5:.5 F#5:.5  G5:1 G4:1 G4:1
C5:1 D5:.5 C5:.5 B4:.5 A4:.5  B4:1 C5:.5 B4:.5 A4:.5 G4:.5
"""
MINUET_RH_1 = "F#4:1 G4:.5 A4:.5 B4:.5 G4:.5  A4:3"
MINUET_RH_2 = "A4:1 B4:.5 A4:.5 G4:.5 F#4:.5  G4:3"
MINUET_LH_1 = """
G3+B3+D4:2 A3:1  B3:3  C4:3  B3:3  A3:3  G3:3  D4:1 B3:1 G3:1  D4:1 D3:.5 C4:.5 B3:.5 A3:.5
"""
MINUET_LH_2 = """
B3:2 A3:1  G3:1 B3:1 G3:1  C4:3  B3:1 C4:.5 B3:.5 A3:.5 G3:.5  A3:2 F#3:1  G3:2 B3:1
C4:1 D4:1 D3:1  G3:2 G2:1
"""


def minuet(folder):
    lead = conductor("Minuet in G, BWV Anh. 114", [(0, 126), (31 * 3 * QUARTER, 104)], (3, 2))
    right, left = Track("right hand", 1, 6), Track("left hand", 2, 6)
    tick = 0
    for level in (84, 70):
        start = tick
        tick = line(right, start, MINUET_RH + MINUET_RH_1, level)
        tick = line(right, tick, MINUET_RH + MINUET_RH_2, level + 4)
        line(left, line(left, start, MINUET_LH_1, level - 12), MINUET_LH_2, level - 10)
    save(folder, "petzold_minuet", [lead, right, left])


# --- Canon in D --------------------------------------------------------------------------------
GROUND = "D3:1 A2:1 B2:1 F#2:1 G2:1 D2:1 G2:1 A2:1"
CHORDS = ("D4+F#4+A4:1 C#4+E4+A4:1 D4+F#4+B4:1 C#4+F#4+A4:1 "
          "B3+D4+G4:1 A3+D4+F#4:1 B3+D4+G4:1 C#4+E4+A4:1")
CANON = [
    "F#5:1 E5:1 D5:1 C#5:1 B4:1 A4:1 B4:1 C#5:1",
    "D5:1 C#5:1 B4:1 A4:1 G4:1 F#4:1 G4:1 E4:1",
    "D4:.5 F#4:.5 A4:.5 G4:.5 F#4:.5 D4:.5 F#4:.5 E4:.5 "
    "D4:.5 B3:.5 D4:.5 A4:.5 G4:.5 B4:.5 A4:.5 G4:.5",
    "F#4:.5 D4:.5 E4:.5 C#5:.5 D5:.5 F#5:.5 A5:.5 A4:.5 "
    "B4:.5 G4:.5 A4:.5 F#4:.5 D4:.5 D5:.5 D5:.75 C#5:.25",
    "D5:.25 C#5:.25 D5:.25 D4:.25 C#4:.25 A4:.25 E4:.25 F#4:.25 "
    "D4:.25 D5:.25 C#5:.25 B4:.25 C#5:.25 F#5:.25 A5:.25 B5:.25 "
    "G5:.25 F#5:.25 E5:.25 G5:.25 F#5:.25 E5:.25 D5:.25 C#5:.25 "
    "B4:.25 A4:.25 G4:.25 F#4:.25 E4:.25 G4:.25 F#4:.25 E4:.25",
]


def canon(folder):
    turns = len(CANON) + 4
    end = turns * 8 * QUARTER
    lead = conductor("Canon in D", [(0, 58), (end - 3 * QUARTER, 50)])
    bass, keys = Track("ground", 4, 42), Track("continuo", 5, 6)
    for turn in range(turns):
        line(bass, turn * 8 * QUARTER, GROUND, 74)
        line(keys, turn * 8 * QUARTER, CHORDS, 44, 0.7)
    line(bass, end, "D2:4", 70, 0.98)
    line(keys, end, "D4+F#4+A4:4", 44, 0.98)
    voices = []
    for v in range(3):
        violin = Track("violin %d" % (v + 1), v + 1, (40, 48, 49)[v])
        violin.control(0, 10, (44, 84, 64)[v])
        tick = (v + 1) * 8 * QUARTER
        while tick < end:
            for part in CANON:
                if tick < end:
                    tick = line(violin, tick, part, 78 - 4 * v, 0.97)
        line(violin, end, ("F#5:4", "D5:4", "A4:4")[v], 72, 0.98)
        voices.append(violin)
    save(folder, "pachelbel_canon", [lead, *voices, bass, keys])


# --- groove: drums, bass, keys, pad and lead, with the controllers a player uses -------------------
CHORD = [(57, 60, 64, 67), (53, 57, 60, 64), (48, 55, 60, 64), (55, 59, 62, 65)]
ROOT = [33, 29, 36, 31]
RIFF = [(0, 0), (0.75, 0), (1.5, 12), (2.5, 0), (3, 7), (3.5, 12)]
SOLO = [[(0, 76, 1.5), (1.5, 79, .5), (2, 81, 1), (3, 79, 1)],
        [(0, 84, 1), (1, 81, .5), (1.5, 79, .5), (2, 76, 2)]]


def drum_bar(drums, t, b):
    eighth = QUARTER / 2
    for i in range(8):
        opened = i == 7 and b % 4 == 3
        drums.note(t + i * eighth, eighth / 2, 46 if opened else 42, 78 if i % 2 == 0 else 56)
    for beat, key, level in ((0, 36, 104), (2.5, 36, 104), (1, 38, 98), (3, 38, 98)):
        drums.note(t + beat * QUARTER, eighth, key, level)
    if b % 4 == 3:
        for i, key in enumerate((48, 47, 45, 43)):
            drums.note(t + (3 + i / 4) * QUARTER, eighth / 2, key, 88 + 3 * i)
    if b % 4 == 0:
        drums.note(t, QUARTER, 49, 84)


def groove(folder):
    eighth, bar = QUARTER / 2, 4 * QUARTER
    lead = conductor("Groove", [(0, 104)])
    drums, bass = Track("drums", 10), Track("bass", 2, 38)
    keys, pad, solo = Track("keys", 3, 4), Track("pad", 4, 89), Track("lead", 5, 81)
    for track in (bass, keys, pad, solo):
        track.control(0, 7, 100)
    for b in range(12):
        t = b * bar
        drum_bar(drums, t, b)
        for i, (beat, up) in enumerate(RIFF):
            bass.note(t + beat * QUARTER, eighth * 0.8, ROOT[b % 4] + up, 96 - 6 * (i % 3))
        if b >= 2:
            for beat in (0.5, 1.5, 2.75):
                for k in CHORD[b % 4]:
                    keys.note(t + beat * QUARTER, eighth * 0.9, k, 66)
        if b >= 4:
            for k in CHORD[b % 4]:
                pad.note(t, bar * 0.98, k + 12, 58)
            pad.ramp(t, bar, 74, 40 + 5 * b, 45 + 5 * b)
            for beat, key, beats in SOLO[b % 2]:
                solo.note(t + beat * QUARTER, beats * QUARTER * 0.96, key, 90)
            solo.ramp(t + 2 * QUARTER, QUARTER * 1.8, 1, 0, 90)
            solo.control(t + 3.9 * QUARTER, 1, 0)
            for i in range(9):
                solo.bend(t + i * QUARTER / 64, -0.5 + i / 16)
    save(folder, "groove", [lead, drums, bass, keys, pad, solo])


# --- first light: the same four notes, four times, 8 seconds ---------------------------------------
def first_light(folder):
    lead = conductor("First light", [(0, 120)])
    track = Track("first light", 1)
    for turn in range(4):
        t = turn * 4 * QUARTER
        track.at(t, 0xC0, turn)
        for i, key in enumerate((60, 67, 76, 71)):
            track.note(t + i * QUARTER, QUARTER * 0.94, key, 96)
    # Third time the weight, fourth time the place on the surface, each from one end to the other.
    track.control(8 * QUARTER - 4, 1, 0)
    track.ramp(8 * QUARTER, 4 * QUARTER - 8, 1, 0, 127)
    track.control(12 * QUARTER - 4, 1, 0)
    track.ramp(12 * QUARTER, 4 * QUARTER - 8, 1, 0, 127)
    save(folder, "first-light", [lead, track])


# --- one note: A3 for 4 seconds -------------------------------------------------------------------
def one_note(folder):
    track = Track("one note", 1)
    track.note(0, 8 * QUARTER, 57, 127)
    save(folder, "one-note", [conductor("One note", [(0, 120)]), track])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    scores, musicians = (os.path.join(sys.argv[1], name) for name in ("scores", "musicians"))
    for folder in (scores, musicians):
        os.makedirs(folder, exist_ok=True)
    for make in (first_light, bwv846, minuet, canon, groove):
        make(scores)
    one_note(musicians)


if __name__ == "__main__":
    main()
