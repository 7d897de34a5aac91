// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/internal/trial_values.h"

#include <cmath>
#include <span>

namespace kinemark::analysis::internal {

using Eigen::Vector3d;

Result<std::vector<Vector3d>> values_over(const SegmentDefinition& definition, const GraphOutput& output,
                                          const GraphNames& names, const Subject& subject,
                                          const TrialMarkers& trial) {
  std::vector<Vector3d> out;
  const auto graph = build_graph(definition, names, std::span(&output, 1));
  if (!graph) return std::unexpected(graph.error());
  if (graph->outputs.front() < 0) return out;
  const auto marker_idx = indices_of(*graph, trial);
  std::vector<StepValue> values(graph->steps.size());
  for (std::int64_t f = 0; f < trial.markers().frames(); ++f) {
    set_inputs(*graph, marker_idx, trial.markers(), f, subject, values);
    graph->evaluate(values);
    const auto& value = values[static_cast<std::size_t>(graph->outputs.front())];
    const Vector3d v = output.type == StepType::number ? Vector3d(value[0], 0.0, 0.0)
                                                       : Vector3d(value[0], value[1], value[2]);
    if (v.allFinite()) out.push_back(v);
  }
  return out;
}

TrialMean trial_mean(const std::vector<Vector3d>& values) {
  TrialMean out{.frames = std::ssize(values)};
  if (values.empty()) return out;
  out.first = values.front();
  out.last = values.back();
  Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
  // About the first value, so that large coordinates lose no digits.
  for (const auto& v : values) {
    sum += v - out.first;
    squares += (v - out.first).cwiseAbs2();
  }
  const auto n = static_cast<double>(out.frames);
  out.mean = out.first + sum / n;
  out.sd.setZero();
  if (out.frames > 1) out.sd = ((squares - sum.cwiseAbs2() / n).cwiseMax(0.0) / (n - 1.0) / n).cwiseSqrt();
  return out;
}

TrialMarkers::TrialMarkers(const data::Trajectories& markers,
                           const std::map<std::string, std::string>& aliases)
    : markers_(markers), aliases_(aliases), index_(markers.names), seen_(markers.names.size()) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m)) seen_[static_cast<std::size_t>(m)] = true;
}

std::int64_t TrialMarkers::find(const std::string& name) const {
  const auto m = index_.find(name);
  if (m >= 0) return m;
  const auto other = aliases_.find(name);
  return other == aliases_.end() ? -1 : index_.find(other->second);
}

bool TrialMarkers::has(const std::string& name) const {
  const auto m = find(name);
  return m >= 0 && seen_[static_cast<std::size_t>(m)];
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
