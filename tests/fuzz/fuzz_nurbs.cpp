// SPDX-License-Identifier: MIT
// Any bytes as a curve and up to 6 operations on it, one after the other: every result is a curve
// create() takes, and is as near as the headers say. A curve of more than 48 points is not gone on
// with.
#include <cstddef>
#include <cstdint>

#include "knotwave/base/index.h"

#include "fuzz_shapes.h"
#include "nurbs_operations.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace knotwave;
  constexpr int kMostPoints = 48, kMostOperations = 6;
  fuzz::ByteReader bytes({data, size});
  fuzz::Outcome curve = fuzz::curve_from(bytes);
  if (!curve) return 0;
  const std::span<const fuzz::Operation> kinds[] = {fuzz::edits(), fuzz::pairs(), fuzz::studies(),
                                                    fuzz::forms()};
  for (int i = 0; i < kMostOperations && !bytes.is_empty(); ++i) {
    const auto& operations = kinds[bytes.below(4)];
    const auto operation = operations[base::index_of(bytes.byte()) % operations.size()];
    const fuzz::Outcome result = operation(*curve, bytes);
    if (result && result->point_count() <= kMostPoints) curve = *result;
  }
  return 0;
}
