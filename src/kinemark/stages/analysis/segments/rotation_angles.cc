// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/rotation_angles.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/math/euler.h"

namespace kinemark::analysis {
namespace {

constexpr double kLocked = 1e-7;
constexpr double kNoRotation = 1e-12;

}  // namespace

Result<AngleSequence> parse_sequence(std::string_view text) {
  AngleSequence out{};
  bool good = text.size() == 3;
  for (std::size_t k = 0; good && k < 3; ++k) {
    const auto axis = std::string_view("xyzXYZ").find(text[k]);
    good = axis != std::string_view::npos;
    out[k] = static_cast<int>(axis % 3);
    good = good && (k == 0 || out[k] != out[k - 1]);
  }
  if (!good)
    return fail(Code::bad_input,
                fmt::format("'{}' is no sequence of axes; expected such as 'yxz' or 'yxy'", text));
  return out;
}

// With i, j, k different and e = +1 where i, j, k are in the order x, y, z, -1 otherwise:
// R(i, a) R(j, b) R(k, c):  M(i, k) = e sin b,      M(j, k) = -e cos b sin a,  M(k, k) = cos b cos a,
//                                                   M(i, j) = -e cos b sin c,  M(i, i) = cos b cos c.
// R(i, a) R(j, b) R(i, c):  M(i, i) = cos b,        M(j, i) = sin b sin a,     M(k, i) = -e sin b cos a,
//                                                   M(i, j) = sin b sin c,     M(i, k) = e sin b cos c.
Eigen::Vector3d sequence_angles(const Eigen::Matrix3d& m, const AngleSequence& sequence) {
  const int i = sequence[0], j = sequence[1], k = 3 - i - j;
  const double e = (j - i + 3) % 3 == 1 ? 1.0 : -1.0;
  if (!m.allFinite()) return Eigen::Vector3d::Constant(kNaN);
  if (sequence[2] == i) {
    const double sine = std::hypot(m(j, i), m(k, i));
    const bool free = sine > kLocked;
    return {free ? std::atan2(m(j, i), -e * m(k, i)) : kNaN, std::atan2(sine, m(i, i)),
            free ? std::atan2(m(i, j), e * m(i, k)) : kNaN};
  }
  const double cosine = std::hypot(m(i, i), m(i, j));
  const bool free = cosine > kLocked;
  return {free ? std::atan2(-e * m(j, k), m(k, k)) : kNaN, std::atan2(e * m(i, k), cosine),
          free ? std::atan2(-e * m(i, j), m(i, i)) : kNaN};
}

double distance_from_lock(double second_rad, const AngleSequence& sequence) {
  const double sine_or_cosine = sequence[0] == sequence[2] ? std::sin(second_rad) : std::cos(second_rad);
  return std::asin(std::min(1.0, std::abs(sine_or_cosine)));
}

// x' = R x + t leaves p + s n on its line when (I - R) p = t - (n . t) n; for p perpendicular to n,
// p = (t_perp + n x t_perp / tan(angle / 2)) / 2.
HelicalAxis helical_axis(const math::SE3& displacement) {
  HelicalAxis out;
  const Eigen::Vector3d rotation = math::log_so3(displacement.rotation);
  const Eigen::Vector3d& t = displacement.translation;
  out.angle_rad = rotation.norm();
  if (!(out.angle_rad > kNoRotation)) {
    out.translation_m = t.norm();
    out.direction.setConstant(kNaN);
    out.point.setConstant(kNaN);
    return out;
  }
  out.direction = rotation / out.angle_rad;
  out.translation_m = out.direction.dot(t);
  const Eigen::Vector3d across = t - out.translation_m * out.direction;
  out.point = 0.5 * (across + out.direction.cross(across) / std::tan(0.5 * out.angle_rad));
  return out;
}

}  // namespace kinemark::analysis
