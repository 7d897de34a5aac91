// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

namespace kinemark::motion::internal {

/// A body's name without "_r" or "_l", and that suffix.
[[nodiscard]] std::pair<std::string, std::string> split_side(const std::string& body);

/// The segment of the body called so in OpenSim's models: "pelvis", "trunk" (with clavicles and scapulae),
/// "head", "upper arm", "forearm", "hand", "thigh", "shank", "foot"; empty for other names. `stem`: without
/// the side.
[[nodiscard]] std::string segment_of(const std::string& stem);

}  // namespace kinemark::motion::internal
