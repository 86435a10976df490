// SPDX-License-Identifier: MIT
#include "riff_scan.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include <sys/stat.h>
#include <unistd.h>

namespace knotwave::io {
namespace {

constexpr int kMaxChunks = 4096;
constexpr std::size_t kMaxClmBytes = 64;
constexpr std::int64_t kUnknownSize = 0xFFFFFFFF;  // RF64: the size is in ds64

bool read_at(int descriptor, std::int64_t at, char* out, std::size_t count) {
  return ::pread(descriptor, out, count, at) == static_cast<ssize_t>(count);
}

std::int64_t number(const char* bytes, bool is_big_endian) {
  std::int64_t value = 0;
  for (int i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[is_big_endian ? i : 3 - i]);
  }
  return value;
}

}  // namespace

RiffFacts scan_riff(int descriptor) {
  RiffFacts facts;
  struct stat info {};
  std::array<char, 12> head{};
  if (::fstat(descriptor, &info) != 0 || !read_at(descriptor, 0, head.data(), head.size())) {
    return facts;
  }
  const std::string_view id(head.data(), 4);
  if ((id != "RIFF" && id != "RIFX" && id != "RF64") ||
      std::string_view(head.data() + 8, 4) != "WAVE") {
    return facts;
  }
  const bool is_rf64 = id == "RF64";
  const std::int64_t file_size = info.st_size;
  std::int64_t at = 12;
  std::array<char, 8> chunk{};
  for (int i = 0; i < kMaxChunks && read_at(descriptor, at, chunk.data(), chunk.size()); ++i) {
    const std::string_view name(chunk.data(), 4);
    const std::int64_t size = number(chunk.data() + 4, id == "RIFX");
    const std::int64_t left = file_size - at - 8;
    if (name == "clm ") {
      facts.clm.resize(std::min(kMaxClmBytes, static_cast<std::size_t>(std::min(size, left))));
      if (!read_at(descriptor, at + 8, facts.clm.data(), facts.clm.size())) facts.clm.clear();
    }
    if (name == "data" && is_rf64 && size == kUnknownSize) return facts;
    if (size > left) {
      facts.warnings.push_back("chunk '" + std::string(name) + "' says it has " +
                               std::to_string(size) + " bytes, " + std::to_string(left) +
                               " are there");
      return facts;
    }
    at += 8 + size + (size & 1);
  }
  return facts;
}

}  // namespace knotwave::io
