// SPDX-License-Identifier: MIT
#include "patch_words.h"

#include <algorithm>
#include <charconv>
#include <span>

#include "knotwave/base/suggest.h"

namespace knotwave::engine {
namespace {

struct NamedSource {
  std::string_view word;
  MapSource source;
  int index = 0;
};
constexpr NamedSource kSources[] = {
    {"constant", MapSource::constant},
    {"velocity", MapSource::velocity},
    {"release_velocity", MapSource::release_velocity},
    {"key", MapSource::key},
    {"key_octaves", MapSource::key_octaves},
    {"random", MapSource::random},
    {"pressure", MapSource::pressure},
    {"channel_pressure", MapSource::channel_pressure},
    {"poly_pressure", MapSource::poly_pressure},
    {"timbre", MapSource::timbre},
    {"bend", MapSource::pitch_bend},
    {"mod", MapSource::control, 1},
    {"breath", MapSource::control, 2},
    {"foot", MapSource::control, 4},
    {"expression", MapSource::control, 11},
};
constexpr int kLastController = 119;  // above are channel mode messages

struct NamedTarget {
  std::string_view word;
  MapTarget target;
};
constexpr NamedTarget kVoiceTargets[] = {
    {"amp", MapTarget::amp},
    {"gain", MapTarget::gain},
    {"pitch", MapTarget::pitch},
    {"pan", MapTarget::pan},
};
constexpr NamedTarget kOscillatorTargets[] = {
    {"level", MapTarget::level}, {"gain", MapTarget::gain},   {"pitch", MapTarget::pitch},
    {"pan", MapTarget::pan},     {"phase", MapTarget::phase}, {"position", MapTarget::position},
};
constexpr NamedTarget kNoiseTargets[] = {
    {"noise.level", MapTarget::level},
    {"noise.gain", MapTarget::gain},
    {"noise.pan", MapTarget::pan},
};
constexpr std::string_view kTargetWords[] = {"amp",      "gain",    "pitch",     "pan", "noise",
                                             "filter",   "shaper",  "crossfade", "lfo", "curve",
                                             "envelope", "surface", "free"};

constexpr base::Synonym kSourceSynonyms[] = {
    {"wheel", "mod"},
    {"aftertouch", "pressure"},
    {"channelaftertouch", "channel_pressure"},
    {"polyaftertouch", "poly_pressure"},
    {"pitchbend", "bend"},
    {"pitchwheel", "bend"},
    {"bender", "bend"},
    {"note", "key"},
    {"pitch", "key"},
    {"keytrack", "key"},
    {"slide", "timbre"},
    {"noise", "random"},
};
constexpr base::Synonym kTargetSynonyms[] = {
    {"volume", "amp"},         {"loudness", "amp"},       {"tremolo", "amp"},
    {"tune", "pitch"},         {"frequency", "pitch"},    {"vibrato", "pitch"},
    {"balance", "pan"},        {"panorama", "pan"},       {"cutoff", "filter.cutoff"},
    {"q", "filter.resonance"}, {"drive", "shaper.drive"}, {"resonance", "filter.resonance"},
};

int controller_number(std::string_view word) {
  const int number = number_after("cc", word);
  return number <= kLastController ? number : -1;
}

bool has_noise(const PatchSpec& patch) { return patch.noise_db > kNoiseOffDb; }

template <class Item>
int index_by_name(const std::vector<Item>& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

// cc0..cc119 as "cc1".
std::vector<std::string> source_words(const PatchSpec& patch) {
  std::vector<std::string> words{"cc1"};
  for (const NamedSource& source : kSources) words.emplace_back(source.word);
  for (const EnvelopeUse& envelope : patch.envelopes) words.push_back(envelope.name);
  for (const LfoUse& lfo : patch.lfos) words.push_back(lfo.name);
  for (const std::string& name : patch.free_numbers)
    words.push_back(std::string(kFreePrefix) + name);
  return words;
}

std::vector<std::string> target_words(const PatchSpec& patch) {
  std::vector<std::string> words;
  for (TargetChoice& choice : target_choices(patch)) words.push_back(std::move(choice.word));
  for (const curves::NurbsCurve& curve : patch.curves.curves) {
    words.push_back("curve." + curve.name() + ".weight.0");
    words.push_back("curve." + curve.name() + ".point.0");
  }
  return words;
}

std::string suggested(std::string_view word, const std::vector<std::string>& words,
                      std::span<const base::Synonym> synonyms) {
  return base::suggestion(word, std::vector<std::string_view>(words.begin(), words.end()),
                          synonyms);
}

}  // namespace

std::vector<TargetChoice> target_choices(const PatchSpec& patch) {
  std::vector<TargetChoice> all;
  for (const auto& [word, target] : kVoiceTargets) {
    if (patch.has_sound) all.push_back({std::string(word), {target, -1}});
  }
  for (std::size_t i = 0; i < patch.oscillators.size(); ++i) {
    for (const auto& [word, target] : kOscillatorTargets) {
      all.push_back(
          {patch.oscillators[i].name + "." + std::string(word), {target, static_cast<int>(i)}});
    }
  }
  if (has_noise(patch)) {
    for (const auto& [word, target] : kNoiseTargets) {
      all.push_back({std::string(word), {target, kMaxOscillators}});
    }
  }
  if (patch.filter_on) {
    all.push_back({"filter.cutoff", {MapTarget::cutoff, -1}});
    all.push_back({"filter.resonance", {MapTarget::resonance, -1}});
  }
  if (!patch.shaper_curve.empty()) all.push_back({"shaper.drive", {MapTarget::drive, -1}});
  if (patch.crossfade_on) all.push_back({"crossfade", {MapTarget::crossfade, -1}});
  for (std::size_t i = 0; i < patch.lfos.size(); ++i) {
    all.push_back(
        {"lfo." + patch.lfos[i].name + ".rate", {MapTarget::lfo_rate, static_cast<int>(i)}});
  }
  for (std::size_t i = 0; i < patch.envelopes.size(); ++i) {
    all.push_back({"envelope." + patch.envelopes[i].name + ".time",
                   {MapTarget::envelope_time, static_cast<int>(i)}});
  }
  for (std::size_t i = 0; i < patch.free_numbers.size(); ++i) {
    all.push_back({std::string(kFreePrefix) + patch.free_numbers[i],
                   {MapTarget::free_number, static_cast<int>(i)}});
  }
  return all;
}

int number_after(std::string_view prefix, std::string_view word) {
  if (!word.starts_with(prefix)) return -1;
  word.remove_prefix(prefix.size());
  if (word.size() > 1 && word.front() == '0') return -1;  // one way to write each
  int number = -1;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = status == std::errc{} && end == word.data() + word.size();
  return whole && number >= 0 ? number : -1;
}

bool is_controller_word(std::string_view word) {
  return word.size() > 2 && word.starts_with("cc") &&
         word.find_first_not_of("0123456789", 2) == std::string_view::npos;
}

bool is_source_word(std::string_view word) {
  return controller_number(word) >= 0 ||
         std::any_of(std::begin(kSources), std::end(kSources),
                     [&](const NamedSource& source) { return source.word == word; });
}

bool is_target_word(std::string_view word) {
  return std::find(std::begin(kTargetWords), std::end(kTargetWords), word) !=
         std::end(kTargetWords);
}

std::optional<SourceWord> find_source(const PatchSpec& patch, std::string_view word) {
  for (const NamedSource& source : kSources) {
    if (source.word == word) return SourceWord{source.source, source.index};
  }
  if (const int number = controller_number(word); number >= 0) {
    return SourceWord{MapSource::control, number};
  }
  if (const int i = index_by_name(patch.envelopes, word); i >= 0) {
    return SourceWord{MapSource::envelope, i};
  }
  if (const int i = index_by_name(patch.lfos, word); i >= 0) return SourceWord{MapSource::lfo, i};
  for (std::size_t i = 0; i < patch.free_numbers.size(); ++i) {
    if (word.starts_with(kFreePrefix) && word.substr(kFreePrefix.size()) == patch.free_numbers[i])
      return SourceWord{MapSource::free_number, static_cast<int>(i)};
  }
  return std::nullopt;
}

std::string source_suggestion(const PatchSpec& patch, std::string_view word) {
  return suggested(word, source_words(patch), kSourceSynonyms);
}

std::optional<TargetWord> find_target(const PatchSpec& patch, std::string_view word) {
  for (const TargetChoice& choice : target_choices(patch)) {
    if (choice.word == word) return choice.target;
  }
  return std::nullopt;
}

std::string target_suggestion(const PatchSpec& patch, std::string_view word) {
  return suggested(word, target_words(patch), kTargetSynonyms);
}

}  // namespace knotwave::engine
