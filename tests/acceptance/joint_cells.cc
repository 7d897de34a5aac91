// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/joint_cells.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/stages/skeleton/articulated/bound.h"

namespace kinemark::joint_cells {
namespace {

using data::CentreState;

/// Of a recording without a fit or without a frame to judge: more than any bar allows.
constexpr double kNoRatio = 99.0;
/// A variance below this share of the bound's is that of a frame near a fold.
constexpr double kFold = 0.5;

int seen_of(const simulation::LimbRecording& limb, std::int64_t frame, int segment) {
  int seen = 0;
  for (const int m : limb.layout.segments[static_cast<std::size_t>(segment)].markers)
    seen += limb.markers.present(frame, m) ? 1 : 0;
  return seen;
}

Eigen::Vector3d truth_of(const simulation::LimbRecording& limb, std::size_t index) {
  return Eigen::Map<const Eigen::Vector3d>(limb.centre_in_world.data() + 3 * index);
}

void measure_lengths(const simulation::LimbRecording& limb, const data::Skeleton& skeleton, Tally& tally) {
  for (const auto& length : skeleton.lengths) {
    const double truth = (truth_of(limb, static_cast<std::size_t>(length.joint_a)) -
                          truth_of(limb, static_cast<std::size_t>(length.joint_b)))
                             .norm();
    const double z = std::abs(length.length_m - truth) / length.sd_m;
    ++tally.lengths;
    tally.length_in_1sd += z < 1.0 ? 1 : 0;
    tally.length_in_2sd += z < 2.0 ? 1 : 0;
  }
}

}  // namespace

double Tally::ratio() const { return std::sqrt(squares_m2 / bound_m2); }
double Tally::worst_seed() const { return seed_ratio.empty() ? kNoRatio : std::ranges::max(seed_ratio); }
double Tally::rms_mm() const {
  return 1e3 * std::sqrt(squares_m2 / static_cast<double>(std::max<std::int64_t>(bounded, 1)));
}
double Tally::bound_mm() const {
  return 1e3 * std::sqrt(bound_m2 / static_cast<double>(std::max<std::int64_t>(bounded, 1)));
}

void Tally::add(const Tally& o) {
  squares_m2 += o.squares_m2;
  bound_m2 += o.bound_m2;
  seed_ratio.insert(seed_ratio.end(), o.seed_ratio.begin(), o.seed_ratio.end());
  frames += o.frames;
  determined += o.determined;
  bounded += o.bounded;
  determined_without_bound += o.determined_without_bound;
  whole += o.whole;
  whole_flagged += o.whole_flagged;
  wrong += o.wrong;
  wrong_unflagged += o.wrong_unflagged;
  coordinates += o.coordinates;
  in_1sd += o.in_1sd;
  in_2sd += o.in_2sd;
  lengths += o.lengths;
  length_in_1sd += o.length_in_1sd;
  length_in_2sd += o.length_in_2sd;
  pairs += o.pairs;
  pairs_flagged += o.pairs_flagged;
  noise_ratio += o.noise_ratio;
  for (int k = 0; k < 3; ++k) kinds[k] += o.kinds[k];
  smooth_squares_m2 += o.smooth_squares_m2;
  bridged_squares_m2 += o.bridged_squares_m2;
  bridged += o.bridged;
  unanswered += o.unanswered;
  worst_m = std::max(worst_m, o.worst_m);
}

std::string Tally::description() const {
  return fmt::format(
      "ratio {:.3f} (worst seed {:.3f}), RMS {:.2f} mm, bound {:.2f} mm, determined {:.1f} %, {} of {} "
      "beyond 5 SD "
      "unflagged, {} determined without a bound, coverage {:.1f} / {:.1f} %, noise x {:.3f}, kinds {}/{}/{}",
      ratio(), worst_seed(), rms_mm(), bound_mm(), 100.0 * share(), wrong_unflagged, wrong,
      determined_without_bound, 100.0 * part(in_1sd, coordinates), 100.0 * part(in_2sd, coordinates),
      noise_ratio / static_cast<double>(std::max<std::size_t>(seed_ratio.size(), 1)), kinds[0], kinds[1],
      kinds[2]);
}

void measure(const simulation::LimbRecording& limb, data::SegmentKind kind, double noise_sd_m,
             const skeleton::ArticulatedOptions& options, Tally& tally) {
  const std::vector<data::SegmentKind> kinds(limb.layout.segments.size(), kind);
  const auto bound = skeleton::calc_centre_bound(
                         limb.markers, limb.layout, kinds,
                         {.x_in_world = limb.x_true, .centre_in_world = limb.centre_in_world}, noise_sd_m)
                         .value();
  const auto fitted = skeleton::fit_articulated(limb.markers, limb.layout, options);
  if (!fitted) {
    fmt::print("no fit: {}\n", fitted.error().message);
    const auto all = static_cast<std::int64_t>(limb.layout.joints.size()) * limb.markers.frames();
    tally.seed_ratio.push_back(kNoRatio);
    tally.frames += all;
    tally.unanswered += all;
    return;
  }
  const data::Skeleton& skeleton = fitted->skeleton;
  Tally one;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
      const std::size_t k = skeleton.index(f, static_cast<std::int64_t>(j));
      const auto& joint = limb.layout.joints[j];
      const int above = seen_of(limb, f, joint.parent), below = seen_of(limb, f, joint.child);
      const bool alone = skeleton.state[k] == CentreState::determined;
      ++one.frames;
      const bool is_pair = std::max(above, below) == 2 && std::min(above, below) == 1;
      one.pairs += is_pair ? 1 : 0;
      one.pairs_flagged += is_pair && !alone ? 1 : 0;
      const auto all_of = [&](int segment) {
        return limb.layout.segments[static_cast<std::size_t>(segment)].markers.size();
      };
      if (above == static_cast<int>(all_of(joint.parent)) || below == static_cast<int>(all_of(joint.child))) {
        ++one.whole;
        one.whole_flagged += alone ? 0 : 1;
      }
      if (skeleton.state[k] == CentreState::undetermined) {
        ++one.unanswered;
        continue;
      }
      const Eigen::Vector3d e = skeleton.centre(f, static_cast<std::int64_t>(j)) - truth_of(limb, k);
      const Eigen::Matrix3d C = skeleton.centre_covariance(f, static_cast<std::int64_t>(j));
      const bool beyond = !(e.squaredNorm() <= 25.0 * C.trace());
      one.wrong += beyond ? 1 : 0;
      one.wrong_unflagged += beyond && alone ? 1 : 0;
      one.worst_m = std::max(one.worst_m, e.norm());
      if (skeleton.state[k] == CentreState::bridged) ++one.bridged, one.bridged_squares_m2 += e.squaredNorm();
      if (skeleton.state[k] == CentreState::ambiguous && options.continuity) ++one.unanswered;
      if (!alone) continue;
      ++one.determined;
      one.smooth_squares_m2 += e.squaredNorm();
      if (!bound.determined[k]) {
        ++one.determined_without_bound;
        continue;
      }
      ++one.bounded;
      one.squares_m2 += e.squaredNorm();
      // Near a fold the bound grows without limit: there the fit's own standard deviation is used as the
      // bound.
      const bool fold = C.trace() < kFold * bound.variance(k);
      one.bound_m2 += fold ? C.trace() : bound.variance(k);
      for (int i = 0; i < 3; ++i) {
        const double z = std::abs(e[i]) / std::sqrt(C(i, i));
        ++one.coordinates;
        one.in_1sd += z < 1.0 ? 1 : 0;
        one.in_2sd += z < 2.0 ? 1 : 0;
      }
    }
  measure_lengths(limb, skeleton, one);
  one.noise_ratio = skeleton.noise_sd_m / noise_sd_m;
  for (const auto& segment : skeleton.segments) ++one.kinds[static_cast<int>(segment.kind)];
  one.seed_ratio.push_back(std::isfinite(one.ratio()) ? one.ratio() : kNoRatio);
  tally.add(one);
}

Tally run_cell(simulation::ChainOptions chain, data::SegmentKind kind, int seeds,
               const skeleton::ArticulatedOptions& options) {
  Tally tally;
  for (int seed = 1; seed <= seeds; ++seed) {
    chain.seed = static_cast<std::uint64_t>(seed);
    measure(simulation::simulate_chain(chain).value(), kind, chain.noise_sd_m, options, tally);
  }
  return tally;
}

}  // namespace kinemark::joint_cells
