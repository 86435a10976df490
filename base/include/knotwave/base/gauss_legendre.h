// SPDX-License-Identifier: MIT
// Gauss-Legendre quadrature. Written by tools/make_fourier_tables.py; do not edit.
#pragma once

namespace knotwave::base {

/// A node above the middle of [0, 1], and its weight; the node as far below has the same.
struct GaussNode {
  double distance = 0;  ///< from 1/2
  double weight = 0;
};

/// 16 nodes: polynomials up to degree 31 are integrated exactly.
inline constexpr GaussNode kGaussLegendre16[8] = {
    {0.4947004674958249663, 0.013576229705877047426},
    {0.47228751153661628804, 0.031126761969323946431},
    {0.43281560119391587194, 0.047579255841246392405},
    {0.37770220417750151695, 0.062314485627766936026},
    {0.30893812220132187422, 0.074797994408288366041},
    {0.22900838882861369317, 0.084578259697501269095},
    {0.14080177538962945662, 0.091301707522461794433},
    {0.047506254918818720093, 0.094725305227534248143}};

}  // namespace knotwave::base
