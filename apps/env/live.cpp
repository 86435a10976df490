// SPDX-License-Identifier: MIT
#include "live.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "knotwave/base/suggest.h"
#include "knotwave/io/audio_device.h"

#include "device_list.h"
#include "status.h"

namespace knotwave::env {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kLookNs = 100'000'000;
constexpr std::int64_t kRestNs = 3 * kSecondNs;

void tell(const std::string& line) {
  std::fprintf(stderr, "knotwave-env: %s\n", io::printable(line, 400).c_str());
}

std::string shown_port(const io::MidiSenderPort& port) {
  return port.name + (port.is_open ? "" : " (gone)");
}

/// What is said where `--midi-out NAME=PORT` names a port that no patch has.
Error no_port(const std::string& name, const std::vector<std::string_view>& names) {
  std::string hint = base::suggestion(name, names);
  if (hint.empty()) {
    for (const std::string_view known : names) {
      if (!known.empty()) hint += (hint.empty() ? "; there is: " : ", ") + std::string(known);
    }
  }
  if (hint.empty()) hint = "; theirs has no name: --midi-out PORT";
  return fail(ErrorCode::usage, "--midi-out: no patch has a port '" + name + "'" + hint);
}

}  // namespace

Result<std::vector<io::MidiOutputConfig>> output_ports(const EnvOptions& options,
                                                       const std::vector<engine::PortSpec>& ports) {
  std::vector<io::MidiOutputConfig> all;
  std::vector<std::string_view> names;
  for (const engine::PortSpec& port : ports) {
    io::MidiOutputConfig& config = all.emplace_back();
    config.api = options.midi_api;
    config.port = port.device;
    config.client_name = kOutputClient;
    if (!port.name.empty()) config.own_name = port.name;
    names.push_back(port.name);
  }
  for (const std::string& word : options.midi_out) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const auto found = std::find(names.begin(), names.end(), name);
    if (equals != std::string::npos && found != names.end()) {
      all[static_cast<std::size_t>(found - names.begin())].port = word.substr(equals + 1);
    } else if (all.empty()) {
      return fail(ErrorCode::usage, "--midi-out '" + word + "': no patch sends MIDI");
    } else if (equals != std::string::npos) {
      return no_port(name, names);
    } else {
      all.front().port = word;
    }
  }
  return all;
}

Result<std::unique_ptr<Live>> Live::open(const EnvOptions& options, const EnvInput& input) {
  std::unique_ptr<Live> live(new Live(options, input));
  auto generator = make_generator(options, input);
  if (!generator) return generator.error();
  live->generator_ = std::move(*generator);
  live->names_ = names_of(*live->generator_, input);
  if (const auto opened = live->open_outputs(); !opened) return opened.error();
  if (const auto opened = live->open_inputs(); !opened) return opened.error();
  return live;
}

Result<void> Live::open_outputs() {
  auto ports = output_ports(options_, generator_->ports());
  if (!ports) return ports.error();
  io::MidiSenderConfig config;
  config.ports = std::move(*ports);
  config.is_woken = true;
  auto sender = io::MidiSender::open(std::move(config));
  if (!sender) return sender.error();
  sender_ = std::move(*sender);
  was_open_.assign(sender_->ports().size(), true);
  reopened_.assign(sender_->ports().size(), 0);
  if (options_.osc) {
    auto osc = io::OscOutput::open(*options_.osc);
    if (!osc) return osc.error();
    osc_ = std::move(*osc);
  }
  if (!input_.voltage_patches().empty()) {
    auto cv = CvStream::open(options_, input_);
    if (!cv) return cv.error();
    cv_ = std::move(*cv);
  }
  return {};
}

Result<void> Live::open_inputs() {
  Planner::Config config;
  config.latency_ns = static_cast<std::int64_t>(options_.latency_ms * 1e6);
  config.monitor = options_.monitor;
  planner_ =
      std::make_unique<Planner>(config, *generator_, *sender_, osc_.get(), cv_.get(), names_);
  io::MidiInputConfig midi;
  midi.api = options_.midi_api == "rtmidi-jack" ? "jack" : options_.midi_api;  // of outputs alone
  midi.ports = options_.midi_in;
  midi.left_out = kOutputClient;
  midi.client_name = "Knotwave-env-in";
  auto inputs = io::MidiInputs::open(midi, *planner_);
  if (!inputs) return inputs.error();
  inputs_ = std::move(*inputs);
  return {};
}

void Live::say_beginning() {
  for (const std::string& note : inputs_->notes()) tell(note);
  if (options_.quiet) return;
  for (const io::MidiSenderPort& port : sender_->ports()) {
    tell("sends to " + port.api + " '" + port.name + "'");
  }
  if (!sender_->ports().empty() && !sender_->why_not_realtime().empty()) {
    tell("the sending thread has no priority: " + sender_->why_not_realtime());
  }
  if (cv_ != nullptr) {
    tell("control voltage to " + cv_->device_text() +
         (options_.direct_current ? "" : "; direct current is kept out (--cv lets it through)"));
  }
  if (osc_ == nullptr && input_.has_osc()) {
    tell("OSC goes nowhere: name a place with --osc");
  }
}

/// Our own port counts once something came through it.
std::string Live::input_name() const {
  std::vector<std::string> open, own;
  for (const io::MidiPortStatus& port : inputs_->ports()) {
    if (!port.is_open) continue;
    (port.is_own && port.messages == 0 ? own : open).push_back(port.name);
  }
  if (open.empty()) open = own;
  if (open.size() == 1) return open.front();
  return open.empty() ? "" : std::to_string(open.size()) + " inputs";
}

void Live::show_status() {
  if (options_.quiet) return;
  const auto ports = sender_->ports();
  std::vector<std::string> lines;
  for (const engine::RouteStatus& route : planner_->routes()) {
    const auto port = static_cast<std::size_t>(std::max(route.port, 0));
    lines.push_back(route_line(input_.programs[static_cast<std::size_t>(route.patch)]->spec(),
                               route, input_name(), route.port < 0 ? "" : shown_port(ports[port])));
  }
  if (lines == told_) return;
  for (const std::string& line : lines) std::printf("%s\n", io::printable(line, 400).c_str());
  std::fflush(stdout);
  told_ = std::move(lines);
}

void Live::show_messages() {
  for (const Planner::Shown& shown : planner_->take_shown()) {
    SentMessage message;
    message.time = shown.time;
    message.port = shown.port;
    message.patch = shown.patch;
    message.output = shown.output;
    message.number = shown.number;
    std::copy_n(shown.bytes, 3, message.bytes);
    const std::string port =
        shown.port < 0 ? "osc" : names_.ports[static_cast<std::size_t>(shown.port)];
    std::printf("%s %s %s\n", seconds_text(shown.time, kClockHz).c_str(),
                io::printable(port).c_str(), io::printable(message_text(message, names_)).c_str());
  }
  std::fflush(stdout);
}

void Live::look() {
  inputs_->poll();
  if (sender_->poll()) {
    const auto ports = sender_->ports();
    for (std::size_t i = 0; i < ports.size(); ++i) {
      if (std::exchange(reopened_[i], ports[i].reopened) != ports[i].reopened) {
        planner_->say_again(static_cast<int>(i));
      }
      if (ports[i].is_open == was_open_[i]) continue;
      was_open_[i] = ports[i].is_open;
      tell("'" + ports[i].name + "' " + (was_open_[i] ? "is back" : "has gone"));
    }
  }
  if (cv_ == nullptr) return;
  if (const std::string news = cv_->look(); !news.empty()) tell(news);
}

/// Destinations at rest, and the last message on its cable.
void Live::rest() {
  planner_->go_to_rest();
  if (cv_ != nullptr) cv_->ramp_out();
  const std::int64_t latest_ns = io::steady_clock_ns() + kRestNs;
  const auto is_at_rest = [this] {
    return planner_->is_at_rest() && sender_->is_done() && (cv_ == nullptr || cv_->is_silent());
  };
  while (!is_at_rest() && io::steady_clock_ns() < latest_ns) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!is_at_rest()) tell("not every destination came to rest within 3 s");
}

Live::End Live::run(const std::atomic<int>& signals) {
  say_beginning();
  planner_->start();
  const std::int64_t begin_ns = io::steady_clock_ns();
  const std::int64_t end_ns = options_.duration_s > 0
                                  ? begin_ns + static_cast<std::int64_t>(options_.duration_s * 1e9)
                                  : INT64_MAX;
  std::int64_t look_ns = begin_ns, show_ns = begin_ns + kSecondNs;
  while (signals == 0 && io::steady_clock_ns() < end_ns) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const std::int64_t now_ns = io::steady_clock_ns();
    if (options_.monitor) show_messages();
    if (now_ns >= look_ns) {
      look();
      look_ns = now_ns + kLookNs;
    }
    if (now_ns >= show_ns) {
      show_status();
      show_ns = now_ns + kSecondNs;
    }
  }
  rest();
  if (options_.monitor) show_messages();
  return signals != 0 ? End::signal : End::duration;
}

std::string device_list() {
  return synth::device_table(io::list_audio_devices(), io::list_midi_ports(),
                             "only control voltage needs one, MIDI and OSC do not");
}

}  // namespace knotwave::env
