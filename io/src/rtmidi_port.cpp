// SPDX-License-Identifier: MIT
#include "rtmidi_port.h"

#include <algorithm>
#include <mutex>
#include <utility>

namespace knotwave::io {
namespace {

struct OwnOutputs {
  std::mutex mutex;
  std::vector<std::pair<std::string, std::string>> names;  ///< API, full name
};

OwnOutputs& own_outputs() {
  static OwnOutputs outputs;
  return outputs;
}

}  // namespace

std::vector<std::string> midi_apis() {
  std::vector<RtMidi::Api> apis;
  RtMidi::getCompiledApi(apis);
  std::vector<std::string> names;
  for (const RtMidi::Api api : apis) {
    if (api != RtMidi::RTMIDI_DUMMY) names.push_back(RtMidi::getApiName(api));
  }
  return names;
}

RtMidi::Api midi_api(std::string_view name) {
  return RtMidi::getCompiledApiByName(std::string(name));
}

bool is_jack(std::string_view api) { return api == "jack"; }

std::string why_not(std::string_view api, const std::string& said) {
  if (api == "alsa") return "there is no sequencer; as root, `modprobe snd-seq` makes one";
  return said;
}

OwnOutput::OwnOutput(std::string api, std::string name)
    : api_(std::move(api)), name_(std::move(name)) {
  const std::lock_guard lock(own_outputs().mutex);
  own_outputs().names.emplace_back(api_, name_);
}

OwnOutput::~OwnOutput() {
  const std::lock_guard lock(own_outputs().mutex);
  auto& names = own_outputs().names;
  const auto found = std::find(names.begin(), names.end(), std::pair(api_, name_));
  if (found != names.end()) names.erase(found);
}

bool OwnOutput::has(const std::string& api, const std::string& name) {
  const std::lock_guard lock(own_outputs().mutex);
  const auto& names = own_outputs().names;
  return std::find(names.begin(), names.end(), std::pair(api, name)) != names.end();
}

std::string new_name(const std::vector<std::string>& before, const std::vector<std::string>& after,
                     const std::string& own_name) {
  for (const std::string& name : after) {
    if (name.find(':' + own_name) == std::string::npos) continue;
    if (std::find(before.begin(), before.end(), name) == before.end()) return name;
  }
  return {};
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNamed = 12;
  if (names.empty()) return "none";
  std::string all;
  for (std::size_t i = 0; i < names.size() && i < kMostNamed; ++i) {
    all += (i == 0 ? "'" : ", '") + names[i] + "'";
  }
  if (names.size() > kMostNamed) {
    all += " and " + std::to_string(names.size() - kMostNamed) + " more";
  }
  return all;
}

}  // namespace knotwave::io
