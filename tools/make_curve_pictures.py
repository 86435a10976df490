#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws docs/pictures/NAME.svg for every curve and surface of docs/pictures/curves.toml.

    tools/make_curve_pictures.py [PROGRAM]    PROGRAM is build/dev/bin/knotwave-curve by default
"""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CURVES = ROOT / "docs/pictures/curves.toml"


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/dev/bin/knotwave-curve")
    facts = json.loads(subprocess.check_output([program, "info", str(CURVES), "--json"]))
    for fact in facts:
        name = fact.get("curve") or fact.get("surface")
        picture = CURVES.with_name(name + ".svg")
        subprocess.check_call([program, "plot", f"{CURVES}#{name}", "-o", str(picture)])


if __name__ == "__main__":
    main()
