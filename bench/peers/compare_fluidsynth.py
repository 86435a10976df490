#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times knotwave-render against fluidsynth -F on the same MIDI files, in turn, in one run.

Both render to 16-bit WAV at 48 kHz with one thread; user + system seconds are counted, the least of
the rounds is kept for each file. FluidSynth is a program of its own: nothing of it is linked.
Needs the Debian packages fluidsynth and fluid-soundfont-gm.

usage: compare_fluidsynth.py KNOTWAVE_RENDER BANK FOLDER_OF_MIDI [ROUNDS]
"""
import os
import subprocess
import sys
import tempfile

SOUNDFONT = "/usr/share/sounds/sf2/FluidR3_GM.sf2"


def cpu_seconds(argv):
    before = os.times()
    subprocess.run(argv, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    after = os.times()
    return (after.children_user - before.children_user
            + after.children_system - before.children_system)


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    render, bank, folder = sys.argv[1:4]
    rounds = int(sys.argv[4]) if len(sys.argv) == 5 else 3
    files = sorted(os.path.join(r, f) for r, _, fs in os.walk(folder) for f in fs
                   if f.endswith(".mid"))
    if not files:
        sys.exit("no .mid below " + folder)
    ours = theirs = 0.0
    with tempfile.TemporaryDirectory() as tmp:
        out = os.path.join(tmp, "out.wav")
        for path in files:
            a = min(cpu_seconds([render, bank, path, "-o", out, "--bits", "16", "--quiet"])
                    for _ in range(rounds))
            b = min(cpu_seconds(["fluidsynth", "-ni", "-r", "48000", "-F", out, SOUNDFONT, path])
                    for _ in range(rounds))
            ours, theirs = ours + a, theirs + b
            print("%-44s knotwave %7.2f s  fluidsynth %7.2f s  ratio %5.2f"
                  % (os.path.basename(path), a, b, a / b))
    print("%d files: knotwave %.1f s, fluidsynth %.1f s, ratio %.2f" % (
        len(files), ours, theirs, ours / theirs))


if __name__ == "__main__":
    main()
