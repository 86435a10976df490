// SPDX-License-Identifier: MIT
// Which of the devices found is meant by an API's name, a number or part of a name.
#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "audio_backend.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kMostNamed = 12;  // a longer list is cut, and says where the whole one is

std::string joined(const std::vector<std::string>& parts, const char* between) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : between) + part;
  return out;
}

std::string names_of(const std::vector<const FoundDevice*>& devices) {
  std::vector<std::string> names;
  for (const FoundDevice* device : devices) {
    if (names.size() == kMostNamed) {
      names.push_back("... (--list-devices shows all)");
      break;
    }
    const AudioDeviceInfo& info = device->info;
    names.push_back(std::to_string(info.number) + " " + info.api + " '" + info.name + "'");
  }
  return joined(names, ", ");
}

std::string reasons(const FoundDevices& found) {
  return found.notes.empty() ? "" : " (" + joined(found.notes, "; ") + ")";
}

Error no_device(const FoundDevices& found, const std::string& api) {
  const std::string which = api.empty() ? "" : " of " + api;
  return fail(ErrorCode::unsupported, "no sound device" + which +
                                          ": start a JACK or PipeWire server, or plug one in" +
                                          reasons(found));
}

Error unknown_api(const FoundDevices& found, const std::string& api) {
  std::vector<std::string> known;
  const auto add = [&known](const std::string& name) {
    if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  };
  for (const FoundDevice& device : found.devices) add(device.info.api);
  for (const std::string& note : found.notes) {
    if (note.rfind("portaudio:", 0) != 0) add(note.substr(0, note.find(':')));
  }
  known.emplace_back("none");
  return fail(ErrorCode::unknown_name, "there is no audio API '" + api + "' here; there is: " +
                                           joined(known, ", ") + reasons(found));
}

bool has_note_on(const FoundDevices& found, const std::string& api) {
  return std::any_of(found.notes.begin(), found.notes.end(),
                     [&](const std::string& note) { return note.rfind(api + ":", 0) == 0; });
}

std::optional<int> number_in(std::string_view text) {
  int number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc{} || end != text.data() + text.size() || number < 0) return {};
  return number;
}

using Devices = std::vector<const FoundDevice*>;

Devices named(const Devices& devices, const std::string& name) {
  Devices exact, part;
  for (const FoundDevice* device : devices) {
    const std::string its = lower_case(device->info.name);
    if (its == name) exact.push_back(device);
    if (its.find(name) != std::string::npos) part.push_back(device);
  }
  return exact.empty() ? part : exact;
}

Devices numbered(const Devices& devices, int number) {
  Devices found;
  for (const FoundDevice* device : devices) {
    if (device->info.number == number) found.push_back(device);
  }
  return found;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

Result<FoundDevice> choose_device(const FoundDevices& found, const AudioConfig& config) {
  const std::string& api = config.api;
  Devices candidates;
  for (const FoundDevice& device : found.devices) {
    if (api.empty() || device.info.api == api) candidates.push_back(&device);
  }
  if (candidates.empty()) {
    if (api.empty() || has_note_on(found, api)) return no_device(found, api);
    return unknown_api(found, api);
  }
  if (config.device.empty()) {
    const auto by_default =
        std::find_if(candidates.begin(), candidates.end(),
                     [](const auto* device) { return device->info.is_default; });
    return by_default == candidates.end() ? *candidates.front() : **by_default;
  }
  const auto number = number_in(config.device);
  const Devices meant =
      number ? numbered(candidates, *number) : named(candidates, lower_case(config.device));
  if (meant.size() == 1) return *meant.front();
  const std::string asked = "'" + config.device + "'";
  if (!meant.empty()) {
    return fail(ErrorCode::unknown_name, "more than one device is named " + asked + ": " +
                                             names_of(meant) +
                                             "; give more of the name or a number");
  }
  return fail(ErrorCode::unknown_name, "no device " + asked + (api.empty() ? "" : " of " + api) +
                                           "; there is: " + names_of(candidates));
}

}  // namespace knotwave::io
