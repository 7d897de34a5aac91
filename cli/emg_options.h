// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "kinemark/pipeline/measures/emg_request.h"

namespace kinemark::cli {

/// What the options for electromyograms are called.
struct EmgNames {
  std::string channels, prefix, write, write_cycles;
};

/// Of `kinemark emg`, and of `analyze`, where others stand beside them.
inline const EmgNames kOwnEmgNames{"--channels", "--", "--write-envelopes", "--write-cycles"};
inline const EmgNames kSharedEmgNames{"--emg", "--emg-", "--write-emg", "--write-emg-cycles"};

/// The options for electromyograms, in a group of their own.
void add_emg_options(CLI::App& command, pipeline::EmgRequest& request, const EmgNames& names);

}  // namespace kinemark::cli
