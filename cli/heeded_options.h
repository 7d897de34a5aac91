// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "kinemark/core/result.h"

namespace kinemark::cli {

/// What a command that measures does, by what it is given: which of its options count depends on it.
enum class AnalysisKind : std::uint8_t {
  list,           ///< say what measures there are
  markers,        ///< measures of a recording of markers
  several,        ///< the same of several recordings, in one table
  segments,       ///< joint centres and angles of a recording by a definition
  motion,         ///< measures of a motion
  tables,         ///< tables of a motion, into a folder
  around,         ///< averages around events of a recording of markers
  around_motion,  ///< the same of a motion
};

/// Every option that was given is heeded by this kind of analysis: Code::usage names the first that is not,
/// what it is for, and what this is.
/// @param input  name of the file that is analysed
[[nodiscard]] Status check_heeded(const CLI::App& command, AnalysisKind kind, const std::string& input);

}  // namespace kinemark::cli
