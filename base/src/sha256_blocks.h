// SPDX-License-Identifier: MIT
// The compression function of SHA-256. Private to base.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace knotwave::base {

using Sha256State = std::array<std::uint32_t, 8>;

/// Takes `blocks` blocks of 64 bytes into `state`, with the processor's own instructions where it
/// has them. [any]
void sha256_blocks(Sha256State& state, const std::uint8_t* data, std::size_t blocks);

/// The same in plain C++. [any]
void sha256_blocks_portable(Sha256State& state, const std::uint8_t* data, std::size_t blocks);

}  // namespace knotwave::base
