// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a scene may hold besides markers: joint centres with their covariance, cameras.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "kinemark/data/skeleton.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report::internal {

/// Centres, covariances and states of every step-th frame, and which joints a segment joins: PackedJoints.
[[nodiscard]] nlohmann::ordered_json skeleton_json(const data::Skeleton& skeleton, std::int64_t step);

/// Names, masses, and origin and end of every step-th frame: PackedBodies.
[[nodiscard]] nlohmann::ordered_json bodies_json(const SceneBodies& bodies, std::int64_t step);

/// PackedCamera of each camera.
[[nodiscard]] nlohmann::ordered_json cameras_json(std::span<const SceneCamera> cameras);

}  // namespace kinemark::report::internal
