// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace kinemark::server {

/// How far the server is with a trial.
enum class RowState : std::uint8_t { reading, read, unreadable };

/// What the list says of a trial.
struct TrialRow {
  std::uint32_t number = 0;             ///< of the trial
  std::string name, folder;             ///< of its file, printable
  RowState state = RowState::reading;   ///< while `reading`, all below is empty
  std::string kind;                     ///< "markers", "cleaned markers", "solved trial", "table", ...
  std::optional<std::int64_t> markers;  ///< those used, of a solved trial
  std::optional<std::int64_t> frames;   ///< F
  std::optional<double> rate_hz;        ///< nothing: the file does not tell it
  std::optional<double> duration_s;     ///< F / rate
  std::optional<double> measured;       ///< share of marker frames that cameras measured, 0 to 1
  std::string verdict;                  ///< "good" or "attention"; empty: nobody judged it
  std::string said;                     ///< why it cannot be read, or what is odd; one sentence, printable
};

/// Read a file and say what it holds. O(file); succeeds whatever the file is like. The number is left to the
/// caller.
[[nodiscard]] TrialRow describe_trial(const std::filesystem::path& path);

/// The row of a trial that has not been read.
[[nodiscard]] TrialRow unread_row(const std::filesystem::path& path);

/// Whether a table is the result of 'kinemark ik' or 'track', with its report beside it.
[[nodiscard]] bool is_solved(const std::filesystem::path& path);

/// number, name, folder, page ("/trial/1"), state, kind, markers, frames, rate_hz, duration_s, measured,
/// verdict, said; what is not known is null.
[[nodiscard]] nlohmann::ordered_json row_json(const TrialRow& row);

}  // namespace kinemark::server
