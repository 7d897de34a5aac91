// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "kinemark/pipeline/measures/emg_request.h"

namespace kinemark::cli {

/// The options of `analyze` that belong to electromyograms, in a group of their own.
void add_emg_options(CLI::App& command, pipeline::EmgRequest& request);

}  // namespace kinemark::cli
