// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "kinemark/data/trial.h"
#include "kinemark/io/nwb/internal/input.h"

namespace kinemark::io::internal {

/// What a file holds besides what we wrote and the series that were read as markers (`movement`, by their
/// paths). Nothing is read but shapes, units, rates and dates. A file of ours that holds no more has no
/// `file`.
[[nodiscard]] data::Beside find_beside(Input& in, const std::set<std::string>& movement);

}  // namespace kinemark::io::internal
