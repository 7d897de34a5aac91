// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "kinemark/pipeline/files/recording.h"

namespace kinemark::cli {

/// The options of every command that reads a recording, in a group of their own: how it is read, which part
/// of it is used, which way is up, what becomes of doubtful samples.
/// @param by_itself  what the command does with doubtful samples where nothing is said
void add_recording_options(CLI::App& command, pipeline::RecordingOptions& recording,
                           pipeline::Doubtful by_itself);

/// A check of options that take a time: empty, or what is wrong with the text.
[[nodiscard]] std::string finite_time(const std::string& text);

/// Of several recordings, those that state a rate or a unit have no use for the one that is given.
void drop_what_it_states(pipeline::RecordingOptions& recording, const std::filesystem::path& input);

}  // namespace kinemark::cli
