// SPDX-License-Identifier: MIT
// Maps defined, enabled and evaluated from C.
#include "knotwave/curves/map.h"

#include <algorithm>

#include "handles.h"

struct kw_map_set {
  knotwave::curves::MapSet maps;
};

using namespace knotwave;
using namespace knotwave::c;
using curves::MapKey;
using curves::MapSet;
using curves::MapValues;
using curves::Target;

namespace {

static_assert(KW_TARGET_COUNT == curves::kTargetCount);
static_assert(KW_TARGET_AMP == static_cast<int>(Target::amp));
static_assert(KW_TARGET_FREE_4 == static_cast<int>(Target::free_4));

bool is_target(kw_target target) { return target >= 0 && target < KW_TARGET_COUNT; }

/// A key that no map has, if the target is none.
MapKey key_of(const kw_map_key& key) {
  const int width = is_target(key.target) ? key.width : 0;
  return {static_cast<Target>(is_target(key.target) ? key.target : 0), key.parameters, width,
          key.rational};
}

void give_key(const MapKey& from, kw_map_key* key) {
  if (key == nullptr) return;
  *key = {static_cast<kw_target>(from.target), from.parameters, from.width, from.rational};
}

template <class Map>
kw_status define(kw_map_set& set, kw_target target, Map map, kw_map_key* key, kw_error** error) {
  if (!is_target(target)) {
    return report(error, unknown_choice("the target", target, KW_TARGET_COUNT));
  }
  map.target = static_cast<Target>(target);
  return give(set.maps.define(std::move(map)), error,
              [&](const MapKey& defined) { give_key(defined, key); });
}

Error no_such_map(const kw_map_key& key) {
  const char* name = kw_target_name(key.target);
  return fail(ErrorCode::unknown_name, std::string("the set has no map of ") +
                                           (name == nullptr ? "such a target" : name) +
                                           " with this key");
}

void copy_values(const MapValues& from, kw_map_values& to) {
  for (std::size_t t = 0; t < KW_TARGET_COUNT; ++t) {
    std::copy(from.numbers[t].begin(), from.numbers[t].end(), to.numbers[t]);
    to.width[t] = from.width[t];
    to.evaluated[t] = from.evaluated[t];
  }
}

/// work(channel) for each; one whose target is none becomes 0.
template <class Work>
kw_status for_each_channel(const kw_map_channel* channels, size_t count, Work work) {
  for (size_t i = 0; i < count; ++i) {
    if (channels[i].out == nullptr && channels[i].out_count > 0) return KW_NULL_ARGUMENT;
  }
  kw_status status = KW_OK;
  for (size_t i = 0; i < count; ++i) {
    const kw_map_channel& channel = channels[i];
    const std::span<double> out(channel.out, channel.out_count);
    if (is_target(channel.target)) {
      const MapSet::Channel one{static_cast<Target>(channel.target), channel.coordinate, out};
      work(std::span(&one, 1));
    } else {
      std::fill(out.begin(), out.end(), 0.0);
      status = KW_VALUE_OUT_OF_RANGE;
    }
  }
  return status;
}

curves::MapGrid grid_of(const kw_map_grid& grid) { return {grid.u1, grid.u2, grid.n}; }

}  // namespace

const char* kw_target_name(kw_target target) {
  return is_target(target) ? curves::to_string(static_cast<Target>(target)) : nullptr;
}
int32_t kw_target_widest(kw_target target) {
  return is_target(target) ? curves::widest(static_cast<Target>(target)) : 0;
}

kw_status kw_map_set_create(kw_map_set** out, kw_error** error) {
  return run({{"out", out}}, error, [&]() -> kw_status {
    *out = nullptr;
    *out = new kw_map_set;
    return KW_OK;
  });
}
void kw_map_set_free(kw_map_set* set) { delete set; }

kw_status kw_map_set_define_curve(kw_map_set* set, kw_target target, double u1, double u2,
                                  const kw_curve* curve, double max_error, kw_map_key* key,
                                  kw_error** error) {
  return run({{"set", set}, {"curve", curve}}, error, [&] {
    return define(*set, target, curves::Map1{Target::amp, u1, u2, curve->curve, max_error}, key,
                  error);
  });
}

kw_status kw_map_set_define_surface(kw_map_set* set, kw_target target, double u1, double u2,
                                    double v1, double v2, const kw_surface* surface,
                                    kw_map_key* key, kw_error** error) {
  return run({{"set", set}, {"surface", surface}}, error, [&] {
    return define(*set, target, curves::Map2{Target::amp, u1, u2, v1, v2, surface->surface}, key,
                  error);
  });
}

kw_status kw_map_set_get_curve(const kw_map_set* set, const kw_map_key* key, double range[2],
                               kw_curve** out, kw_error** error) {
  return make_curve({{"set", set}, {"key", key}, {"range", range}}, out, error,
                    [&]() -> Result<curves::NurbsCurve> {
                      const curves::Map1* map = set->maps.map1(key_of(*key));
                      if (map == nullptr || key->parameters != 1) return no_such_map(*key);
                      range[0] = map->u1;
                      range[1] = map->u2;
                      return map->curve;
                    });
}

kw_status kw_map_set_get_surface(const kw_map_set* set, const kw_map_key* key, double range[4],
                                 kw_surface** out, kw_error** error) {
  return make_surface({{"set", set}, {"key", key}, {"range", range}}, out, error,
                      [&]() -> Result<curves::NurbsSurface> {
                        const curves::Map2* map = set->maps.map2(key_of(*key));
                        if (map == nullptr || key->parameters != 2) return no_such_map(*key);
                        range[0] = map->u1;
                        range[1] = map->u2;
                        range[2] = map->v1;
                        range[3] = map->v2;
                        return map->surface;
                      });
}

bool kw_map_set_enable(kw_map_set* set, const kw_map_key* key, bool on) {
  return set != nullptr && key != nullptr && set->maps.enable(key_of(*key), on);
}
bool kw_map_set_is_enabled(const kw_map_set* set, const kw_map_key* key) {
  return set != nullptr && key != nullptr && set->maps.is_enabled(key_of(*key));
}

kw_status kw_map_set_set_current(kw_map_set* set, kw_target target, const double* value,
                                 size_t value_count) {
  if (set == nullptr || (value == nullptr && value_count > 0)) return KW_NULL_ARGUMENT;
  if (!is_target(target)) return KW_VALUE_OUT_OF_RANGE;
  set->maps.set_current(static_cast<Target>(target), numbers(value, value_count));
  return KW_OK;
}
const double* kw_map_set_current(const kw_map_set* set, kw_target target, size_t* count) {
  if (set == nullptr || !is_target(target)) return nothing_lent(count);
  return lent(set->maps.current(static_cast<Target>(target)), count);
}

kw_status kw_map_set_evaluate(const kw_map_set* set, double u, kw_map_values* out) {
  if (set == nullptr || out == nullptr) return KW_NULL_ARGUMENT;
  MapValues values;
  set->maps.evaluate(u, values);
  copy_values(values, *out);
  return KW_OK;
}
kw_status kw_map_set_evaluate_uv(const kw_map_set* set, double u, double v, kw_map_values* out) {
  if (set == nullptr || out == nullptr) return KW_NULL_ARGUMENT;
  MapValues values;
  set->maps.evaluate(u, v, values);
  copy_values(values, *out);
  return KW_OK;
}
kw_status kw_map_set_slopes(const kw_map_set* set, double u, kw_map_values* by_u) {
  if (set == nullptr || by_u == nullptr) return KW_NULL_ARGUMENT;
  MapValues slopes;
  set->maps.evaluate_slopes(u, slopes);
  copy_values(slopes, *by_u);
  return KW_OK;
}
kw_status kw_map_set_slopes_uv(const kw_map_set* set, double u, double v, kw_map_values* by_u,
                               kw_map_values* by_v) {
  if (set == nullptr || by_u == nullptr || by_v == nullptr) return KW_NULL_ARGUMENT;
  MapValues of_u, of_v;
  set->maps.evaluate_slopes(u, v, of_u, of_v);
  copy_values(of_u, *by_u);
  copy_values(of_v, *by_v);
  return KW_OK;
}

kw_status kw_map_set_evaluate_grid(const kw_map_set* set, const kw_map_grid* grid, int64_t first,
                                   const kw_map_channel* channels, size_t channels_count) {
  if (set == nullptr || grid == nullptr || (channels == nullptr && channels_count > 0)) {
    return KW_NULL_ARGUMENT;
  }
  return for_each_channel(channels, channels_count, [&](std::span<const MapSet::Channel> one) {
    set->maps.evaluate_grid(grid_of(*grid), first, one);
  });
}

kw_status kw_map_set_evaluate_mesh(const kw_map_set* set, const kw_map_grid* grid_u,
                                   int64_t first_u, int64_t count_u, const kw_map_grid* grid_v,
                                   int64_t first_v, const kw_map_channel* channels,
                                   size_t channels_count) {
  if (set == nullptr || grid_u == nullptr || grid_v == nullptr ||
      (channels == nullptr && channels_count > 0)) {
    return KW_NULL_ARGUMENT;
  }
  if (count_u < 1) return KW_VALUE_OUT_OF_RANGE;
  return for_each_channel(channels, channels_count, [&](std::span<const MapSet::Channel> one) {
    set->maps.evaluate_mesh(grid_of(*grid_u), first_u, count_u, grid_of(*grid_v), first_v, one);
  });
}
