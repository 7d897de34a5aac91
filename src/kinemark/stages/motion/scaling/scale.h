// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A general model scaled to a subject as OpenSim's ScaleTool does: factors from distances of marker pairs, or
// by hand.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/scale_recipe.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::motion {

/// One distance, measured and in the model.
struct MeasuredPair {
  std::string first, second;   ///< names in the model
  double measured_m = 0.0;     ///< mean over the frames that show both
  double measured_sd_m = 0.0;  ///< over these frames
  double model_m = 0.0;        ///< in the model's default pose
};

/// One measurement, carried out.
struct MeasurementResult {
  std::string name;                 ///< as given
  double factor = 1.0;              ///< measured over model, mean over the pairs
  std::vector<MeasuredPair> pairs;  ///< one by one
};

/// A scaled model and where its factors come from.
struct ScaleResult {
  data::ModelDescription model;                 ///< with the new sizes and masses
  std::vector<data::BodyFactors> factors;       ///< one per body, in the model's order
  std::vector<MeasurementResult> measurements;  ///< as carried out
};

/// Scale a model as the recipe says. `recording` may be null when no step measures.
///
/// Factors outside 0.2 to 5 are refused: they come from swapped markers or a wrong unit. Fails for markers,
/// bodies or times that do not exist, and for a pair that no frame shows. Names match exactly or behind a
/// subject prefix ("Ann:LASI").
[[nodiscard]] Result<ScaleResult> scale_model(const data::ModelDescription& model,
                                              const data::Trajectories* recording,
                                              const data::ScaleRecipe& recipe);

/// The subject's size over the model's: distances between markers of one body, mean over at most 500 frames
/// that show both, summed, over the same in the model; 1 where no body has two markers in the recording.
/// Fails outside 0.2 to 5. O(F M^2 / bodies).
[[nodiscard]] Result<double> find_overall_size(const data::ModelDescription& model,
                                               const data::Trajectories& recording);

/// Scale every body by its factors (one per body, along its axes): joint frames, joints' translation
/// functions (by the parent), radii, mass centres, markers, points of loops. A coordinate that is itself a
/// translation is left alone. Inertia follows as for a body whose every point is stretched; `scale_mass`: the
/// mass by the product of the factors, otherwise it stays.
void apply_factors(data::ModelDescription& model, std::span<const Eigen::Vector3d> factors, bool scale_mass);

/// Multiply all masses and inertias so that the model weighs mass_kg. Fails for a massless model.
[[nodiscard]] Status set_total_mass(data::ModelDescription& model, double mass_kg);

}  // namespace kinemark::motion
