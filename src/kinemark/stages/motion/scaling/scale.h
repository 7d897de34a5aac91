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
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::motion {

struct MarkerPair {
  std::string first, second;
};

/// One factor for several bodies: the mean over its pairs of measured over model distance.
struct Measurement {
  std::string name;
  std::vector<MarkerPair> pairs;
  std::vector<ScaleGroup::Part> bodies;
};

struct ManualScale {
  std::string body;
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();  ///< > 0, along the axes of the body
};

enum class ScaleStep : std::uint8_t { measurements, manual };

/// Options of scale_model(). Later steps replace the factors of earlier ones.
struct ScaleOptions {
  std::vector<Measurement> measurements;
  std::vector<ManualScale> manual;
  std::vector<ScaleStep> order{ScaleStep::measurements, ScaleStep::manual};
  double mass_kg = 0.0;                     ///< of the subject; 0: as the factors make it
  bool preserve_mass_distribution = false;  ///< masses keep their ratios; else they grow with the volume
  double first_time_s = -1e300, last_time_s = 1e300;  ///< distances are averaged over this range
};

struct BodyFactors {
  std::string body;
  Eigen::Vector3d factors = Eigen::Vector3d::Ones();
};

struct MeasuredPair {
  std::string first, second;
  double measured_m = 0.0;     ///< mean over the frames that show both
  double measured_sd_m = 0.0;  ///< over these frames
  double model_m = 0.0;        ///< in the model's default pose
};

struct MeasurementResult {
  std::string name;
  double factor = 1.0;
  std::vector<MeasuredPair> pairs;
};

struct ScaleResult {
  data::ModelDescription model;
  std::vector<BodyFactors> factors;  ///< one per body, in the model's order
  std::vector<MeasurementResult> measurements;
};

/// Scale a model. `recording` may be null when no step measures.
///
/// Factors outside 0.2 to 5 are refused: they come from swapped markers or a wrong unit. Fails for markers,
/// bodies or times that do not exist, and for a pair that no frame shows. Names match exactly or behind a
/// subject prefix ("Ann:LASI").
[[nodiscard]] Result<ScaleResult> scale_model(const data::ModelDescription& model,
                                              const data::Trajectories* recording,
                                              const ScaleOptions& options);

/// Scale every body by its factors (one per body, along its axes): joint frames, joints' translation
/// functions (by the parent), radii, mass centres, markers, points of loops. A coordinate that is itself a
/// translation is left alone. Inertia follows as for a body whose every point is stretched; `scale_mass`: the
/// mass by the product of the factors, otherwise it stays.
void apply_factors(data::ModelDescription& model, std::span<const Eigen::Vector3d> factors, bool scale_mass);

/// Multiply all masses and inertias so that the model weighs mass_kg. Fails for a massless model.
[[nodiscard]] Status set_total_mass(data::ModelDescription& model, double mass_kg);

}  // namespace kinemark::motion
