// SPDX-License-Identifier: MIT
// Curve evaluation as others write it, on the common curve (peer_curve.h): a textbook de Boor, and
// Eigen's and Boost's splines where their headers are installed.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace peers {

/// One library, one number type, plain or rational. Without a rational form, the weighted points
/// and the weights are two curves and their quotient is taken, as one would use it.
class Peer {
 public:
  virtual ~Peer() = default;
  /// The curve at i / kGrid for every i, one call of the library a point.
  virtual void evaluate(std::span<double> out) const = 0;
  virtual void evaluate(std::span<float> out) const = 0;
};

struct NamedPeer {
  std::string name;  ///< library/type/form
  bool is_float;
  std::unique_ptr<Peer> peer;
};
std::vector<NamedPeer> linked_peers();

/// How much of its time the machine needs at least, in ns a float32 sample: no curve, only the
/// operations. Zero where the machine has no AVX2.
struct MachineLimits {
  double cubic;            ///< 4 products and 4 sums: t and Horner
  double rational_cubic;   ///< 7 products, 7 sums, a division
  double degree_7_double;  ///< in double: 9 products, 10 sums, made a float
  double store;            ///< a store into 1 KiB
};
MachineLimits machine_limits();

}  // namespace peers
