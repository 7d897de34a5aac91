// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "kinemark/stages/analysis/segments/internal/subject.h"
#include "kinemark/stages/analysis/segments/internal/trial_values.h"

namespace kinemark::analysis::internal {
namespace {

using Eigen::Vector3d;

constexpr std::string_view kFromOutputs = "the file's own model outputs";

bool is_called(const SegmentDefinition::Parameter& parameter, const std::string& name) {
  return name == parameter.name || std::ranges::find(parameter.also, name) != parameter.also.end();
}

const SubjectValue* find_value(const std::vector<SubjectValue>& list,
                               const SegmentDefinition::Parameter& parameter) {
  const auto at = std::ranges::find_if(list, [&](const SubjectValue& v) {
    return is_called(parameter, v.name) && std::isfinite(v.value) &&
           !(parameter.zero_is_unknown && v.value == 0.0);
  });
  return at == list.end() ? nullptr : &*at;
}

/// Finds each parameter and landmark when it is first needed, so that they may stand in any order.
class Finder {
 public:
  Finder(const SegmentDefinition& definition, const SegmentInput& input, const SegmentOptions& options)
      : d_(definition), input_(input), recording_(*input.markers, input.aliases) {
    if (input.static_trial != nullptr) static_.emplace(*input.static_trial, input.aliases);
    subject_.up = options.up;
  }

  Result<Subject> find() {
    for (const auto& p : d_.parameters) find_parameter(p.name);
    for (const auto& l : d_.landmarks) find_parameter(l.name + "@x");
    if (status_ && d_.progression) progression();
    if (!status_) return std::unexpected(status_.error());
    return std::move(subject_);
  }

  // After find(): `subject` is what it gave.
  Result<std::vector<ShownParameter>> shown(Subject subject) {
    subject_ = std::move(subject);
    std::vector<ShownParameter> out;
    for (const auto& p : d_.parameters) {
      const auto used = subject_.parameters.find(p.name);
      what_ = fmt::format("parameter {}", p.name);
      auto one = shown_by(p, recording_, recording_is_static());
      if (!one) continue;
      if (used != subject_.parameters.end()) {
        one->used = used->second.value;
        one->from = used->second.from;
        if (agree(*one)) used->second.value = one->value;
      }
      out.push_back(std::move(*one));
    }
    if (!status_) return std::unexpected(status_.error());
    return out;
  }

 private:
  [[nodiscard]] bool recording_is_static() const { return input_.static_trial == input_.markers; }

  // Values of a formula over a trial; none where it lacks something or makes no sense.
  std::vector<Vector3d> values(const Formula& formula, StepType type, const TrialMarkers& trial,
                               bool is_static) {
    GraphNames names = subject_.names(trial, is_static);
    names.has_parameter = [this](const std::string& name) {
      find_parameter(name);
      return subject_.parameters.contains(name);
    };
    names.levels = &levels_;
    auto out = values_over(d_, {.formula = &formula, .type = type, .what = what_}, names, subject_, trial);
    if (out) return *out;
    if (status_) status_ = std::unexpected(out.error());
    return {};
  }
  TrialMean mean(const Formula& formula, StepType type, const TrialMarkers& trial, bool is_static) {
    return trial_mean(values(formula, type, trial, is_static));
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

  using Parameter = SegmentDefinition::Parameter;

  void take(const Parameter& p, double value, double sd, std::string from, bool constant = false,
            bool assumed = false) {
    subject_.parameters[p.name] = {p.name,  p.quantity,          value, sd, std::move(from),
                                   assumed, constant && sd > 0.0};
  }
  double deviation(const std::optional<Formula>& formula) {
    if (!formula) return 0.0;
    const auto found = number(*formula);
    return found.frames > 0 ? std::abs(found.mean.x()) : 0.0;
  }

  void parameter(const Parameter& p) {
    if (const auto* given = find_value(input_.given, p))
      return take(p, given->value, given->sd.value_or(deviation(p.formula_sd)), given->from, true);
    const auto* known = find_value(input_.known, p);
    if (known != nullptr && p.entered_first) return take_known(p, *known);
    if (p.measured && static_ && !p.measured_here)
      if (const auto found = mean(*p.measured, StepType::number, *static_, true); found.frames > 0)
        return take(p, found.mean.x(), found.sd.x(), "the static trial");
    if (known != nullptr) return take_known(p, *known);
    if (const auto shown = shown_by_any(p))
      return take(p, shown->value, deviation(p.assumed_sd), std::string(kFromOutputs), true, true);
    if (!p.choices.empty() && choose(p)) return;
    if (p.formula)
      if (const auto found = number(*p.formula); found.frames > 0) {
        const bool assumed = p.assumed_sd.has_value() || !p.choices.empty();
        return take(p, found.mean.x(), deviation(assumed ? p.assumed_sd : p.formula_sd),
                    assumed ? "assumed" : "its formula", true, assumed);
      }
    if (p.measured && p.measured_anywhere)
      if (const auto found = number(*p.measured); found.frames > 0)
        take(p, found.mean.x(), found.sd.x(), "the recording");
  }
  void take_known(const Parameter& p, const SubjectValue& known) {
    if (known.value != 0.0 || !p.zero_sd)
      return take(p, known.value, known.sd.value_or(deviation(p.formula_sd)), known.from, true);
    const double sd = deviation(input_.zeros_doubtful && p.assumed_sd ? p.assumed_sd : p.zero_sd);
    take(p, 0.0, known.sd.value_or(sd), known.from + ", where 0 may stand for 'not measured'", true, true);
  }

  // The value that the outputs in a trial were made with: the median over its formulas of medians over
  // frames.
  std::optional<ShownParameter> shown_by(const Parameter& p, const TrialMarkers& trial, bool is_static) {
    if (is_static && !p.shown_anywhere) return std::nullopt;
    ShownParameter out{.name = p.name, .quantity = p.quantity};
    std::vector<double> medians;
    for (const auto& formula : p.shown) {
      std::vector<double> x;
      for (const auto& v : values(formula, StepType::number, trial, is_static)) x.push_back(v.x());
      if (x.empty()) continue;
      std::ranges::sort(x);
      const auto quantile = [&](double q) {
        return x[static_cast<std::size_t>(std::lround(q * static_cast<double>(x.size() - 1)))];
      };
      medians.push_back(quantile(0.5));
      out.spread = std::max(out.spread, 0.5 * (quantile(0.95) - quantile(0.05)));
    }
    if (medians.empty()) return std::nullopt;
    std::ranges::sort(medians);
    const auto n = medians.size();
    out.value = 0.5 * (medians[(n - 1) / 2] + medians[n / 2]);
    out.disagreement = 0.5 * (medians.back() - medians.front());
    out.formulas = std::ssize(medians);
    return out;
  }
  // Outputs count where they tell one value: others are of another model, or the markers have changed since.
  std::optional<ShownParameter> shown_by_any(const Parameter& p) {
    if (p.shown.empty()) return std::nullopt;
    if (auto here = shown_by(p, recording_, recording_is_static()); here && agree(*here)) return here;
    if (static_ && p.shown_anywhere && !recording_is_static())
      if (auto there = shown_by(p, *static_, true); there && agree(*there)) return there;
    return std::nullopt;
  }
  static bool agree(const ShownParameter& shown) {
    constexpr double kOneAngle_rad = 0.02, kOneLength_m = 0.0005, kSpread_m = 0.002;
    if (shown.quantity == SubjectQuantity::length)
      return shown.spread < kSpread_m && shown.disagreement < kOneLength_m;
    return shown.spread < kOneAngle_rad && shown.disagreement < kOneAngle_rad;
  }

  // The choice with which `chosen_by` come out of the static trial as files hold them; none, or all: not
  // told.
  bool choose(const Parameter& p) {
    constexpr double kSame_rad = 0.002;
    if (!static_) return false;
    std::vector<std::pair<double, std::string>> fitting;
    for (const double choice : p.choices) {
      take(p, choice, 0.0, "a trial");
      double worst = 0.0;
      std::string file;
      for (const auto& name : p.chosen_by) {
        const auto by = std::ranges::find(d_.parameters, name, &Parameter::name);
        if (by == d_.parameters.end() || !by->measured) continue;
        const auto found = mean(*by->measured, StepType::number, *static_, true);
        double nearest = kNaN;
        for (const auto& known : input_.known)
          if (found.frames > 0 && is_called(*by, known.name)) {
            const double off = std::abs(known.value - found.mean.x());
            if (!(off >= nearest)) nearest = off;
            if (off == nearest) file = known.from;
          }
        if (std::isfinite(nearest)) worst = std::max(worst, nearest);
      }
      if (!file.empty() && worst < kSame_rad) fitting.emplace_back(choice, file);
    }
    subject_.parameters.erase(p.name);
    if (fitting.size() != 1) return false;
    take(p, fitting.front().first, 0.0, "offsets in " + fitting.front().second);
    return true;
  }

  void landmark(const SegmentDefinition::Landmark& l) {
    std::optional<TrialMarkers> other;
    const TrialMarkers* trial = nullptr;
    if (l.trial == "static") {
      if (static_) trial = &*static_;
    } else if (const auto at = input_.trials.find(l.trial); at != input_.trials.end()) {
      trial = &other.emplace(*at->second, input_.aliases);
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

Result<std::vector<SubjectShift>> find_shifts(const SegmentDefinition& definition, const SegmentInput& input,
                                              const SegmentOptions& options, const Subject& subject) {
  constexpr double h = 1.7320508075688772;
  std::vector<SubjectShift> out;
  for (const auto& [name, used] : subject.parameters) {
    if (!used.constant) continue;
    SubjectShift shift;
    for (auto* moved : {&shift.plus, &shift.minus}) {
      SegmentInput with = input;
      const double step = moved == &shift.plus ? h * used.sd : -h * used.sd;
      with.given.insert(with.given.begin(), {name, used.value + step, used.from});
      // Outputs of a model tell what they told.
      for (const auto& [other, value] : subject.parameters)
        if (value.from == kFromOutputs) with.given.push_back({other, value.value, value.from});
      auto found = find_subject(definition, with, options);
      if (!found) return std::unexpected(found.error());
      *moved = std::move(*found);
      // What cannot be measured then stays as it was.
      for (const auto& [other, value] : subject.parameters) moved->parameters.try_emplace(other, value);
    }
    out.push_back(std::move(shift));
  }
  return out;
}

}  // namespace kinemark::analysis::internal

namespace kinemark::analysis {

Result<std::vector<ShownParameter>> shown_parameters(const SegmentDefinition& definition,
                                                     const SegmentInput& input,
                                                     const SegmentOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = definition.check(); !s) return std::unexpected(s.error());
  internal::Finder finder(definition, input, options);
  auto subject = finder.find();
  if (!subject) return std::unexpected(subject.error());
  return finder.shown(std::move(*subject));
}

}  // namespace kinemark::analysis
