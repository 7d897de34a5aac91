// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kinemark/data/neural.h"
#include "kinemark/io/nwb/internal/output.h"

namespace kinemark::io::internal {

/// Units, intervals and the samples of field potentials, into a file that has its root.
void write_neural(Output& out, const data::Neural& neural, const std::vector<data::FieldSamples>& fields,
                  int compression);

}  // namespace kinemark::io::internal
