// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kinemark::pipeline::internal {

[[nodiscard]] std::string_view pig_text();           ///< models/segments/pig.toml
[[nodiscard]] std::string_view isb_shoulder_text();  ///< models/segments/isb-shoulder.toml

}  // namespace kinemark::pipeline::internal
