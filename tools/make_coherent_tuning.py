#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a .scl and a .kbm that tune each MIDI note to the odd multiple of RATE / SIZE nearest to it.

Over SIZE samples such a note makes a whole odd number of cycles, so that an FFT of SIZE samples needs
no window and every alias falls on a line of its own. The pitches are ratios of whole numbers, so
nothing is rounded: note n sounds at k[n] RATE / SIZE, the scale's degree n is k[n] / k[0], the mapping
is linear (size 0) from note 0, and its reference is note 0.

  tools/make_coherent_tuning.py --rate 48000 --size 65536 -o examples/tunings/coherent_48000
"""
import argparse
from fractions import Fraction


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rate", type=int, default=48000, help="sample rate in Hz")
    parser.add_argument("--size", type=int, default=65536, help="samples of the transform, a power of two")
    parser.add_argument("-o", required=True, metavar="NAME", help="writes NAME.scl and NAME.kbm")
    args = parser.parse_args()

    step = Fraction(args.rate, args.size)
    nominal = [440 * 2.0 ** ((note - 69) / 12) / float(step) for note in range(128)]
    k = [2 * int(n // 2) + 1 for n in nominal]
    reference = k[0] * step  # a binary fraction, so its decimals end
    digits = args.size.bit_length() - 1
    name = args.o.rsplit("/", 1)[-1]
    with open(args.o + ".scl", "w", encoding="ascii", newline="\n") as scl:
        scl.write(f"! {name}.scl, made by tools/make_coherent_tuning.py\n")
        scl.write(f"MIDI notes at odd multiples of {args.rate}/{args.size} Hz; use with {name}.kbm\n")
        scl.write("128\n")
        scl.writelines(f"{k[note]}/{k[0]}\n" for note in range(1, 128))
        scl.write(f"{2 * k[127]}/{k[0]}\n! the last is the interval of repetition, which no note reaches\n")
    with open(args.o + ".kbm", "w", encoding="ascii", newline="\n") as kbm:
        kbm.write(f"! {name}.kbm, made by tools/make_coherent_tuning.py\n")
        kbm.write("! size of the pattern (0: every key is the next degree), first and last note\n0\n0\n127\n")
        kbm.write("! the note of degree 0, the reference note and its frequency in Hz\n0\n0\n")
        whole, rest = divmod(reference, 1)
        kbm.write(f"{whole}.{str(int(rest * 10 ** digits)).zfill(digits)}\n! formal octave (unused)\n128\n")


if __name__ == "__main__":
    main()
