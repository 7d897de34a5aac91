// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kinemark/data/foreign_group.h"

namespace kinemark::data {

/// A parameter that is one float, or one whole number of two bytes; nothing for any other.
[[nodiscard]] std::optional<double> number_of(const ForeignParameter& parameter);

}  // namespace kinemark::data
