// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_output.h"

#include <algorithm>
#include <optional>

#include "knotwave/io/midi_queue.h"

#include "audio_backend.h"
#include "complete_midi.h"
#include "midi_backend.h"
#include "rtmidi_port.h"

namespace knotwave::io {
namespace {

constexpr const char* kRtMidiJack = "rtmidi-jack";

class OpenOutput : public MidiOutput {
 public:
  Result<void> send(std::span<const std::uint8_t> message) override {
    base::MidiEvent event;
    if (message.size() > kLongestMidi) return too_long(message.size());
    if (!read_complete_midi(message, event)) return no_message();
    if (watch_ && !watch_->is_alive()) {
      return fail(ErrorCode::io_failed, "the JACK server has gone");
    }
    try {
      (*port_)->sendMessage(message.data(), message.size());
    } catch (const std::exception& error) {
      return fail(ErrorCode::io_failed, error.what());
    }
    return {};
  }
  bool exists() override {
    if (watch_ && !watch_->is_alive()) return false;
    if (!is_theirs_) return true;
    if (!watch_ && !lister_) return true;  // nobody can tell
    const auto names = watch_ ? watch_->sinks() : lister_->names();
    return std::find(names.begin(), names.end(), name_) != names.end();
  }
  const std::string& api() const override { return api_; }
  const std::string& name() const override { return name_; }

  /// `api` with our own port, or with the port whose name has `config.port`.
  static Result<std::unique_ptr<OpenOutput>> open(const std::string& api,
                                                  const MidiOutputConfig& config) {
    auto output = std::make_unique<OpenOutput>();
    output->api_ = api;
    if (is_jack(api)) {
      auto watch = JackWatch::open(config.client_name + "-watch");
      if (!watch) return watch.error();
      output->watch_ = std::move(*watch);
    }
    auto port = RtMidiOutput::create(api, config.client_name);
    if (!port) return port.error();
    output->port_ = std::move(*port);
    const auto done =
        config.port.empty() ? output->be_port(config.own_name) : output->find_port(config);
    if (!done) return done.error();
    return output;
  }

 private:
  std::vector<std::string> sources() const {
    if (watch_) return watch_->sources();
    auto lister = RtMidiInput::create(api_, "Knotwave-list");
    return lister ? (**lister).names() : std::vector<std::string>();
  }

  Result<void> be_port(const std::string& own_name) {
    const auto before = sources();
    if (!port_->open_virtual(own_name)) return fail(ErrorCode::unsupported, port_->complaint());
    own_.emplace(api_, new_name(before, sources(), own_name));
    name_ = own_->name();
    return {};
  }

  Result<void> find_port(const MidiOutputConfig& config) {
    auto meant = one_output(api_, port_->names(), config.port);
    if (!meant) return meant.error();
    const auto before = sources();
    if (!port_->open(*meant, config.own_name)) {
      return fail(ErrorCode::io_failed, "'" + *meant + "': " + port_->complaint());
    }
    own_.emplace(api_, new_name(before, sources(), config.own_name));
    name_ = std::move(*meant);
    is_theirs_ = true;
    if (watch_) return {};
    if (auto lister = RtMidiOutput::create(api_, "Knotwave-list")) lister_ = std::move(*lister);
    return {};
  }

  std::string api_, name_;
  bool is_theirs_ = false;
  std::unique_ptr<JackWatch> watch_;      ///< jack
  std::unique_ptr<RtMidiOutput> lister_;  ///< the others: exists() need not be of port_'s thread
  std::optional<OwnOutput> own_;
  std::unique_ptr<RtMidiOutput> port_;  ///< goes first
};

/// Each API that works has its own answer to a name that nobody has: all are told.
Error refused_by_all(const std::vector<Error>& errors, const std::vector<std::string>& apis) {
  std::string reasons;
  std::optional<Error> refusal;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    reasons += (i == 0 ? "" : "; ") + apis[i] + ": " + errors[i].message;
    if (errors[i].code == ErrorCode::unsupported) continue;
    if (refusal) {
      refusal->message += "; " + errors[i].message;
    } else {
      refusal = errors[i];
    }
  }
  if (refusal) return *refusal;
  return fail(ErrorCode::unsupported, "no MIDI output can be opened (" + reasons + ")");
}

Result<std::unique_ptr<MidiOutput>> open_over(const std::string& api,
                                              const MidiOutputConfig& config) {
  if (is_jack(api)) return open_jack_midi_output(config);
  auto output = OpenOutput::open(api == kRtMidiJack ? "jack" : api, config);
  if (!output) return output.error();
  return std::unique_ptr<MidiOutput>(std::move(*output));
}

}  // namespace

Error too_long(std::size_t bytes) {
  return fail(ErrorCode::value_out_of_range, "a message of " + std::to_string(bytes) +
                                                 " bytes is longer than " +
                                                 std::to_string(kLongestMidi));
}

Error no_message() { return fail(ErrorCode::malformed, "these bytes are no MIDI message"); }

Result<std::string> one_output(const std::string& api, const std::vector<std::string>& names,
                               const std::string& part) {
  std::vector<std::string> meant;
  for (const std::string& name : names) {
    if (lower_case(name) == lower_case(part)) return name;
    if (lower_case(name).find(lower_case(part)) != std::string::npos) meant.push_back(name);
  }
  if (meant.empty()) {
    return fail(ErrorCode::unknown_name, "no MIDI output of " + api + " has '" + part +
                                             "' in its name; there is: " + listed(names));
  }
  if (meant.size() == 1) return meant.front();
  return fail(ErrorCode::unknown_name,
              "more than one MIDI output has '" + part + "' in its name: " + listed(meant));
}

Result<std::unique_ptr<MidiOutput>> MidiOutput::open(const MidiOutputConfig& config) {
  silence_alsa();
  const std::string api = lower_case(config.api);
  std::vector<std::string> apis = midi_apis();
  if (api == kRtMidiJack && std::find(apis.begin(), apis.end(), "jack") != apis.end()) {
    apis = {kRtMidiJack};
  }
  if (!api.empty() && std::find(apis.begin(), apis.end(), api) == apis.end()) {
    return fail(ErrorCode::unknown_name,
                "there is no MIDI API '" + config.api + "' here; there is: " + listed(apis));
  }
  if (!api.empty()) apis = {api};
  std::vector<Error> errors;
  for (const std::string& name : apis) {
    auto output = open_over(name, config);
    if (output) return output;
    errors.push_back(output.error());
  }
  return refused_by_all(errors, apis);
}

}  // namespace knotwave::io
