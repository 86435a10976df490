#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/pictures/musicians/*.svg by the plot commands that docs/nurbs-for-musicians.md prints.

    tools/make_musician_pictures.py [PROGRAM]    PROGRAM is build/dev/bin/knotwave-curve by default
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/dev/bin/knotwave-curve")
    page = (ROOT / "docs/nurbs-for-musicians.md").read_text()
    folder = ROOT / "docs/pictures/musicians"
    folder.mkdir(exist_ok=True)
    for curve, name in re.findall(r"^knotwave-curve plot (\S+) -o out/(\S+)$", page, re.M):
        subprocess.check_call([program, "plot", curve, "-o", str(folder / name)], cwd=ROOT)


if __name__ == "__main__":
    main()
