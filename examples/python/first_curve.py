# SPDX-License-Identifier: MIT
"""You learn: how Python makes a curve, finds its top, plays it into an array, and hears of a fault.

Build:     cmake --preset release && cmake --build --preset release --target knotwave_python
           (on Debian after apt-get install pybind11-dev python3-dev python3-numpy)
Run:       PYTHONPATH=build/release/python python3 examples/python/first_curve.py
"""
import numpy as np

import knotwave

bell = knotwave.Curve([0, 0, 1, 0, 0], weights=[1, 1, 4, 1, 1], name="bell")
late = bell.bend(2)
top = late.value_range().high
print(f"highest: {top.value:.6f} at {top.u:.6f}")

# What an audio callback plays, in blocks of any size.
program = knotwave.compile_function(late)
block = np.empty(4, np.float32)
for first in range(0, 16, 4):
    program.render(0, 1 / 16, first=first, out=block)
    print(" ".join(f"{sample:8.6f}" for sample in block))

# Recorded data as a curve with few points, within a proved bound.
t = np.linspace(0, 1, 200)
fitted = knotwave.reduce_data(t, np.exp(-5 * t), tolerance=1e-3)
print(f"200 values, {len(fitted.curve.points)} points, error below {fitted.max_error:.1e}")

try:
    bell.insert_knot(1.5)
except knotwave.Error as error:
    print(f"{error.code}: {error}")
