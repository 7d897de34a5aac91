// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/joint_choice.h"

#include <fmt/core.h>

namespace kinemark::data {

std::string_view to_string(JointChoice choice) {
  switch (choice) {
    case JointChoice::automatic:
      return "auto";
    case JointChoice::ball:
      return "ball";
    case JointChoice::hinge:
      return "hinge";
  }
  return "unknown";
}

Result<JointChoice> parse_joint_choice(std::string_view name) {
  for (const auto choice : {JointChoice::automatic, JointChoice::ball, JointChoice::hinge})
    if (name == to_string(choice)) return choice;
  return fail(Code::usage, fmt::format("'{}' is not a kind of joint; use auto, ball or hinge", name));
}

}  // namespace kinemark::data
