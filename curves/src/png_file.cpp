// SPDX-License-Identifier: MIT
// A small PNG writer: 8-bit RGB, rows filtered by difference to the row above, deflate with fixed
// Huffman codes and the nearest match. Source: ISO/IEC 15948 (PNG), RFC 1950 and RFC 1951.
#include <algorithm>
#include <array>

#include "plot_scene.h"

namespace knotwave::curves {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append_big_endian(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count) {
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

std::uint32_t adler32(const Bytes& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : bytes) {
    a = (a + byte) % 65521u;
    b = (b + a) % 65521u;
  }
  return (b << 16) | a;
}

void append_chunk(Bytes& out, const char* type, const Bytes& content) {
  append_big_endian(out, static_cast<std::uint32_t>(content.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), content.begin(), content.end());
  append_big_endian(out, crc32(out.data() + start, out.size() - start));
}

class BitWriter {
 public:
  explicit BitWriter(Bytes& out) : out_(out) {}
  /// The lowest `count` bits of `value`, lowest first.
  void bits(std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bit((value >> i) & 1u);
  }
  /// A Huffman code: highest bit first.
  void code(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) bit((value >> i) & 1u);
  }
  void flush() {
    if (used_ > 0) out_.push_back(current_);
    current_ = 0;
    used_ = 0;
  }

 private:
  void bit(std::uint32_t value) {
    current_ = static_cast<std::uint8_t>(current_ | (value << used_));
    if (++used_ == 8) flush();
  }
  Bytes& out_;
  std::uint8_t current_ = 0;
  int used_ = 0;
};

// RFC 1951, 3.2.6: the fixed codes of literals and lengths.
void write_symbol(BitWriter& out, std::uint32_t symbol) {
  if (symbol < 144) {
    out.code(0x30 + symbol, 8);
  } else if (symbol < 256) {
    out.code(0x190 + symbol - 144, 9);
  } else if (symbol < 280) {
    out.code(symbol - 256, 7);
  } else {
    out.code(0xc0 + symbol - 280, 8);
  }
}

// RFC 1951, 3.2.5. Lengths 3..258: 8 symbols of one length, then 4 each of 2, 4, 8, 16, 32 lengths.
void write_length(BitWriter& out, int length) {
  if (length == 258) return write_symbol(out, 285);
  int first = 3, symbol = 257, extra = 0;
  while (length >= first + (1 << extra)) {
    first += 1 << extra;
    ++symbol;
    if (symbol > 264 && (symbol - 265) % 4 == 0) ++extra;
  }
  write_symbol(out, static_cast<std::uint32_t>(symbol));
  out.bits(static_cast<std::uint32_t>(length - first), extra);
}

// Distances 1..32768: 4 codes of one distance, then 2 each of 2, 4, 8 and so on.
void write_distance(BitWriter& out, int distance) {
  int first = 1, symbol = 0, extra = 0;
  while (distance >= first + (1 << extra)) {
    first += 1 << extra;
    ++symbol;
    if (symbol > 3 && symbol % 2 == 0) ++extra;
  }
  out.code(static_cast<std::uint32_t>(symbol), 5);
  out.bits(static_cast<std::uint32_t>(distance - first), extra);
}

Bytes zlib_of(const Bytes& content) {
  Bytes out = {0x78, 0x01};
  BitWriter writer(out);
  writer.bits(1, 1);                   // the last block
  writer.bits(1, 2);                   // fixed codes
  std::vector<int> last(1 << 15, -1);  // where three bytes with this hash were seen
  const int size = static_cast<int>(content.size());
  const auto at = [&](int i) { return content[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < size;) {
    int length = 0, distance = 0;
    if (i + 3 <= size) {
      const auto hash = static_cast<std::size_t>(
          (at(i) * 2654435761u + at(i + 1) * 40503u + at(i + 2) * 69069u) >> 3 & 0x7fff);
      const int before = last[hash];
      last[hash] = i;
      if (before >= 0 && i - before <= 32768) {
        const int most = std::min(258, size - i);
        while (length < most && at(before + length) == at(i + length)) ++length;
        distance = i - before;
      }
    }
    if (length >= 3) {
      write_length(writer, length);
      write_distance(writer, distance);
      i += length;
    } else {
      write_symbol(writer, at(i));
      ++i;
    }
  }
  write_symbol(writer, 256);  // end of block
  writer.flush();
  append_big_endian(out, adler32(content));
  return out;
}

}  // namespace

Bytes png_file(int width, int height, const Bytes& rgb) {
  const auto row = static_cast<std::size_t>(width) * 3;
  Bytes filtered;
  filtered.reserve((row + 1) * static_cast<std::size_t>(height));
  for (std::size_t start = 0; start < rgb.size(); start += row) {
    filtered.push_back(2);  // "up": what differs from the row above
    for (std::size_t i = start; i < start + row; ++i) {
      filtered.push_back(static_cast<std::uint8_t>(rgb[i] - (start > 0 ? rgb[i - row] : 0)));
    }
  }
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes header;
  append_big_endian(header, static_cast<std::uint32_t>(width));
  append_big_endian(header, static_cast<std::uint32_t>(height));
  header.insert(header.end(), {8, 2, 0, 0, 0});  // 8 bits, RGB, no interlace
  append_chunk(out, "IHDR", header);
  append_chunk(out, "IDAT", zlib_of(filtered));
  append_chunk(out, "IEND", {});
  return out;
}

}  // namespace knotwave::curves
