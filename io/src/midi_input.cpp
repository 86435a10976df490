// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_input.h"

#include <algorithm>
#include <optional>

#include "knotwave/io/audio_device.h"

#include "audio_backend.h"
#include "midi_api.h"

namespace knotwave::io {
namespace {

constexpr std::int64_t kReopenNs = 1'000'000'000;

/// A port number and whose it is.
struct Slot {
  std::string api, key;  ///< key: the name without what changes when the port comes back
  std::string name;      ///< as it is called now, or was
  bool is_virtual = false;
  std::shared_ptr<MidiCable> cable;
  std::optional<OpenInput> input;
  std::string full_name;                 ///< virtual, jack
  std::vector<std::string> connections;  ///< virtual, jack
  std::int64_t closed_ns = 0, next_try_ns = 0;
  std::string fault;  ///< why it could not be opened
};

struct Source {
  std::string key, name;
};

/// ALSA ends a name with numbers, " 20:0", that change from plug to plug.
std::string without_numbers(const std::string& name) {
  const std::size_t blank = name.find_last_of(' ');
  if (blank == std::string::npos || name.find(':', blank) == std::string::npos) return name;
  const bool has_numbers_only =
      name.find_first_not_of("0123456789:", blank + 1) == std::string::npos;
  return has_numbers_only ? name.substr(0, blank) : name;
}

/// Ports of ALSA as JACK shows them once more: by jackd itself, a2jmidid and PipeWire.
bool is_alsa_seen_by_jack(const std::string& name) {
  for (const char* bridge : {"a2j:", "alsa_pcm:", "system:midi_", "Midi-Bridge:"}) {
    if (name.rfind(bridge, 0) == 0) return true;
  }
  return false;
}

bool has_part(const std::string& name, const std::string& part) {
  return lower_case(name).find(lower_case(part)) != std::string::npos;
}

class RtMidiInputs : public MidiInputs {
 public:
  RtMidiInputs(const MidiInputConfig& config, MidiListener& listener)
      : config_(config), listener_(listener) {
    for (const std::string& name : midi_apis()) {
      if (config.api.empty() || config.api == name) apis_.emplace_back(name, config.client_name);
    }
  }
  ~RtMidiInputs() override {
    for (Slot& slot : slots_) close(slot);
  }
  RtMidiInputs(const RtMidiInputs&) = delete;
  RtMidiInputs& operator=(const RtMidiInputs&) = delete;

  bool poll() override {
    const std::int64_t now_ns = steady_clock_ns();
    bool has_changed = false;
    too_many_.clear();
    left_out_.clear();
    for (MidiApi& api : apis_) {
      if (api.has_gone()) {
        for (Slot& slot : slots_) {
          if (slot.api == api.name()) has_changed |= close(slot);
        }
        api.stop();
      }
      api.start(now_ns);
      if (!api.works()) continue;
      const std::vector<Source> sources = wanted(api);
      has_changed |= close_vanished(api, sources);
      has_changed |= open_new(api, sources, now_ns);
      watch_virtual(api);
    }
    for (Slot& slot : slots_) {
      if (slot.input) slot.cable->check_sensing(now_ns);
    }
    return has_changed;
  }

  std::vector<MidiPortStatus> ports() const override {
    std::vector<MidiPortStatus> all;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const Slot& slot = slots_[i];
      all.push_back({static_cast<int>(i), slot.api, slot.name, slot.input.has_value(),
                     slot.is_virtual, slot.cable->messages(), slot.cable->faults()});
    }
    return all;
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    for (const MidiApi& api : apis_) {
      if (!api.works()) all.push_back(api.name() + ": " + api.fault());
    }
    for (const Slot& slot : slots_) {
      if (!slot.fault.empty()) all.push_back(slot.api + ": '" + slot.name + "': " + slot.fault);
    }
    for (const std::string& name : too_many_) {
      all.push_back("'" + name + "' is left out: " + std::to_string(kMaxMidiPorts) +
                    " inputs are open, which is the most");
    }
    for (const std::string& name : left_out_) {
      all.push_back("'" + name + "' is left out: it is heard where it is asked for by name");
    }
    return all;
  }

  /// What open() refuses.
  Result<void> check() {
    std::vector<std::string> names;
    for (MidiApi& api : apis_) {
      if (!config_.api.empty() && !api.works() && !is_jack(api.name())) {
        return fail(ErrorCode::unsupported,
                    "the MIDI API '" + api.name() + "' does not work here: " + api.fault());
      }
      for (const std::string& name : api.sources()) {
        if (!OwnOutput::has(api.name(), name)) names.push_back(name);
      }
    }
    for (const std::string& part : config_.ports) {
      if (std::none_of(names.begin(), names.end(),
                       [&](const std::string& name) { return has_part(name, part); })) {
        return fail(ErrorCode::unknown_name,
                    "no MIDI input has '" + part + "' in its name; there is: " + listed(names));
      }
    }
    return {};
  }

 private:
  MidiApi* api_of(const Slot& slot) {
    const auto found = std::find_if(apis_.begin(), apis_.end(),
                                    [&](const MidiApi& api) { return api.name() == slot.api; });
    return found == apis_.end() ? nullptr : &*found;
  }

  bool is_wanted(const MidiApi& api, const std::string& name) const {
    if (name.empty() || OwnOutput::has(api.name(), name)) return false;
    if (!config_.ports.empty()) {
      return std::any_of(config_.ports.begin(), config_.ports.end(),
                         [&](const std::string& part) { return has_part(name, part); });
    }
    if (is_left_out(name)) return false;
    // Each keyboard once: where ALSA works, what JACK shows of it is left to ALSA.
    const bool has_alsa = std::any_of(apis_.begin(), apis_.end(), [](const MidiApi& other) {
      return other.name() == "alsa" && other.works();
    });
    return !(is_jack(api.name()) && has_alsa && is_alsa_seen_by_jack(name));
  }

  bool is_left_out(const std::string& name) const {
    return config_.ports.empty() && !config_.left_out.empty() && has_part(name, config_.left_out);
  }

  /// The key of the open port of that very name; empty: none.
  std::string open_key(const MidiApi& api, const std::string& name) const {
    const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) {
      return slot.input && !slot.is_virtual && slot.api == api.name() && slot.name == name;
    });
    return found == slots_.end() ? std::string() : found->key;
  }

  /// Of two keyboards of one make the second is "#2", and stays it when the first is unplugged.
  std::vector<Source> wanted(MidiApi& api) {
    std::vector<Source> all;
    for (const std::string& name : api.sources()) {
      if (is_wanted(api, name)) all.push_back({open_key(api, name), name});
      if (is_left_out(name) && !OwnOutput::has(api.name(), name)) left_out_.push_back(name);
    }
    const auto is_taken = [&](const std::string& key) {
      return std::any_of(all.begin(), all.end(),
                         [&](const Source& source) { return source.key == key; });
    };
    for (Source& source : all) {
      if (!source.key.empty()) continue;
      const std::string plain = api.name() == "alsa" ? without_numbers(source.name) : source.name;
      std::string key = plain;
      for (int twin = 2; is_taken(key); ++twin) key = plain + " #" + std::to_string(twin);
      source.key = key;
    }
    return all;
  }

  /// True if it was open.
  bool close(Slot& slot) {
    if (!slot.input) return false;
    slot.cable->end();
    MidiApi* const api = api_of(slot);
    api->close(std::move(*slot.input));
    slot.input.reset();
    slot.closed_ns = steady_clock_ns();
    slot.connections.clear();
    return true;
  }

  bool close_vanished(const MidiApi& api, const std::vector<Source>& sources) {
    bool has_closed = false;
    for (Slot& slot : slots_) {
      if (slot.api != api.name() || slot.is_virtual) continue;
      const auto here = std::find_if(sources.begin(), sources.end(), [&](const Source& source) {
        return source.key == slot.key && source.name == slot.name;
      });
      if (here == sources.end()) {
        slot.fault.clear();
        has_closed |= close(slot);
      }
    }
    return has_closed;
  }

  /// The port that had this key before, else a new one, else the one that is closed for the longest
  /// time. Null: all are open.
  Slot* slot_for(const MidiApi& api, const std::string& key, bool is_virtual) {
    Slot* longest_closed = nullptr;
    for (Slot& slot : slots_) {
      if (slot.api == api.name() && slot.key == key && slot.is_virtual == is_virtual) return &slot;
      if (slot.input || slot.is_virtual) continue;
      if (longest_closed == nullptr || slot.closed_ns < longest_closed->closed_ns) {
        longest_closed = &slot;
      }
    }
    if (slots_.size() < kMaxMidiPorts) {
      longest_closed = &slots_.emplace_back();
      longest_closed->cable = std::make_shared<MidiCable>(number(*longest_closed), listener_, 0, 0);
    }
    if (longest_closed == nullptr) return nullptr;
    longest_closed->api = api.name();
    longest_closed->key = key;
    longest_closed->is_virtual = is_virtual;
    longest_closed->fault.clear();
    longest_closed->next_try_ns = 0;
    return longest_closed;
  }

  int number(const Slot& slot) const { return static_cast<int>(&slot - slots_.data()); }

  bool open_new(MidiApi& api, const std::vector<Source>& sources, std::int64_t now_ns) {
    bool has_opened = false;
    if (config_.virtual_port) {
      has_opened |= open(api, {"virtual", config_.client_name + ":in"}, true, now_ns);
    }
    for (const Source& source : sources) has_opened |= open(api, source, false, now_ns);
    return has_opened;
  }

  bool open(MidiApi& api, const Source& source, bool is_virtual, std::int64_t now_ns) {
    Slot* const slot = slot_for(api, source.key, is_virtual);
    if (slot == nullptr) {
      too_many_.push_back(source.name);
      return false;
    }
    if (slot->input || now_ns < slot->next_try_ns) return false;
    slot->name = source.name;
    slot->next_try_ns = now_ns + kReopenNs;
    slot->cable = std::make_shared<MidiCable>(number(*slot), listener_, slot->cable->messages(),
                                              slot->cable->faults());
    auto input = is_virtual ? api.open_virtual(slot->cable, slot->full_name)
                            : api.open(source.name, slot->cable);
    if (!input) {
      slot->fault = input.error().message;
      return false;
    }
    slot->fault.clear();
    slot->input = std::move(*input);
    slot->next_try_ns = 0;
    if (is_virtual && !slot->full_name.empty()) slot->name = slot->full_name;
    return true;
  }

  /// A cable pulled out of our own port leaves the port where it is, but its notes must end.
  void watch_virtual(const MidiApi& api) {
    for (Slot& slot : slots_) {
      if (slot.api != api.name() || !slot.is_virtual || !slot.input) continue;
      auto now = api.connections(slot.full_name);
      const bool has_lost = std::any_of(
          slot.connections.begin(), slot.connections.end(), [&](const std::string& before) {
            return std::find(now.begin(), now.end(), before) == now.end();
          });
      if (has_lost) slot.cable->end_notes();
      slot.connections = std::move(now);
    }
  }

  MidiInputConfig config_;
  MidiListener& listener_;
  std::vector<MidiApi> apis_;
  std::vector<Slot> slots_ = reserved();
  std::vector<std::string> too_many_, left_out_;

  static std::vector<Slot> reserved() {
    std::vector<Slot> slots;
    slots.reserve(kMaxMidiPorts);  // slot_for() keeps pointers
    return slots;
  }
};

void list_api(const std::string& name, MidiPortList& list) {
  std::unique_ptr<JackWatch> watch;  // for as long as RtMidi has clients
  if (is_jack(name)) {
    auto opened = JackWatch::open("Knotwave-list");
    if (!opened) {
      list.notes.push_back(name + ": " + opened.error().message);
      return;
    }
    watch = std::move(*opened);
    for (const std::string& port : watch->sources()) list.inputs.push_back({name, port});
    for (const std::string& port : watch->sinks()) list.outputs.push_back({name, port});
    return;
  }
  auto in = RtMidiInput::create(name, "Knotwave-list");
  auto out = RtMidiOutput::create(name, "Knotwave-list");
  if (!in || !out) {
    list.notes.push_back(name + ": " + (in ? out.error().message : in.error().message));
    return;
  }
  for (const std::string& port : (**in).names()) list.inputs.push_back({name, port});
  for (const std::string& port : (**out).names()) list.outputs.push_back({name, port});
}

}  // namespace

MidiPortList list_midi_ports() {
  MidiPortList list;
  silence_alsa();
  for (const std::string& name : midi_apis()) list_api(name, list);
  return list;
}

Result<std::unique_ptr<MidiInputs>> MidiInputs::open(const MidiInputConfig& config,
                                                     MidiListener& listener) {
  silence_alsa();
  MidiInputConfig checked = config;
  checked.api = lower_case(config.api);
  const std::vector<std::string> apis = midi_apis();
  if (!checked.api.empty() && std::find(apis.begin(), apis.end(), checked.api) == apis.end()) {
    return fail(ErrorCode::unknown_name,
                "there is no MIDI API '" + config.api + "' here; there is: " + listed(apis));
  }
  auto inputs = std::make_unique<RtMidiInputs>(checked, listener);
  inputs->poll();
  if (const auto fine = inputs->check(); !fine) return fine.error();
  return std::unique_ptr<MidiInputs>(std::move(inputs));
}

}  // namespace knotwave::io
