// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kinemark::pipeline::internal {

/// models/human.osim as text.
[[nodiscard]] std::string_view human_model_text();

}  // namespace kinemark::pipeline::internal
