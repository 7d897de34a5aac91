// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/sample_findings.h"

#include <iterator>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::motion::internal {
namespace {

data::Finding finding_of(const Problem& problem, const Outlier& outlier) {
  const auto name = [&](int marker) { return problem.fit.markers[at(marker)].name; };
  data::Finding finding{.kind = data::FindingKind::outlier,
                        .subject = name(outlier.marker),
                        .first_frame = outlier.first_frame,
                        .last_frame = outlier.last_frame,
                        .size = outlier.length_m};
  if (outlier.why == Outlier::Why::held) finding.detail = "it holds one value digit by digit";
  if (outlier.why == Outlier::Why::zero) finding.detail = "a coordinate is exactly 0";
  if (outlier.partner >= 0) finding.detail = "it lies where '" + name(outlier.partner) + "' should";
  return finding;
}

data::Finding finding_of(const Problem& problem, const Exchange& exchange,
                         const data::Trajectories& markers) {
  const auto sample = [&](std::int64_t f, int m) {
    return markers.x(problem.first_frame + f, problem.data_marker[at(m)]);
  };
  std::vector<double> apart;
  for (const auto f : exchange.frames)
    apart.push_back((sample(f, exchange.one) - sample(f, exchange.other)).norm());
  const bool whole = exchange.frames.back() - exchange.frames.front() + 1 == std::ssize(exchange.frames);
  return {.kind = data::FindingKind::label_swap,
          .subject = problem.fit.markers[at(exchange.one)].name,
          .partner = problem.fit.markers[at(exchange.other)].name,
          .first_frame = exchange.frames.front(),
          .last_frame = exchange.frames.back(),
          .frames = whole ? std::vector<std::int64_t>() : exchange.frames,
          .size = math::upper_median(apart),
          .detail = "exchanged back"};
}

}  // namespace

void add_sample_findings(const Problem& problem, const JudgedFrames& judged,
                         const data::Trajectories& markers, data::JointMotion& motion, data::MarkerFit& fit) {
  const data::Trajectories& kept = judged.kept ? *judged.kept : markers;
  const auto M = problem.data_marker.size();
  motion.marker_state.resize(at(problem.frames) * M);
  for (auto& marker : fit.markers) marker.rejected_frames = 0;
  for (std::int64_t f = 0; f < problem.frames; ++f)
    for (std::size_t m = 0; m < M; ++m) {
      const auto state = kept.state[kept.index(problem.first_frame + f, problem.data_marker[m])];
      motion.marker_state[at(f) * M + m] = state;
      *fit.markers[m].rejected_frames += state == data::SampleState::rejected;
    }
  for (const Exchange& exchange : judged.exchanges)
    fit.findings.push_back(finding_of(problem, exchange, markers));
  for (const Outlier& outlier : judged.rejected) fit.findings.push_back(finding_of(problem, outlier));
  for (const Outlier& outlier : judged.doubtful) {
    auto finding = finding_of(problem, outlier);
    finding.kind = data::FindingKind::marker_slip;
    finding.partner = problem.fit.markers[at(outlier.marker)].body;
    finding.confidence = 0.5;
    finding.detail = "the samples before or those from there on are wrong; both were kept";
    fit.findings.push_back(std::move(finding));
  }
}

}  // namespace kinemark::motion::internal
