// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Formulas of a definition as a list of steps, each of which needs earlier ones only.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stages/analysis/segments/segment_definition.h"

namespace kinemark::analysis {

/// Number, vector (3) or frame (axes column by column, origin): what a step is worth.
using StepValue = std::array<double, 12>;
/// Which of these.
enum class StepType : std::uint8_t { number, vector, frame };

/// A function of earlier steps.
struct Step {
  StepType type = StepType::number;                                             ///< of the result
  std::vector<int> from;                                                        ///< steps
  std::function<void(std::span<const StepValue* const>, StepValue&)> evaluate;  ///< of their values
  std::vector<int> inputs;  ///< that it depends on, increasing
};

/// Steps and what they depend on.
///
/// Inputs are the markers that are used, in the order of `markers`, then the parameters that are used, in
/// that of `parameters`; steps [0, inputs) are their values.
struct SegmentGraph {
  std::vector<std::string> markers;          ///< names of markers that are used
  std::vector<std::string> parameters;       ///< names of parameters that are used
  std::vector<Step> steps;                   ///< each needs earlier ones
  std::vector<std::vector<int>> followers;   ///< for each input, steps that depend on it, increasing
  std::vector<int> outputs;                  ///< step of each output that was asked for; -1: lacks something
  std::vector<std::set<std::string>> lacks;  ///< for each output, names that are not there

  [[nodiscard]] int inputs() const {
    return static_cast<int>(markers.size() + parameters.size());
  }  ///< number
  /// Evaluate all steps behind the inputs, whose values are there.
  void evaluate(std::vector<StepValue>& values) const;
  /// Evaluate again what depends on an input whose value has changed.
  void evaluate_followers(int input, std::vector<StepValue>& values) const;
};

/// What there is to name besides the entries of the definition.
struct GraphNames {
  std::function<bool(const std::string&)> has_marker;     ///< whether the recording has it
  std::function<bool(const std::string&)> has_parameter;  ///< whether its value is known
  std::optional<Eigen::Matrix3d> progression;             ///< axes of "progression" in the laboratory
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();          ///< what "up" is in the laboratory
  bool static_trial = false;                              ///< which entries count
  int* levels = nullptr;  ///< of formulas within each other so far, where graphs are made for graphs; null: 0
};

/// An output to make steps for.
struct GraphOutput {
  const Formula* formula = nullptr;                 ///< a formula; null: an angle
  StepType type = StepType::vector;                 ///< that the formula must have
  const SegmentDefinition::Angle* angle = nullptr;  ///< a vector of its components, rad
  std::string what;                                 ///< begins a failure: "point LKJC"
};

/// Steps for some outputs of a definition. An output that needs a marker or a parameter that is not there has
/// none, and its name is in `lacks`; formulas that make no sense are Code::bad_input: an unknown function, a
/// wrong number or kind of arguments, an entry that needs itself, more than 200 entries that need each other
/// in a row, 1200 levels of formulas within each other (a term of a sum is one) or 20,000 steps.
///
/// A landmark is three parameters, NAME@x, NAME@y and NAME@z: where it is in its segment, m.
[[nodiscard]] Result<SegmentGraph> build_graph(const SegmentDefinition& definition, const GraphNames& names,
                                               std::span<const GraphOutput> outputs);

}  // namespace kinemark::analysis
