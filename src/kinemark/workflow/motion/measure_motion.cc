// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/name_pattern.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/stages/analysis/body/body_measures.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/motion/internal/body_input.h"
#include "kinemark/workflow/motion/internal/held_motion.h"
#include "kinemark/workflow/motion/internal/rated_motion.h"

namespace kinemark::workflow {
namespace {

Status unknown_coordinate(const std::string& name, const std::vector<std::string>& names) {
  const auto nearest = nearest_names(name, names);
  return fail(Code::usage, fmt::format("the model has no coordinate '{}' that moves by itself{}", name,
                                       nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
}

/// Coordinates that a name or a pattern stands for, among those that are measured.
Result<std::vector<Eigen::Index>> coordinates_of(const std::string& text,
                                                 const analysis::BodyRecord& record) {
  std::vector<Eigen::Index> out;
  std::vector<std::string> names;
  for (Eigen::Index c = 0; c < record.size(); ++c) {
    if (!record.measured[at(c)]) continue;
    names.push_back(record.names[at(c)]);
    if (matches_name_pattern(text, names.back())) out.push_back(c);
  }
  if (!out.empty()) return out;
  return std::unexpected(unknown_coordinate(text, names).error());
}

Status choose(const MotionMeasureOptions& asked, const analysis::BodyRecord& record,
              analysis::BodyMeasureOptions& options) {
  for (const auto& text : asked.select) {
    const auto some = coordinates_of(text, record);
    if (!some) return std::unexpected(some.error());
    options.coordinates.insert(options.coordinates.end(), some->begin(), some->end());
  }
  for (const auto& text : asked.couple) {
    const auto comma = text.find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == text.size())
      return fail(Code::usage, fmt::format("'{}' is not two coordinates: hip_flexion_r,knee_angle_r", text));
    const auto a = coordinates_of(text.substr(0, comma), record);
    if (!a) return std::unexpected(a.error());
    const auto b = coordinates_of(text.substr(comma + 1), record);
    if (!b) return std::unexpected(b.error());
    if (a->size() != 1 || b->size() != 1 || a->front() == b->front())
      return fail(Code::usage, fmt::format("'{}' is not two coordinates, one and another", text));
    options.pairs.emplace_back(a->front(), b->front());
  }
  return {};
}

/// No refits where the errors are not known, and what intervals do not hold.
void settle_intervals(const MotionMeasureOptions& asked, const GivenMotion& given,
                      const data::JointMotion& motion, analysis::BodyMeasureOptions& options,
                      std::vector<std::string>& warnings) {
  if (asked.cutoff_hz > 0.0 && asked.refits > 0) {
    options.refits = 0;
    warnings.push_back(
        fmt::format("coordinates were low-passed at {:g} Hz: what that leaves of their noise "
                    "is not known, and there are no intervals",
                    asked.cutoff_hz));
  }
  if (options.refits > 0 && std::ranges::none_of(motion.q_sd, [](double sd) { return std::isfinite(sd); }))
    warnings.push_back(
        fmt::format("{}: intervals hold the errors that its samples show, not those of skin and markers",
                    given.names.no_deviations));
}

}  // namespace

Result<MotionMeasured> measure_motion(const model::Model& model, const GivenMotion& given,
                                      const MotionMeasureOptions& asked) {
  auto rated = internal::rate_motion(model, given, asked.cutoff_hz);
  if (!rated) return std::unexpected(rated.error());
  auto input = internal::body_input(model, given, *rated, asked.torques, asked.threads);
  if (!input) return std::unexpected(input.error());
  MotionMeasured found;
  found.remarks.warnings = std::move(input->notes);
  internal::hold_motion(model, given, !asked.torques && !given.forces, found.remarks);
  analysis::BodyMeasureOptions options{.measures = asked.measures,
                                       .stretches = asked.stretches,
                                       .normalized = asked.normalized,
                                       .refits = asked.refits,
                                       .level = asked.level,
                                       .seed = asked.seed,
                                       .threads = asked.threads};
  settle_intervals(asked, given, rated->motion, options, found.remarks.warnings);
  if (auto s = choose(asked, input->record, options); !s) return std::unexpected(s.error());
  auto measured = analysis::measure_body(input->record, input->mechanics, options);
  if (!measured)
    return measured.error().code == Code::usage ? std::unexpected(measured.error())
                                                : fail_at(given.names.motion, measured.error());
  if (measured->measures.empty())
    return fail(Code::bad_input, fmt::format("{}: nothing of what is asked for can be measured; torques need "
                                             "--forces or --torques, coupling needs --couple",
                                             given.names.motion));
  found.measures = std::move(measured->measures);
  found.left_out = std::move(measured->notes);
  found.motion = std::move(rated->motion);
  found.record = std::move(input->record);
  return found;
}

}  // namespace kinemark::workflow
