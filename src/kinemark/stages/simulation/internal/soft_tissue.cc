// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/internal/soft_tissue.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/simulation/internal/streams.h"

namespace kinemark::simulation::internal {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRigid_m = 0.002, kFleshy_m = 0.013;
constexpr double kThigh_kg_m = 17.0;
constexpr double kTrunkFlesh = 0.3;
constexpr double kOscillation_hz = 9.0, kDecay_s = 0.1, kImpactShare = 0.5;

bool is_trunk(const Segment& segment) {
  return segment.carried_joints.size() + (segment.has_own_joint ? 0 : 1) >= 2;
}

double flesh(const Segment& segment) {
  if (segment.carried_joints.empty()) return 0.0;
  if (is_trunk(segment)) return kTrunkFlesh;
  return std::min(1.0, segment.mass / segment.length_m / kThigh_kg_m);
}

double near_joints(const Segment& segment, const Vector3d& marker) {
  if (is_trunk(segment)) return 1.0;
  double nearest = (marker - segment.own_joint).norm();
  for (const auto& joint : segment.carried_joints) nearest = std::min(nearest, (marker - joint).norm());
  return 0.45 + 0.55 * std::min(1.0, nearest / (0.35 * segment.length_m));
}

Vector3d gaussian_vector(Random& random) {
  const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
  return {x, y, z};
}

// Coordinates with the mean removed, over their standard deviation; still ones stay 0.
Eigen::MatrixXd standardised(Eigen::MatrixXd q) {
  for (auto row : q.rowwise()) {
    row.array() -= row.mean();
    const double sd = std::sqrt(row.squaredNorm() / static_cast<double>(row.size()));
    if (sd > 1e-6)
      row /= sd;
    else
      row.setZero();
  }
  return q;
}

// A displacement field linear in the segment's angles, of unit mean square, and a direction of oscillation.
struct Field {
  Matrix3Xd slide;
  Vector3d direction;
};

Field draw_field(const Segment& segment, const Eigen::MatrixXd& angles, Random random) {
  Field field;
  field.direction = gaussian_vector(random).normalized();
  field.slide.setZero(3, angles.cols());
  for (const int c : segment.coordinates) field.slide += gaussian_vector(random) * angles.row(c);
  const double rms = std::sqrt(field.slide.squaredNorm() / static_cast<double>(angles.cols()));
  if (rms > 1e-9) field.slide /= rms;
  return field;
}

// Oscillation of the soft tissue under every marker after impacts at jittered instants.
VectorXd oscillation(double impact_hz, const SubjectOptions& options, Eigen::Index frames) {
  VectorXd out = VectorXd::Zero(frames);
  if (options.motion == MotionKind::tai_chi) return out;
  Random random = stream(options.seed, Draw::impacts);
  for (double next_s = random.uniform(0.0, 1.0) / impact_hz; next_s < options.duration_s;
       next_s += random.uniform(0.9, 1.1) / impact_hz) {
    const auto first = static_cast<Eigen::Index>(std::ceil(next_s * options.rate_hz));
    for (Eigen::Index f = first; f < frames; ++f) {
      const double since = static_cast<double>(f) / options.rate_hz - next_s;
      if (since > 12.0 * kDecay_s) break;
      out[f] += kImpactShare * std::exp(-since / kDecay_s) *
                std::sin(2.0 * std::numbers::pi * kOscillation_hz * since);
    }
  }
  return out;
}

}  // namespace

VectorXd tissue_amplitudes(const Segments& segments) {
  VectorXd rms = VectorXd::Zero(static_cast<Eigen::Index>(segments.of_marker.size()));
  for (std::size_t m = 0; m < segments.of_marker.size(); ++m) {
    if (segments.of_marker[m] < 0) continue;  // markers on the ground have no flesh
    const Segment& segment = segments.all[at(segments.of_marker[m])];
    rms[static_cast<Eigen::Index>(m)] =
        kRigid_m + kFleshy_m * flesh(segment) * near_joints(segment, segments.marker_in_segment[m]);
  }
  return rms;
}

std::vector<Matrix3Xd> tissue_displacements(const Segments& segments, const Eigen::MatrixXd& q,
                                            double impact_hz, const SubjectOptions& options) {
  const auto frames = q.cols();
  const Eigen::MatrixXd angles = standardised(q);
  const VectorXd shake = oscillation(impact_hz, options, frames);
  const VectorXd amplitude = options.soft_tissue * tissue_amplitudes(segments);
  const double common = std::sqrt(options.soft_tissue_common),
               own = std::sqrt(1.0 - options.soft_tissue_common);

  std::vector<Field> of_segment(segments.all.size());
  for (std::size_t s = 0; s < of_segment.size(); ++s)
    of_segment[s] = draw_field(segments.all[s], angles, stream(options.seed, Draw::tissue_segment, s));

  std::vector<Matrix3Xd> out(segments.of_marker.size());
  parallel_for(static_cast<std::int64_t>(out.size()), 1, options.threads,
               [&](std::int64_t begin, std::int64_t end) {
                 for (std::int64_t m = begin; m < end; ++m) {
                   Matrix3Xd& u = out[static_cast<std::size_t>(m)];
                   u.setZero(3, frames);
                   const int s = segments.of_marker[static_cast<std::size_t>(m)];
                   if (s < 0 || amplitude[m] == 0.0) continue;
                   const Field mine =
                       draw_field(segments.all[at(s)], angles,
                                  stream(options.seed, Draw::tissue_marker, static_cast<std::size_t>(m)));
                   const Field& shared = of_segment[at(s)];
                   u = own * mine.slide + common * shared.slide;
                   u += (own * mine.direction + common * shared.direction) * shake.transpose();
                   u.colwise() -= Vector3d(u.rowwise().mean());
                   const double rms = std::sqrt(u.squaredNorm() / static_cast<double>(frames));
                   if (rms > 0.0) u *= amplitude[m] / rms;
                 }
               });
  return out;
}

}  // namespace kinemark::simulation::internal
