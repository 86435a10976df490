// SPDX-License-Identifier: MIT
// The C interface of the curve library: C11, or C++ from a C compiler's point of view. What each
// operation does to the last bit is said in the C++ header of the same topic,
// knotwave/curves/*.h; docs/c.md has an example.
//
// Rules, the same for every function:
// - Handles (kw_curve and so on) are opaque and immutable, but for a kw_curve_set that is being
//   filled and for a kw_map_set. Any number of threads may read one at once. There are no globals.
// - Who gets a handle, text or kw_doubles through an argument called `out` owns it, and gives it
//   back to the function whose name ends in _free. Each has its own memory: curves made from a
//   curve outlive it. What a function returns as a `const` pointer is borrowed: it lives as long as
//   the handle it came from.
// - What can fail returns a kw_status, KW_OK being 0. Then `out` is NULL (counts and numbers are
//   left as they were), and if `error` is not NULL, *error is an object with a sentence to act on,
//   which the caller frees. On success *error is NULL. What *out and *error held before is
//   overwritten, never freed.
// - What a handle is asked for without a status is 0, NULL or false if the handle is NULL; where it
//   is NULL, *count is 0. A handle that was freed must not be used or freed again.
// - Arrays are a pointer and a count of their elements (for coordinates: of numbers, not of
//   points). A pointer may be NULL where its count is 0. Output arrays must have exactly the count
//   that is stated, or the call fails with KW_DIMENSION_MISMATCH and writes nothing.
// - No exception leaves the library. [control], [any] and [audio] are the threads a function may be
//   called on: docs/realtime-rules.md. [any] and [audio] functions do not allocate, lock or block.
// - The ABI: values of enumerators, the order of arguments and the members of structs stay for one
//   kw_abi_version(). Structs that may grow begin with their size, which their _INIT sets.
#pragma once
#include "knotwave/c/analysis.h"
#include "knotwave/c/bezier.h"
#include "knotwave/c/combine.h"
#include "knotwave/c/curve.h"
#include "knotwave/c/curve_set.h"
#include "knotwave/c/edit.h"
#include "knotwave/c/fast_program.h"
#include "knotwave/c/fit.h"
#include "knotwave/c/join_program.h"
#include "knotwave/c/map.h"
#include "knotwave/c/moving_curve.h"
#include "knotwave/c/program.h"
#include "knotwave/c/shapes.h"
#include "knotwave/c/status.h"
#include "knotwave/c/surface.h"
#include "knotwave/c/surface_edit.h"
#include "knotwave/c/tessellate.h"
#include "knotwave/c/trim_region.h"
