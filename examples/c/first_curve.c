// SPDX-License-Identifier: MIT
// You learn: how C makes a curve, bends it, plays it in blocks, and hears of a fault.
// Run:       build/release/bin/first_curve_c
#include <stdio.h>

#include "knotwave/curves.h"

static int fail(kw_error* error) {
  fprintf(stderr, "%s\n", kw_error_text(error));
  kw_error_free(error);
  return 1;
}

int main(void) {
  const double points[] = {0, 0, 1, 0, 0};
  const double weights[] = {1, 1, 4, 1, 1};
  kw_curve_spec spec = KW_CURVE_SPEC_INIT;
  spec.name = "bell";
  spec.points = points;
  spec.points_count = 5;
  spec.weights = weights;
  spec.weights_count = 5;

  kw_error* error = NULL;
  kw_curve *bell = NULL, *late = NULL;
  kw_program* program = NULL;
  if (kw_curve_create(&spec, &bell, &error) != KW_OK) return fail(error);
  if (kw_curve_bend(bell, 2, &late, &error) != KW_OK) return fail(error);
  if (kw_compile_function(late, NULL, &program, &error) != KW_OK) return fail(error);

  kw_extremum top;
  if (kw_curve_value_range(late, 0, NULL, &top, &error) != KW_OK) return fail(error);
  printf("highest: %.6f at %.6f\n", top.value, top.u);

  // What an audio callback does: the next four samples of 16, no matter how a block is cut.
  double block[4];
  int32_t cursor = 0;
  for (int64_t first = 0; first < 16; first += 4) {
    kw_program_render(program, 0, 1.0 / 16, first, 0, block, 4, &cursor);
    printf("%8.6f %8.6f %8.6f %8.6f\n", block[0], block[1], block[2], block[3]);
  }

  kw_curve* none = NULL;
  if (kw_curve_insert_knot(bell, 1.5, 1, &none, &error) != KW_OK) {
    printf("%s\n", kw_error_text(error));
    kw_error_free(error);
  }
  kw_program_free(program);
  kw_curve_free(late);
  kw_curve_free(bell);
  return 0;
}
