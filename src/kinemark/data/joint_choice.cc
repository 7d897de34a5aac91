// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/joint_choice.h"

#include <fmt/core.h>

#include "kinemark/core/enum_names.h"

namespace kinemark::data {

namespace {
constexpr EnumNames<JointChoice::hinge> kChoices{"auto", "ball", "hinge"};
}  // namespace

std::string_view to_string(JointChoice choice) { return kChoices[choice]; }

Result<JointChoice> parse_joint_choice(std::string_view name) {
  if (const auto choice = kChoices.find(name)) return *choice;
  return fail(Code::usage, fmt::format("'{}' is not a kind of joint; use auto, ball or hinge", name));
}

}  // namespace kinemark::data
