// SPDX-License-Identifier: MIT
// One coordinate drives many targets: the evaluators of OpenGL (glMap, glEvalCoord, glMapGrid,
// glEvalMesh, glGetMap) for sound. docs/from-opengl.md goes through them call by call.
// Source: Khronos, OpenGL 2.1 reference pages of these calls.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/map_grid.h"
#include "knotwave/curves/nurbs_surface.h"
#include "knotwave/curves/surface_program.h"

namespace knotwave::curves {

/// What a map drives. position, modulation and the free ones are families: maps of 1 to 3 (1 to 4)
/// coordinates; the others have one.
enum class Target {
  amp,
  pitch,
  pan,
  phase,
  wave_position,
  cutoff,
  resonance,
  drive,
  crossfade,
  control_point,
  weight,
  knot,
  time_scale,
  position,
  modulation,
  free_1,
  free_2,
  free_3,
  free_4
};
inline constexpr int kTargetCount = 19;

/// Whether a number cast to Target is one. [any]
constexpr bool is_target(Target target) KNOTWAVE_RT {
  return static_cast<int>(target) >= 0 && static_cast<int>(target) < kTargetCount;
}
/// The most coordinates a map onto the target may have; 0 if it is none. [any]
constexpr int widest(Target target) KNOTWAVE_RT {
  if (!is_target(target)) return 0;
  if (target < Target::position) return 1;
  return target == Target::position ? 3 : 4;
}
const char* to_string(Target target) noexcept;  ///< "unknown" if it is none

/// A curve bound to a target over [u1, u2] of the common coordinate; the curve's own domain is
/// mapped linearly onto it, forwards if u1 < u2, backwards if not.
struct Map1 {
  Target target = Target::amp;
  double u1 = 0, u2 = 1;
  NurbsCurve curve;
  double max_error = 1e-7;  ///< as CompileOptions::max_error
};

/// A surface bound to a target over [u1, u2] x [v1, v2].
struct Map2 {
  Target target = Target::amp;
  double u1 = 0, u2 = 1;
  double v1 = 0, v2 = 1;
  NurbsSurface surface;
};

/// A map's place: one map each. What GL_MAP1_VERTEX_4 names, {position, 1, 3, true} names here.
struct MapKey {
  Target target = Target::amp;
  int parameters = 1;     ///< 1 = curve, 2 = surface
  int width = 1;          ///< coordinates
  bool rational = false;  ///< weights differ

  friend constexpr bool operator==(const MapKey&, const MapKey&) = default;
};

/// Bézier maps from points that lie `stride` numbers apart, as glMap1 and glMap2 take them (same
/// order of arguments; order = degree + 1, 2..16; surfaces to be played 2..8). A rational point is
/// (w x, ..., w), width + 1 numbers. [control] Points are copied. Errors: dimension_mismatch (a
/// stride below the numbers of a point, fewer numbers than points need), degree_out_of_range,
/// weight_not_positive, value_out_of_range (the target is none), and those of NurbsCurve::create
/// and NurbsSurface::create.
Result<Map1> bezier_map(const MapKey& key, double u1, double u2, int stride, int order,
                        std::span<const double> points);
Result<Map2> bezier_map(const MapKey& key, double u1, double u2, int ustride, int uorder, double v1,
                        double v2, int vstride, int vorder, std::span<const double> points);

/// What every target is at one coordinate.
struct MapValues {
  std::array<std::array<double, 4>, kTargetCount> numbers{};
  std::array<int, kTargetCount> width{};       ///< how many of them count
  std::array<bool, kTargetCount> evaluated{};  ///< false: the current value

  /// Nothing, and not evaluated, for what is no target.
  std::span<const double> of(Target target) const KNOTWAVE_RT {
    if (!is_target(target)) return {};
    const auto i = static_cast<std::size_t>(target);
    return std::span(numbers[i]).first(static_cast<std::size_t>(width[i]));
  }
  bool is_evaluated(Target target) const KNOTWAVE_RT {
    return is_target(target) && evaluated[static_cast<std::size_t>(target)];
  }
};

/// Maps, which of them are enabled, and the current values. All enabled maps of curves (of
/// surfaces) are evaluated at one coordinate in one pass. Of one target the widest enabled map
/// counts, and of two of that width the rational one; the others, and disabled maps, are not
/// evaluated. A target without an enabled map has its current value, which evaluation never
/// changes. Unlike OpenGL, which ignores an evaluation without a vertex map, no target is needed
/// for the others.
///
/// Coordinates outside [u1, u2] are clamped (wrapped where the curve is periodic), NaN counts as
/// u1. A value never leaves the hull of its map's control points. One owner at a time: made on the
/// control thread, handed over (base/hand_over.h), then enabled and evaluated by the audio thread.
class MapSet {
 public:
  MapSet();  ///< no maps, current values 0

  /// Compiles and keeps a map in place of the one with the same key; it is disabled until enabled.
  /// [control] Errors: empty_domain (u1 == u2), not_finite, value_out_of_range (beyond kMaxKnot, or
  /// nearer each other than kMinKnotStep, or the target is none), dimension_mismatch (the target
  /// takes fewer coordinates), those of compile_parametric or compile_surface. The set is then as
  /// before.
  Result<MapKey> define(Map1 map);
  Result<MapKey> define(Map2 map);

  /// False, and no effect, for a map that was never defined. [any]
  bool enable(const MapKey& key, bool on = true) KNOTWAVE_RT;
  bool disable(const MapKey& key) KNOTWAVE_RT { return enable(key, false); }
  bool is_enabled(const MapKey& key) const KNOTWAVE_RT;

  /// The value a target has where no map drives it, up to widest() numbers; of more the first, NaN
  /// leaves a number as it was. What is no target has none. [any]
  void set_current(Target target, std::span<const double> value) KNOTWAVE_RT;
  std::span<const double> current(Target target) const KNOTWAVE_RT;

  /// All targets at one coordinate. [audio]
  void evaluate(double u, MapValues& out) const KNOTWAVE_RT;
  void evaluate(double u, double v, MapValues& out) const KNOTWAVE_RT;
  /// Derivatives by the common coordinates instead of values, right-hand (left-hand at the end); 0
  /// where a target is not evaluated or held. Beyond all doubles: the largest. [audio]
  void evaluate_slopes(double u, MapValues& by_u) const KNOTWAVE_RT;
  void evaluate_slopes(double u, double v, MapValues& by_u, MapValues& by_v) const KNOTWAVE_RT;

  /// Where a grid's numbers go: one coordinate of one target (0 where the target has fewer, or is
  /// none).
  struct Channel {
    Target target = Target::amp;
    int coordinate = 0;
    std::span<double> out;
  };
  /// out[i] is what evaluate(grid.at(first + i)) gives, to the bit, so any split into blocks gives
  /// the same. [audio] n < 1 in a grid is no error: its nodes are clamped as any coordinate.
  void evaluate_grid(const MapGrid& grid, std::int64_t first,
                     std::span<const Channel> channels) const KNOTWAVE_RT;
  /// Rows of u, one row a v: out[j * count_u + i] is what evaluate(grid_u.at(first_u + i),
  /// grid_v.at(first_v + j)) gives, to the bit, until out is full. [audio] A wavetable in one call.
  void evaluate_mesh(const MapGrid& grid_u, std::int64_t first_u, std::int64_t count_u,
                     const MapGrid& grid_v, std::int64_t first_v,
                     std::span<const Channel> channels) const KNOTWAVE_RT;

  /// Query back: what was defined, number for number; null without. [any] Valid until the next
  /// define().
  const Map1* map1(const MapKey& key) const KNOTWAVE_RT;
  const Map2* map2(const MapKey& key) const KNOTWAVE_RT;

 private:
  /// [from, to] onto [low, high], the ends exactly.
  struct Stretch {
    double from = 0, to = 1, low = 0, high = 1, scale = 1;
    Stretch(double from, double to, double low, double high) noexcept;
    double at(double x) const KNOTWAVE_RT {
      if (x == from) return low;
      return x == to ? high : low + (x - from) * scale;
    }
    bool holds(double x) const KNOTWAVE_RT;  ///< not before its start nor after its end
  };
  struct Curve {
    MapKey key;
    bool enabled = false;
    Map1 map;
    CurveProgram program;
    Stretch u;
  };
  struct Surface {
    MapKey key;
    bool enabled = false;
    Map2 map;
    SurfaceProgram program;
    Stretch u, v;
  };
  using Chosen = std::array<std::int16_t, kTargetCount>;  ///< what to evaluate; -1 = nothing

  template <class Slot>
  void keep(std::vector<Slot>& slots, Slot slot);
  template <class Slot>
  static void choose(const std::vector<Slot>& slots, Chosen& chosen) KNOTWAVE_RT;
  void take_current(MapValues& out) const KNOTWAVE_RT;
  void take_nothing(MapValues& out) const KNOTWAVE_RT;
  void fill_held(const Channel& channel, bool is_evaluated) const KNOTWAVE_RT;

  std::vector<Curve> curves_;
  std::vector<Surface> surfaces_;
  Chosen chosen_curves_, chosen_surfaces_;
  std::array<std::array<double, 4>, kTargetCount> current_{};
};

}  // namespace knotwave::curves
