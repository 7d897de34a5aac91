// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/body_name.h"

#include <fmt/core.h>

namespace kinemark::motion::internal {

Result<int> body_by_name(const model::Model& model, const std::string& name) {
  if (name.empty()) return data::kGround;
  const int described = model.description().find_body(name);
  if (described == data::kGround) return data::kGround;
  if (described < 0) return fail(Code::bad_input, fmt::format("the model has no body '{}'", name));
  return model.body_of(described);
}

bool is_welded(const model::Model& model, int body) {
  return body < 0 || model.bodies()[static_cast<std::size_t>(body)].support.empty();
}

}  // namespace kinemark::motion::internal
