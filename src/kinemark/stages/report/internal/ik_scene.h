// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "kinemark/stages/report/ik_report.h"

namespace kinemark::report::internal {

/// The used markers and where the model has them, for the space view; null where positions are not known or
/// do not lie in the model's axes.
/// @param max_bytes  of the scene as text in the page, at least 1000
[[nodiscard]] nlohmann::ordered_json ik_scene_json(const IkReport& report,
                                                   std::int64_t max_bytes = 1'000'000);

}  // namespace kinemark::report::internal
