// SPDX-License-Identifier: MIT
// The same from C.
#include <stdio.h>
#include <string.h>

#include "knotwave/curves.h"

int main(void) {
  const char* text = "format = 1\nkind = \"curve\"\n[curves.ramp]\ndegree = 1\npoints = [0, 1]\n";
  kw_error* error = NULL;
  kw_curve_set* set = NULL;
  kw_curve* square = NULL;
  kw_program* program = NULL;
  if (kw_abi_version() != KW_ABI_VERSION ||
      kw_curve_set_parse(text, strlen(text), "text", &set, &error) != KW_OK ||
      kw_curve_product(kw_curve_set_curve_at(set, 0), kw_curve_set_curve_at(set, 0), &square,
                       &error) != KW_OK ||
      kw_compile_function(square, NULL, &program, &error) != KW_OK) {
    fprintf(stderr, "%s\n", kw_error_text(error));
    return 1;
  }
  float out[5];
  kw_program_evaluate_grid(program, 0, 1, 4, 0, out, 5);
  for (int i = 0; i < 5; ++i) printf("%g ", (double)out[i]);
  kw_program_free(program);
  kw_curve_free(square);
  kw_curve_set_free(set);
  return 0;
}
