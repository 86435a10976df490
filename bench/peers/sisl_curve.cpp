// SPDX-License-Identifier: MIT
// SISL on the common curve: prints "name ns-per-point checksum" lines. A program of its own, as
// SISL is under the AGPL; bench/peers/compare_curves.py builds and runs it.
#include <cstdio>

#include <sisl.h>

#include "peer_curve.h"

namespace {

void measure(const char* form, bool rational) {
  using namespace peers;
  Curve curve = peer_curve();
  std::vector<double> coefficients;
  for (std::size_t i = 0; i < std::size_t(kPoints); ++i) {
    const double weight = rational ? curve.weights[i] : 1;
    coefficients.push_back(curve.points[i] * weight);
    if (rational) coefficients.push_back(weight);
  }
  SISLCurve* const spline =
      newCurve(kPoints, 4, curve.knots.data(), coefficients.data(), rational ? 2 : 1, 1, 1);
  std::vector<double> nodes(kGrid), out(kGrid);
  for (int i = 0; i < kGrid; ++i) nodes[std::size_t(i)] = i / double(kGrid);
  int status = 0;
  const auto per_call = [&] {
    int left = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      s1221(spline, 0, nodes[i], &left, &out[i], &status);
  };
  const auto batch = [&] { s1542(spline, kGrid, nodes.data(), out.data(), &status); };
  const double per_call_ns = ns_per_point(per_call);
  std::printf("%s/SISL_s1221/per_call %.17g %.17g\n", form, per_call_ns, out[kGrid / 3]);
  const double batch_ns = ns_per_point(batch);
  std::printf("%s/SISL_s1542/batch %.17g %.17g\n", form, batch_ns, out[kGrid / 3]);
  freeCurve(spline);
}

}  // namespace

int main() {
  measure("cubic", false);
  measure("rational", true);
}
