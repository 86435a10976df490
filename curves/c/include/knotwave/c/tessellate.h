// SPDX-License-Identifier: MIT
// Curves as few straight steps, by a policy. See knotwave/curves/tessellate.h. [control]
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

typedef int32_t kw_sampling_method;
enum {
  KW_SAMPLING_FIXED_STEP = 0,  ///< at least `amount` equal steps for each unit of u
  KW_SAMPLING_MAX_ERROR = 1,   ///< no farther from the curve than `amount` dB re full_scale
  KW_SAMPLING_MAX_STEP = 2     ///< no coordinate moves by more than `amount` within a step
};

typedef struct kw_sampling {
  kw_sampling_method method;
  int32_t reserved;  ///< 0
  double amount;
  double full_scale;  ///< for KW_SAMPLING_MAX_ERROR
} kw_sampling;

/// kw_tessellator calls = KW_TESSELLATOR_INIT; then set who listens. `user` is handed to each; what
/// `value` and `slope` point to lives until they return. None may leave by longjmp.
typedef struct kw_tessellator {
  size_t struct_size;  ///< set by KW_TESSELLATOR_INIT
  void* user;
  void (*begin)(void* user, double u);  ///< a stretch between jumps begins
  void (*value)(void* user, double u, const double* value, size_t dim);
  void (*slope)(void* user, double u, const double* slope, size_t dim);  ///< after its value
  void (*end)(void* user, double u);
} kw_tessellator;
#define KW_TESSELLATOR_INIT \
  { sizeof(kw_tessellator), NULL, NULL, NULL, NULL, NULL }

/// Calls begin, then value and slope for every parameter, then end, for each stretch. Nothing is
/// called if it fails, as it does for more than max_values.
KW_API kw_status kw_curve_tessellate(const kw_curve* curve, const kw_sampling* sampling,
                                     const kw_tessellator* calls, int32_t max_values,
                                     kw_error** error);
/// The parameters alone, over [u_a, u_b], one stretch after the other: where a jump parts two, its
/// u stands twice.
KW_API kw_status kw_curve_sample_parameters(const kw_curve* curve, const kw_sampling* sampling,
                                            double u_a, double u_b, int32_t max_values,
                                            kw_doubles* out, kw_error** error);

KW_END
