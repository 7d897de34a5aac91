// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/output_comparison.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/data/name_index.h"
#include "kinemark/workflow/segments/subject_values.h"

namespace kinemark::workflow {
namespace {

using analysis::SegmentDefinition;
using analysis::SegmentInput;
using analysis::SegmentMotion;
using analysis::ShownParameter;
using analysis::SubjectQuantity;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSameAngle_rad = 0.1 * kDegree, kSamePoint_m = 1e-4;
constexpr double kVaries_rad = 0.001, kVaries_m = 1e-4;  // of a parameter within a trial
constexpr double kFinest_rad = 1e-4, kFinest_m = 1e-5;   // difference of a parameter

// "_M" or "V": what a laboratory puts behind the names of outputs.
bool is_output_suffix(std::string_view text) {
  return text.empty() || (text.size() <= 5 && text.front() == '_') ||
         (text.size() == 1 && text.front() >= 'A' && text.front() <= 'Z');
}

/// The file's own outputs under the definition's names.
class FileOutputs {
 public:
  FileOutputs(const SegmentDefinition& d, const SegmentInput& input, const data::Trial& recording)
      : d_(d), input_(input), recording_(recording), markers_(input.markers->names) {
    std::map<std::string, std::int64_t, std::less<>> votes;
    const auto& names = recording.channels.names;
    if (recording.channels.frames != input.markers->frames()) return;
    for (const auto& a : d.angles)
      for (const auto& name : names) {
        const auto there = data::without_prefix(name);
        if (there.starts_with(a.name) && is_output_suffix(there.substr(a.name.size())))
          ++votes[std::string(there.substr(a.name.size()))];
      }
    // Of as many, the shortest: plain names.
    const auto most = std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; });
    if (most == votes.end()) return;
    for (const auto& a : d.angles)
      for (std::size_t c = 0; c < names.size(); ++c)
        if (data::without_prefix(names[c]) == a.name + most->first) angles_.try_emplace(a.name, c);
    for (std::size_t c = 0; c < names.size(); ++c)
      if (recording.channels.kinds[c] == data::ChannelKind::modeled_marker)
        modelled_.try_emplace(std::string(data::without_prefix(names[c])), c);
  }

  [[nodiscard]] std::vector<ComparedOutput> compare(const SegmentMotion& motion) const {
    std::vector<ComparedOutput> out;
    for (const auto& series : motion.angles)
      if (const auto at_channel = angles_.find(series.name); at_channel != angles_.end())
        add(out, {.name = series.name, .theirs = recording_.channels.names[at_channel->second]},
            [&](std::int64_t f) { return angle_difference(series, at_channel->second, f); });
    for (const auto& p : d_.points) {
      const auto ours = motion.points.find(p.name);
      // An entry may stand twice, for static and for moving trials.
      if (!p.written || ours < 0 || std::ranges::find(out, p.name, &ComparedOutput::name) != out.end())
        continue;
      const auto difference = [&](const auto& theirs) {
        return [&, theirs](std::int64_t f) -> std::optional<double> {
          const std::optional<Vector3d> there = theirs(f);
          if (!there || !motion.points.present(f, ours)) return std::nullopt;
          return (Vector3d(motion.points.x(f, ours)) - *there).norm();
        };
      };
      if (const auto m = marker_of(p); m >= 0)
        add(out, {.name = p.name, .theirs = input_.markers->names[at(m)], .angle = false},
            difference([&, m](std::int64_t f) { return marker_at(m, f); }));
      else if (const auto c = modelled_.find(p.name); c != modelled_.end())
        add(out, {.name = p.name, .theirs = recording_.channels.names[c->second], .angle = false},
            difference([&, c](std::int64_t f) { return modelled_at(c->second, f); }));
    }
    return out;
  }
  /// Index of the marker that is this point in the file; -1: none.
  [[nodiscard]] std::int64_t marker_of(const SegmentDefinition::Point& p) const {
    for (const auto& name : p.also) {
      auto m = markers_.find(name);
      if (const auto other = input_.aliases.find(name); m < 0 && other != input_.aliases.end())
        m = markers_.find(other->second);
      if (m >= 0) return m;
    }
    return markers_.find(p.name);
  }

 private:
  template <class Difference>
  void add(std::vector<ComparedOutput>& out, ComparedOutput one, const Difference& difference) const {
    std::vector<double> sizes;
    for (std::int64_t f = 0; f < input_.markers->frames(); ++f)
      if (const std::optional<double> d = difference(f)) sizes.push_back(*d);
    if (sizes.empty()) return;
    std::ranges::sort(sizes);
    const auto quantile = [&](double q) {
      return sizes[static_cast<std::size_t>(std::lround(q * static_cast<double>(sizes.size() - 1)))];
    };
    one.median = quantile(0.5);
    one.p95 = quantile(0.95);
    one.largest = sizes.back();
    one.frames = std::ssize(sizes);
    out.push_back(std::move(one));
  }
  [[nodiscard]] const double* channel_at(std::size_t c, std::int64_t f) const {
    return &recording_.channels.values[(at(f) * recording_.channels.names.size() + c) * 3];
  }
  // Of the components the largest; none where either is missing. A point at zero is missing.
  [[nodiscard]] std::optional<double> angle_difference(const analysis::SegmentSeries& series, std::size_t c,
                                                       std::int64_t f) const {
    const double* theirs = channel_at(c, f);
    if (theirs[0] == 0.0 && theirs[1] == 0.0 && theirs[2] == 0.0) return std::nullopt;
    double largest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double ours = series.value[at(f) * 3 + k];
      if (!std::isfinite(ours) || !std::isfinite(theirs[k])) return std::nullopt;
      largest =
          std::max(largest, std::abs(std::remainder(ours - theirs[k] * kDegree, 2.0 * std::numbers::pi)));
    }
    return largest;
  }
  [[nodiscard]] std::optional<Vector3d> marker_at(std::int64_t m, std::int64_t f) const {
    if (!input_.markers->present(f, m)) return std::nullopt;
    Vector3d x = input_.markers->x(f, m);
    if (x.isZero(0.0)) return std::nullopt;
    return x;
  }
  [[nodiscard]] std::optional<Vector3d> modelled_at(std::size_t c, std::int64_t f) const {
    const double* x = channel_at(c, f);
    Vector3d point =
        metres_per_unit(recording_.channels.units[c]).value_or(1e-3) * Vector3d(x[0], x[1], x[2]);
    if (!point.allFinite() || point.isZero(0.0)) return std::nullopt;
    return point;
  }

  const SegmentDefinition& d_;
  const SegmentInput& input_;
  const data::Trial& recording_;
  data::NameIndex markers_;
  std::map<std::string, std::size_t> angles_, modelled_;
};

/// The largest difference of 95 % of frames.
struct Size {
  double angle_rad = 0.0, point_m = 0.0;
  /// 1 is what counts as the same.
  [[nodiscard]] double score() const { return std::max(angle_rad / kSameAngle_rad, point_m / kSamePoint_m); }
};

Size size_of(const std::vector<ComparedOutput>& outputs) {
  Size out;
  for (const auto& o : outputs)
    if (o.angle)
      out.angle_rad = std::max(out.angle_rad, o.p95);
    else
      out.point_m = std::max(out.point_m, o.p95);
  return out;
}

/// A parameter with another value, or a point as the file has it.
struct Candidate {
  std::optional<ShownParameter> parameter;
  std::string point, theirs;
};

/// Tries what explains a difference.
class Explainer {
 public:
  Explainer(const SegmentDefinition& d, const SegmentInput& input, analysis::SegmentOptions options,
            const FileOutputs& outputs)
      : d_(d), input_(input), options_(std::move(options)), outputs_(outputs) {
    options_.deviations = false;
  }

  Status explain(const SegmentMotion& motion, OutputComparison& out) {
    const double before = size_of(out.outputs).score();
    auto candidates = find_candidates(motion, out);
    if (!candidates) return std::unexpected(candidates.error());
    auto found = size_with(*candidates, input_.static_trial);
    if (!found) return std::unexpected(found.error());
    if (auto s = try_other_kind(std::min(before, found->score()), out); !s || out.static_outputs) return s;
    if (candidates->empty() || found->score() > 0.5 * before) return {};
    // Leave out what is not needed, points first, so that a parameter that explains them is named.
    for (auto i = std::ssize(*candidates) - 1; i >= 0; --i) {
      auto fewer = *candidates;
      fewer.erase(fewer.begin() + i);
      const auto without = size_with(fewer, input_.static_trial);
      if (!without) return std::unexpected(without.error());
      if (without->score() > std::max(1.0, 1.05 * found->score())) continue;
      candidates = std::move(fewer);
      found = without;
    }
    for (const auto& c : *candidates)
      if (c.parameter)
        out.explanation.parameters.push_back(*c.parameter);
      else
        out.explanation.points.push_back(c.point);
    out.explanation.angle_rad = found->angle_rad;
    out.explanation.point_m = found->point_m;
    return {};
  }

 private:
  [[nodiscard]] bool is_static() const { return input_.static_trial == input_.markers; }

  Result<std::vector<Candidate>> find_candidates(const SegmentMotion& motion, OutputComparison& out) {
    const auto shown = analysis::shown_parameters(d_, input_, options_);
    if (!shown) return std::unexpected(shown.error());
    std::vector<Candidate> list;
    for (const auto& p : *shown) {
      const bool length = p.quantity == SubjectQuantity::length;
      if (!is_static() && p.spread > (length ? kVaries_m : kVaries_rad)) out.varying.push_back(p);
      const double finest = std::max(3.0 * p.spread, length ? kFinest_m : kFinest_rad);
      if (std::isfinite(p.used) && std::abs(p.value - p.used) > finest && p.disagreement < finest + kVaries_m)
        list.push_back({.parameter = p});
    }
    // What was measured in the static trial where a file has another value; choices that nobody made.
    for (const auto& used : motion.parameters) {
      const auto p = std::ranges::find(d_.parameters, used.name, &SegmentDefinition::Parameter::name);
      if (p == d_.parameters.end() ||
          std::ranges::any_of(list, [&](const Candidate& c) { return c.parameter->name == used.name; }))
        continue;
      ShownParameter other{
          .name = used.name, .quantity = used.quantity, .used = used.value, .from = used.from};
      if (used.assumed && input_.static_trial != nullptr)
        for (const double choice : p->choices)
          if (choice != used.value) other.value = choice;
      if (used.from == "the static trial")
        for (const auto& known : input_.known)
          if (known.name == p->name || std::ranges::find(p->also, known.name) != p->also.end()) {
            other.value = known.value;
            break;
          }
      if (std::abs(other.value - other.used) > kFinest_rad) list.push_back({.parameter = other});
    }
    for (const auto& p : d_.points) {
      const auto difference = std::ranges::find(out.outputs, p.name, &ComparedOutput::name);
      if (!p.regression || difference == out.outputs.end() || difference->median <= kSamePoint_m) continue;
      if (outputs_.marker_of(p) >= 0) list.push_back({.point = p.name, .theirs = difference->theirs});
    }
    return list;
  }

  // Does it agree as a trial of the other kind?
  Status try_other_kind(double best, OutputComparison& out) {
    if (is_static() || best <= 1.0) return {};
    const auto as_static = size_with({}, input_.markers);
    if (!as_static) return {};  // It cannot be one.
    out.static_outputs = as_static->score() < 0.2 * best;
    return {};
  }

  Result<Size> size_with(const std::vector<Candidate>& candidates, const data::Trajectories* static_trial) {
    SegmentInput with = input_;
    with.static_trial = static_trial;
    SegmentDefinition definition = d_;
    for (const auto& c : candidates) {
      if (c.parameter)
        with.given.insert(with.given.begin(), {c.parameter->name, c.parameter->value, "the file's outputs"});
      for (auto& p : definition.points) {
        if (c.point.empty() || p.name != c.point) continue;
        p.formula = {.kind = analysis::Formula::Kind::name};
        p.formula.name = c.theirs;
      }
    }
    const auto motion = analysis::compute_segments(definition, with, options_);
    if (!motion) return std::unexpected(motion.error());
    return size_of(outputs_.compare(*motion));
  }

  const SegmentDefinition& d_;
  const SegmentInput& input_;
  analysis::SegmentOptions options_;
  const FileOutputs& outputs_;
};

const ComparedOutput* worst_of(const std::vector<ComparedOutput>& outputs, bool angle) {
  const ComparedOutput* out = nullptr;
  for (const auto& o : outputs)
    if (o.angle == angle && (out == nullptr || o.largest > out->largest)) out = &o;
  return out;
}

std::string in_unit(const ComparedOutput& o, double value) {
  return o.angle ? fmt::format("{:.2g} deg", value / kDegree) : fmt::format("{:.2g} mm", value * 1e3);
}

std::string shown_value(SubjectQuantity quantity, double value) {
  return fmt::format("{:.4g} {}", value / per_shown(quantity), shown_unit(quantity));
}

}  // namespace

bool OutputComparison::agrees() const {
  return std::ranges::all_of(
      outputs, [](const auto& o) { return o.largest <= (o.angle ? kSameAngle_rad : kSamePoint_m); });
}

std::string OutputComparison::summary() const {
  std::vector<std::string> parts;
  const bool same = agrees();
  for (const bool angle : {true, false}) {
    const auto* worst = worst_of(outputs, angle);
    if (worst == nullptr) continue;
    const auto count = std::ranges::count(outputs, angle, &ComparedOutput::angle);
    const auto* what = angle ? "angle" : "centre";
    if (same)
      parts.push_back(
          fmt::format("{} {}{} to {}", count, what, count == 1 ? "" : "s", in_unit(*worst, worst->largest)));
    else
      parts.push_back(fmt::format("{}s by up to {} ({}; median {}, 95 % of frames below {})", what,
                                  in_unit(*worst, worst->largest), worst->name,
                                  in_unit(*worst, worst->median), in_unit(*worst, worst->p95)));
  }
  return fmt::format("{} the file's own {}", same ? "agrees with" : "differs from",
                     fmt::join(parts, " and "));
}

std::vector<std::string> OutputComparison::findings() const {
  std::vector<std::string> out;
  if (empty() || agrees()) return out;
  if (static_outputs) {
    out.emplace_back(
        "The file's own angles are those of a static trial, and it was computed as a moving one: name it "
        "with --static too.");
    return out;
  }
  std::vector<std::string> causes;
  for (const auto& p : explanation.parameters)
    causes.push_back(fmt::format("{} (the file's outputs were made with {}, here {} from {})", p.name,
                                 shown_value(p.quantity, p.value), shown_value(p.quantity, p.used), p.from));
  for (const auto& point : explanation.points) {
    const auto o = std::ranges::find(outputs, point, &ComparedOutput::name);
    causes.push_back(fmt::format("{} by another regression ({} away)", point, in_unit(*o, o->median)));
  }
  if (!causes.empty())
    out.push_back(
        fmt::format("The difference from the file's own outputs is explained by {}; with {}, angles agree to "
                    "{:.2g} deg and "
                    "centres to {:.2g} mm in 95 % of frames.",
                    fmt::join(causes, "; "), causes.size() == 1 ? "it" : "them",
                    explanation.angle_rad / kDegree, explanation.point_m * 1e3));
  if (!varying.empty()) {
    const auto times = [](const ShownParameter& p) {
      return p.spread / (p.quantity == SubjectQuantity::length ? kVaries_m : kVaries_rad);
    };
    auto most = varying;
    std::ranges::stable_sort(most, std::greater(), times);
    if (most.size() > 3) most.resize(3);
    std::vector<std::string> list;
    for (const auto& p : most)
      list.push_back(fmt::format("{} by +-{}", p.name, shown_value(p.quantity, p.spread)));
    const auto more = varying.size() - most.size();
    out.push_back(fmt::format(
        "Markers were changed after the file's model ran on them: by its outputs, what is constant in "
        "the model varies within the trial: {}{}.",
        fmt::join(list, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
  }
  if (out.empty())
    out.emplace_back(
        "No parameter of the model that can be read from the file's own outputs explains the difference.");
  return out;
}

Result<OutputComparison> compare_outputs(const SegmentDefinition& definition, const SegmentInput& input,
                                         const analysis::SegmentOptions& options, const SegmentMotion& motion,
                                         const data::Trial& recording) {
  OutputComparison out;
  const FileOutputs outputs(definition, input, recording);
  out.outputs = outputs.compare(motion);
  if (out.empty() || out.agrees()) return out;
  if (auto s = Explainer(definition, input, options, outputs).explain(motion, out); !s)
    return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::workflow
