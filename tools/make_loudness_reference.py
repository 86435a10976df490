#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/dsp/loudness_reference.inc: levels of a known sound by numpy, in exact sums.

    tools/make_loudness_reference.py > tests/dsp/loudness_reference.inc
"""
import math

import numpy as np

CASES = [  # rate, channels, frames, window frames, hop frames
    (48000, 1, 5000, 2400, 480),
    (44100, 2, 3001, 441, 221),
    (8000, 3, 500, 7, 7),
    (1000, 1, 20, 1, 1),
]


def sound(frames, channels):
    """Multiples of 2^-15 from a linear congruence, louder and softer."""
    state, samples = 12345, []
    for i in range(frames * channels):
        state = (state * 1103515245 + 12345) % 2**31
        loud = 1 + (i // channels) * 7 // frames
        samples.append((state // 2**15 - 2**15) // loud / 2**15)
    return np.array(samples).reshape(frames, channels)


def main():
    print("// SPDX-License-Identifier: MIT")
    print("// By tools/make_loudness_reference.py: rate, channels, frames, window, hop; then frame, rms, peak.")
    print("const Reference kReferences[] = {")
    for rate, channels, frames, window, hop in CASES:
        x = sound(frames, channels)
        print(f"    {{{rate}, {channels}, {frames}, {window}, {hop}, {{")
        for at in [*range(0, frames, hop), frames]:
            first = min(max(at - window // 2, 0), frames - 1)
            part = x[first:min(at - window // 2 + window, frames)]
            rms = math.sqrt(math.fsum((part * part).ravel()) / part.size)
            print(f"        {{{at}, {rms!r}, {float(np.abs(part).max())!r}}},")
        print("    }},")
    print("};")


if __name__ == "__main__":
    main()
