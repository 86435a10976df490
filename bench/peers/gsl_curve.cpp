// SPDX-License-Identifier: MIT
// GSL on the common curve: prints "name ns-per-point checksum" lines. A program of its own, as GSL
// is under the GPL; bench/peers/compare_curves.py builds and runs it.
#include <cstdio>

#include <gsl/gsl_bspline.h>

#include "peer_curve.h"

int main() {
  using namespace peers;
  const Curve curve = peer_curve();
  gsl_bspline_workspace* const workspace = gsl_bspline_alloc(4, kPoints - 2);
  gsl_vector* const breaks = gsl_vector_alloc(kPoints - 2);
  for (int i = 0; i < kPoints - 2; ++i)
    gsl_vector_set(breaks, std::size_t(i), curve.knots[std::size_t(i + 3)]);
  gsl_bspline_knots(breaks, workspace);
  gsl_vector* const basis = gsl_vector_alloc(4);
  std::vector<double> out(kGrid);
  const auto plain = [&] {
    for (int i = 0; i < kGrid; ++i) {
      std::size_t first, last;
      gsl_bspline_eval_nonzero(i / double(kGrid), basis, &first, &last, workspace);
      double sum = 0;
      for (std::size_t k = 0; k < 4; ++k) sum += gsl_vector_get(basis, k) * curve.points[first + k];
      out[std::size_t(i)] = sum;
    }
  };
  const auto rational = [&] {
    for (int i = 0; i < kGrid; ++i) {
      std::size_t first, last;
      gsl_bspline_eval_nonzero(i / double(kGrid), basis, &first, &last, workspace);
      double sum = 0, weight = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const double share = gsl_vector_get(basis, k) * curve.weights[first + k];
        sum += share * curve.points[first + k];
        weight += share;
      }
      out[std::size_t(i)] = sum / weight;
    }
  };
  const double plain_ns = ns_per_point(plain);
  std::printf("cubic/gsl_bspline_eval_nonzero/per_call %.17g %.17g\n", plain_ns, out[kGrid / 3]);
  const double rational_ns = ns_per_point(rational);
  std::printf("rational/gsl_bspline_eval_nonzero/per_call %.17g %.17g\n", rational_ns,
              out[kGrid / 3]);
  gsl_vector_free(basis);
  gsl_vector_free(breaks);
  gsl_bspline_free(workspace);
}
