// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kinemark::data {

/// The component of a force plate that an analog channel's label names: "fx" of "Fx", "Electric
/// Potential.Fx", "Force.Fx2" and "F1X", "mz" of "Mz1"; empty where the label names none.
[[nodiscard]] std::string plate_component(std::string_view label);

}  // namespace kinemark::data
