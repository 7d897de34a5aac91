// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/skeleton/articulated/chain/robust_weights.h"
#include "kinemark/stages/skeleton/articulated/frame/chain_solver.h"
#include "kinemark/stages/skeleton/articulated/geometry/bootstrap.h"
#include "kinemark/stages/skeleton/articulated/geometry/frame_selection.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"
#include "kinemark/stages/skeleton/articulated/geometry/mirror_ambiguity.h"
#include "kinemark/stages/skeleton/articulated/geometry/segment_kind.h"
#include "kinemark/stages/skeleton/articulated/geometry/segment_shape.h"
#include "kinemark/stages/skeleton/articulated/geometry/start_geometry.h"

namespace kinemark::skeleton::articulated {

namespace {

using data::CentreState;
using data::SegmentKind;

constexpr double kFirstNoise = 1e-3;  // m, before the residuals are known
constexpr double kLeastNoise = 1e-9;  // m: data without noise
constexpr double kTooRough = 4.0;     // deviates of the residuals above the noise that was given
constexpr int kReplicates = 3;
constexpr std::int64_t kFollowed = 256;    // frames that one thread follows from a cold start
constexpr std::size_t kFirstFrames = 400;  // enough for a first geometry, which further rounds refine
constexpr double kMirrorClear = 10.0;      // chi-square between a geometry and its mirror image
// A fit is done once a step changes chi-square by no more: a thirtieth of an SD, or a third in fits that
// others follow.
constexpr int kRoughSteps = 6;  // of a fit, until its noise is about known
constexpr double kLeastGain = 1e-3, kLeastGainBefore = 0.1;

Status check_options(const ChainSamples& samples, const ChainLayout& layout, const ChainFitOptions& options) {
  check(samples.markers == layout.markers(), "one segment a marker");
  check(options.kind.empty() || static_cast<int>(options.kind.size()) == layout.segments(),
        "one kind a segment");
  check(options.marker_names.empty() || static_cast<int>(options.marker_names.size()) == layout.markers(),
        "one name a marker");
  if (layout.joints() < 1) return fail(Code::usage, "an articulated chain needs two segments or more");
  for (int s = 0; s < layout.segments(); ++s) {
    if (layout.markers_of(s).empty()) {
      return fail(Code::bad_input,
                  "segment " + std::to_string(s) + " has no marker; every segment needs one or more");
    }
  }
  return {};
}

// Take markers out that no frame ties to their segment; their indices.
std::vector<int> drop_loose_markers(ChainSamples& samples, const ChainLayout& layout) {
  std::vector<int> dropped;
  for (int s = 0; s < layout.segments(); ++s) {
    const std::vector<int> markers = layout.markers_of(s);
    if (markers.size() < 4) continue;
    const auto shape = segment_shape(samples, markers, SegmentKind::solid, 0.0);
    if (!shape) continue;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      if (!std::isnan((*shape)(0, static_cast<Eigen::Index>(i)))) continue;
      dropped.push_back(markers[i]);
      for (std::int64_t f = 0; f < samples.frames; ++f) {
        std::fill_n(samples.x.data() + 3 * (f * samples.markers + markers[i]), 3,
                    std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
  return dropped;
}

// Those of `frames` whose joints are all determined, with their poses.
PosedFrames determined_frames(const ChainSamples& samples, const std::vector<std::int64_t>& frames,
                              const FittedChain& fit, int threads) {
  std::vector<std::optional<ChainPose>> poses(frames.size());
  parallel_for(std::ssize(frames), kFollowed, threads, [&](std::int64_t begin, std::int64_t end) {
    ChainSolver solver(fit);
    ChainFrame frame;
    ChainPose last;
    for (std::int64_t i = begin; i < end; ++i) {
      solver.solve(samples.frame(frames[at(i)]), last.rotation.empty() ? nullptr : &last, frame);
      if (frame.mode_count == 0) continue;
      last = frame.modes[0].pose;
      const bool all = std::all_of(frame.state.begin(), frame.state.end(),
                                   [](CentreState s) { return s == CentreState::determined; });
      const bool gathered =
          std::ranges::any_of(frame.gathered, [](Gathered g) { return g != Gathered::none; });
      if (all && !gathered) poses[at(i)] = last;
    }
  });
  PosedFrames out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!poses[i]) continue;
    out.frame.push_back(frames[i]);
    out.pose.push_back(std::move(*poses[i]));
    out.weight.push_back(fit.marker_weight);
  }
  return out;
}

// At most `most` of the frames, evenly drawn.
std::vector<std::int64_t> draw(const std::vector<std::int64_t>& frames, std::size_t most) {
  if (frames.size() <= most) return frames;
  std::vector<std::int64_t> out(most);
  for (std::size_t i = 0; i < most; ++i) out[i] = frames[i * frames.size() / most];
  return out;
}

bool is_hopeless(const FittedChain& fit, const ChainSamples& samples, const PosedFrames& frames,
                 const ChainFitOptions& options) {
  double reach = 0.0, change = 0.0;
  for (int j = 0; j < fit.chain.joints(); ++j) {
    reach = std::max(reach, reach_of(fit.chain, j));
    if (std::isfinite(options.most_change_m))
      change = std::max(change, distance_change(fit.chain, samples, frames, j));
  }
  return !(fit.noise_sd_m <= options.most_noise_m && reach <= options.most_reach_m &&
           change <= options.most_change_m);
}

class Rounds {
 public:
  Rounds(const ChainSamples& samples, const ChainFitOptions& options, FittedChain& fit)
      : samples_(samples), options_(options), fit_(fit), measured_(options.noise_sd_m > 0.0) {}

  // Geometry, noise and covariance from `frames`.
  void fit(PosedFrames& frames, bool last) {
    GeometryFit geometry(fit_.chain, samples_, frames, fit_.noise_sd_m, options_.threads);
    const auto done = [&](bool followed) {
      return [this, least = followed || !last ? kLeastGainBefore : kLeastGain](int, double gain_m2) {
        return gain_m2 < least * fit_.noise_sd_m * fit_.noise_sd_m;
      };
    };
    const bool robust = options_.robust_dof > 0.0;
    kept_ = 1.0;
    if (!measured_) measure_noise(geometry, geometry.run(kRoughSteps));
    double cost = geometry.run(30, {}, done(robust));
    measure_noise(geometry, cost);
    if (robust) {
      for (const bool followed : {true, false}) {
        geometry.reweigh(fit_.marker_weight, options_.robust_dof, fit_.noise_sd_m);
        cost = geometry.run(followed ? 10 : 30, {}, done(followed));
      }
      kept_ = robust_share(options_.robust_dof, geometry.degrees_of_freedom() / geometry.coordinates());
      measure_noise(geometry, cost);
    }
    if (options_.marker_noise) {
      kept_ = 1.0;  // robust weights are given up
      for (int round = 0; round < 3; ++round) {
        const std::vector<double> ratio = geometry.marker_variance(fit_.noise_sd_m);
        for (std::size_t k = 0; k < ratio.size(); ++k) {
          if (fit_.marker_weight[k] > 0.0)
            fit_.marker_weight[k] = std::clamp(fit_.marker_weight[k] / ratio[k], 0.01, 100.0);
        }
        for (auto& weight : frames.weight) weight = fit_.marker_weight;
        cost = geometry.run(10, {}, done(round < 2));
        measure_noise(geometry, cost);
      }
    }
    const bool lines = std::all_of(fit_.chain.kind.begin(), fit_.chain.kind.end(),
                                   [](SegmentKind kind) { return kind == SegmentKind::line; });
    if (last && lines) {
      Eigen::VectorXd extra_gradient = Eigen::VectorXd::Zero(fit_.chain.geometry_parameters().size());
      for (int round = 0; round < 4; ++round) {
        const Eigen::VectorXd before = extra_gradient;
        extra_gradient = geometry.integrated_gradient(fit_.noise_sd_m);
        if ((extra_gradient - before).cwiseAbs().maxCoeff() < 1e-3 * extra_gradient.cwiseAbs().maxCoeff())
          break;
        cost = geometry.run(15, extra_gradient);
        measure_noise(geometry, cost);
        // No joint comes back from where no body has one.
        if (is_hopeless(fit_, samples_, frames, options_)) break;
      }
    }
    fit_.geometry_covariance = fit_.noise_sd_m * fit_.noise_sd_m * geometry.covariance(fit_.noise_sd_m);
    double expected = 1.0;
    double wider = 1.0;
    if (last && has_weak_rotation(fit_.chain, fit_.noise_sd_m)) {
      const Bootstrap found = bootstrap(samples_, frames, fit_, kReplicates);
      expected = std::clamp(found.chi2_ratio, 0.5, 1.0);
      fit_.covariance_scale = std::clamp(found.variance_ratio, 1.0, 2.0);
      // A bias that is larger than the segments themselves is a refit that ran away.
      if (found.bias.allFinite() && found.bias.cwiseAbs().maxCoeff() < fit_.chain.scale()) {
        fit_.chain.move_geometry(-found.bias);
        cost = geometry.cost();
        // The bias has a scatter of its own: that of the replicates' geometries.
        const auto n = static_cast<double>(frames.size());
        wider += n / (std::min(n, static_cast<double>(kBootstrapFrames)) * kReplicates);
      }
      if (options_.noise_sd_m <= 0.0) fit_.noise_sd_m /= std::sqrt(expected);
    }
    fit_.residual_dof = expected * kept_ * geometry.degrees_of_freedom();
    if (const double excess = cost / (fit_.noise_sd_m * fit_.noise_sd_m * fit_.residual_dof);
        last && options_.noise_sd_m > 0.0 &&
        excess > 1.0 + kTooRough * std::sqrt(2.0 / std::max(fit_.residual_dof, 1.0))) {
      // Markers that slip on the skin, or a shape that is simpler than the truth: the noise includes these
      // errors.
      fit_.noise_sd_m *= std::sqrt(excess);
    }
    fit_.chi2 = cost / (fit_.noise_sd_m * fit_.noise_sd_m);
    fit_.geometry_covariance_scale = wider;
    fit_.geometry_covariance =
        wider * fit_.noise_sd_m * fit_.noise_sd_m * geometry.covariance(fit_.noise_sd_m);
  }

 private:
  void measure_noise(GeometryFit& geometry, double cost) {
    if (options_.noise_sd_m > 0.0) return;
    fit_.noise_sd_m =
        std::max(std::sqrt(cost / (kept_ * std::max(geometry.degrees_of_freedom(), 1.0))), kLeastNoise);
    geometry.set_noise(fit_.noise_sd_m);
    measured_ = true;
  }

  const ChainSamples& samples_;
  const ChainFitOptions& options_;
  FittedChain& fit_;
  bool measured_ = false;
  double kept_ = 1.0;  // share of Gaussian noise's cost that robust weights leave
};

}  // namespace

Result<FittedChain> fit_chain(const ChainSamples& samples, const ChainLayout& layout,
                              const ChainFitOptions& options, const Progress& progress) {
  const auto stopped = [&] { return progress && !progress(0, samples.frames); };
  const auto cancelled = [] { return fail(Code::cancelled, "stopped while finding the geometry"); };
  if (const Status status = check_options(samples, layout, options); !status)
    return std::unexpected(status.error());
  std::vector<std::int64_t> kept;
  ChainSamples drawn = thin_out(samples, std::max(options.frames_max, 50), kept);
  if (drawn.frames < 5)
    return fail(Code::bad_input,
                "fewer than five frames show two markers or more; nothing can be known of the joints");
  const std::vector<int> dropped = drop_loose_markers(drawn, layout);
  std::vector<SegmentKind> kind = options.kind;
  if (kind.empty()) {
    auto chosen = choose_kinds(drawn, layout, options.noise_sd_m, stopped, options.threads);
    if (!chosen) return std::unexpected(chosen.error());
    kind = std::move(*chosen);
  }
  auto start = start_geometry(drawn, layout, kind, options.noise_sd_m);
  if (!start) return std::unexpected(start.error());
  FittedChain fit;
  fit.chain = std::move(*start);
  fit.noise_sd_m = options.noise_sd_m > 0.0 ? options.noise_sd_m : kFirstNoise;
  fit.marker_weight.assign(layout.markers(), 1.0);
  for (const int k : dropped) {
    fit.marker_weight[k] = 0.0;
    fit.warnings.emplace_back(
        "Marker " + (options.marker_names.empty() ? std::to_string(k) : "'" + options.marker_names[k] + "'") +
        " is not seen together with three others of its segment in three frames; it was left out.");
  }
  fit.robust_dof = options.robust_dof;
  fit.alternative_max = options.alternative_max;

  const std::vector<std::int64_t> first = first_frames(drawn, fit.chain);
  if (first.size() < 5)
    return fail(Code::bad_input,
                "fewer than five frames show enough markers of all segments to find their joints");
  Rounds rounds(drawn, options, fit);
  const auto pose = [&](const std::vector<std::int64_t>& which) {
    return first_poses(drawn, fit.chain, which, fit.marker_weight, fit.noise_sd_m, 25, options.threads);
  };
  const bool two_lines =
      fit.chain.segments() == 2 && kind[0] == SegmentKind::line && kind[1] == SegmentKind::line;
  const int count = two_lines ? 1 : std::max(options.rounds, 1);
  std::vector<std::int64_t> all(at(drawn.frames));
  std::iota(all.begin(), all.end(), 0);
  PosedFrames frames = pose(count > 1 ? draw(first, kFirstFrames) : first);
  for (int round = 0; round < count; ++round) {
    if (stopped()) return cancelled();
    rounds.fit(frames, round + 1 == count);
    if (stopped()) return cancelled();
    if (round == 0 && try_mirrored(drawn, frames, fit, options.threads)) {
      frames = pose(frames.frame);
      rounds.fit(frames, round + 1 == count);
    }
    if (round + 1 == count) break;
    if (is_hopeless(fit, drawn, frames, options)) {
      fit.refined = false;
      fit.warnings.emplace_back(
          "The first geometry is so far from what is expected that it was not refined; its error bars are "
          "rough.");
      break;
    }
    if (stopped()) return cancelled();
    const auto determined = [&](std::size_t most) {
      return determined_frames(drawn, draw(all, most), fit, options.threads);
    };
    PosedFrames next = determined(round + 2 == count ? all.size() : kFirstFrames);
    if (next.size() < kFirstFrames / 2 && round + 2 < count && all.size() > kFirstFrames)
      next = determined(all.size());
    if (next.size() < 20) {
      fit.warnings.emplace_back(
          "Fewer than 20 of the frames that are used determine all joints by themselves; the geometry rests "
          "on "
          "those that show most markers.");
      if (round == 0) frames = pose(first);
      rounds.fit(frames, true);
      break;
    }
    frames = std::move(next);
  }
  for (const std::int64_t f : frames.frame) fit.frames.push_back(kept[f]);
  if (fit.mirror_margin < kMirrorClear) {
    fit.warnings.emplace_back(
        "A mirrored geometry fits nearly as well; which side of its markers a joint lies on is not known.");
  }
  return fit;
}

}  // namespace kinemark::skeleton::articulated
