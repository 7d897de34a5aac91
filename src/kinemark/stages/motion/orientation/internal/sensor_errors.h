// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/core/array.h"
#include "kinemark/stages/motion/orientation/orientation_ik.h"

namespace kinemark::motion::internal {

/// Shares seen, RMS and largest angles of the sensors of a fit, from F x S angles between measured and model.
void summarize_errors(const Array<double>& errors, OrientationFit& fit);

}  // namespace kinemark::motion::internal
