// SPDX-License-Identifier: MIT
// Programs in float32 from C.
#include "knotwave/curves/fast_program.h"

#include <algorithm>
#include <limits>

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;

struct kw_fast_program {
  curves::FastProgram program;
};

namespace {

bool has_coordinate(const kw_fast_program* program, int32_t coordinate) {
  return program != nullptr && coordinate >= 0 && coordinate < program->program.accurate().dim();
}

}  // namespace

kw_status kw_fast_program_create(const kw_program* program, double max_error, kw_fast_program** out,
                                 kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"program", program}, {"out", out}}, error, [&]() -> kw_status {
    *out = new kw_fast_program{curves::FastProgram(program->program, max_error)};
    return KW_OK;
  });
}
void kw_fast_program_free(kw_fast_program* program) { delete program; }

double kw_fast_program_max_error(const kw_fast_program* program, int32_t coordinate) {
  return has_coordinate(program, coordinate) ? program->program.max_error(coordinate)
                                             : std::numeric_limits<double>::quiet_NaN();
}
int32_t kw_fast_program_fast_piece_count(const kw_fast_program* program, int32_t coordinate) {
  return has_coordinate(program, coordinate) ? program->program.fast_piece_count(coordinate) : 0;
}

kw_status kw_fast_program_render(const kw_fast_program* program, double origin, double step,
                                 int64_t first, int32_t coordinate, float* out, size_t out_count,
                                 int32_t* cursor) {
  if (out == nullptr && out_count > 0) return KW_NULL_ARGUMENT;
  if (!has_coordinate(program, coordinate)) {
    std::fill_n(out, out_count, 0.0F);
    return program == nullptr ? KW_NULL_ARGUMENT : KW_DIMENSION_MISMATCH;
  }
  curves::CurveCursor here{cursor == nullptr ? 0 : *cursor};
  program->program.render(curves::GridRun{origin, step, first}, std::span<float>(out, out_count),
                          here, coordinate);
  if (cursor != nullptr) *cursor = here.piece;
  return KW_OK;
}
