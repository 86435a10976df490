// SPDX-License-Identifier: MIT
// Private to io: the container around samples, by libsndfile on a descriptor of ours.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "knotwave/io/sound_file.h"

namespace knotwave::io {

class SoundEncoder {
 public:
  /// Writes to `descriptor` from its start. Errors: unsupported_format, unsupported.
  static Result<std::unique_ptr<SoundEncoder>> create(const SoundWriteConfig& config,
                                                      int descriptor);
  virtual ~SoundEncoder() = default;

  /// Whole frames, all of them or an error.
  virtual Result<void> write(std::span<const float> interleaved) = 0;
  virtual Result<void> write(std::span<const std::int32_t> interleaved) = 0;
  /// Completes the header. Nothing can be written afterwards.
  virtual Result<void> close() = 0;
};

}  // namespace knotwave::io
