// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "kinemark/pipeline/measures/gait_request.h"

namespace kinemark::cli {

/// The options of `analyze` that belong to walking, in a group of their own.
void add_gait_options(CLI::App& command, pipeline::GaitRequest& request);

}  // namespace kinemark::cli
