// SPDX-License-Identifier: MIT
#include "map_schedule.h"

#include <algorithm>

namespace knotwave::engine {
namespace {

using Step = PatchProgram::Step;
using Kind = PatchProgram::Step::Kind;

class Scheduler {
 public:
  Scheduler(std::span<const PatchProgram::MapPart> maps,
            std::span<const PatchProgram::EnvelopePart> envelopes,
            std::span<const PatchProgram::LfoPart> lfos)
      : maps_(maps),
        envelopes_(envelopes),
        lfos_(lfos),
        map_done_(maps.size()),
        envelope_done_(envelopes.size()),
        lfo_done_(lfos.size()) {}

  // Takes, again and again, all whose inputs are computed. What is left when nothing more can be
  // taken moves itself.
  Schedule run() {
    const std::size_t total = maps_.size() + envelopes_.size() + lfos_.size();
    while (steps_.size() < total) {
      const std::size_t before = steps_.size();
      take(Kind::map, map_done_, [&](std::size_t i) {
        return source_is_ready(maps_[i].source, maps_[i].source_index) &&
               source_is_ready(maps_[i].source_v, maps_[i].source_v_index) &&
               slots_are_ready(slots_read_by(maps_[i]));
      });
      take(Kind::envelope, envelope_done_,
           [&](std::size_t i) { return slots_are_ready(envelopes_[i].control_slots); });
      take(Kind::lfo, lfo_done_, [&](std::size_t i) {
        return slot_is_ready(kSlotLfoRate + static_cast<int>(i)) &&
               slots_are_ready(lfos_[i].control_slots);
      });
      if (steps_.size() == before) break;
    }
    return {std::move(steps_), stuck()};
  }

 private:
  template <class Ready>
  void take(Kind kind, std::vector<bool>& done, Ready&& ready) {
    for (std::size_t i = 0; i < done.size(); ++i) {
      if (done[i] || !ready(i)) continue;
      done[i] = true;
      steps_.push_back({kind, static_cast<int>(i)});
    }
  }

  bool source_is_ready(MapSource source, int index) const {
    if (source == MapSource::envelope) return envelope_done_[static_cast<std::size_t>(index)];
    if (source == MapSource::lfo) return lfo_done_[static_cast<std::size_t>(index)];
    return true;
  }
  bool slot_is_ready(int slot) const {
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      if (maps_[i].slot == slot && !map_done_[i]) return false;
    }
    return true;
  }
  bool slots_are_ready(const std::vector<int>& slots) const {
    return std::all_of(slots.begin(), slots.end(), [&](int slot) { return slot_is_ready(slot); });
  }

  std::vector<Step> stuck() const {
    std::vector<Step> left;
    const auto add = [&](Kind kind, const std::vector<bool>& done) {
      for (std::size_t i = 0; i < done.size(); ++i) {
        if (!done[i]) left.push_back({kind, static_cast<int>(i)});
      }
    };
    add(Kind::map, map_done_);
    add(Kind::envelope, envelope_done_);
    add(Kind::lfo, lfo_done_);
    // What nothing left waits for is only behind a circle.
    for (std::size_t before = 0; before != left.size();) {
      before = left.size();
      const std::vector<Step> all = left;
      std::erase_if(left, [&](const Step& step) {
        return std::none_of(all.begin(), all.end(),
                            [&](const Step& other) { return waits_for(other, step); });
      });
    }
    return left;
  }

  bool waits_for(const Step& step, const Step& other) const {
    const auto i = static_cast<std::size_t>(step.index), k = static_cast<std::size_t>(other.index);
    const auto reads = [](const std::vector<int>& slots, int slot) {
      return std::find(slots.begin(), slots.end(), slot) != slots.end();
    };
    if (other.kind != Kind::map) {
      const auto source = other.kind == Kind::envelope ? MapSource::envelope : MapSource::lfo;
      if (step.kind != Kind::map) return false;
      const PatchProgram::MapPart& map = maps_[i];
      return (map.source == source && map.source_index == other.index) ||
             (map.source_v == source && map.source_v_index == other.index);
    }
    const int slot = maps_[k].slot;
    if (step.kind == Kind::map) return reads(slots_read_by(maps_[i]), slot);
    if (step.kind == Kind::envelope) return reads(envelopes_[i].control_slots, slot);
    return slot == kSlotLfoRate + step.index || reads(lfos_[i].control_slots, slot);
  }

  std::span<const PatchProgram::MapPart> maps_;
  std::span<const PatchProgram::EnvelopePart> envelopes_;
  std::span<const PatchProgram::LfoPart> lfos_;
  std::vector<bool> map_done_, envelope_done_, lfo_done_;
  std::vector<Step> steps_;
};

}  // namespace

std::vector<int> slots_read_by(const PatchProgram::MapPart& map) {
  std::vector<int> slots = map.control_slots;
  if (map.source == MapSource::free_number) slots.push_back(kSlotFree + map.source_index);
  if (map.source_v == MapSource::free_number) slots.push_back(kSlotFree + map.source_v_index);
  return slots;
}

Schedule make_schedule(std::span<const PatchProgram::MapPart> maps,
                       std::span<const PatchProgram::EnvelopePart> envelopes,
                       std::span<const PatchProgram::LfoPart> lfos) {
  return Scheduler(maps, envelopes, lfos).run();
}

}  // namespace knotwave::engine
