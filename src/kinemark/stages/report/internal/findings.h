// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/stages/report/ik_summary.h"

namespace kinemark::report::internal {

/// The sentences of "what needs your attention", from a summary whose other fields are filled in.
///
/// Of level attention: a failed gate, frames that did not converge or had no marker, a coordinate that is
/// never determined, an exit status other than 0. Notes: excluded markers, coordinates determined for part of
/// the time, warnings. The serious ones come first, otherwise the order is fixed by the inputs.
[[nodiscard]] std::vector<Notice> find_notices(const IkSummary& summary, const data::JointMotion& motion);

}  // namespace kinemark::report::internal
