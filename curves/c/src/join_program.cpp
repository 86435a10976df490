// SPDX-License-Identifier: MIT
// Sections that start from any value and slope, from C.
#include "knotwave/curves/compile.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;

struct kw_join_program {
  curves::JoinProgram join;
  kw_program basis;
};

namespace {

kw_join_deltas deltas_of(const curves::JoinProgram::Deltas& deltas) {
  return {deltas.dp0, deltas.dp1, deltas.limited};
}

}  // namespace

kw_status kw_compile_join(const kw_curve* curve, double u_join, const kw_compile_options* options,
                          kw_join_program** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"curve", curve}, {"out", out}, needed_controls(options)}, error, [&]() -> kw_status {
    const auto asked = compile_options_of(options);
    if (!asked) return report(error, asked.error());
    return give(curves::compile_join(curve->curve, u_join, *asked), error,
                [&](curves::JoinProgram&& join) {
                  kw_program basis{join.basis};
                  *out = new kw_join_program{std::move(join), std::move(basis)};
                });
  });
}
void kw_join_program_free(kw_join_program* join) { delete join; }

const kw_program* kw_join_program_basis(const kw_join_program* join) {
  return join ? &join->basis : nullptr;
}
double kw_join_program_u_join(const kw_join_program* join) { return join ? join->join.u_join : 0; }
double kw_join_program_u_basis_end(const kw_join_program* join) {
  return join ? join->join.u_basis_end : 0;
}
bool kw_join_program_moves_p1(const kw_join_program* join) { return join && join->join.moves_p1; }

kw_join_deltas kw_join_program_start(const kw_join_program* join, double value0, double slope0) {
  return join ? deltas_of(join->join.join(value0, slope0)) : kw_join_deltas{0, 0, false};
}
kw_join_deltas kw_join_program_start_c0(const kw_join_program* join, double value0) {
  return join ? deltas_of(join->join.join_c0(value0)) : kw_join_deltas{0, 0, false};
}
