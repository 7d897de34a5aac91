// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/stages/report/inputs_json.h"
#include "kinemark/stages/report/report_parts.h"

namespace kinemark::report::internal {

/// Rounded to so many decimals, never -0; null when not finite.
[[nodiscard]] nlohmann::ordered_json number(double value, int decimals);

/// Rounded to so many significant digits (1 to 17), for what spans decades; null when not finite.
[[nodiscard]] nlohmann::ordered_json significant(double value, int digits);

/// A length in mm, to 0.1 micrometre.
[[nodiscard]] nlohmann::ordered_json millimetres(double metres);

/// The parts that all reports share, as docs/formats/pages.md describes them.
[[nodiscard]] nlohmann::ordered_json gates_json(std::span<const Gate> gates);
[[nodiscard]] nlohmann::ordered_json findings_json(std::span<const Notice> findings);
/// Each with 2,000 items at most, so that a page stays usable.
[[nodiscard]] nlohmann::ordered_json groups_json(std::span<const NoticeGroup> groups);
[[nodiscard]] nlohmann::ordered_json options_json(
    std::span<const std::pair<std::string, std::string>> options);

}  // namespace kinemark::report::internal
