// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/geometry/fit_chain.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "kinemark/core/check.h"
#include "kinemark/stages/skeleton/articulated/geometry/bootstrap.h"
#include "kinemark/stages/skeleton/articulated/geometry/fit_rounds.h"
#include "kinemark/stages/skeleton/articulated/geometry/geometry_fit.h"
#include "kinemark/stages/skeleton/articulated/geometry/segment_kind.h"
#include "kinemark/stages/skeleton/articulated/geometry/segment_shape.h"

namespace kinemark::skeleton {

namespace {

using data::CentreState;
using data::SegmentKind;

constexpr double kFirstNoise = 1e-3;  // m, until the residuals tell
constexpr double kLeastNoise = 1e-9;  // m: data without noise
constexpr double kTooRough = 4.0;     // deviates of the residuals above the noise that was given
constexpr int kReplicates = 3;
constexpr double kTwinClear = 10.0;  // chi-square between a geometry and its mirror twin

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

// Frames whose joints are all determined, with their poses.
GlobalFrames determined_frames(const ChainSamples& samples, const ChainFit& fit) {
  GlobalFrames out;
  ChainSolver solver(fit);
  ChainFrame frame;
  ChainPose last;
  for (std::int64_t f = 0; f < samples.frames; ++f) {
    solver.solve(samples.frame(f), last.rotation.empty() ? nullptr : &last, frame);
    if (frame.mode_count == 0) continue;
    last = frame.modes[0].pose;
    const bool all = std::all_of(frame.state.begin(), frame.state.end(),
                                 [](CentreState s) { return s == CentreState::determined; });
    if (!all || frame.gathered) continue;
    out.frame.push_back(f);
    out.pose.push_back(last);
    out.weight.push_back(fit.marker_weight);
  }
  return out;
}

class Rounds {
 public:
  Rounds(const ChainSamples& samples, const ChainFitOptions& options, ChainFit& fit)
      : samples_(samples), options_(options), fit_(fit) {}

  // Geometry, noise and covariance from `frames`.
  void fit(GlobalFrames& frames, bool last) {
    GlobalFit globals(fit_.chain, samples_, frames, fit_.noise_sd_m);
    double cost = globals.run(30);
    measure_noise(globals, cost);
    if (options_.robust_dof > 0.0) {
      for (int round = 0; round < 2; ++round) {
        globals.reweigh(fit_.marker_weight, options_.robust_dof, fit_.noise_sd_m);
        cost = globals.run(10);
      }
      measure_noise(globals, cost);
    }
    if (options_.marker_noise) {
      for (int round = 0; round < 3; ++round) {
        const std::vector<double> ratio = globals.marker_variance(fit_.noise_sd_m);
        for (std::size_t k = 0; k < ratio.size(); ++k) {
          if (fit_.marker_weight[k] > 0.0)
            fit_.marker_weight[k] = std::clamp(fit_.marker_weight[k] / ratio[k], 0.01, 100.0);
        }
        for (auto& weight : frames.weight) weight = fit_.marker_weight;
        cost = globals.run(10);
        measure_noise(globals, cost);
      }
    }
    const bool lines = std::all_of(fit_.chain.kind.begin(), fit_.chain.kind.end(),
                                   [](SegmentKind kind) { return kind == SegmentKind::line; });
    if (last && lines) {
      Eigen::VectorXd push = Eigen::VectorXd::Zero(fit_.chain.globals().size());
      for (int round = 0; round < 4; ++round) {
        const Eigen::VectorXd before = push;
        push = globals.integrated_gradient(fit_.noise_sd_m);
        if ((push - before).cwiseAbs().maxCoeff() < 1e-3 * push.cwiseAbs().maxCoeff()) break;
        cost = globals.run(15, push);
        measure_noise(globals, cost);
      }
    }
    fit_.global_covariance = fit_.noise_sd_m * fit_.noise_sd_m * globals.covariance(fit_.noise_sd_m);
    double expected = 1.0;
    double wider = 1.0;
    if (last && has_weak_turns(fit_.chain, fit_.noise_sd_m)) {
      const Bootstrap found = bootstrap(samples_, frames, fit_, kReplicates);
      expected = std::clamp(found.chi2_ratio, 0.5, 1.0);
      fit_.covariance_scale = std::clamp(found.variance_ratio, 1.0, 2.0);
      // A bias that is larger than the segments themselves is a refit that ran away.
      if (found.bias.allFinite() && found.bias.cwiseAbs().maxCoeff() < fit_.chain.scale()) {
        fit_.chain.add_globals(-found.bias);
        cost = globals.cost();
        // The bias has a scatter of its own: that of the replicates' geometries.
        const auto n = static_cast<double>(frames.size());
        wider += n / (std::min(n, static_cast<double>(kBootstrapFrames)) * kReplicates);
      }
      if (options_.noise_sd_m <= 0.0) fit_.noise_sd_m /= std::sqrt(expected);
    }
    fit_.residual_dof = expected * globals.degrees_of_freedom();
    if (const double excess = cost / (fit_.noise_sd_m * fit_.noise_sd_m * fit_.residual_dof);
        last && options_.noise_sd_m > 0.0 &&
        excess > 1.0 + kTooRough * std::sqrt(2.0 / std::max(fit_.residual_dof, 1.0))) {
      // Markers that slip on the skin, or a shape that is simpler than the truth: say how large the errors
      // are.
      fit_.noise_sd_m *= std::sqrt(excess);
    }
    fit_.chi2 = cost / (fit_.noise_sd_m * fit_.noise_sd_m);
    fit_.global_covariance_scale = wider;
    fit_.global_covariance = wider * fit_.noise_sd_m * fit_.noise_sd_m * globals.covariance(fit_.noise_sd_m);
  }

 private:
  void measure_noise(GlobalFit& globals, double cost) {
    if (options_.noise_sd_m > 0.0) return;
    fit_.noise_sd_m = std::max(std::sqrt(cost / std::max(globals.degrees_of_freedom(), 1.0)), kLeastNoise);
    globals.set_noise(fit_.noise_sd_m);
  }

  const ChainSamples& samples_;
  const ChainFitOptions& options_;
  ChainFit& fit_;
};

}  // namespace

Result<ChainFit> fit_chain(const ChainSamples& samples, const ChainLayout& layout,
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
    auto chosen = choose_kinds(drawn, layout, options.noise_sd_m, stopped);
    if (!chosen) return std::unexpected(chosen.error());
    kind = std::move(*chosen);
  }
  auto start = start_geometry(drawn, layout, kind, options.noise_sd_m);
  if (!start) return std::unexpected(start.error());
  ChainFit fit;
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
  GlobalFrames frames = first_poses(drawn, fit.chain, first, fit.marker_weight, fit.noise_sd_m, 25);
  const bool two_lines =
      fit.chain.segments() == 2 && kind[0] == SegmentKind::line && kind[1] == SegmentKind::line;
  const int count = two_lines ? 1 : std::max(options.rounds, 1);
  for (int round = 0; round < count; ++round) {
    if (stopped()) return cancelled();
    rounds.fit(frames, round + 1 == count);
    if (stopped()) return cancelled();
    if (round == 0 && try_twins(drawn, frames, fit)) {
      frames = first_poses(drawn, fit.chain, frames.frame, fit.marker_weight, fit.noise_sd_m, 25);
      rounds.fit(frames, round + 1 == count);
    }
    if (round + 1 == count) break;
    if (stopped()) return cancelled();
    GlobalFrames next = determined_frames(drawn, fit);
    if (next.size() < 20) {
      fit.warnings.emplace_back(
          "Fewer than 20 frames determine all joints by themselves; the geometry rests on the frames that "
          "show most markers.");
      rounds.fit(frames, true);
      break;
    }
    frames = std::move(next);
  }
  for (const std::int64_t f : frames.frame) fit.frames.push_back(kept[f]);
  if (fit.twin_margin < kTwinClear) {
    fit.warnings.emplace_back(
        "A mirrored geometry fits nearly as well; which side of its markers a joint lies on is not known.");
  }
  return fit;
}

Matrix3d ChainFit::joint_covariance(int j, bool in_parent) const {
  const int s = in_parent ? chain.layout.parent[j] : j + 1;
  const Vector3d p = in_parent ? Vector3d(chain.joint.col(j)) : Vector3d(Vector3d::Zero());
  std::vector<int> markers = chain.layout.markers_of(s);
  std::erase_if(markers, [&](int k) { return !(marker_weight[k] > 0.0); });  // their places are not known
  const auto n = static_cast<double>(markers.size());
  Vector3d mean = Vector3d::Zero();
  for (const int k : markers) mean += chain.marker.col(k) / n;
  Matrix3d inertia = Matrix3d::Zero();
  for (const int k : markers) {
    const Vector3d d = chain.marker.col(k) - mean;
    inertia += d.squaredNorm() * Matrix3d::Identity() - d * d.transpose();
  }
  // About the line of collinear markers there is no turn to tell.
  inertia.diagonal().array() += 1e-9 * inertia.trace() + 1e-300;
  const Matrix3d mobility = inertia.inverse();
  const auto& globals = chain.globals();
  Eigen::Matrix3Xd L = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(globals.size()));
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].segment != s) continue;
    const Vector3d e = Vector3d::Unit(globals[g].axis);
    if (globals[g].marker < 0) {
      if (in_parent && globals[g].joint == j) L.col(g) = e;
      continue;
    }
    if (!(marker_weight[globals[g].marker] > 0.0)) continue;
    const Vector3d turn = mobility * (chain.marker.col(globals[g].marker) - mean).cross(e);
    L.col(g) = -e / n - turn.cross(p - mean);
  }
  return L * global_covariance * L.transpose();
}

std::vector<ChainFit::Length> ChainFit::lengths() const {
  std::vector<Length> out;
  for (int s = 0; s < chain.segments(); ++s) {
    std::vector<int> joints;
    if (s > 0) joints.push_back(s - 1);
    for (int j = 0; j < chain.joints(); ++j) {
      if (chain.layout.parent[j] == s) joints.push_back(j);
    }
    for (std::size_t a = 0; a < joints.size(); ++a) {
      for (std::size_t b = a + 1; b < joints.size(); ++b) {
        // The segment's upper joint (segment 0: joint 0) is its origin.
        const auto place = [&](int j) {
          return j == s - 1 ? Vector3d(Vector3d::Zero()) : Vector3d(chain.joint.col(j));
        };
        const Vector3d way = place(joints[b]) - place(joints[a]);
        const double length = way.norm();
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(chain.globals().size());
        for (std::size_t g = 0; g < chain.globals().size(); ++g) {
          const Chain::Global& what = chain.globals()[g];
          if (what.joint < 0 || what.segment != s) continue;
          const double sign = what.joint == joints[b] ? 1.0 : what.joint == joints[a] ? -1.0 : 0.0;
          gradient[g] = sign * way[what.axis] / std::max(length, 1e-12);
        }
        const double variance = gradient.dot(global_covariance * gradient);
        out.push_back({joints[a], joints[b], s, length, std::sqrt(std::max(variance, 0.0)),
                       way / std::max(length, 1e-12)});
      }
    }
  }
  return out;
}

}  // namespace kinemark::skeleton
