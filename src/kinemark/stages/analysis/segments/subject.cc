// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "kinemark/stages/analysis/segments/internal/subject.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Vector3d;

/// A formula's mean over the frames that give it, and the standard deviation of that mean.
struct TrialMean {
  Vector3d mean = Vector3d::Constant(kNaN), sd = Vector3d::Constant(kNaN);
  Vector3d first = Vector3d::Constant(kNaN), last = Vector3d::Constant(kNaN);
  std::int64_t frames = 0;
};

// None where the trial lacks what the formula needs.
Result<TrialMean> mean_over(const SegmentDefinition& definition, const GraphOutput& output,
                            const GraphNames& names, const Subject& subject, const TrialMarkers& trial) {
  TrialMean out;
  const auto graph = build_graph(definition, names, std::span(&output, 1));
  if (!graph) return std::unexpected(graph.error());
  if (graph->outputs.front() < 0) return out;
  const auto marker_idx = indices_of(*graph, trial);
  std::vector<StepValue> values(graph->steps.size());
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  for (std::int64_t f = 0; f < trial.markers().frames(); ++f) {
    set_inputs(*graph, marker_idx, trial.markers(), f, subject, values);
    graph->evaluate(values);
    const auto& value = values[static_cast<std::size_t>(graph->outputs.front())];
    const Vector3d v = output.type == StepType::number ? Vector3d(value[0], 0.0, 0.0)
                                                       : Vector3d(value[0], value[1], value[2]);
    if (!v.allFinite()) continue;
    if (out.frames == 0) out.first = v;
    out.last = v;
    // About the first value, so that large coordinates lose no digits.
    sum += v - out.first;
    squares += (v - out.first).cwiseAbs2();
    ++out.frames;
  }
  if (out.frames == 0) return out;
  const auto n = static_cast<double>(out.frames);
  out.mean = out.first + sum / n;
  out.sd.setZero();
  if (out.frames > 1) out.sd = ((squares - sum.cwiseAbs2() / n).cwiseMax(0.0) / (n - 1.0) / n).cwiseSqrt();
  return out;
}

const SubjectValue* find_value(const std::vector<SubjectValue>& list,
                               const SegmentDefinition::Parameter& parameter) {
  const auto at = std::ranges::find_if(list, [&](const SubjectValue& v) {
    if (v.name != parameter.name && std::ranges::find(parameter.also, v.name) == parameter.also.end())
      return false;
    return std::isfinite(v.value) && !(parameter.zero_is_unknown && v.value == 0.0);
  });
  return at == list.end() ? nullptr : &*at;
}

/// Finds each parameter and landmark when it is first needed, so that they may stand in any order.
class Finder {
 public:
  Finder(const SegmentDefinition& definition, const SegmentInput& input, const SegmentOptions& options)
      : d_(definition), input_(input), recording_(*input.markers) {
    if (input.static_trial != nullptr) static_.emplace(*input.static_trial);
    subject_.up = options.up;
  }

  Result<Subject> find() {
    for (const auto& p : d_.parameters) find_parameter(p.name);
    for (const auto& l : d_.landmarks) find_parameter(l.name + "@x");
    if (status_ && d_.progression) progression();
    if (!status_) return std::unexpected(status_.error());
    return std::move(subject_);
  }

 private:
  [[nodiscard]] bool recording_is_static() const { return input_.static_trial == input_.markers; }

  // The mean of a formula over a trial; without frames where it lacks something or makes no sense.
  TrialMean mean(const Formula& formula, StepType type, const TrialMarkers& trial, bool is_static) {
    GraphNames names = subject_.names(trial, is_static);
    names.has_parameter = [this](const std::string& name) {
      find_parameter(name);
      return subject_.parameters.contains(name);
    };
    names.levels = &levels_;
    auto out = mean_over(d_, {.formula = &formula, .type = type, .what = what_}, names, subject_, trial);
    if (out) return *out;
    if (status_) status_ = std::unexpected(out.error());
    return {};
  }
  TrialMean number(const Formula& formula) {
    return mean(formula, StepType::number, recording_, recording_is_static());
  }

  void find_parameter(const std::string& name) {
    constexpr int kMostParameters = 50;
    if (!status_ || subject_.parameters.contains(name) || !begun_.insert(name).second) return;
    if (++depth_ > kMostParameters) {
      status_ = fail(Code::bad_input,
                     fmt::format("'{}' is the {}th parameter in a row that needs another", name, depth_));
      return;
    }
    const std::string before = what_;
    for (const auto& p : d_.parameters) {
      if (p.name != name) continue;
      what_ = fmt::format("parameter {}", name);
      parameter(p);
    }
    for (const auto& l : d_.landmarks) {
      if (!name.starts_with(l.name + "@")) continue;
      what_ = fmt::format("landmark {}", l.name);
      landmark(l);
    }
    what_ = before;
    --depth_;
  }

  void take(const SegmentDefinition::Parameter& p, double value, double sd, std::string from) {
    subject_.parameters[p.name] = {p.name, p.quantity, value, sd, std::move(from)};
  }

  void parameter(const SegmentDefinition::Parameter& p) {
    double sd = 0.0;
    if (p.formula_sd)
      if (const auto found = number(*p.formula_sd); found.frames > 0) sd = std::abs(found.mean.x());
    if (const auto* given = find_value(input_.given, p)) return take(p, given->value, sd, given->from);
    if (p.measured && static_ && !p.measured_here)
      if (const auto found = mean(*p.measured, StepType::number, *static_, true); found.frames > 0)
        return take(p, found.mean.x(), found.sd.x(), "the static trial");
    if (const auto* known = find_value(input_.known, p)) return take(p, known->value, sd, known->from);
    if (p.formula)
      if (const auto found = number(*p.formula); found.frames > 0)
        return take(p, found.mean.x(), sd, "its formula");
    if (p.measured && p.measured_anywhere)
      if (const auto found = number(*p.measured); found.frames > 0)
        take(p, found.mean.x(), found.sd.x(), "the recording");
  }

  void landmark(const SegmentDefinition::Landmark& l) {
    std::optional<TrialMarkers> other;
    const TrialMarkers* trial = nullptr;
    if (l.trial == "static") {
      if (static_) trial = &*static_;
    } else if (const auto at = input_.trials.find(l.trial); at != input_.trials.end()) {
      trial = &other.emplace(*at->second);
    }
    if (trial == nullptr) return;
    // in(segment, formula), as a formula would say it.
    Formula in{.kind = Formula::Kind::call};
    in.name = "in";
    Formula segment{.kind = Formula::Kind::name};
    segment.name = l.segment;
    in.arguments.push_back(std::move(segment));
    in.arguments.push_back(l.formula);
    const auto found = mean(in, StepType::vector, *trial, l.trial == "static");
    if (found.frames == 0) return;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::string name = l.name + "@" + "xyz"[k];
      subject_.parameters[name] = {name, SubjectQuantity::length, found.mean[k], found.sd[k],
                                   "the trial '" + l.trial + "'"};
    }
  }

  // Forward is the axis of the laboratory nearest to the way from the first to the last frame.
  void progression() {
    constexpr double kFarEnough_m = 0.5;
    what_ = "progression";
    const Vector3d up = subject_.up;
    const auto along_floor = [&](const Vector3d& v) -> Vector3d { return v - v.dot(up) * up; };
    const auto way = mean(d_.progression->first, StepType::vector, recording_, recording_is_static());
    Vector3d forward = along_floor(way.last - way.first);
    if (!(forward.norm() > kFarEnough_m))
      forward =
          along_floor(mean(d_.progression->second, StepType::vector, recording_, recording_is_static()).mean);
    if (!forward.allFinite()) return;
    Eigen::Index axis = 0;
    forward.cwiseAbs().maxCoeff(&axis);
    const Vector3d x = Vector3d::Unit(axis) * (forward[axis] < 0.0 ? -1.0 : 1.0);
    Eigen::Matrix3d axes;
    axes << x, up.cross(x), up;
    subject_.progression = axes;
  }

  const SegmentDefinition& d_;
  const SegmentInput& input_;
  TrialMarkers recording_;
  std::optional<TrialMarkers> static_;
  Subject subject_;
  Status status_;
  std::set<std::string> begun_;
  std::string what_;  // begins a failure
  int depth_ = 0, levels_ = 0;
};

}  // namespace

TrialMarkers::TrialMarkers(const data::Trajectories& markers)
    : markers_(markers), index_(markers.names), seen_(markers.names.size()) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m)) seen_[static_cast<std::size_t>(m)] = true;
}

bool TrialMarkers::has(const std::string& name) const {
  const auto m = index_.find(name);
  return m >= 0 && seen_[static_cast<std::size_t>(m)];
}

GraphNames Subject::names(const TrialMarkers& trial, bool is_static) const {
  return {.has_marker = [&trial](const std::string& name) { return trial.has(name); },
          .has_parameter = [this](const std::string& name) { return parameters.contains(name); },
          .progression = progression,
          .up = up,
          .static_trial = is_static};
}

Result<Subject> find_subject(const SegmentDefinition& definition, const SegmentInput& input,
                             const SegmentOptions& options) {
  return Finder(definition, input, options).find();
}

std::vector<std::int64_t> indices_of(const SegmentGraph& graph, const TrialMarkers& trial) {
  std::vector<std::int64_t> out;
  for (const auto& name : graph.markers) out.push_back(trial.find(name));
  return out;
}

void set_inputs(const SegmentGraph& graph, const std::vector<std::int64_t>& marker_idx,
                const data::Trajectories& markers, std::int64_t frame, const Subject& subject,
                std::vector<StepValue>& values) {
  for (std::size_t i = 0; i < marker_idx.size(); ++i)
    Eigen::Map<Vector3d>(values[i].data()) = markers.x(frame, marker_idx[i]);
  for (std::size_t i = 0; i < graph.parameters.size(); ++i)
    values[marker_idx.size() + i][0] = subject.parameters.at(graph.parameters[i]).value;
}

}  // namespace kinemark::analysis::internal
