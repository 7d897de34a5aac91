// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/scaling/geometry.h"

namespace kinemark::studies {

/// Geometry parameters that may change to fit the landmarks.
enum class Freedom : std::uint8_t {
  none,      ///< as scaled by medians
  centres,   ///< joints; landmarks that are joint centres stay joint centres (72 numbers; 78 with clavicles)
  positions  ///< joints, and the position of every landmark (111; 117)
};

/// The geometry parameters of a model with landmarks, each with a prior of 20 mm: three per joint of
/// trunk, arms, thighs and shanks (clavicles where they move), and three per landmark that is free.
[[nodiscard]] Result<std::vector<motion::GeometryParameter>> landmark_geometry(
    const data::ModelDescription& model, Freedom freedom);

struct GeometryFit {
  data::ModelDescription model;
  std::int64_t parameters = 0;
  double rms_m = 0.0, max_m = 0.0;               ///< least squares of all frames on that model
  double rms_first_m = 0.0, rms_second_m = 0.0;  ///< of the first and the second half of the frames
};

/// Adapt the geometry to the landmarks of frames [first, last) and solve all frames. Freedom::none adapts
/// nothing; Freedom::positions keeps the better of two starts, the model as it is and with its centres
/// adapted. About 5 s for a whole body and 334 frames.
[[nodiscard]] Result<GeometryFit> fit_geometry(const data::ModelDescription& model,
                                               const data::Trajectories& landmarks, Freedom freedom,
                                               std::int64_t first, std::int64_t last, int threads = 1);

}  // namespace kinemark::studies
