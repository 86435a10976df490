#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the pictures of docs/nurbs-for-musicians.md by the commands it prints: those of its plot commands into
docs/pictures/musicians, and what it shows of the gallery into docs/pictures/gallery.

    tools/make_musician_pictures.py [FOLDER]    with knotwave-curve and gallery; build/dev/bin by default
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs/pictures"


def main():
    programs = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/dev/bin").resolve()
    page = (ROOT / "docs/nurbs-for-musicians.md").read_text()
    for folder in ("musicians", "gallery"):
        (PICTURES / folder).mkdir(exist_ok=True)
    for curve, name in re.findall(r"^knotwave-curve plot (\S+) -o out/(\S+)$", page, re.M):
        subprocess.check_call([programs / "knotwave-curve", "plot", curve, "-o", PICTURES / "musicians" / name], cwd=ROOT)
    with tempfile.TemporaryDirectory() as made:
        subprocess.check_call([programs / "gallery", made])
        for name in re.findall(r"pictures/gallery/(\S+)\)", page):
            shutil.copyfile(pathlib.Path(made) / name, PICTURES / "gallery" / name)


if __name__ == "__main__":
    main()
