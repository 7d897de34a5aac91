// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Channels that are no electromyograms as an amplifier gives them.
#pragma once

#include <string>
#include <vector>

#include "kinemark/stages/analysis/emg/emg_measures.h"

namespace kinemark::analysis {

/// A sentence where a channel was rectified or made an envelope before, with either sign: all values lie on
/// one side of zero, the nearest within half of their median, and either half of them lie nearer to that than
/// to their extreme or they are smooth. An offset, which an unrectified channel has all of its values about,
/// is none of this. Empty of one that is as it should be, of fewer than
/// 100 samples, and where one value fills it.
[[nodiscard]] std::string why_rectified(const EmgChannel& channel);

/// A sentence where the mean of an envelope of a whole recording is above its maximum, 1; empty else.
[[nodiscard]] std::string why_above_maximum(const std::string& name, const Eigen::VectorXd& envelope);

}  // namespace kinemark::analysis
