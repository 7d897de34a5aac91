// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segments, joint centres and joint angles of a recording by a definition, without a body model.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/path/marker_noise.h"
#include "kinemark/stages/analysis/segments/segment_definition.h"

namespace kinemark::analysis {

/// A measure of the subject that somebody knows, in SI units.
struct SubjectValue {
  std::string name;               ///< of the definition, or another name that files have for it
  double value = 0.0;             ///< m, rad, kg
  std::string from;               ///< who says so: "--subject", "Ann.vsk"
  std::optional<double> sd = {};  ///< standard deviation, SI; none: that of the definition
};

/// What segments are computed from.
struct SegmentInput {
  const data::Trajectories* markers = nullptr;  ///< the recording
  const data::Trajectories* static_trial =
      nullptr;  ///< of the same subject; null: none; may be the recording
  std::map<std::string, const data::Trajectories*> trials;  ///< others, in which landmarks were shown
  std::vector<SubjectValue> given;                          ///< taken first
  std::vector<SubjectValue> known;                          ///< of files; the first of a name counts
  /// Names of points as files have them, by those that formulas have: LFEO is LFE_MO.
  std::map<std::string, std::string> aliases;
  bool zeros_doubtful = false;         ///< the laboratory measures offsets: a file's 0 has `assumed_sd`
  const MarkerNoise* noise = nullptr;  ///< of `markers`; null: found where deviations need it
};

/// How segments are computed.
struct SegmentOptions {
  /// Of each marker's samples and axis, m; 0: the markers' covariance where they carry one, else
  /// SegmentInput::noise.
  double noise_sd_m = 0.0;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< axis of the laboratory against gravity
  int threads = 1;                                ///< 0: all cores; any number gives the same bits
  bool deviations = true;                         ///< false: none are computed, `sd` is 0

  [[nodiscard]] Status check() const;  ///< Code::usage
};

/// Components of an angle, or one number, through time.
struct SegmentSeries {
  std::string name;                                   ///< of the definition
  std::vector<std::string> labels;                    ///< n; empty: n is 1
  SubjectQuantity quantity = SubjectQuantity::angle;  ///< of all components
  std::string unit = {};                              ///< "N m/kg"; empty: that of the quantity
  Array<double> value;                                ///< F x n, SI; NaN where missing
  Array<double> sd;                                   ///< F x n, SI
  Array<double> constant_sd = {};                     ///< F x n, SI: the part of sd that is one error in all
                                                      ///< frames, of the subject's measures; may be empty
  Array<data::SampleState> state;                     ///< F: measured, interpolated (a marker was), missing

  [[nodiscard]] std::size_t size() const { return labels.empty() ? 1 : labels.size(); }  ///< n
};

/// A measure of the subject as it was used.
struct UsedParameter {
  std::string name;                                    ///< of the definition
  SubjectQuantity quantity = SubjectQuantity::number;  ///< what it measures
  double value = kNaN;                                 ///< SI
  double sd = 0.0;                                     ///< standard deviation; 0: not known, taken as exact
  std::string from;       ///< "--subject", "the static trial", "its formula", ...
  bool assumed = false;   ///< nobody measured it, or it may be so
  bool constant = false;  ///< sd is that of one error in all frames, on which other measures depend
};

/// A measure of the subject by the outputs of a model that the recording holds.
struct ShownParameter {
  std::string name;                                    ///< of the definition
  SubjectQuantity quantity = SubjectQuantity::number;  ///< what it measures
  double used = kNaN;                                  ///< the value that was computed with, SI; NaN: none
  double value = kNaN;                                 ///< the value that the outputs were made with, SI
  double spread = 0.0;        ///< half the range from 5 to 95 % of the frames, the largest of its formulas
  double disagreement = 0.0;  ///< of its formulas, half their range; SI
  std::int64_t formulas = 0;  ///< number of formulas that tell
  std::string from = {};      ///< who says `used`
};

/// What a definition gives of a recording.
struct SegmentMotion {
  TimeBase time;                          ///< F frames, of the recording
  std::vector<SegmentSeries> angles;      ///< that could be computed
  std::vector<SegmentSeries> values;      ///< that could be computed
  data::Trajectories points;              ///< model_filled (interpolated where a marker was), with covariance
  std::vector<UsedParameter> parameters;  ///< all that have a value
  std::optional<MarkerNoise> noise = {};  ///< of the markers that were used, where deviations rest on it
  std::vector<std::string> warnings;  ///< what could not be computed and why; gimbal lock; one sentence each
};

/// Segments, points and angles in every frame. Where a marker that one needs is missing, it is missing.
///
/// Deviations follow from those of the markers' samples (MarkerNoise: noise of any colour, also of what was
/// filtered), taken as independent of each other, and of measured
/// parameters, by differences over sqrt(3) deviations in each direction with the second-order term (Norgaard
/// et al. 2000, the divided-difference form of the unscented rule): exact for what is quadratic in a marker,
/// which the chord function nearly is. They know nothing of skin that moves or of a wrong knee width.
///
/// Constant errors, of measures that are assumed or that carry a deviation of their own, are one draw for all
/// joints and frames: what follows from such a measure, a foot's offset in the static trial, moves with it.
///
/// Code::usage as SegmentOptions::check(); Code::bad_input for a definition that does not check() or makes no
/// sense, and where nothing can be computed.
[[nodiscard]] Result<SegmentMotion> compute_segments(const SegmentDefinition& definition,
                                                     const SegmentInput& input,
                                                     const SegmentOptions& options = {});

/// Parameters by the outputs of a model in the recording: those whose `shown` formulas find what they name.
/// Each is found with those before it as shown. Fails as compute_segments().
[[nodiscard]] Result<std::vector<ShownParameter>> shown_parameters(const SegmentDefinition& definition,
                                                                   const SegmentInput& input,
                                                                   const SegmentOptions& options = {});

}  // namespace kinemark::analysis
