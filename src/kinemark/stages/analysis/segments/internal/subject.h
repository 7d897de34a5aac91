// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is fixed in a recording: measures of the subject, landmarks in their segments, the way forward.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/name_index.h"
#include "kinemark/stages/analysis/segments/segment_graph.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::analysis::internal {

/// A recording whose markers formulas name. A marker without a sample is none.
class TrialMarkers {
 public:
  /// @param aliases  names that the recording may have for others; must outlive this
  TrialMarkers(const data::Trajectories& markers, const std::map<std::string, std::string>& aliases);
  [[nodiscard]] const data::Trajectories& markers() const { return markers_; }
  [[nodiscard]] bool has(const std::string& name) const;
  [[nodiscard]] std::int64_t find(const std::string& name) const;

 private:
  const data::Trajectories& markers_;
  const std::map<std::string, std::string>& aliases_;
  data::NameIndex index_;
  std::vector<bool> seen_;  // of each marker, whether any frame has it
};

/// What does not change from frame to frame.
struct Subject {
  std::map<std::string, UsedParameter> parameters;  ///< by name; NAME@x, NAME@y, NAME@z of landmarks too
  std::optional<Eigen::Matrix3d> progression;       ///< forward, left, up
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();    ///< in the laboratory

  /// Names for a graph of a trial.
  [[nodiscard]] GraphNames names(const TrialMarkers& trial, bool is_static) const;
};

/// Measure, look up and compute all that is fixed. Code::bad_input for formulas that make no sense.
[[nodiscard]] Result<Subject> find_subject(const SegmentDefinition& definition, const SegmentInput& input,
                                           const SegmentOptions& options);

/// The subject as he is where one of his measures is larger, and smaller, by sqrt(3) deviations.
struct SubjectShift {
  Subject plus, minus;
};
/// One for each measure with a constant error: what depends on it is measured and computed again.
[[nodiscard]] Result<std::vector<SubjectShift>> find_shifts(const SegmentDefinition& definition,
                                                            const SegmentInput& input,
                                                            const SegmentOptions& options,
                                                            const Subject& subject);

/// Put a frame's markers and the subject's parameters in front of a graph's steps.
void set_inputs(const SegmentGraph& graph, const std::vector<std::int64_t>& marker_idx,
                const data::Trajectories& markers, std::int64_t frame, const Subject& subject,
                std::vector<StepValue>& values);
/// Indices of a graph's markers in a recording.
[[nodiscard]] std::vector<std::int64_t> indices_of(const SegmentGraph& graph, const TrialMarkers& trial);

}  // namespace kinemark::analysis::internal
