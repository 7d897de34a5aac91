// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Formulas of a definition in every frame of a recording, for those who compute further with them.
#pragma once

#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/analysis/segments/segment_graph.h"
#include "kinemark/stages/analysis/segments/segment_motion.h"

namespace kinemark::analysis {

/// What some outputs of a definition are worth in every frame, without deviations, again and again for
/// versions of one recording whose markers lie elsewhere.
class FormulaTracks {
 public:
  /// Measure what is fixed of the subject and make steps of the formulas. The definition, the recording and
  /// what `outputs` points to must outlive this.
  /// Code::bad_input for formulas that make no sense.
  [[nodiscard]] static Result<FormulaTracks> create(const SegmentDefinition& definition,
                                                    const SegmentInput& input, const SegmentOptions& options,
                                                    std::span<const GraphOutput> outputs);
  FormulaTracks(FormulaTracks&&) noexcept;             ///< the other one is empty
  FormulaTracks& operator=(FormulaTracks&&) noexcept;  ///< the other one is empty
  ~FormulaTracks();                                    ///< frees the steps

  /// Names that an output needs and that are not there; empty: it can be computed.
  [[nodiscard]] const std::set<std::string>& lacks(std::size_t output) const;
  /// Indices of the markers of the recording that an output depends on, increasing.
  [[nodiscard]] std::vector<std::int64_t> markers_of(std::size_t output) const;
  /// One sentence for outputs that lack something, grouped by what they lack.
  /// @param names  of all outputs, as sentences call them; those that are empty are not named
  [[nodiscard]] std::vector<std::string> lack_sentences(std::span<const std::string> names) const;
  /// Measures of the subject whose errors are the same in all frames (UsedParameter::constant).
  [[nodiscard]] std::vector<UsedParameter> constant_parameters() const;
  /// Values of all outputs in a frame of a version of the recording: those of an output that lacks something
  /// are not touched. From several threads, each with its own `work`.
  /// @param markers  names and shape as the recording's; NaN where missing gives NaN
  /// @param work     filled as needed, kept between calls
  /// @param out      as many as outputs
  void evaluate(const data::Trajectories& markers, std::int64_t frame, std::vector<StepValue>& work,
                std::span<StepValue> out) const;

 private:
  struct Steps;
  explicit FormulaTracks(std::unique_ptr<Steps> steps);
  std::unique_ptr<Steps> steps_;
};

}  // namespace kinemark::analysis
