// SPDX-License-Identifier: MIT
// Curve files: read, searched, filled, written. Pictures. See knotwave/curves/curve_file.h,
// plot.h and docs/curve-format.md. [control]
#pragma once
#include "knotwave/c/surface.h"

KW_BEGIN

/// The curves and surfaces of one file, in order.
typedef struct kw_curve_set kw_curve_set;

KW_API kw_status kw_curve_set_create(kw_curve_set** out, kw_error** error);
/// Reads a file.
KW_API kw_status kw_curve_set_read(const char* path, kw_curve_set** out, kw_error** error);
/// Reads a text (UTF-8, TOML). `source_name` is what errors begin with; NULL = "".
KW_API kw_status kw_curve_set_parse(const char* text, size_t text_count, const char* source_name,
                                    kw_curve_set** out, kw_error** error);
KW_API void kw_curve_set_free(kw_curve_set* set);

KW_API size_t kw_curve_set_curve_count(const kw_curve_set* set);
KW_API size_t kw_curve_set_surface_count(const kw_curve_set* set);
/// Borrowed; NULL if there is none.
KW_API const kw_curve* kw_curve_set_curve_at(const kw_curve_set* set, size_t index);
KW_API const kw_surface* kw_curve_set_surface_at(const kw_curve_set* set, size_t index);
/// Borrowed. KW_UNKNOWN_NAME, which suggests the nearest one.
KW_API kw_status kw_curve_set_find_curve(const kw_curve_set* set, const char* name,
                                         const kw_curve** out, kw_error** error);
KW_API kw_status kw_curve_set_find_surface(const kw_curve_set* set, const char* name,
                                           const kw_surface** out, kw_error** error);

/// Adds a copy. Its name must be 1 to 64 letters, digits, '_' and '-' (KW_MALFORMED) and new to the
/// set (KW_DUPLICATE_NAME).
KW_API kw_status kw_curve_set_add_curve(kw_curve_set* set, const kw_curve* curve, kw_error** error);
KW_API kw_status kw_curve_set_add_surface(kw_curve_set* set, const kw_surface* surface,
                                          kw_error** error);

/// The text of a file that reads back to equal curves. Free it with kw_text_free().
KW_API kw_status kw_curve_set_text(const kw_curve_set* set, char** out, kw_error** error);
/// Writes that file; an old one is kept until the new one is complete.
KW_API kw_status kw_curve_set_write(const kw_curve_set* set, const char* path, kw_error** error);

/// A picture as SVG. Free it with kw_text_free().
KW_API kw_status kw_curve_plot_svg(const kw_curve* curve, int32_t width_px, int32_t height_px,
                                   char** out, kw_error** error);
KW_API kw_status kw_surface_plot_svg(const kw_surface* surface, int32_t width_px, int32_t height_px,
                                     char** out, kw_error** error);

KW_END
