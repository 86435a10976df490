#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/golden/tick_clock.tsv: ticks and their sample times by exact fractions.

usage: make_tick_clock_golden.py > tests/golden/tick_clock.tsv
Columns: division (ticks a quarter, or fps:ticks a frame), rate in Hz, tempo map
(tick:microseconds, joined by commas, or -), tick, sample, fraction in 2^-32."""
import random
from fractions import Fraction

LAST = 1 << 62


def sample_time(division, rate, tempos, tick):
    if ":" in division:
        fps, ticks = map(int, division.split(":"))
        frames = Fraction(30000, 1001) if fps == 29 else Fraction(fps)
        samples = Fraction(tick) * rate / (frames * ticks)
    else:
        samples, at, us = Fraction(0), 0, 500000
        for change, next_us in tempos:
            if change > tick:
                break
            samples += Fraction((change - at) * us * rate, 10**6 * int(division))
            at, us = change, next_us
        samples += Fraction((tick - at) * us * rate, 10**6 * int(division))
    whole = samples.__floor__()
    if whole >= LAST:
        return LAST, 0
    return whole, ((samples - whole) * 2**32).__floor__()


def main():
    rng = random.Random(1)
    print("division\trate_hz\ttempos\ttick\tsample\tfraction")
    for case in range(60):
        smpte = case % 4 == 0
        division = (f"{rng.choice([24, 25, 29, 30])}:{rng.randint(1, 255)}" if smpte
                    else str(rng.choice([1, 24, 96, 480, 960, 32767, rng.randint(1, 32767)])))
        rate = rng.choice([1, 8000, 44100, 48000, 96000, 768000])
        top = 1 << rng.choice([8, 16, 32, 52, 64])
        tempos = sorted((rng.randrange(top), rng.choice([1, 16777215, rng.randint(1, 10**6)]))
                        for _ in range(rng.randint(0, 6)))
        # equal ticks: the later entry holds, which a stable sort by tick alone keeps
        text = ",".join(f"{t}:{us}" for t, us in tempos) or "-"
        ticks = sorted({0, top - 1, *(rng.randrange(top) for _ in range(5)),
                        *(t for t, _ in tempos)})
        for tick in ticks:
            sample, fraction = sample_time(division, rate, tempos, tick)
            print(division, rate, text, tick, sample, fraction, sep="\t")


main()
