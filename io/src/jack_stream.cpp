// SPDX-License-Identifier: MIT
// A stream as a client of JACK.
#include <algorithm>
#include <cerrno>
#include <utility>

#include "knotwave/base/document.h"

#include "audio_backend.h"
#include "block_watch.h"
#include "jack_graph.h"
#include "library_silence.h"
#include "patient_call.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::milliseconds kServerAnswersWithin{3000};
constexpr std::chrono::milliseconds kClosesWithin{700};
constexpr std::chrono::milliseconds kConnectsWithin{700};
constexpr const char* kNotConnected = "not connected";

class JackStream final : public AudioStream {
 public:
  JackStream(std::shared_ptr<JackGraph> graph, AudioFormat format,
             std::vector<std::string> playback)
      : graph_(std::make_unique<std::shared_ptr<JackGraph>>(std::move(graph))),
        format_(std::move(format)),
        playback_(std::move(playback)) {}
  // The graph goes with the call that closes it, however late, and stays where that is refused.
  ~JackStream() override {
    graph().pump().close();
    jack_calls().run(kClosesWithin, [graph = graph_.release()] { delete graph; });
  }
  JackStream(const JackStream&) = delete;
  JackStream& operator=(const JackStream&) = delete;

  Result<void> start() override;
  // The client stays in the graph, silent, and keeps the connections others made.
  void stop() override {
    graph().pump().close();
    is_started_ = false;
  }
  const AudioFormat& format() const override { return format_; }
  AudioStatus status() override;
  void connect_midi(const std::vector<std::string>& sources) override;

 private:
  void look();
  void follow_server();

  JackGraph& graph() const noexcept { return **graph_; }

  std::unique_ptr<std::shared_ptr<JackGraph>> graph_;  ///< held so that it can be left behind
  AudioFormat format_;
  std::vector<std::string> playback_;  ///< the port each channel is connected to
  bool is_active_ = false, is_started_ = false;
  std::string lost_;                 ///< why
  std::vector<std::string> joined_;  ///< MIDI sources that were connected
  BlockWatch watch_;
};

/// Error text, empty when all went well.
std::string activate_and_connect(JackGraph& graph, const std::vector<std::string>& playback) {
  if (jack_activate(graph.client()) != 0) return "the JACK server does not let us in";
  for (std::size_t c = 0; c < playback.size(); ++c) {
    const char* const ours = jack_port_name(graph.output(c));
    const int fault = jack_connect(graph.client(), ours, playback[c].c_str());
    if (fault != 0 && fault != EEXIST) {
      return "JACK does not connect " + std::string(ours) + " to " + playback[c];
    }
  }
  return {};
}

Result<void> JackStream::start() {
  if (!lost_.empty()) return fail(ErrorCode::io_failed, lost_);
  if (!is_active_) {
    const auto fault = std::make_shared<std::string>();
    const auto outcome =
        jack_calls().run(kServerAnswersWithin, [graph = *graph_, playback = playback_, fault] {
          *fault = activate_and_connect(*graph, playback);
        });
    if (outcome != PatientCall::Outcome::done) *fault = "the JACK server does not answer";
    if (!fault->empty()) return fail(ErrorCode::io_failed, *fault);
    is_active_ = true;
  }
  watch_.restart(steady_clock_ns());
  graph().pump().open();
  is_started_ = true;
  return {};
}

void JackStream::follow_server() {
  JackGraph::News& news = graph().news();
  format_.block_frames = news.block_frames;
  format_.is_freewheeling = news.is_freewheeling;
  jack_latency_range_t range{};
  jack_port_get_latency_range(graph().output(0), JackPlaybackLatency, &range);
  format_.latency_s = static_cast<double>(range.max) / format_.rate_hz;
}

void JackStream::look() {
  JackGraph::News& news = graph().news();
  if (news.is_over) {
    const std::string why = news.reason.data();
    lost_ = "the JACK server has gone" + (why.empty() ? "" : " (" + why + ")");
    return;
  }
  if (news.rate_hz != static_cast<int>(format_.rate_hz)) {
    lost_ = "the JACK server went from " + base::number_text(format_.rate_hz) + " Hz to " +
            std::to_string(news.rate_hz);
    return;
  }
  follow_server();
  const double length_ns = format_.block_frames / format_.rate_hz * 1e9;
  if (is_started_ && watch_.is_silent(graph().pump().blocks(), static_cast<std::int64_t>(length_ns),
                                      steady_clock_ns())) {
    lost_ = "the JACK server has asked for no block for 0.8 s";
  }
}

/// The ports that send to ours; what JACK keeps in shared memory.
std::vector<std::string> sources_of(jack_client_t* client, const std::string& port) {
  std::vector<std::string> names;
  const char** list =
      jack_port_get_all_connections(client, jack_port_by_name(client, port.c_str()));
  for (const char** name = list; name != nullptr && *name != nullptr; ++name) {
    names.emplace_back(*name);
  }
  jack_free(list);
  return names;
}

AudioStatus JackStream::status() {
  using State = AudioStatus::State;
  if (lost_.empty()) look();
  const LoadMeter::Figures load = graph().pump().load();
  AudioStatus status;
  status.state = !lost_.empty() ? State::lost : is_started_ ? State::running : State::stopped;
  status.reason = lost_;
  status.blocks = graph().pump().blocks();
  status.xruns = graph().news().xruns;
  status.midi_dropped = graph().news().midi_dropped;
  if (lost_.empty()) {
    status.midi_sources = sources_of(graph().client(), format_.client_name + ":midi_in");
  }
  status.overruns = load.overruns;
  status.load = load.load;
  status.load_p99 = load.p99;
  status.load_max = load.max;
  return status;
}

void JackStream::connect_midi(const std::vector<std::string>& sources) {
  if (!is_active_ || !lost_.empty()) return;
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  // One that went and came back at once has the same name.
  const std::set<std::string> came = graph().take_ports_that_came();
  std::erase_if(
      joined_, [&](const std::string& name) { return !has(sources, name) || came.contains(name); });
  std::vector<std::string> fresh;
  for (const std::string& name : sources) {
    if (!has(joined_, name)) fresh.push_back(name);
  }
  if (fresh.empty()) return;
  const auto joined = std::make_shared<std::vector<std::string>>();
  const auto outcome = jack_calls().run(
      kConnectsWithin, [graph = *graph_, fresh, joined, ours = format_.client_name + ":midi_in"] {
        for (const std::string& name : fresh) {
          const int fault = jack_connect(graph->client(), name.c_str(), ours.c_str());
          if (fault == 0 || fault == EEXIST) joined->push_back(name);
        }
      });
  // Where the server hangs, status() tells it soon; who is not in the graph yet is tried again.
  if (outcome != PatientCall::Outcome::done) return;
  joined_.insert(joined_.end(), joined->begin(), joined->end());
}

Result<void> check_server(jack_client_t* client, const AudioConfig& config) {
  const double rate_hz = jack_get_sample_rate(client);
  if (config.rate_hz != 0 && config.rate_hz != rate_hz) {
    const std::string its = base::number_text(rate_hz), asked = base::number_text(config.rate_hz);
    return fail(ErrorCode::unsupported, "the JACK server runs at " + its + " Hz, not " + asked +
                                            ": leave the rate out, or start the server anew with "
                                            "that rate (jackd -r " +
                                            asked + ")");
  }
  const auto block = static_cast<int>(jack_get_buffer_size(client));
  if (config.block_frames != 0 && config.block_frames != block) {
    const std::string asked = std::to_string(config.block_frames);
    return fail(ErrorCode::unsupported, "the JACK server runs blocks of " + std::to_string(block) +
                                            " frames, not " + asked +
                                            ": leave the block out, or set the server's "
                                            "(jack_bufsize " +
                                            asked + ")");
  }
  return {};
}

/// The playback port of each channel; none where the stream is to be left unconnected.
Result<std::vector<std::string>> ports_to_play(jack_client_t* client, const AudioConfig& config,
                                               const std::string& device) {
  std::vector<std::string> ports;
  if (!config.connect || device.empty()) return ports;
  for (const JackOutputs& outputs : physical_outputs(client)) {
    if (outputs.name != device) continue;
    for (const int channel : config.channels) {
      if (channel > static_cast<int>(outputs.ports.size())) {
        return fail(ErrorCode::value_out_of_range,
                    "there is no channel " + std::to_string(channel) + ": '" + device + "' has " +
                        std::to_string(outputs.ports.size()));
      }
      ports.push_back(outputs.ports[static_cast<std::size_t>(channel - 1)]);
    }
  }
  if (ports.empty()) return fail(ErrorCode::io_failed, "JACK's '" + device + "' has just gone");
  return ports;
}

OpenedStream open_client(const AudioConfig& config, const std::string& device, AudioClient& audio) {
  std::string why;
  JackClient client = JackClient::open(config.client_name, why);
  if (!client) return fail(ErrorCode::unsupported, "jack: " + why);
  if (const auto fits = check_server(client.get(), config); !fits) return fits.error();
  auto ports = ports_to_play(client.get(), config, device);
  if (!ports) return ports.error();
  AudioFormat format;
  format.api = "jack";
  format.device = ports->empty() ? kNotConnected : device;
  format.client_name = jack_get_client_name(client.get());
  format.rate_hz = jack_get_sample_rate(client.get());
  format.block_frames = static_cast<int>(jack_get_buffer_size(client.get()));
  format.channels = static_cast<int>(config.channels.size());
  format.has_midi = true;
  auto graph = std::make_shared<JackGraph>(std::move(client), audio, format.channels);
  if (const auto entered = graph->enter(); !entered) return entered.error();
  return std::unique_ptr<AudioStream>(
      new JackStream(std::move(graph), std::move(format), std::move(*ports)));
}

}  // namespace

OpenedStream open_jack_stream(const AudioConfig& config, const FoundDevice& device,
                              AudioClient& client) {
  silence_jack();
  const auto opened = std::make_shared<std::unique_ptr<OpenedStream>>();
  const auto outcome =
      jack_calls().run(kServerAnswersWithin, [opened, config, name = device.info.name, &client] {
        *opened = std::make_unique<OpenedStream>(open_client(config, name, client));
      });
  if (outcome == PatientCall::Outcome::done) return std::move(**opened);
  return fail(ErrorCode::io_failed, "the JACK server does not answer: start it anew");
}

}  // namespace knotwave::io
