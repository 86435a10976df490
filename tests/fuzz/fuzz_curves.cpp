// SPDX-License-Identifier: MIT
// Any bytes as a curve file: either an error with a place and a message, or curves that keep the
// limits and are written back equal, the second time as the same text.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "knotwave/curves/curve_file.h"

#include "fuzz_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace knotwave;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto set = curves::parse_curves(text, "fuzz.toml");
  if (!set) {
    fuzz::check_error(set.error());
    return 0;
  }
  for (const auto& curve : set->curves) {
    FUZZ_CHECK(curve.degree() >= 1 && curve.degree() <= curves::kMaxDegree);
    FUZZ_CHECK(curve.point_count() <= curves::kMaxPoints + curves::kMaxDegree);
    FUZZ_CHECK(curve.u_min() < curve.u_max());
  }
  const std::string written = curves::write_curves(*set);
  const auto again = curves::parse_curves(written, "written.toml");
  // Shortest decimals of a file of short ones may be longer than a file may be.
  if (!again && again.error().code == ErrorCode::file_too_large) return 0;
  FUZZ_CHECK(again);
  FUZZ_CHECK(again->curves == set->curves);
  FUZZ_CHECK(again->surfaces == set->surfaces);
  FUZZ_CHECK(curves::write_curves(*again) == written);
  return 0;
}
