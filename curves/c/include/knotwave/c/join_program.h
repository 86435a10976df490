// SPDX-License-Identifier: MIT
// A section of a curve that starts from any value and slope: retrigger, legato, release. See
// knotwave/curves/compile.h, JoinProgram. A join plays program(u) + dp0 * basis0(u) + dp1 *
// basis1(u).
#pragma once
#include "knotwave/c/program.h"

KW_BEGIN

typedef struct kw_join_program kw_join_program;

/// u_join is a parameter of the compiled function (for 2-D curves a time). options may be NULL.
/// [control]
KW_API kw_status kw_compile_join(const kw_curve* curve, double u_join,
                                 const kw_compile_options* options, kw_join_program** out,
                                 kw_error** error);
KW_API void kw_join_program_free(kw_join_program* join);

// [any]
/// dim 2: basis0 and basis1. Borrowed.
KW_API const kw_program* kw_join_program_basis(const kw_join_program* join);
KW_API double kw_join_program_u_join(const kw_join_program* join);
/// From here on both bases are 0. But a join of degree 1 in the last span has basis 1 = 1 at the
/// end; it doesn't sound, as such a join never moves P1.
KW_API double kw_join_program_u_basis_end(const kw_join_program* join);
/// Whether a join can take a slope on; else it takes the value alone.
KW_API bool kw_join_program_moves_p1(const kw_join_program* join);

typedef struct kw_join_deltas {
  double dp0;
  double dp1;
  bool limited;  ///< the slope was as near as the hull allows
} kw_join_deltas;
/// What to play to start at value0 with slope0 (by u of this section), or at value0 with the
/// curve's own slope. 0, 0 where `join` is NULL. [audio]
KW_API kw_join_deltas kw_join_program_start(const kw_join_program* join, double value0,
                                            double slope0);
KW_API kw_join_deltas kw_join_program_start_c0(const kw_join_program* join, double value0);

KW_END
