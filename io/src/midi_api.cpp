// SPDX-License-Identifier: MIT
#include "midi_api.h"

#include <chrono>
#include <limits>

#include "knotwave/io/audio_device.h"

#include "patient_call.h"

namespace knotwave::io {
namespace {

constexpr std::int64_t kRetryNs = 500'000'000;
constexpr std::chrono::milliseconds kClosesWithin{700};
constexpr const char* kOwnName = "in";

/// Destroys what talks to the JACK server. Where that hangs, it is left behind.
template <class Owned>
void close_patiently(Owned owned) {
  auto* const left = new Owned(std::move(owned));
  // Refused: an earlier call still hangs, and this one would too.
  static_cast<void>(jack_calls().run(kClosesWithin, [left] { delete left; }));
}

}  // namespace

MidiApi::MidiApi(std::string name, std::string client_name)
    : name_(std::move(name)), client_name_(std::move(client_name)) {}

MidiApi::~MidiApi() { stop(); }

bool MidiApi::start(std::int64_t now_ns) {
  if (works_ || now_ns < next_try_ns_) return false;
  if (is_jack(name_)) {
    next_try_ns_ = now_ns + kRetryNs;
    auto watch = JackWatch::open(client_name_ + "-watch");
    if (watch) {
      watch_ = std::move(*watch);
    } else {
      fault_ = watch.error().message;
    }
    works_ = watch_ != nullptr;
  } else {
    next_try_ns_ = std::numeric_limits<std::int64_t>::max();
    auto lister = RtMidiInput::create(name_, client_name_);
    if (lister) {
      lister_ = std::move(*lister);
    } else {
      fault_ = lister.error().message;
    }
    works_ = lister_ != nullptr;
  }
  if (works_) fault_.clear();
  return works_;
}

void MidiApi::stop() {
  if (has_gone()) fault_ = "the server has gone";
  if (watch_) close_patiently(std::move(watch_));
  lister_.reset();
  works_ = false;
}

std::vector<std::string> MidiApi::sources() {
  if (watch_) return watch_->sources();
  return lister_ ? (*lister_).names() : std::vector<std::string>();
}

Result<OpenInput> MidiApi::make(std::shared_ptr<MidiCable> cable) const {
  auto made = RtMidiInput::create(name_, client_name_);
  if (!made) return made.error();
  OpenInput input{std::move(cable), std::move(*made)};
  RtMidiIn& port = **input.port;
  port.ignoreTypes(false, false, false);
  port.setCallback(
      [](double, std::vector<unsigned char>* bytes, void* to) {
        static_cast<MidiCable*>(to)->receive(*bytes, steady_clock_ns());
      },
      input.cable.get());
  return input;
}

Result<OpenInput> MidiApi::open(const std::string& source, std::shared_ptr<MidiCable> cable) {
  auto input = make(std::move(cable));
  if (!input || input->port->open(source, kOwnName)) return input;
  const std::string complaint = input->port->complaint();
  close(std::move(*input));
  return fail(ErrorCode::io_failed, complaint);
}

Result<OpenInput> MidiApi::open_virtual(std::shared_ptr<MidiCable> cable, std::string& full_name) {
  const auto before = watch_ ? watch_->sinks() : std::vector<std::string>();
  auto input = make(std::move(cable));
  if (!input) return input;
  if (!input->port->open_virtual(kOwnName)) {
    const std::string complaint = input->port->complaint();
    close(std::move(*input));
    return fail(ErrorCode::unsupported, complaint);
  }
  full_name = watch_ ? new_name(before, watch_->sinks(), kOwnName) : std::string();
  return input;
}

void MidiApi::close(OpenInput input) {
  if (is_jack(name_)) {
    close_patiently(std::move(input));
  } else {
    input.port.reset();
  }
}

std::vector<std::string> MidiApi::connections(const std::string& full_name) const {
  if (!watch_ || full_name.empty()) return {};
  return watch_->connections(full_name);
}

}  // namespace knotwave::io
