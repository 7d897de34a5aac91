// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/screens/desk.h"
#include "cli/screens/plan_text.h"
#include "cli/screens/terminal.h"
#include "kinemark/core/result.h"

namespace kinemark::screens {

/// The menus on a terminal, until the person leaves; files of the trials that were kept.
[[nodiscard]] std::vector<std::string> show_menus(Desk& desk, const Wanted& wanted, Terminal& terminal);

/// The menus where input and output are a terminal that has room for them, plain lines on standard input and
/// output elsewhere.
[[nodiscard]] std::vector<std::string> acquire_by_hand(Desk& desk, const Wanted& wanted);

}  // namespace kinemark::screens
