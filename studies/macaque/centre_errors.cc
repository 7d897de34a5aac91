// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/centre_errors.h"

#include <cmath>
#include <limits>

#include "kinemark/core/check.h"

namespace kinemark::studies {
namespace {

double part(double of, std::int64_t count) {
  return count > 0 ? of / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

double part(std::int64_t of, std::int64_t count) { return part(static_cast<double>(of), count); }

}  // namespace

CentreErrors& CentreErrors::operator+=(const CentreErrors& other) {
  frames += other.frames;
  answered += other.answered;
  determined += other.determined;
  bridged += other.bridged;
  ambiguous += other.ambiguous;
  squares_answered += other.squares_answered;
  squares_determined += other.squares_determined;
  squares_bridged += other.squares_bridged;
  bounded += other.bounded;
  squares_bounded += other.squares_bounded;
  bound_squares += other.bound_squares;
  determined_without_bound += other.determined_without_bound;
  folded += other.folded;
  beyond_5sd += other.beyond_5sd;
  beyond_5sd_determined += other.beyond_5sd_determined;
  coordinates += other.coordinates;
  within_1sd += other.within_1sd;
  within_2sd += other.within_2sd;
  return *this;
}

double CentreErrors::rms_answered_m() const { return std::sqrt(part(squares_answered, answered)); }
double CentreErrors::rms_determined_m() const { return std::sqrt(part(squares_determined, determined)); }
double CentreErrors::rms_bridged_m() const { return std::sqrt(part(squares_bridged, bridged)); }
double CentreErrors::bound_m() const { return std::sqrt(part(bound_squares, bounded)); }
double CentreErrors::over_bound() const { return std::sqrt(squares_bounded / bound_squares); }
double CentreErrors::share_answered() const { return part(answered, frames); }
double CentreErrors::share_decided() const { return part(answered - ambiguous, frames); }
double CentreErrors::share_determined() const { return part(determined, frames); }
double CentreErrors::share_within_1sd() const { return part(within_1sd, coordinates); }
double CentreErrors::share_within_2sd() const { return part(within_2sd, coordinates); }

CentreErrors judge_centres(const data::Skeleton& skeleton, const simulation::LimbRecording& limb,
                           const skeleton::CentreBound* bound) {
  check(skeleton.frames() == limb.markers.frames() && skeleton.joints.size() == limb.layout.joints.size(),
        "skeleton and recording have the same frames and joints");
  constexpr double kFar = 5.0;
  constexpr double kFold = 0.5;  // a variance below this share of the bound's is that of a frame near a fold
  CentreErrors out;
  const auto joints = static_cast<std::int64_t>(skeleton.joints.size());
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    for (std::int64_t j = 0; j < joints; ++j) {
      const std::size_t at = skeleton.index(f, j);
      const auto state = skeleton.state[at];
      ++out.frames;
      if (state == data::CentreState::undetermined) continue;
      const Eigen::Vector3d error =
          skeleton.centre(f, j) - Eigen::Map<const Eigen::Vector3d>(limb.centre_in_world.data() + 3 * at);
      const Eigen::Matrix3d covariance = skeleton.centre_covariance(f, j);
      const double squares = error.squaredNorm();
      const bool determined = state == data::CentreState::determined;
      ++out.answered;
      out.squares_answered += squares;
      // A frame with a NaN covariance counts as beyond, and below as not within.
      const bool far = !(squares <= kFar * kFar * covariance.trace());
      out.beyond_5sd += far ? 1 : 0;
      out.ambiguous += state == data::CentreState::ambiguous ? 1 : 0;
      if (state == data::CentreState::bridged) {
        ++out.bridged;
        out.squares_bridged += squares;
      }
      if (!determined) continue;
      ++out.determined;
      out.squares_determined += squares;
      out.beyond_5sd_determined += far ? 1 : 0;
      for (int a = 0; a < 3; ++a) {
        const double sds = std::abs(error[a]) / std::sqrt(covariance(a, a));
        ++out.coordinates;
        out.within_1sd += sds <= 1.0 ? 1 : 0;
        out.within_2sd += sds <= 2.0 ? 1 : 0;
      }
      if (bound == nullptr) continue;
      if (bound->determined[at] == 0) {
        ++out.determined_without_bound;
        continue;
      }
      ++out.bounded;
      out.squares_bounded += squares;
      const bool fold = covariance.trace() < kFold * bound->variance(at);
      out.folded += fold ? 1 : 0;
      out.bound_squares += fold ? covariance.trace() : bound->variance(at);
    }
  return out;
}

}  // namespace kinemark::studies
