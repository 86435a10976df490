# SPDX-License-Identifier: MIT
"""NURBS curves and surfaces: made, edited, measured, and compiled to what an audio thread plays.

Arrays are numpy's, doubles in and out. Where a curve has one coordinate there is no axis for it: points [n],
values of u's own shape; else points [n, dim], values [..., dim]. What cannot be done raises knotwave.Error.

    import knotwave
    bell = knotwave.Curve([0, 0, 1, 0, 0], weights=[1, 1, 4, 1, 1])
    bell(0.5)
"""
from . import _knotwave
from ._knotwave import *  # noqa: F401,F403
from ._knotwave import __version__  # noqa: F401

__all__ = [name for name in dir(_knotwave) if not name.startswith("_")]
