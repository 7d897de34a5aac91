// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/data/model_description.h"

namespace kinemark::io {

/// Gives bodies, joints, coordinates and markers names that every reader of robots takes: letters, digits,
/// "_", "-" and "."; any other byte becomes "_", a name that is then taken gets "_2" and so on. "world" and
/// "ground" are taken among the bodies. What was changed comes back as a sentence, none where nothing was.
[[nodiscard]] std::vector<std::string> make_names_legal(data::ModelDescription& model);

}  // namespace kinemark::io
