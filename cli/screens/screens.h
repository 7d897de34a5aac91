// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/screens/terminal.h"
#include "kinemark/core/result.h"
#include "kinemark/pipeline/desk/desk.h"
#include "kinemark/pipeline/desk/plan_text.h"

namespace kinemark::screens {

/// The menus on a terminal, until the person leaves; files of the trials that were kept.
[[nodiscard]] std::vector<std::string> show_menus(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                                  Terminal& terminal);

/// The menus where input and output are a terminal that has room for them, plain lines on standard input and
/// output elsewhere.
[[nodiscard]] std::vector<std::string> acquire_by_hand(pipeline::Desk& desk, const pipeline::Wanted& wanted);

}  // namespace kinemark::screens
