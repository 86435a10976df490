#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the manual pages and the shell completions of our programs from what they print for --help.

    tools/program_pages.py PROGRAM_DIR [OUT_DIR [PROGRAM...]]

PROGRAM_DIR holds the programs, build/release/bin for one; without names all knotwave-* in it are meant. Below
OUT_DIR, which is this repository by default, docs/man/NAME.1 and completions/{bash,zsh,fish}/ are written anew, and
pages of no such program go.
"""
import pathlib
import subprocess
import sys

from completions import bash_completion, fish_completion, zsh_completion
from man_page import man_page
from program_help import read_help

ROOT = pathlib.Path(__file__).resolve().parent.parent


def pages_of(folder, names):
    """{path: text} for the programs in `folder` of these names."""
    pages = {}
    for name in names:
        help = read_help(folder / name)
        version = version_of(folder / name)
        pages[f"docs/man/{name}.1"] = man_page(help, version, [other for other in names if other != name])
        pages[f"completions/bash/{name}"] = bash_completion(help)
        pages[f"completions/zsh/_{name}"] = zsh_completion(help)
        pages[f"completions/fish/{name}.fish"] = fish_completion(help)
    return pages


def version_of(program):
    return subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1]).resolve()
    out = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT
    names = sorted(sys.argv[3:] or (path.name for path in folder.glob("knotwave-*")))
    if not names:
        sys.exit(f"program_pages.py: no knotwave-* in {folder}")
    pages = pages_of(folder, names)
    for kind in ("docs/man", "completions/bash", "completions/zsh", "completions/fish"):
        (out / kind).mkdir(parents=True, exist_ok=True)
        for old in (out / kind).iterdir():
            if f"{kind}/{old.name}" not in pages:
                old.unlink()
    for path, text in pages.items():
        (out / path).write_text(text)


if __name__ == "__main__":
    main()
