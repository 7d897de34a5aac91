// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/camera/shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "kinemark/camera/monomials.h"
#include "kinemark/core/check.h"

namespace kinemark::camera {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

/// K(1/2), the complete elliptic integral of the first kind with parameter m = 1/2.
constexpr double kQuarterPeriod = 1.8540746773013719184;

/// Jacobi's sn, cn, dn.
struct Elliptic {
  double sn, cn, dn;
};

// For m = 1/2 the nome is q = e^-pi, so theta series end after a few terms: q^12 and q^16 are below 1e-16.
// sn = 2^(1/4) theta1 / theta4, cn = theta2 / theta4, dn = 2^(-1/4) theta3 / theta4 at z = pi u / (2 K).
Elliptic elliptic(double z) {
  static const double q = std::exp(-pi), q2 = q * q, q4 = q2 * q2, q6 = q4 * q2, q9 = q6 * q2 * q;
  static const double front = 2.0 * std::exp(-pi / 4.0), root = std::sqrt(std::numbers::sqrt2);
  const double s = std::sin(z), c = std::cos(z);
  const double c2 = 1.0 - 2.0 * s * s, c4 = 2.0 * c2 * c2 - 1.0, c6 = c2 * (2.0 * c4 - 1.0);
  const double theta1 = front * s * (1.0 - q2 * (2.0 * c2 + 1.0) + q6 * (2.0 * c4 + 2.0 * c2 + 1.0));
  const double theta2 = front * c * (1.0 + q2 * (2.0 * c2 - 1.0) + q6 * (2.0 * c4 - 2.0 * c2 + 1.0));
  const double even = 2.0 * q4 * c4, odd = 2.0 * (q * c2 + q9 * c6);
  const double theta3 = 1.0 + even + odd, theta4 = 1.0 + even - odd;
  return {root * theta1 / theta4, theta2 / theta4, theta3 / (root * theta4)};
}

double clamp_to(double edge, double v) { return std::clamp(v, -edge, edge); }

}  // namespace

// The disc's point w(z) = e^(-i pi/4) cn(K (1+i)/2 z - K) is where z = x + iy of the square goes; its corners
// go to -45, 45, 135, 225 degrees. On the disc, the harmonic measure of the arc between two corners e_k and
// e_(k+1) is arg((e_(k+1) - w) / (e_k - w)) / pi - 1/4. The derivative follows from w' = -K/sqrt2 sn dn,
// because log of the quotient is analytic in z.
Shares tetra_lateral_shares(double x, double y) {
  const Elliptic a = elliptic(pi / 4.0 * (x - y) - pi / 2.0);
  const Elliptic b = elliptic(pi / 4.0 * (x + y));
  const double denominator = b.cn * b.cn + 0.5 * a.sn * a.sn * b.sn * b.sn;
  const Complex cn(a.cn * b.cn / denominator, -a.sn * a.dn * b.sn * b.dn / denominator);
  const Complex sn(a.sn * b.dn / denominator, a.cn * a.dn * b.sn * b.cn / denominator);
  const Complex dn(a.dn * b.cn * b.dn / denominator, -0.5 * a.sn * a.cn * b.sn / denominator);
  constexpr double h = std::numbers::sqrt2 / 2.0;
  const Complex w = Complex(h, -h) * cn;
  const Complex dw = -kQuarterPeriod * h * sn * dn;
  const std::array<Complex, 4> corner{Complex(h, -h), Complex(h, h), Complex(-h, h), Complex(-h, -h)};
  constexpr std::array<int, 4> electrode{0, 2, 1, 3};  // edges run counter-clockwise from +x
  Shares out;
  for (std::size_t k = 0; k < 4; ++k) {
    const Complex from = corner[k] - w, to = corner[(k + 1) % 4] - w;
    double angle = std::arg(to / from);
    if (angle < 0.0) angle += 2.0 * pi;
    const Complex slope = dw * (1.0 / from - 1.0 / to) / pi;
    out.share[electrode[k]] = angle / pi - 0.25;
    out.d_spot.row(electrode[k]) << slope.imag(), slope.real();
  }
  return out;
}

Shares duo_lateral_shares(double x, double y) {
  Shares out;
  out.share << (1.0 + x) / 2.0, (1.0 - x) / 2.0, (1.0 + y) / 2.0, (1.0 - y) / 2.0;
  out.d_spot << 0.5, 0.0, -0.5, 0.0, 0.0, 0.5, 0.0, -0.5;
  return out;
}

Shares pin_cushion_shares(double x, double y) {
  constexpr std::array<std::array<double, 2>, 4> corner{{{1, 1}, {-1, -1}, {-1, 1}, {1, -1}}};
  Shares out;
  for (int k = 0; k < 4; ++k) {
    const auto [sx, sy] = corner[static_cast<std::size_t>(k)];
    out.share[k] = (1.0 + sx * x) * (1.0 + sy * y) / 4.0;
    out.d_spot.row(k) << sx * (1.0 + sy * y) / 4.0, sy * (1.0 + sx * x) / 4.0;
  }
  return out;
}

Shares generic_shares(std::span<const double> coefficients, int degree, double x, double y) {
  const Monomials basis(x, y, 0, degree);
  check(coefficients.size() == static_cast<std::size_t>(3 * basis.size()),
        "generic shares need three polynomials of their degree");
  const Eigen::Map<const Eigen::MatrixXd> columns(coefficients.data(), basis.size(), 3);
  Shares out;
  out.share << 0, 0, 0, 1;
  out.d_spot.setZero();
  for (int k = 0; k < 3; ++k) {
    out.share[k] = columns.col(k).dot(basis.value());
    out.d_spot.row(k) << columns.col(k).dot(basis.d_x()), columns.col(k).dot(basis.d_y());
    out.share[3] -= out.share[k];
    out.d_spot.row(3) -= out.d_spot.row(k);
  }
  return out;
}

Shares shares(const data::Detector& detector, double x, double y) {
  // The closed form ends at the edge itself, where the field has poles in the corners.
  const double edge = std::min(detector.edge, 1.0 - 1e-9);
  const double xc = clamp_to(edge, x), yc = clamp_to(edge, y);
  Shares out;
  switch (detector.kind) {
    case data::DetectorKind::tetra_lateral:
      out = tetra_lateral_shares(xc, yc);
      break;
    case data::DetectorKind::duo_lateral:
      out = duo_lateral_shares(xc, yc);
      break;
    case data::DetectorKind::pin_cushion:
      out = pin_cushion_shares(xc, yc);
      break;
    case data::DetectorKind::generic:
      out = generic_shares(detector.generic, detector.generic_degree, xc, yc);
      break;
  }
  if (xc != x) out.d_spot.col(0).setZero();
  if (yc != y) out.d_spot.col(1).setZero();
  return out;
}

}  // namespace kinemark::camera
