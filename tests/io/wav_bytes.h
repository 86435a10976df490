// SPDX-License-Identifier: MIT
// WAV files built byte by byte.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace knotwave::io {

using WavBytes = std::vector<std::uint8_t>;

inline WavBytes little(std::uint64_t value, int count) {
  WavBytes out;
  for (int i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  return out;
}
inline WavBytes wav_chunk(const std::string& id, const WavBytes& body) {
  WavBytes out(id.begin(), id.end());
  for (const auto b : little(body.size(), 4)) out.push_back(b);
  out.insert(out.end(), body.begin(), body.end());
  if (body.size() % 2 != 0) out.push_back(0);
  return out;
}
struct WavKind {
  int tag = 1;  ///< 1 integers, 3 floats
  int bits = 16;
  int channels = 1;
  int rate_hz = 44100;
};
/// `samples` are the sample words; `extra` chunks come before the data.
inline WavBytes wav_file(const WavKind& kind, const std::vector<std::uint64_t>& samples,
                         const WavBytes& extra = {}) {
  const int bytes = kind.bits / 8;
  WavBytes fmt;
  const auto add = [&fmt](int value, int count) {
    for (const auto b : little(static_cast<std::uint64_t>(value), count)) fmt.push_back(b);
  };
  add(kind.tag, 2);
  add(kind.channels, 2);
  add(kind.rate_hz, 4);
  add(kind.rate_hz * kind.channels * bytes, 4);
  add(kind.channels * bytes, 2);
  add(kind.bits, 2);
  WavBytes data;
  for (const auto sample : samples) {
    for (const auto b : little(sample, bytes)) data.push_back(b);
  }
  WavBytes body = {'W', 'A', 'V', 'E'};
  for (const WavBytes& part : {wav_chunk("fmt ", fmt), extra, wav_chunk("data", data)}) {
    body.insert(body.end(), part.begin(), part.end());
  }
  return wav_chunk("RIFF", body);
}
inline std::uint64_t float_bits(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace knotwave::io
