// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Values of a table that are no coordinates of a body, and no deviations.
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/table.h"

namespace kinemark::analysis {

/// Without a model, by names and header alone: angles that the file calls radians and that turn further than
/// a body can, four of them or more; angles that go from one end to the other of more than two turns, each by
/// name. Translations ("_tx", "_x"), speeds, forces, moments, powers, states of muscles are no angles. Of
/// deviations, those below zero: a table whose file ends with "_sd.sto", or that is called "Standard
/// deviations of ...".
[[nodiscard]] std::vector<std::string> contradicted_values(const data::Table& table,
                                                           const std::string& file_name);

}  // namespace kinemark::analysis
