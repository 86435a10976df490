// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "knotwave/io/midi_file.h"

#include "midi_meta.h"

namespace knotwave::io {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint64_t kMaxDelta = 0x0FFFFFFF;

void put_big_endian(Bytes& out, std::uint64_t value, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

void put_number(Bytes& out, std::uint64_t value) {
  int shift = 21;
  while (shift > 0 && (value >> shift) == 0) shift -= 7;
  for (; shift > 0; shift -= 7) {
    out.push_back(static_cast<std::uint8_t>(0x80 | (value >> shift & 0x7F)));
  }
  out.push_back(static_cast<std::uint8_t>(value & 0x7F));
}

/// One track being written.
class TrackWriter {
 public:
  explicit TrackWriter(Bytes& out) : out_(out) {
    for (const char c : {'M', 'T', 'r', 'k'}) out_.push_back(static_cast<std::uint8_t>(c));
    begin_ = out_.size();
    put_big_endian(out_, 0, 4);
  }

  void meta(std::uint64_t tick, int type, std::span<const std::uint8_t> content) {
    delta(tick);
    out_.push_back(0xFF);
    out_.push_back(static_cast<std::uint8_t>(type));
    put_number(out_, content.size());
    out_.insert(out_.end(), content.begin(), content.end());
  }

  void event(const SongEvent& event, const Song& song) {
    delta(event.tick);
    const std::uint8_t status = event.bytes[0];
    out_.push_back(status);
    if (status >= 0xF0) {
      put_number(out_, event.sysex_size + 1u);
      const auto first = song.sysex_bytes.begin() + event.sysex_begin;
      out_.insert(out_.end(), first, first + event.sysex_size);
      out_.push_back(0xF7);
      return;
    }
    const bool has_one = (status & 0xE0) == 0xC0;  // program change, channel pressure
    out_.insert(out_.end(), event.bytes + 1, event.bytes + (has_one ? 2 : 3));
  }

  void finish(std::uint64_t tick) {
    meta(tick, kMetaEndOfTrack, {});
    const std::size_t size = out_.size() - begin_ - 4;
    for (std::size_t i = 0; i < 4; ++i) {
      out_[begin_ + i] = static_cast<std::uint8_t>(size >> (24 - 8 * i));
    }
  }

 private:
  /// A gap longer than a delta time can say is filled with empty texts.
  void delta(std::uint64_t tick) {
    std::uint64_t gap = tick - std::min(tick, tick_);
    tick_ = std::max(tick, tick_);
    for (; gap > kMaxDelta; gap -= kMaxDelta) {
      put_number(out_, kMaxDelta);
      for (const int b : {0xFF, 0x01, 0x00}) out_.push_back(static_cast<std::uint8_t>(b));
    }
    put_number(out_, gap);
  }

  Bytes& out_;
  std::size_t begin_ = 0;
  std::uint64_t tick_ = 0;
};

/// Something of a track with its tick; `write` says what.
struct Item {
  std::uint64_t tick;
  enum class Kind : std::uint8_t { tempo, meter, text, event } kind;
  std::size_t index;
};

void write_item(const Item& item, const Song& song, TrackWriter& track) {
  switch (item.kind) {
    case Item::Kind::tempo: {
      const std::uint32_t us = song.tempos[item.index].microseconds_per_quarter;
      const std::uint8_t content[] = {static_cast<std::uint8_t>(us >> 16),
                                      static_cast<std::uint8_t>(us >> 8),
                                      static_cast<std::uint8_t>(us)};
      return track.meta(item.tick, kMetaTempo, content);
    }
    case Item::Kind::meter: {
      const MeterChange& meter = song.meters[item.index];
      std::uint8_t power = 0;
      while (power < 7 && 1 << power < meter.denominator) ++power;
      const std::uint8_t content[] = {static_cast<std::uint8_t>(meter.numerator), power, 24, 8};
      return track.meta(item.tick, kMetaMeter, content);
    }
    case Item::Kind::text: {
      const SongText& text = song.texts[item.index];
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.text.data());
      return track.meta(item.tick, text.meta_type, {bytes, text.text.size()});
    }
    case Item::Kind::event:
      return track.event(song.events[item.index], song);
  }
}

/// The contents of every track, by tick; tempos and meters belong to the first.
std::vector<std::vector<Item>> items_by_track(const Song& song) {
  std::size_t count = 1;
  for (const SongEvent& e : song.events) count = std::max<std::size_t>(count, e.track + 1u);
  for (const SongText& t : song.texts) count = std::max<std::size_t>(count, t.track + 1u);
  count = std::max(count, static_cast<std::size_t>(std::max(song.track_count, 0)));
  std::vector<std::vector<Item>> tracks(std::min<std::size_t>(count, 65535));
  for (std::size_t i = 0; i < song.tempos.size(); ++i) {
    tracks[0].push_back({song.tempos[i].tick, Item::Kind::tempo, i});
  }
  for (std::size_t i = 0; i < song.meters.size(); ++i) {
    tracks[0].push_back({song.meters[i].tick, Item::Kind::meter, i});
  }
  for (std::size_t i = 0; i < song.texts.size(); ++i) {
    tracks[song.texts[i].track].push_back({song.texts[i].tick, Item::Kind::text, i});
  }
  for (std::size_t i = 0; i < song.events.size(); ++i) {
    tracks[song.events[i].track].push_back({song.events[i].tick, Item::Kind::event, i});
  }
  for (auto& items : tracks) {
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.tick < b.tick; });
  }
  return tracks;
}

}  // namespace

std::vector<std::uint8_t> write_midi(const Song& song) {
  const auto tracks = items_by_track(song);
  Bytes out = {'M', 'T', 'h', 'd'};
  put_big_endian(out, 6, 4);
  put_big_endian(out, tracks.size() == 1 ? 0 : 1, 2);
  put_big_endian(out, tracks.size(), 2);
  const TimeBase& base = song.time_base;
  if (base.smpte_fps > 0) {
    put_big_endian(out, static_cast<std::uint64_t>(256 - base.smpte_fps), 1);
    put_big_endian(out, static_cast<std::uint64_t>(base.ticks_per_frame), 1);
  } else {
    put_big_endian(out, static_cast<std::uint64_t>(base.ticks_per_quarter), 2);
  }
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    TrackWriter track(out);
    for (const Item& item : tracks[t]) write_item(item, song, track);
    const std::uint64_t last = tracks[t].empty() ? 0 : tracks[t].back().tick;
    track.finish(t == 0 ? std::max(last, song.length_ticks) : last);
  }
  return out;
}

}  // namespace knotwave::io
