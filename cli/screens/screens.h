// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/screens/terminal.h"
#include "kinemark/core/result.h"
#include "kinemark/pipeline/desk/desk.h"
#include "kinemark/pipeline/desk/plan_text.h"

namespace kinemark::screens {

/// Whether the program was asked to end, by a signal.
using Stopped = std::function<bool()>;

/// The menus on a terminal, until the person leaves or the program is asked to end; files of the trials that
/// were kept.
[[nodiscard]] std::vector<std::string> show_menus(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                                  Terminal& terminal, const Stopped& stopped);

/// The menus where input and output are a terminal that has room for them, plain lines on standard input and
/// output elsewhere.
[[nodiscard]] std::vector<std::string> acquire_by_hand(pipeline::Desk& desk, const pipeline::Wanted& wanted,
                                                       const Stopped& stopped);

}  // namespace kinemark::screens
