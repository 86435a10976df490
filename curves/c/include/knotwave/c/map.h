// SPDX-License-Identifier: MIT
// One coordinate drives many targets: maps, current values, grids and meshes. See
// knotwave/curves/map.h and docs/from-opengl.md.
#pragma once
#include "knotwave/c/surface.h"

KW_BEGIN

/// What a map drives.
typedef int32_t kw_target;
enum {
  KW_TARGET_AMP = 0,
  KW_TARGET_PITCH = 1,
  KW_TARGET_PAN = 2,
  KW_TARGET_PHASE = 3,
  KW_TARGET_WAVE_POSITION = 4,
  KW_TARGET_CUTOFF = 5,
  KW_TARGET_RESONANCE = 6,
  KW_TARGET_DRIVE = 7,
  KW_TARGET_CROSSFADE = 8,
  KW_TARGET_CONTROL_POINT = 9,
  KW_TARGET_WEIGHT = 10,
  KW_TARGET_KNOT = 11,
  KW_TARGET_TIME_SCALE = 12,
  KW_TARGET_POSITION = 13,
  KW_TARGET_MODULATION = 14,
  KW_TARGET_FREE_1 = 15,
  KW_TARGET_FREE_2 = 16,
  KW_TARGET_FREE_3 = 17,
  KW_TARGET_FREE_4 = 18
};
#define KW_TARGET_COUNT 19

/// Such as "wave_position"; NULL for any other number. [any]
KW_API const char* kw_target_name(kw_target target);
/// The most coordinates its maps may have, 1 to 4; 0 for any other number. [any]
KW_API int32_t kw_target_widest(kw_target target);

/// A map's place in a set: one map each.
typedef struct kw_map_key {
  kw_target target;
  int32_t parameters;  ///< 1 = curve, 2 = surface
  int32_t width;       ///< coordinates
  bool rational;       ///< weights differ
} kw_map_key;

/// What every target is at one coordinate.
typedef struct kw_map_values {
  double numbers[KW_TARGET_COUNT][4];
  int32_t width[KW_TARGET_COUNT];   ///< how many of them count
  bool evaluated[KW_TARGET_COUNT];  ///< false: the current value
} kw_map_values;

/// n steps from u1 to u2; node n is exactly u2.
typedef struct kw_map_grid {
  double u1;
  double u2;
  int64_t n;
} kw_map_grid;

/// Where a grid's numbers go: one coordinate of one target.
typedef struct kw_map_channel {
  kw_target target;
  int32_t coordinate;
  double* out;  ///< [out_count]
  size_t out_count;
} kw_map_channel;

/// Maps, which of them are enabled, and the current values. Unlike other handles it changes: one
/// thread at a time has it.
typedef struct kw_map_set kw_map_set;

KW_API kw_status kw_map_set_create(kw_map_set** out, kw_error** error);
KW_API void kw_map_set_free(kw_map_set* set);

/// Binds a copy of a curve to a target over [u1, u2] (backwards if u1 > u2), within max_error of
/// it, in place of the map with the same key, and disabled. The key goes to *key, if that is not
/// NULL. [control]
KW_API kw_status kw_map_set_define_curve(kw_map_set* set, kw_target target, double u1, double u2,
                                         const kw_curve* curve, double max_error, kw_map_key* key,
                                         kw_error** error);
/// The same for a surface over [u1, u2] x [v1, v2].
KW_API kw_status kw_map_set_define_surface(kw_map_set* set, kw_target target, double u1, double u2,
                                           double v1, double v2, const kw_surface* surface,
                                           kw_map_key* key, kw_error** error);
/// What was defined, to copies of the caller's own and to [u1, u2] ([u1, u2, v1, v2]). [control]
/// KW_UNKNOWN_NAME.
KW_API kw_status kw_map_set_get_curve(const kw_map_set* set, const kw_map_key* key, double range[2],
                                      kw_curve** out, kw_error** error);
KW_API kw_status kw_map_set_get_surface(const kw_map_set* set, const kw_map_key* key,
                                        double range[4], kw_surface** out, kw_error** error);

// Below, [audio]: no function allocates, locks, blocks or calls the system. Of one target the
// widest enabled map counts, and of two of that width the rational one. Coordinates outside of a
// map's range are clamped (wrapped if its curve is periodic), NaN counts as u1.

/// False, and no effect, for a map that was never defined.
KW_API bool kw_map_set_enable(kw_map_set* set, const kw_map_key* key, bool on);
KW_API bool kw_map_set_is_enabled(const kw_map_set* set, const kw_map_key* key);

/// The value a target has where no map drives it; of more than kw_target_widest() numbers the
/// first, NaN leaves a number as it was.
KW_API kw_status kw_map_set_set_current(kw_map_set* set, kw_target target, const double* value,
                                        size_t value_count);
KW_API const double* kw_map_set_current(const kw_map_set* set, kw_target target, size_t* count);

/// All targets by the maps of curves at u, by the maps of surfaces at (u, v).
KW_API kw_status kw_map_set_evaluate(const kw_map_set* set, double u, kw_map_values* out);
KW_API kw_status kw_map_set_evaluate_uv(const kw_map_set* set, double u, double v,
                                        kw_map_values* out);
/// Derivatives instead of values; 0 where a target is not evaluated or held.
KW_API kw_status kw_map_set_slopes(const kw_map_set* set, double u, kw_map_values* by_u);
KW_API kw_status kw_map_set_slopes_uv(const kw_map_set* set, double u, double v,
                                      kw_map_values* by_u, kw_map_values* by_v);

/// out[i] of every channel is what kw_map_set_evaluate gives at node first + i, to the bit. A
/// target that is none gives 0 everywhere and KW_VALUE_OUT_OF_RANGE.
KW_API kw_status kw_map_set_evaluate_grid(const kw_map_set* set, const kw_map_grid* grid,
                                          int64_t first, const kw_map_channel* channels,
                                          size_t channels_count);
/// The same for surfaces, rows of u, one row a v: out[j * count_u + i] at (first_u + i,
/// first_v + j), until out is full.
KW_API kw_status kw_map_set_evaluate_mesh(const kw_map_set* set, const kw_map_grid* grid_u,
                                          int64_t first_u, int64_t count_u,
                                          const kw_map_grid* grid_v, int64_t first_v,
                                          const kw_map_channel* channels, size_t channels_count);

KW_END
