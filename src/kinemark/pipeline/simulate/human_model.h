// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"

namespace kinemark::pipeline {

/// kinemark's own human (models/human.osim), which is part of the program.
[[nodiscard]] Result<data::ModelDescription> human_model();

}  // namespace kinemark::pipeline
