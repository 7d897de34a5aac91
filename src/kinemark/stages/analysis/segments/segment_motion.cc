// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/segment_motion.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "kinemark/core/parallel.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/analysis/segments/internal/lacks.h"
#include "kinemark/stages/analysis/segments/internal/subject.h"

namespace kinemark::analysis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using internal::Subject;
using internal::SubjectShift;
using internal::TrialMarkers;
using State = data::SampleState;

constexpr std::int64_t kGrain = 16;
constexpr std::uint64_t kNoiseSeed = 1;

/// Where an output goes.
struct Target {
  SegmentSeries* series = nullptr;  ///< null: a point
  std::int64_t point = -1;          ///< index of it
  std::size_t size = 3;             ///< components
};

/// Square roots of the inputs' covariances.
class InputNoise {
 public:
  InputNoise(const SegmentGraph& graph, const std::vector<std::int64_t>& marker_idx,
             const data::Trajectories& markers, const Subject& subject, const MarkerNoise* found,
             double noise_sd_m)
      : markers_(markers), marker_idx_(marker_idx) {
    if (noise_sd_m > 0.0)
      sd_.assign(marker_idx.size(), noise_sd_m);
    else if (found != nullptr)
      for (const auto m : marker_idx) sd_.push_back(found->sample_sd_m(m));
    // Constant errors are shifts of the whole subject.
    for (const auto& name : graph.parameters) {
      const auto& used = subject.parameters.at(name);
      parameter_sd_.push_back(used.constant ? 0.0 : used.sd);
    }
  }
  /// Columns are directions of one deviation; of a parameter the first row.
  [[nodiscard]] Matrix3d root(std::int64_t frame, std::size_t input) const {
    if (input >= marker_idx_.size()) {
      Matrix3d one = Matrix3d::Zero();
      one(0, 0) = parameter_sd_[input - marker_idx_.size()];
      return one;
    }
    if (!sd_.empty()) return sd_[input] * Matrix3d::Identity();
    const Matrix3d covariance =
        math::unpack_symmetric3(&markers_.covariance[6 * markers_.index(frame, marker_idx_[input])]);
    if (!covariance.allFinite()) return Matrix3d::Constant(kNaN);
    const Eigen::LDLT<Matrix3d> ldlt(covariance);
    const Vector3d d = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
    return ldlt.transpositionsP().transpose() * Matrix3d(ldlt.matrixL() * Matrix3d(d.asDiagonal()));
  }

 private:
  const data::Trajectories& markers_;
  const std::vector<std::int64_t>& marker_idx_;
  std::vector<double> sd_, parameter_sd_;
};

/// One pass over the frames.
class Run {
 public:
  Run(const SegmentGraph& graph, const TrialMarkers& trial, const Subject& subject,
      const std::vector<SubjectShift>& shifts, std::vector<Target> targets, const MarkerNoise* noise,
      const SegmentOptions& options)
      : graph_(graph),
        markers_(trial.markers()),
        subject_(subject),
        targets_(std::move(targets)),
        shifts_(shifts),
        deviations_(options.deviations),
        marker_idx_(internal::indices_of(graph, trial)),
        noise_(graph, marker_idx_, markers_, subject, noise, options.noise_sd_m),
        touched_(static_cast<std::size_t>(graph.inputs())) {
    for (std::size_t t = 0; t < targets_.size(); ++t)
      for (const int input : graph.steps[static_cast<std::size_t>(graph.outputs[t])].inputs)
        touched_[static_cast<std::size_t>(input)].push_back(t);
  }

  void frames(std::int64_t begin, std::int64_t end, data::Trajectories& points) const {
    Work work{.values = std::vector<StepValue>(graph_.steps.size()),
              .covariance = std::vector<Matrix3d>(targets_.size()),
              .constant = std::vector<Matrix3d>(targets_.size())};
    for (std::int64_t f = begin; f < end; ++f) frame(f, work, points);
  }

 private:
  struct Work {
    std::vector<StepValue> values, base;
    std::vector<Matrix3d> covariance, constant;  // of all errors; of those that are the same in all frames
    std::vector<Vector3d> plus;
  };

  [[nodiscard]] Vector3d output(const std::vector<StepValue>& values, std::size_t t) const {
    const auto& v = values[static_cast<std::size_t>(graph_.outputs[t])];
    Vector3d out = Vector3d::Zero();
    for (std::size_t k = 0; k < targets_[t].size; ++k) out[static_cast<Eigen::Index>(k)] = v[k];
    return out;
  }
  // Differences of angles do not count full turns.
  [[nodiscard]] Vector3d difference(const Vector3d& a, const Vector3d& b, std::size_t t) const {
    Vector3d out = a - b;
    const auto* series = targets_[t].series;
    if (series != nullptr && series->quantity == SubjectQuantity::angle)
      for (double& d : out) d = std::remainder(d, 2.0 * std::numbers::pi);
    return out;
  }
  [[nodiscard]] State state_of(std::int64_t frame, std::size_t t) const {
    State worst = State::measured;
    for (const int input : graph_.steps[static_cast<std::size_t>(graph_.outputs[t])].inputs) {
      if (static_cast<std::size_t>(input) >= marker_idx_.size()) break;
      const auto m = marker_idx_[static_cast<std::size_t>(input)];
      if (!markers_.present(frame, m)) return State::missing;
      if (markers_.state[markers_.index(frame, m)] != State::measured) worst = State::interpolated;
    }
    return worst;
  }

  void spread(std::int64_t f, std::size_t input, Work& work) const {
    constexpr double h = 1.7320508075688772;
    const Matrix3d root = noise_.root(f, input);
    auto& value = work.values[input];
    for (int column = 0; column < (input < marker_idx_.size() ? 3 : 1); ++column) {
      const Vector3d step = h * root.col(column);
      if (step.isZero(0.0)) continue;
      const auto evaluate = [&](double sign) {
        for (std::size_t k = 0; k < 3; ++k)
          value[k] = work.base[input][k] + sign * step[static_cast<Eigen::Index>(k)];
        graph_.evaluate_followers(static_cast<int>(input), work.values);
      };
      evaluate(1.0);
      work.plus.clear();
      for (const auto t : touched_[input]) work.plus.push_back(output(work.values, t));
      evaluate(-1.0);
      for (std::size_t i = 0; i < touched_[input].size(); ++i) {
        const auto t = touched_[input][i];
        const Vector3d centre = output(work.base, t);
        const Vector3d up = difference(work.plus[i], centre, t);
        const Vector3d down = difference(output(work.values, t), centre, t);
        const Vector3d first = (up - down) / (2.0 * h);
        const Vector3d second = (up + down) * (std::sqrt(h * h - 1.0) / (2.0 * h * h));
        work.covariance[t] += first * first.transpose() + second * second.transpose();
      }
    }
    value = work.base[input];
    for (const int follower : graph_.followers[input])
      work.values[static_cast<std::size_t>(follower)] = work.base[static_cast<std::size_t>(follower)];
  }

  // Outputs with the subject's measures moved by `share` of a shift.
  void evaluate_shift(const Subject& moved, double share, Work& work) const {
    for (std::size_t i = 0; i < graph_.parameters.size(); ++i) {
      const double base = work.base[marker_idx_.size() + i][0];
      const double there = moved.parameters.at(graph_.parameters[i]).value;
      work.values[marker_idx_.size() + i][0] = base + share * (there - base);
    }
    graph_.evaluate(work.values);
  }

  // Constant errors. A shift may be larger than geometry allows: a smaller one, or one side of it, counts
  // then.
  void spread_constant(Work& work) const {
    constexpr double h = 1.7320508075688772;
    for (const auto& shift : shifts_) {
      std::vector<bool> done(targets_.size(), false);
      for (const double share : {1.0, 0.25, 0.0625}) {
        if (std::ranges::find(done, false) == done.end()) break;
        evaluate_shift(shift.plus, share, work);
        work.plus.clear();
        for (std::size_t t = 0; t < targets_.size(); ++t) work.plus.push_back(output(work.values, t));
        evaluate_shift(shift.minus, share, work);
        for (std::size_t t = 0; t < targets_.size(); ++t) {
          if (done[t]) continue;
          const Vector3d centre = output(work.base, t);
          const Vector3d up = difference(work.plus[t], centre, t);
          const Vector3d down = difference(output(work.values, t), centre, t);
          done[t] = !centre.allFinite() || (up.allFinite() && down.allFinite());
          if (!done[t] || !centre.allFinite()) continue;
          const double size = h * share;
          const Vector3d first = (up - down) / (2.0 * size);
          const Vector3d second = (up + down) * (std::sqrt(h * h - 1.0) / (2.0 * size * size));
          work.constant[t] += first * first.transpose() + second * second.transpose();
        }
      }
    }
    work.values = work.base;
    for (std::size_t t = 0; t < targets_.size(); ++t) work.covariance[t] += work.constant[t];
  }

  void frame(std::int64_t f, Work& work, data::Trajectories& points) const {
    internal::set_inputs(graph_, marker_idx_, markers_, f, subject_, work.values);
    graph_.evaluate(work.values);
    work.base = work.values;
    for (auto& covariance : work.covariance) covariance.setZero();
    for (auto& covariance : work.constant) covariance.setZero();
    for (std::size_t input = 0; deviations_ && input < touched_.size(); ++input)
      if (std::isfinite(work.base[input][0])) spread(f, input, work);
    if (deviations_) spread_constant(work);
    for (std::size_t t = 0; t < targets_.size(); ++t) store(f, t, work, points);
  }

  void store(std::int64_t f, std::size_t t, const Work& work, data::Trajectories& points) const {
    const Vector3d value = output(work.base, t);
    State state = state_of(f, t);
    if (targets_[t].series != nullptr) {
      auto& series = *targets_[t].series;
      bool some = false;
      for (std::size_t k = 0; k < series.size(); ++k) {
        const auto i = static_cast<std::size_t>(f) * series.size() + k;
        const auto c = static_cast<Eigen::Index>(k);
        const bool there = state != State::missing && std::isfinite(value[c]);
        series.value[i] = there ? value[c] : kNaN;
        series.sd[i] = there ? std::sqrt(work.covariance[t](c, c)) : kNaN;
        series.constant_sd[i] = there ? std::sqrt(work.constant[t](c, c)) : kNaN;
        some = some || there;
      }
      series.state[static_cast<std::size_t>(f)] = some ? state : State::missing;
      return;
    }
    const auto p = targets_[t].point;
    if (state == State::missing || !value.allFinite()) return;
    points.x(f, p) = value;
    points.state[points.index(f, p)] = state == State::measured ? State::model_filled : State::interpolated;
    math::pack_symmetric3(work.covariance[t], &points.covariance[6 * points.index(f, p)]);
  }

  const SegmentGraph& graph_;
  const data::Trajectories& markers_;
  const Subject& subject_;
  std::vector<Target> targets_;
  const std::vector<SubjectShift>& shifts_;
  bool deviations_;
  std::vector<std::int64_t> marker_idx_;
  InputNoise noise_;
  std::vector<std::vector<std::size_t>> touched_;  // for each input, targets that depend on it
};

SegmentSeries empty_series(std::string name, std::vector<std::string> labels, SubjectQuantity quantity,
                           std::int64_t frames) {
  SegmentSeries out{.name = std::move(name), .labels = std::move(labels), .quantity = quantity};
  const auto n = static_cast<std::size_t>(frames);
  out.value.assign(n * out.size(), kNaN);
  out.sd.assign(n * out.size(), kNaN);
  out.constant_sd.assign(n * out.size(), kNaN);
  out.state.assign(n, State::missing);
  return out;
}

/// What is asked of the graph, and what the results are called.
struct Wanted {
  std::vector<GraphOutput> outputs;
  std::vector<Formula> landmark_names;  ///< formulas that name landmarks
  std::vector<std::string> names;
};

Wanted wanted_of(const SegmentDefinition& d, bool is_static) {
  Wanted out;
  const auto counts = [&](InTrial trial) {
    return trial == InTrial::any || (trial == InTrial::fixed) == is_static;
  };
  const auto add = [&](std::string_view kind, const std::string& name, GraphOutput output) {
    output.what = fmt::format("{} {}", kind, name);
    out.names.push_back(name);
    out.outputs.push_back(std::move(output));
  };
  for (const auto& a : d.angles) add("angle", a.name, {.angle = &a});
  for (const auto& v : d.values) add("value", v.name, {.formula = &v.formula, .type = StepType::number});
  for (const auto& p : d.points)
    if (p.written && counts(p.trial)) add("point", p.name, {.formula = &p.formula});
  out.landmark_names.reserve(d.landmarks.size());
  for (const auto& l : d.landmarks) {
    if (!l.written) continue;
    Formula name{.kind = Formula::Kind::name};
    name.name = l.name;
    out.landmark_names.push_back(std::move(name));
    add("landmark", l.name, {.formula = &out.landmark_names.back()});
  }
  return out;
}

// Where the second angle of a sequence comes near gimbal lock.
void note_gimbal_lock(const SegmentDefinition& d, SegmentMotion& motion) {
  for (const auto& series : motion.angles) {
    const auto a = std::ranges::find(d.angles, series.name, &SegmentDefinition::Angle::name);
    if (a == d.angles.end() || a->helical) continue;
    const auto* const c = std::ranges::find(a->components, 1, &SegmentDefinition::Component::index);
    if (c == a->components.end()) continue;
    std::int64_t near = 0;
    for (std::int64_t f = 0; f < motion.time.frames; ++f) {
      const auto i = static_cast<std::size_t>(f) * 3 + static_cast<std::size_t>(c - a->components.begin());
      const double second = c->sign * (series.value[i] - c->offset_rad);
      near += distance_from_lock(second, a->sequence) < kNearGimbalLock_rad;
    }
    if (near > 0)
      motion.warnings.push_back(fmt::format(
          "{}: {} is within 5 deg of gimbal lock in {} of {} frames: the other two angles say little there.",
          series.name, c->label, near, motion.time.frames));
  }
}

}  // namespace

Status SegmentOptions::check() const {
  if (!(noise_sd_m >= 0.0) || !std::isfinite(noise_sd_m))
    return fail(Code::usage, fmt::format("noise of {:g} m: expected 0 or more", noise_sd_m));
  if (!(std::abs(up.cwiseAbs().maxCoeff() - 1.0) < 1e-12) || !(std::abs(up.norm() - 1.0) < 1e-12))
    return fail(Code::usage, "up must be an axis of the laboratory");
  return {};
}

Result<SegmentMotion> compute_segments(const SegmentDefinition& definition, const SegmentInput& input,
                                       const SegmentOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = definition.check(); !s) return std::unexpected(s.error());
  const auto& markers = *input.markers;
  const bool is_static = input.static_trial == input.markers;
  const auto subject = internal::find_subject(definition, input, options);
  if (!subject) return std::unexpected(subject.error());
  const TrialMarkers trial(markers, input.aliases);
  const Wanted wanted = wanted_of(definition, is_static);
  auto graph = build_graph(definition, subject->names(trial, is_static), wanted.outputs);
  if (!graph) return std::unexpected(graph.error());

  SegmentMotion out{.time = markers.time};
  out.warnings = internal::lack_sentences(definition, wanted.names, *graph, markers.names);
  std::vector<std::string> points;
  std::vector<Target> targets;
  out.angles.reserve(definition.angles.size());
  out.values.reserve(definition.values.size());
  std::vector<int> outputs;
  for (std::size_t i = 0; i < wanted.outputs.size(); ++i) {
    if (graph->outputs[i] < 0) continue;
    outputs.push_back(graph->outputs[i]);
    if (const auto* a = wanted.outputs[i].angle; a != nullptr) {
      out.angles.push_back(
          empty_series(a->name, {a->components[0].label, a->components[1].label, a->components[2].label},
                       SubjectQuantity::angle, markers.frames()));
      targets.push_back({.series = &out.angles.back()});
    } else if (i < definition.angles.size() + definition.values.size()) {
      const auto& v = definition.values[i - definition.angles.size()];
      out.values.push_back(empty_series(v.name, {}, v.quantity, markers.frames()));
      targets.push_back({.series = &out.values.back(), .size = 1});
    } else {
      targets.push_back({.point = std::ssize(points)});
      points.push_back(wanted.names[i]);
    }
  }
  if (targets.empty())
    return fail(Code::bad_input, fmt::format("nothing can be computed: {}",
                                             out.warnings.empty() ? "no output" : out.warnings.front()));
  graph->outputs = std::move(outputs);
  out.points = data::Trajectories::all_missing(std::move(points), markers.time);
  out.points.covariance.assign(6 * out.points.state.size(), kNaN);
  std::vector<SubjectShift> shifts;
  if (options.deviations) {
    auto found = internal::find_shifts(definition, input, options, *subject);
    if (!found) return std::unexpected(found.error());
    shifts = std::move(*found);
  }
  if (options.deviations && options.noise_sd_m == 0.0 && markers.covariance.empty()) {
    const auto used = internal::indices_of(*graph, trial);
    out.noise = input.noise != nullptr
                    ? *input.noise
                    : MarkerNoise::find(markers, {used.begin(), used.end()}, kNoiseSeed, options.threads);
  }
  const Run run(*graph, trial, *subject, shifts, std::move(targets), out.noise ? &*out.noise : nullptr,
                options);
  parallel_for(markers.frames(), kGrain, options.threads,
               [&](std::int64_t begin, std::int64_t end) { run.frames(begin, end, out.points); });
  for (const auto& [name, used] : subject->parameters) out.parameters.push_back(used);
  note_gimbal_lock(definition, out);
  return out;
}

}  // namespace kinemark::analysis
