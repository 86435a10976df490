// SPDX-License-Identifier: MIT
// What an envelope is made of: its places checked, the curve and its joins compiled.
#include <charconv>
#include <string>
#include <utility>

#include "knotwave/dsp/envelope.h"

namespace knotwave::dsp {
namespace {

std::string text(double x) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, x);
  return {digits, end.ptr};
}

struct Place {
  const char* name;
  double u;
};

Error outside(const Place& place, const curves::CurveProgram& program) {
  return fail(ErrorCode::parameter_out_of_range,
              std::string(place.name) + " is at " + text(place.u) + ", the curve runs from " +
                  text(program.u_min()) + " to " + text(program.u_max()));
}

Result<void> check_order(const Place& first, const Place& second) {
  if (first.u <= second.u) return {};
  return fail(ErrorCode::parameter_out_of_range, std::string(first.name) + " (" + text(first.u) +
                                                     ") is after " + second.name + " (" +
                                                     text(second.u) + ")");
}

Result<void> check_places(const EnvelopeSpec& spec, const curves::CurveProgram& program) {
  const double u_min = program.u_min(), u_max = program.u_max();
  const Place sustain{"sustain", spec.sustain_u}, release{"release", spec.release_u};
  const Place loop_start{"loop start", spec.loop_start_u}, loop_end{"loop end", spec.loop_end_u};
  const bool has_sustain = !(spec.sustain_u < u_min), has_release = !(spec.release_u < u_min);
  const bool has_loop = spec.loop_start_u != spec.loop_end_u;
  for (const auto& [place, used] :
       {std::pair(sustain, has_sustain), std::pair(release, has_release),
        std::pair(loop_start, has_loop), std::pair(loop_end, has_loop)}) {
    if (used && !(place.u >= u_min && place.u <= u_max)) return outside(place, program);
  }
  if (has_loop && has_sustain) {
    return fail(ErrorCode::parameter_out_of_range,
                "an envelope holds at its sustain place (" + text(spec.sustain_u) +
                    ") or repeats its loop (" + text(spec.loop_start_u) + " to " +
                    text(spec.loop_end_u) + "), not both");
  }
  if (has_loop) {
    if (auto ordered = check_order(loop_start, loop_end); !ordered) return ordered;
    if (has_release) return check_order(loop_end, release);
  }
  if (has_sustain && has_release) return check_order(sustain, release);
  return {};
}

// Where the gate's end leads, below u_min for nowhere.
double release_place(const EnvelopeSpec& spec, double u_min) {
  if (spec.release_u >= u_min) return spec.release_u;
  if (spec.sustain_u >= u_min) return spec.sustain_u;
  if (spec.loop_end_u > spec.loop_start_u) return spec.loop_end_u;
  return u_min - 1;
}

}  // namespace

Result<EnvelopeProgram> EnvelopeProgram::create(const curves::NurbsCurve& curve,
                                                const EnvelopeSpec& spec) {
  if (!(spec.seconds > 0 && spec.seconds < 1e9)) {
    return fail(
        ErrorCode::value_out_of_range,
        "an envelope lasts more than 0 and less than 1e9 seconds, not " + text(spec.seconds));
  }
  auto program = curves::compile_function(curve, spec.compile);
  if (!program) return program.error();
  if (auto checked = check_places(spec, *program); !checked) return checked.error();

  EnvelopeProgram envelope;
  envelope.spec_ = spec;
  envelope.program_ = std::move(*program);
  const double u_min = envelope.program_.u_min(), u_max = envelope.program_.u_max();
  envelope.u_per_second_ = (curve.dim() == 1 ? u_max - u_min : 1.0) / spec.seconds;
  envelope.end_value_ = envelope.program_.at_u(u_max);
  auto start = curves::compile_join(curve, u_min, spec.compile);
  if (!start) return start.error();
  envelope.start_join_ = std::move(*start);
  const double release_u = release_place(spec, u_min);
  if (release_u >= u_min && release_u < u_max) {
    auto release = curves::compile_join(curve, release_u, spec.compile);
    if (!release) return release.error();
    envelope.release_join_ = std::move(*release);
    envelope.has_release_ = true;
  }
  return envelope;
}

}  // namespace knotwave::dsp
