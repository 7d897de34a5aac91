// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kinemark/data/model_description.h"

namespace kinemark::io::osim {

/// What differs between two descriptions by more than rounding (1e-9 of a number, or 1e-9), as a few words
/// such as "joint 'knee_r'"; empty when nothing does. Order, characters that OpenSim refuses in names,
/// credits and warnings do not count.
[[nodiscard]] std::string difference_of(const data::ModelDescription& wanted,
                                        const data::ModelDescription& found);

}  // namespace kinemark::io::osim
