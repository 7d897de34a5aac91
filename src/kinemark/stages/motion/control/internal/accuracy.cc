// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/accuracy.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/motion/control/internal/bounds.h"
#include "kinemark/stages/motion/control/internal/step_error.h"
#include "kinemark/stages/motion/control/internal/track_bars.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPilot_hz = 8.0, kPilotStep_s = 1.0 / 240.0, kPilotOmega = 100.0;
constexpr double kCutoffs_hz[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0, 25.0};
constexpr double kMostOfRate = 1.0 / 6.0;           // higher cut-offs leave noise that the steps amplify
constexpr double kLeastBand_hz = 6.0, kBand = 2.5;  // movement is looked for up to so many cut-offs
constexpr double kMargin = 1.1;
constexpr double kOmegaStep = 0.5;
constexpr int kParts[] = {1, 2, 3, 4, 8, 16};  // of a frame
constexpr std::int64_t kLookedFrames = 400;
constexpr double kSixth = 924.0;         // squares of the weights of a sixth difference
constexpr double kSmoothedBefore = 0.5;  // of the variance that white noise has at the highest frequencies

/// Weights of the samples in a goal at a frame, from the middle outwards.
VectorXd response_of(const GoalFilter& filter) {
  const auto& k = filter.kernel();
  const auto at_distance = [&](std::size_t i) { return i < k.size() ? k[i] : 0.0; };
  VectorXd out(static_cast<Index>(k.size()) + 1);
  for (Index i = 0; i < out.size(); ++i) {
    const auto n = at(i);
    out[i] = (at_distance(n > 0 ? n - 1 : 1) + 4.0 * at_distance(n) + at_distance(n + 1)) / 6.0;
  }
  return out;
}

/// Power that white noise of variance 1 has after `band` of what `filter` took away.
double power_of_rest(const GoalFilter& filter, const GoalFilter& band) {
  const VectorXd taken = response_of(filter), passed = response_of(band);
  const auto value = [](const VectorXd& half, Index k) {
    return std::abs(k) < half.size() ? half[std::abs(k)] : 0.0;
  };
  const Index reach = taken.size() + passed.size();
  double power = 0.0;
  for (Index k = -reach; k <= reach; ++k) {
    double sum = value(passed, k);
    for (Index j = -passed.size(); j <= passed.size(); ++j) sum -= value(passed, j) * value(taken, k - j);
    power += sum * sum;
  }
  return power;
}

TrackOptions with_cutoff(const TrackOptions& options, double cutoff_hz) {
  TrackOptions out = options;
  out.cutoff_hz = cutoff_hz;
  out.accuracy_rad = 0.0;
  return out;
}

/// What a cut-off does to the angles.
struct Cutoff {
  double hz = 0.0;
  double noise_gain = 0.0, rest_gain = 0.0;  // of variances of the samples
  MatrixXd lost;                             // 3M x frames: movement that the filter takes, and some noise
  VectorXd squares;                          // per coordinate, of `lost` as angles
};

/// Frames that are looked at: those at the ends, where filters mirror, are among them.
std::vector<std::int64_t> frames_of(const Problem& problem) {
  const auto stride = std::max<std::int64_t>(1, problem.frames / kLookedFrames);
  std::vector<std::int64_t> frames;
  for (std::int64_t f = 0; f < problem.frames; f += stride) frames.push_back(f);
  return frames;
}

Result<Cutoff> make_cutoff(const Plan& plan, const data::Trajectories& samples,
                           const std::vector<std::int64_t>& frames, double hz, const TrackOptions& options) {
  const auto& p = plan.problem;
  const double band_hz = std::max(kLeastBand_hz, kBand * hz);
  const auto goals = control_goals(samples, with_cutoff(options, hz));
  if (!goals) return std::unexpected(goals.error());
  auto rest = samples;
  for (std::int64_t f = 0; f < samples.frames(); ++f)
    for (std::int64_t m = 0; m < samples.markers(); ++m) {
      if (samples.present(f, m) && goals->present(f, m))
        rest.x(f, m) -= goals->x(f, m);
      else
        rest.set_missing(f, m);
    }
  const auto lost = control_goals(rest, with_cutoff(options, band_hz));
  if (!lost) return std::unexpected(lost.error());
  Cutoff out{.hz = hz};
  const auto filter = make_filter(plan.rate_hz, with_cutoff(options, hz));
  out.noise_gain = filter.noise_in_goal();
  out.rest_gain = power_of_rest(filter, make_filter(plan.rate_hz, with_cutoff(options, band_hz)));
  out.lost.setZero(3 * p.model.marker_count(), std::ssize(frames));
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (int m = 0; m < p.model.marker_count(); ++m)
      if (const auto f = p.first_frame + frames[i]; lost->present(f, p.data_marker[at(m)]))
        out.lost.col(static_cast<Index>(i)).segment<3>(3 * static_cast<Index>(m)) =
            lost->x(f, p.data_marker[at(m)]);
  out.squares.setZero(p.model.coordinate_count());
  return out;
}

/// Pooled variance of sixth differences of the samples: what white noise would have.
double roughness(const data::Trajectories& samples) {
  double squares = 0.0, count = 0.0;
  for (std::int64_t m = 0; m < samples.markers(); ++m)
    for (std::int64_t f = 6; f < samples.frames(); ++f) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      bool whole = true;
      constexpr double kBinomial[] = {1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};
      for (std::int64_t k = 0; k < 7 && whole; ++k) {
        whole = samples.present(f - k, m);
        if (whole) sum += kBinomial[k] * samples.x(f - k, m);
      }
      if (!whole) continue;
      squares += sum.squaredNorm() / kSixth;
      count += 3.0;
    }
  return count > 0.0 ? squares / count : 0.0;
}

/// The motion with accelerations as a lower cut-off leaves them.
data::JointMotion smoothed(const data::JointMotion& motion, const GoalFilter& filter) {
  const VectorXd half = response_of(filter);
  auto out = motion;
  for (std::int64_t c = 0; c < motion.size(); ++c)
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      double sum = 0.0, weight = 0.0;
      for (Index k = 1 - half.size(); k < half.size(); ++k) {
        if (f + k < 0 || f + k >= motion.frames()) continue;
        sum += half[std::abs(k)] * motion.qdd[motion.index(f + k, c)];
        weight += half[std::abs(k)];
      }
      out.qdd[out.index(f, c)] = sum / weight;
    }
  return out;
}

/// Variances of angles, before any filter, and which angles count.
struct Angles {
  VectorXd variance, frames;  // per coordinate; frames in which it is determined
  std::vector<int> used;
};

Angles map_to_angles(const Plan& plan, const JudgedRun& pilot, const VectorXd& white,
                     const std::vector<std::int64_t>& frames, std::vector<Cutoff>& cutoffs) {
  const auto& p = plan.problem;
  const auto& [joined, track, result] = pilot.body;
  Bounds bounds(plan);
  const MarkerVariances nothing{.own = VectorXd::Zero(p.model.marker_count()),
                                .common = VectorXd::Zero(static_cast<Index>(p.model.bodies().size()))};
  GoalValues goal(p.model.marker_count());
  Angles angles;
  angles.variance.setZero(p.model.coordinate_count());
  angles.frames = angles.variance;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto f = frames[i];
    goal.weight = track.weights.col(f);
    for (Index m = 0; m < goal.weight.size(); ++m)
      if (goal.weight[m] > 0.0) goal.x.col(m) = track.goals.x(p.first_frame + f, p.data_marker[at(m)]);
    const Eigen::Map<const VectorXd> q(result.motion.q.data() + result.motion.index(f, 0),
                                       result.motion.size());
    bounds.find(track.states.col(f), q, goal, result.motion.time.time_s(f), nothing);
    const VectorXd variance = bounds.variance_of(white);
    std::vector<VectorXd> lost;
    for (const auto& cutoff : cutoffs)
      lost.push_back(bounds.coordinates_of(Eigen::Map<const Eigen::Matrix3Xd>(
          cutoff.lost.col(static_cast<Index>(i)).data(), 3, p.model.marker_count())));
    for (int c = 0; c < p.model.coordinate_count(); ++c) {
      const int speed = p.model.coordinates()[at(c)].speed_idx;
      if (bounds.determined()[at(c)] == 0 || speed < 0 || p.fixed_speed[at(speed)] != 0 ||
          !p.model.description().coordinates[at(c)].is_rotation)
        continue;
      angles.variance[c] += variance[c];
      angles.frames[c] += 1.0;
      for (std::size_t k = 0; k < cutoffs.size(); ++k) cutoffs[k].squares[c] += lost[k][c] * lost[k][c];
    }
  }
  for (int c = 0; c < p.model.coordinate_count(); ++c)
    if (angles.frames[c] > 0.0) angles.used.push_back(c);
  return angles;
}

/// Mean squares over the angles.
struct Parts {
  double noise = 0.0, lost = 0.0;
  [[nodiscard]] double sum() const { return noise + lost; }
};

Parts parts_of(const Angles& angles, const Cutoff& cutoff) {
  Parts parts;
  for (const int c : angles.used) {
    parts.noise += cutoff.noise_gain * angles.variance[c] / angles.frames[c];
    parts.lost += (cutoff.squares[c] - cutoff.rest_gain * angles.variance[c]) / angles.frames[c];
  }
  const auto count = static_cast<double>(angles.used.size());
  return {.noise = parts.noise / count, .lost = std::max(0.0, parts.lost / count)};
}

/// Equation 17: the angles that are known best and worst.
void add_extremes(const model::Model& model, const Angles& angles, const Cutoff& cutoff,
                  AccuracyChoice& choice) {
  choice.smallest_rad = 1e300;
  for (const int c : angles.used) {
    const double lost = std::max(0.0, cutoff.squares[c] - cutoff.rest_gain * angles.variance[c]);
    const double error = std::sqrt((cutoff.noise_gain * angles.variance[c] + lost) / angles.frames[c]);
    const auto& name = model.description().coordinates[at(c)].name;
    if (error > choice.largest_rad) choice.largest_rad = error, choice.largest = name;
    if (error < choice.smallest_rad) choice.smallest_rad = error, choice.smallest = name;
  }
}

/// What it would take.
std::string way_out(const AccuracyChoice& c, double rate_hz) {
  const double floor = std::hypot(c.noise_rad, c.lost_rad), share = c.wanted_rad / (kMargin * floor);
  if (share >= 1.0)
    return fmt::format(
        "without steps it could: the movement is too fast for those of {:.2g} ms, the shortest that are "
        "tried",
        1e3 * c.step_s);
  return fmt::format("noise of {:.2g} mm would do, it is {:.2g} mm, or {:.0f} Hz instead of {:g} Hz",
                     1e3 * c.noise_sd_m * share, 1e3 * c.noise_sd_m, std::ceil(rate_hz / (share * share)),
                     rate_hz);
}

std::unexpected<Error> refuse(const AccuracyChoice& c, double rate_hz) {
  return fail(
      Code::bad_input,
      fmt::format(
          "an accuracy of {:g} deg cannot be had: {:.2g} deg are expected at best (noise {:.2g}, lost "
          "movement {:.2g}, steps {:.2g} deg; the most in '{}', {:.2g} deg); {}",
          kDegPerRad * c.wanted_rad, kDegPerRad * c.predicted_rad, kDegPerRad * c.noise_rad,
          kDegPerRad * c.lost_rad, kDegPerRad * c.step_rad, c.largest, kDegPerRad * c.largest_rad,
          way_out(c, rate_hz)));
}

}  // namespace

TrackOptions pilot_options(double rate_hz, const TrackOptions& options) {
  TrackOptions pilot = with_cutoff(options, std::min(kPilot_hz, rate_hz / 5.0));
  pilot.omega_rad_s = kPilotOmega;
  pilot.step_s = kPilotStep_s;
  pilot.error_bars = pilot.settle = false;
  return pilot;
}

Result<AccuracyChoice> choose_by_accuracy(const Plan& plan, const JudgedRun& pilot,
                                          const data::Trajectories& markers, const GoalFilter& pilot_filter,
                                          const TrackOptions& options) {
  const auto& samples = pilot.kept(markers);
  const auto& result = pilot.body.result;
  const Index M = plan.problem.model.marker_count();
  const double given = options.marker_noise_sd_m * options.marker_noise_sd_m;
  const VectorXd white = given > 0.0 ? VectorXd(VectorXd::Constant(M, given))
                                     : white_noise(pilot.body.plan, samples, pilot.body.track, pilot_filter,
                                                   options.threads, result.motion);
  if (given == 0.0 && !(roughness(samples) > kSmoothedBefore * white.mean()))
    return fail(Code::bad_input,
                "which accuracy can be had is not known: the samples show no noise of their own (they were "
                "smoothed before, or are never seen in seven frames on end); give it (--noise)");
  const auto frames = frames_of(plan.problem);
  std::vector<Cutoff> cutoffs;
  for (const double hz : kCutoffs_hz) {
    if (hz > kMostOfRate * plan.rate_hz) break;
    auto cutoff = make_cutoff(plan, samples, frames, hz, options);
    if (!cutoff) return std::unexpected(cutoff.error());
    cutoffs.push_back(std::move(*cutoff));
  }
  const Angles angles = cutoffs.empty() ? Angles{} : map_to_angles(plan, pilot, white, frames, cutoffs);
  if (angles.used.empty())
    return fail(Code::bad_input,
                "which accuracy can be had is not known: the markers determine no angle, or "
                "come at less than 6 Hz");
  const auto best = std::ranges::min_element(
      cutoffs, {}, [&](const Cutoff& cutoff) { return parts_of(angles, cutoff).sum(); });
  const Parts parts = parts_of(angles, *best);
  AccuracyChoice choice{.wanted_rad = options.accuracy_rad,
                        .noise_sd_m = std::sqrt(white.mean()),
                        .noise_rad = std::sqrt(parts.noise),
                        .lost_rad = std::sqrt(parts.lost),
                        .cutoff_hz = best->hz};
  add_extremes(plan.problem.model, angles, *best, choice);
  const auto motion = smoothed(result.motion, make_filter(plan.rate_hz, with_cutoff(options, best->hz)));
  for (const int parts_of_frame : kParts) {
    choice.step_s = 1.0 / (plan.rate_hz * parts_of_frame);
    choice.omega_rad_s = kOmegaStep / choice.step_s;
    choice.step_rad = step_error(plan.problem.model, motion, choice.step_s, choice.omega_rad_s);
    choice.predicted_rad = std::sqrt(parts.sum() + choice.step_rad * choice.step_rad);
    if (kMargin * choice.predicted_rad <= choice.wanted_rad) return choice;
  }
  return refuse(choice, plan.rate_hz);
}

}  // namespace kinemark::motion::internal
