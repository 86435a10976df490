// SPDX-License-Identifier: MIT
#include "jack_watch.h"

#include <atomic>
#include <chrono>

#include <jack/jack.h>

#include "jack_devices.h"
#include "jack_session.h"
#include "library_silence.h"
#include "patient_call.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::seconds kServerAnswersWithin{1};

/// What jack_get_ports() and its like give, freed.
std::vector<std::string> taken(const char** names) {
  std::vector<std::string> all;
  for (const char* const* name = names; name != nullptr && *name != nullptr; ++name) {
    all.emplace_back(*name);
  }
  jack_free(names);
  return all;
}

class OpenWatch : public JackWatch {
 public:
  bool is_alive() const noexcept override { return !has_gone_ && !JackTicket::has_server_gone(); }
  std::vector<std::string> sources() const override { return midi_ports(JackPortIsOutput); }
  std::vector<std::string> sinks() const override { return midi_ports(JackPortIsInput); }
  std::vector<std::string> connections(const std::string& port) const override {
    jack_port_t* const found = jack_port_by_name(client_.get(), port.c_str());
    if (found == nullptr) return {};
    return taken(jack_port_get_all_connections(client_.get(), found));
  }

  /// Empty where it worked, else why not.
  std::string open(const std::string& client_name) {
    std::string why;
    client_ = JackClient::open(client_name, why);
    if (!client_) return why;
    jack_on_shutdown(
        client_.get(),
        [](void* watch) {
          static_cast<OpenWatch*>(watch)->has_gone_ = true;
          JackTicket::server_has_gone();
        },
        this);
    return {};
  }

 private:
  std::vector<std::string> midi_ports(unsigned long flags) const {
    return taken(jack_get_ports(client_.get(), nullptr, JACK_DEFAULT_MIDI_TYPE, flags));
  }

  std::atomic<bool> has_gone_{false};
  JackClient client_;
};

struct Attempt {
  std::unique_ptr<OpenWatch> watch = std::make_unique<OpenWatch>();
  std::string fault;
};

}  // namespace

Result<std::unique_ptr<JackWatch>> JackWatch::open(const std::string& client_name) {
  silence_jack();
  const auto attempt = std::make_shared<Attempt>();
  const auto outcome = jack_calls().run(kServerAnswersWithin, [attempt, client_name] {
    attempt->fault = attempt->watch->open(client_name);
  });
  if (outcome != PatientCall::Outcome::done) {
    return fail(ErrorCode::unsupported, "the server does not answer");
  }
  if (!attempt->fault.empty()) return fail(ErrorCode::unsupported, attempt->fault);
  return std::unique_ptr<JackWatch>(std::move(attempt->watch));
}

}  // namespace knotwave::io
