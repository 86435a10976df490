# SPDX-License-Identifier: MIT
"""What docs/python.md shows after its first example runs, and prints what it says."""
import contextlib
import io
import pathlib
import re

import numpy as np

import knotwave as kw

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"


def test_blocks_run_one_after_the_other_and_print_their_comments():
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)[1:]
    assert len(blocks) >= 2 and any("scipy" in block for block in blocks)
    names = {"knotwave": kw, "np": np, "bell": kw.Curve([0, 0, 1, 0, 0], weights=[1, 1, 4, 1, 1], name="bell")}
    for block in blocks:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(block, names)  # noqa: S102 (our own page)
        wanted = re.findall(r"^print\(.*\) +# (.*)$", block, re.M)
        assert printed.getvalue().splitlines() == wanted
