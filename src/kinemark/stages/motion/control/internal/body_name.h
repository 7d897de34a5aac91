// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"

namespace kinemark::motion::internal {

/// Tree index of a body by name; data::kGround for "" and "ground". Fails when the model has none.
[[nodiscard]] Result<int> body_by_name(const model::Model& model, const std::string& name);

/// True for bodies that no joint can move: the ground and bodies welded to it.
[[nodiscard]] bool is_welded(const model::Model& model, int body);

}  // namespace kinemark::motion::internal
