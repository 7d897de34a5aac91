// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/stages/analysis/segments/formula.h"

namespace kinemark::analysis::testing {

/// A formula that is right.
inline Formula of(const std::string& text) { return parse_formula(text).value(); }

}  // namespace kinemark::analysis::testing
