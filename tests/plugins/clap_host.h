// SPDX-License-Identifier: MIT
// A CLAP host for tests: opens a .clap file as any host does, plays events into it, keeps its
// sound.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <clap/entry.h>
#include <clap/events.h>
#include <clap/ext/audio-ports.h>
#include <clap/ext/params.h>
#include <clap/ext/state.h>
#include <clap/plugin-factory.h>

namespace knotwave::test {

/// Any event that CLAP has, by its header.
union ClapEvent {
  clap_event_header header;
  clap_event_note note;
  clap_event_note_expression expression;
  clap_event_param_value value;
  clap_event_param_mod mod;
  clap_event_transport transport;
  clap_event_midi midi;
};
ClapEvent clap_note(std::uint32_t sample, int type, int channel, int key, double velocity);
/// With the host's own number of the note.
ClapEvent clap_numbered(std::uint32_t sample, int type, std::int32_t note, int channel, int key,
                        double velocity);
ClapEvent clap_expression(std::uint32_t sample, int what, std::int32_t note, int channel, int key,
                          double value);
ClapEvent clap_modulation(std::uint32_t sample, clap_id id, std::int32_t note, int channel, int key,
                          double amount);
ClapEvent clap_value(std::uint32_t sample, clap_id id, double value);
ClapEvent clap_midi(std::uint32_t sample, int status, int one, int two);

/// Those of all ports, one after the other.
using Channels = std::vector<std::vector<float>>;

struct StereoSound {
  std::vector<float> left, right;
  bool operator==(const StereoSound&) const = default;
};

/// What a host counts.
struct HostCalls {
  int rescans = 0;
};

class ClapPlugin {
 public:
  ClapPlugin(const clap_plugin_factory* factory, const char* id);
  ~ClapPlugin();
  ClapPlugin(const ClapPlugin&) = delete;
  ClapPlugin& operator=(const ClapPlugin&) = delete;

  const clap_plugin* operator->() const { return plugin_; }
  const clap_plugin* get() const { return plugin_; }
  const HostCalls& calls() const { return calls_; }
  template <class Extension>
  const Extension* extension(const char* id) const {
    return static_cast<const Extension*>(plugin_->get_extension(plugin_, id));
  }

  bool start(double rate_hz, std::uint32_t max_frames);  ///< activate and start_processing
  void stop();
  /// One call of process(): events of this block.
  clap_process_status process(const std::vector<ClapEvent>& events, std::size_t frames,
                              StereoSound& out, const clap_event_transport* transport = nullptr);
  /// The same of any ports: `in` and `out` as the plugin says it has them, `frames` of `in` each.
  /// With `in_place` the first ports share their buffers where the plugin says they may.
  clap_process_status process(const std::vector<ClapEvent>& events, std::size_t frames,
                              const Channels& in, Channels& out,
                              const clap_event_transport* transport = nullptr,
                              bool in_place = false);
  /// What the plugin gave in the last process().
  const std::vector<ClapEvent>& given() const { return given_; }
  std::size_t channels(bool is_input) const;
  /// `events` by their sample of the whole sound, in blocks of `block`.
  StereoSound play(const std::vector<ClapEvent>& events, std::size_t frames, std::size_t block);

  std::string save(std::size_t bytes_at_once = 1 << 20) const;
  bool load(const std::string& state, std::size_t bytes_at_once = 1 << 20);

 private:
  clap_host host_{};
  HostCalls calls_;
  const clap_plugin* plugin_ = nullptr;
  bool is_started_ = false;
  std::vector<ClapEvent> given_;
};

/// The file, opened with every symbol looked up.
class ClapLibrary {
 public:
  explicit ClapLibrary(const std::string& path);
  ~ClapLibrary();
  ClapLibrary(const ClapLibrary&) = delete;
  ClapLibrary& operator=(const ClapLibrary&) = delete;
  const clap_plugin_entry* entry() const { return entry_; }
  const clap_plugin_factory* factory() const { return factory_; }

 private:
  void* library_ = nullptr;
  const clap_plugin_entry* entry_ = nullptr;
  const clap_plugin_factory* factory_ = nullptr;
};

}  // namespace knotwave::test
