// SPDX-License-Identifier: MIT
// Curve files and pictures from C.
#include <algorithm>

#include "knotwave/base/file.h"
#include "knotwave/base/suggest.h"
#include "knotwave/curves/plot.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::CurveSet;

namespace {

CurveSet set_of(const kw_curve_set& handle) {
  CurveSet set;
  for (const auto& curve : handle.curves) set.curves.push_back(curve->curve);
  for (const auto& surface : handle.surfaces) set.surfaces.push_back(surface->surface);
  return set;
}

const std::string& name_of(const kw_curve& handle) { return handle.curve.name(); }
const std::string& name_of(const kw_surface& handle) { return handle.surface.name(); }

std::vector<std::string_view> names_of(const kw_curve_set& set) {
  std::vector<std::string_view> names;
  for (const auto& curve : set.curves) names.emplace_back(name_of(*curve));
  for (const auto& surface : set.surfaces) names.emplace_back(name_of(*surface));
  return names;
}

template <class Handle>
kw_status find(const kw_curve_set& set, const std::vector<std::unique_ptr<Handle>>& items,
               const char* what, const char* name, const Handle** out, kw_error** error) {
  for (const auto& item : items) {
    if (name_of(*item) == name) {
      *out = item.get();
      return KW_OK;
    }
  }
  return report(
      error, fail(ErrorCode::unknown_name, std::string("there is no ") + what + " '" + name + "'" +
                                               base::suggestion(name, names_of(set))));
}

template <class Handle>
kw_status add(kw_curve_set& set, std::vector<std::unique_ptr<Handle>>& items, const Handle& item,
              kw_error** error) {
  const std::string& name = name_of(item);
  if (!curves::is_valid_name(name)) {
    return report(error, fail(ErrorCode::malformed,
                              "'" + name + "': a name is 1 to 64 letters, digits, '_' and '-'"));
  }
  const auto names = names_of(set);
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return report(error,
                  fail(ErrorCode::duplicate_name, "the set has a curve '" + name + "' already"));
  }
  items.push_back(std::make_unique<Handle>(item));
  return KW_OK;
}

template <class Picture>
kw_status plot(const void* what, const Picture& draw, int32_t width_px, int32_t height_px,
               char** out, kw_error** error) {
  constexpr int32_t kLeast = 64, kMost = 16384;
  if (out != nullptr) *out = nullptr;
  return run({{"curve or surface", what}, {"out", out}}, error, [&]() -> kw_status {
    if (std::min(width_px, height_px) < kLeast || std::max(width_px, height_px) > kMost) {
      return report(error, KW_VALUE_OUT_OF_RANGE,
                    "a picture of " + std::to_string(width_px) + " by " +
                        std::to_string(height_px) + " pixels: each must be 64 to 16384");
    }
    curves::PlotOptions options;
    options.width_px = width_px;
    options.height_px = height_px;
    *out = new_text(draw(options));
    return KW_OK;
  });
}

}  // namespace

namespace knotwave::c {
std::unique_ptr<kw_curve_set> handle_of(CurveSet&& from) {
  auto set = std::make_unique<kw_curve_set>();
  for (auto& curve : from.curves) {
    set->curves.push_back(std::make_unique<kw_curve>(kw_curve{std::move(curve)}));
  }
  for (auto& surface : from.surfaces) {
    set->surfaces.push_back(std::make_unique<kw_surface>(kw_surface{std::move(surface)}));
  }
  return set;
}
}  // namespace knotwave::c

kw_status kw_curve_set_create(kw_curve_set** out, kw_error** error) {
  return make_curve_set({}, out, error, []() -> Result<CurveSet> { return CurveSet(); });
}
kw_status kw_curve_set_read(const char* path, kw_curve_set** out, kw_error** error) {
  return make_curve_set({{"path", path}}, out, error, [&] { return curves::read_curves(path); });
}
kw_status kw_curve_set_parse(const char* text, size_t text_count, const char* source_name,
                             kw_curve_set** out, kw_error** error) {
  return make_curve_set({array("text", text, text_count)}, out, error, [&] {
    return curves::parse_curves({text, text_count}, text_of(source_name));
  });
}
void kw_curve_set_free(kw_curve_set* set) { delete set; }

size_t kw_curve_set_curve_count(const kw_curve_set* set) { return set ? set->curves.size() : 0; }
size_t kw_curve_set_surface_count(const kw_curve_set* set) {
  return set ? set->surfaces.size() : 0;
}
const kw_curve* kw_curve_set_curve_at(const kw_curve_set* set, size_t index) {
  return index < kw_curve_set_curve_count(set) ? set->curves[index].get() : nullptr;
}
const kw_surface* kw_curve_set_surface_at(const kw_curve_set* set, size_t index) {
  return index < kw_curve_set_surface_count(set) ? set->surfaces[index].get() : nullptr;
}

kw_status kw_curve_set_find_curve(const kw_curve_set* set, const char* name, const kw_curve** out,
                                  kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"set", set}, {"name", name}, {"out", out}}, error,
             [&] { return find(*set, set->curves, "curve", name, out, error); });
}
kw_status kw_curve_set_find_surface(const kw_curve_set* set, const char* name,
                                    const kw_surface** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"set", set}, {"name", name}, {"out", out}}, error,
             [&] { return find(*set, set->surfaces, "surface", name, out, error); });
}

kw_status kw_curve_set_add_curve(kw_curve_set* set, const kw_curve* curve, kw_error** error) {
  return run({{"set", set}, {"curve", curve}}, error,
             [&] { return add(*set, set->curves, *curve, error); });
}
kw_status kw_curve_set_add_surface(kw_curve_set* set, const kw_surface* surface, kw_error** error) {
  return run({{"set", set}, {"surface", surface}}, error,
             [&] { return add(*set, set->surfaces, *surface, error); });
}

kw_status kw_curve_set_text(const kw_curve_set* set, char** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"set", set}, {"out", out}}, error, [&]() -> kw_status {
    *out = new_text(curves::write_curves(set_of(*set)));
    return KW_OK;
  });
}
kw_status kw_curve_set_write(const kw_curve_set* set, const char* path, kw_error** error) {
  return run({{"set", set}, {"path", path}}, error, [&]() -> kw_status {
    const auto written = base::write_file(path, curves::write_curves(set_of(*set)));
    return written ? KW_OK : report(error, written.error());
  });
}

kw_status kw_curve_plot_svg(const kw_curve* curve, int32_t width_px, int32_t height_px, char** out,
                            kw_error** error) {
  const auto draw = [&](const auto& options) { return curves::plot_svg(curve->curve, options); };
  return plot(curve, draw, width_px, height_px, out, error);
}
kw_status kw_surface_plot_svg(const kw_surface* surface, int32_t width_px, int32_t height_px,
                              char** out, kw_error** error) {
  const auto draw = [&](const auto& options) {
    return curves::plot_svg(surface->surface, options);
  };
  return plot(surface, draw, width_px, height_px, out, error);
}
