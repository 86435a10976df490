// SPDX-License-Identifier: MIT
#include "lv2_host.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <lv2/atom-forge.h>
#include <lv2/atom-util.h>
#include <lv2/atom.h>
#include <lv2/buf-size.h>
#include <lv2/midi.h>
#include <lv2/options.h>
#include <lv2/time.h>

namespace knotwave::test {
namespace {

constexpr const char* kKey = "urn:distrho:patch";
constexpr std::size_t kEventWords = 1 << 16;

/// A sequence of atoms as a host gives it, in order of time.
class Sequence {
 public:
  Sequence(LV2_URID_Map& map, std::vector<std::uint64_t>& room) : map_(map) {
    lv2_atom_forge_init(&forge_, &map);
    lv2_atom_forge_set_buffer(&forge_, reinterpret_cast<std::uint8_t*>(room.data()),
                              room.size() * sizeof room[0]);
    lv2_atom_forge_sequence_head(&forge_, &frame_, 0);
  }
  ~Sequence() { lv2_atom_forge_pop(&forge_, &frame_); }
  Sequence(const Sequence&) = delete;
  Sequence& operator=(const Sequence&) = delete;

  void add(const Story::Midi& event) {
    lv2_atom_forge_frame_time(&forge_, static_cast<std::int64_t>(event.sample));
    const int status = event.bytes[0] & 0xF0;
    const std::uint32_t size = status == 0xC0 || status == 0xD0 ? 2 : 3;
    lv2_atom_forge_atom(&forge_, size, number(LV2_MIDI__MidiEvent));
    lv2_atom_forge_write(&forge_, event.bytes.data(), size);
  }
  /// In bars and beats; without a time signature the running beat alone.
  void add(const Story::Song& told) {
    const double beats = told.transport.quarters * told.beat_unit / 4;
    const double bar = std::floor(beats / told.beats_per_bar);
    lv2_atom_forge_frame_time(&forge_, static_cast<std::int64_t>(told.sample));
    LV2_Atom_Forge_Frame object;
    lv2_atom_forge_object(&forge_, &object, 0, number(LV2_TIME__Position));
    key(LV2_TIME__speed);
    lv2_atom_forge_float(&forge_, told.transport.is_playing ? 1.0F : 0.0F);
    key(LV2_TIME__beatsPerMinute);
    lv2_atom_forge_double(&forge_, told.transport.beats_per_minute);
    if (told.has_signature) {
      key(LV2_TIME__bar);
      if (std::abs(bar) < 1e9) {
        lv2_atom_forge_long(&forge_, static_cast<std::int64_t>(bar));
      } else {
        lv2_atom_forge_double(&forge_, bar);
      }
      key(LV2_TIME__barBeat);
      lv2_atom_forge_double(&forge_, beats - bar * told.beats_per_bar);
      key(LV2_TIME__beatUnit);
      lv2_atom_forge_int(&forge_, told.beat_unit);
      key(LV2_TIME__beatsPerBar);
      lv2_atom_forge_float(&forge_, static_cast<float>(told.beats_per_bar));
    } else if (told.transport.has_position) {
      key(LV2_TIME__beat);
      lv2_atom_forge_double(&forge_, told.transport.quarters);
    }
    lv2_atom_forge_pop(&forge_, &object);
  }

 private:
  std::uint32_t number(const char* uri) { return map_.map(map_.handle, uri); }
  void key(const char* uri) { lv2_atom_forge_key(&forge_, number(uri)); }

  LV2_URID_Map& map_;
  LV2_Atom_Forge forge_{};
  LV2_Atom_Forge_Frame frame_{};
};

void write_events(const Story& story, LV2_URID_Map& map, std::vector<std::uint64_t>& room) {
  Sequence events(map, room);
  auto told = story.song.begin();
  const auto tell_song_until = [&](std::size_t sample) {
    for (; told != story.song.end() && told->sample <= sample; ++told) events.add(*told);
  };
  for (const Story::Midi& event : story.midi) {
    tell_song_until(event.sample);
    events.add(event);
  }
  tell_song_until(story.frames);
}

struct Kept {
  std::uint32_t key = 0, type = 0;
  std::string text;
};

}  // namespace

std::uint32_t Lv2Plugin::number_of(const char* uri) {
  return numbers_.try_emplace(uri, static_cast<std::uint32_t>(numbers_.size() + 1)).first->second;
}

Lv2Plugin::Lv2Plugin(const plugins::PluginInfo& info, const std::string& binary, double rate_hz)
    : info_(info), events_in_(kEventWords), events_out_(kEventWords) {
  library_ = dlopen(binary.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) {
    ADD_FAILURE() << dlerror();
    return;
  }
  const auto describe =
      reinterpret_cast<LV2_Descriptor_Function>(dlsym(library_, "lv2_descriptor"));
  descriptor_ = describe(0);
  EXPECT_EQ(describe(1), nullptr);
  EXPECT_EQ(descriptor_->URI, "urn:knotwave:" + std::string(info.key));

  map_ = {this, [](LV2_URID_Map_Handle self, const char* uri) {
            return static_cast<Lv2Plugin*>(self)->number_of(uri);
          }};
  worker_ = {this, [](LV2_Worker_Schedule_Handle, std::uint32_t, const void*) -> LV2_Worker_Status {
               return LV2_WORKER_ERR_UNKNOWN;
             }};
  const int most = 16384;
  const LV2_Options_Option options[] = {
      {LV2_OPTIONS_INSTANCE, 0, number_of(LV2_BUF_SIZE__maxBlockLength), sizeof most,
       number_of(LV2_ATOM__Int), &most},
      {LV2_OPTIONS_INSTANCE, 0, 0, 0, 0, nullptr}};
  const LV2_Feature map_feature{LV2_URID__map, &map_};
  const LV2_Feature worker_feature{LV2_WORKER__schedule, &worker_};
  const LV2_Feature options_feature{LV2_OPTIONS__options, const_cast<LV2_Options_Option*>(options)};
  const LV2_Feature* const features[] = {&map_feature, &worker_feature, &options_feature, nullptr};
  handle_ = descriptor_->instantiate(descriptor_, rate_hz,
                                     binary.substr(0, binary.rfind('/') + 1).c_str(), features);
  EXPECT_NE(handle_, nullptr);
  for (const plugins::Parameter& parameter : info.parameters->all()) {
    controls_.push_back(static_cast<float>(parameter.initial));
  }
}

Lv2Plugin::~Lv2Plugin() {
  if (handle_ != nullptr) {
    deactivate();
    descriptor_->cleanup(handle_);
  }
  if (library_ != nullptr) dlclose(library_);
}

void Lv2Plugin::activate() {
  descriptor_->activate(handle_);
  is_active_ = true;
  passed_ = 0;
  given_.clear();
}
void Lv2Plugin::deactivate() {
  if (is_active_) descriptor_->deactivate(handle_);
  is_active_ = false;
}

Channels Lv2Plugin::run(const Story& story) {
  std::uint32_t port = 0;
  Channels in = story.inputs, out;
  in.resize(channels(info_.inputs), std::vector<float>(story.frames));
  out.assign(channels(info_.outputs), std::vector<float>(story.frames, 99.0F));
  for (std::vector<float>& channel : in) {
    descriptor_->connect_port(handle_, port++, channel.data());
  }
  for (std::vector<float>& channel : out) {
    descriptor_->connect_port(handle_, port++, channel.data());
  }
  const std::uint32_t sequence = number_of(LV2_ATOM__Sequence);
  write_events(story, map_, events_in_);
  *reinterpret_cast<LV2_Atom*>(events_out_.data()) = {
      static_cast<std::uint32_t>(kEventWords * 8 - sizeof(LV2_Atom)), sequence};
  descriptor_->connect_port(handle_, port++, events_in_.data());
  descriptor_->connect_port(handle_, port++, events_out_.data());
  for (const Story::Point& point : story.points) {
    controls_[point.place] =
        static_cast<float>(value_of((*info_.parameters)[point.place], point.part));
  }
  for (float& control : controls_) descriptor_->connect_port(handle_, port++, &control);
  call_block_([&] { descriptor_->run(handle_, static_cast<std::uint32_t>(story.frames)); });
  const auto& sequence_out = *reinterpret_cast<const LV2_Atom_Sequence*>(events_out_.data());
  LV2_ATOM_SEQUENCE_FOREACH(&sequence_out, event) {
    if (event->body.type != numbers_.at(LV2_MIDI__MidiEvent)) continue;
    Story::Midi& midi = given_.emplace_back();
    midi.sample = passed_ + static_cast<std::size_t>(event->time.frames);
    std::memcpy(midi.bytes.data(), event + 1, std::min<std::size_t>(event->body.size, 3));
  }
  passed_ += story.frames;
  return out;
}

Channels Lv2Plugin::play(const Story& story, std::size_t block) {
  Channels all;
  for (std::size_t from = 0; from < story.frames; from += block) {
    append(all, run(story.part(from, std::min(block, story.frames - from))));
  }
  return all;
}

std::string Lv2Plugin::save() const {
  const auto* const state =
      static_cast<const LV2_State_Interface*>(descriptor_->extension_data(LV2_STATE__interface));
  Kept kept;
  const auto store = [](LV2_State_Handle to, std::uint32_t key, const void* value, std::size_t size,
                        std::uint32_t type, std::uint32_t) {
    *static_cast<Kept*>(to) = {key, type, std::string(static_cast<const char*>(value), size)};
    return LV2_STATE_SUCCESS;
  };
  EXPECT_EQ(state->save(handle_, store, &kept, 0, nullptr), LV2_STATE_SUCCESS);
  EXPECT_EQ(kept.key, numbers_.at(kKey));
  EXPECT_EQ(kept.type, numbers_.at(LV2_ATOM__String));
  return kept.text.substr(0, kept.text.find('\0'));
}

bool Lv2Plugin::load(const std::string& text) {
  const auto* const state =
      static_cast<const LV2_State_Interface*>(descriptor_->extension_data(LV2_STATE__interface));
  Kept kept{number_of(kKey), number_of(LV2_ATOM__String), text};
  const auto retrieve = [](LV2_State_Handle from, std::uint32_t key, std::size_t* size,
                           std::uint32_t* type, std::uint32_t*) -> const void* {
    const auto& given = *static_cast<Kept*>(from);
    if (key != given.key) return nullptr;
    *size = given.text.size() + 1;
    *type = given.type;
    return given.text.c_str();
  };
  return state->restore(handle_, retrieve, &kept, 0, nullptr) == LV2_STATE_SUCCESS;
}

}  // namespace knotwave::test
