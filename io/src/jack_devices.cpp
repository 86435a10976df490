// SPDX-License-Identifier: MIT
#include "jack_devices.h"

#include <algorithm>
#include <string_view>

#include "audio_backend.h"
#include "library_silence.h"
#include "patient_call.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::seconds kServerAnswersWithin{3};

double latency_s(jack_client_t* client, const std::string& port, double rate_hz) {
  jack_latency_range_t range{};
  jack_port_get_latency_range(jack_port_by_name(client, port.c_str()), JackPlaybackLatency, &range);
  return static_cast<double>(range.min) / rate_hz;
}

struct Answer {
  bool runs = false;
  FoundDevices found;
};

void ask_server(Answer& answer) {
  std::string why;
  const JackClient client = JackClient::open("Knotwave-list", why);
  if (!client) {
    answer.found.notes.push_back("jack: " + why);
    return;
  }
  answer.runs = true;
  const double rate_hz = jack_get_sample_rate(client.get());
  for (const JackOutputs& outputs : physical_outputs(client.get())) {
    AudioDeviceInfo info;
    info.api = "jack";
    info.name = outputs.name;
    info.outputs = static_cast<int>(outputs.ports.size());
    info.rate_hz = rate_hz;
    info.latency_s = latency_s(client.get(), outputs.ports.front(), rate_hz);
    info.is_default = answer.found.devices.empty();
    answer.found.devices.push_back({info, -1});
  }
  if (answer.found.devices.empty()) {
    answer.found.notes.emplace_back("jack: the server runs, but has no physical outputs");
  }
}

std::string refusal(jack_status_t status) {
  if ((status & (JackServerFailed | JackServerError)) != 0) return "no server is running";
  if ((status & JackVersionError) != 0) return "the server is of another version than libjack";
  return "the server refused a client (status " + std::to_string(static_cast<int>(status)) + ")";
}

}  // namespace

JackClient JackClient::open(const std::string& name, std::string& why) {
  JackClient client;
  client.ticket_ = JackTicket::take();
  if (!client.ticket_) {
    why = "its server has gone";
    return client;
  }
  jack_status_t status{};
  client.client_.reset(jack_client_open(name.c_str(), JackNoStartServer, &status));
  if (!client) {
    client.ticket_.reset();
    why = refusal(status);
  }
  return client;
}

std::vector<JackOutputs> physical_outputs(jack_client_t* client) {
  std::vector<JackOutputs> found;
  const char** const names = jack_get_ports(client, nullptr, JACK_DEFAULT_AUDIO_TYPE,
                                            JackPortIsPhysical | JackPortIsInput);
  for (const char* const* name = names; name != nullptr && *name != nullptr; ++name) {
    const std::string_view port(*name);
    const std::string_view owner = port.substr(0, port.find(':'));
    auto outputs = std::find_if(found.begin(), found.end(),
                                [&](const JackOutputs& known) { return known.name == owner; });
    if (outputs == found.end()) outputs = found.insert(outputs, {std::string(owner), {}});
    outputs->ports.emplace_back(port);
  }
  jack_free(names);
  return found;
}

JackServer find_jack_devices(FoundDevices& found) {
  silence_jack();
  const auto answer = std::make_shared<Answer>();
  switch (jack_calls().run(kServerAnswersWithin, [answer] { ask_server(*answer); })) {
    case PatientCall::Outcome::done:
      break;
    case PatientCall::Outcome::hangs:
      found.notes.emplace_back("jack: the server does not answer");
      return JackServer::hangs;
    case PatientCall::Outcome::refused:
      found.notes.emplace_back("jack: an earlier call of its library hangs");
      return JackServer::hangs;
  }
  std::move(answer->found.devices.begin(), answer->found.devices.end(),
            std::back_inserter(found.devices));
  std::move(answer->found.notes.begin(), answer->found.notes.end(),
            std::back_inserter(found.notes));
  return answer->runs ? JackServer::runs : JackServer::none;
}

}  // namespace knotwave::io
