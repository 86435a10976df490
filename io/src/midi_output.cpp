// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_output.h"

#include <algorithm>
#include <optional>

#include "knotwave/io/midi_stream.h"

#include "audio_backend.h"
#include "rtmidi_port.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kLongest =
    16000;  // RtMidi drops what its ring for JACK, 16 KiB, does not take

class OpenOutput : public MidiOutput {
 public:
  Result<void> send(std::span<const std::uint8_t> message) override {
    if (message.size() > kLongest) {
      return fail(ErrorCode::value_out_of_range, "a message of " + std::to_string(message.size()) +
                                                     " bytes is longer than " +
                                                     std::to_string(kLongest));
    }
    if (!is_message(message)) return fail(ErrorCode::malformed, "these bytes are no MIDI message");
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
  /// One message, whole, and nothing else.
  bool is_message(std::span<const std::uint8_t> bytes) {
    check_.reset();
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (check_.feed(bytes[i])) return i + 1 == bytes.size();
    }
    return false;
  }

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
    const std::vector<std::string> all = port_->names();
    std::vector<std::string> meant;
    for (const std::string& name : all) {
      if (lower_case(name).find(lower_case(config.port)) != std::string::npos) {
        meant.push_back(name);
      }
    }
    if (meant.empty()) {
      return fail(ErrorCode::unknown_name, "no MIDI output of " + api_ + " has '" + config.port +
                                               "' in its name; there is: " + listed(all));
    }
    if (meant.size() > 1) {
      return fail(ErrorCode::unknown_name, "more than one MIDI output has '" + config.port +
                                               "' in its name: " + listed(meant));
    }
    const auto before = sources();
    if (!port_->open(meant.front(), config.own_name)) {
      return fail(ErrorCode::io_failed, "'" + meant.front() + "': " + port_->complaint());
    }
    own_.emplace(api_, new_name(before, sources(), config.own_name));
    name_ = meant.front();
    return {};
  }

  std::string api_, name_;
  MidiStream check_{kLongest};
  std::unique_ptr<JackWatch> watch_;
  std::optional<OwnOutput> own_;
  std::unique_ptr<RtMidiOutput> port_;  ///< goes first
};

}  // namespace

Result<std::unique_ptr<MidiOutput>> MidiOutput::open(const MidiOutputConfig& config) {
  silence_alsa();
  const std::string api = lower_case(config.api);
  const std::vector<std::string> apis = midi_apis();
  if (!api.empty() && std::find(apis.begin(), apis.end(), api) == apis.end()) {
    return fail(ErrorCode::unknown_name,
                "there is no MIDI API '" + config.api + "' here; there is: " + listed(apis));
  }
  std::string reasons;
  std::optional<Error> refusal;
  for (const std::string& name : apis) {
    if (!api.empty() && api != name) continue;
    auto output = OpenOutput::open(name, config);
    if (output) return std::unique_ptr<MidiOutput>(std::move(*output));
    if (output.error().code != ErrorCode::unsupported) refusal = output.error();
    reasons += (reasons.empty() ? "" : "; ") + name + ": " + output.error().message;
  }
  if (refusal) return *refusal;
  return fail(ErrorCode::unsupported, "no MIDI output can be opened (" + reasons + ")");
}

}  // namespace knotwave::io
