// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A folder of trials that belong together: docs/formats/session.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// One trial, as its recording says.
struct SessionTrial {
  std::string file;     ///< from the session's folder: "raw/reach_01.mcap"
  std::string source;   ///< address of the device
  std::string started;  ///< UTC, "2026-05-04T09:12:45Z"
  double rate_hz = 0.0;
  std::int64_t frames = 0;  ///< kept and lost
  std::int64_t dropped_by_device = 0, dropped_here = 0;
  /// That the device's clock is fast against the machine's, 1e-6, and its standard deviation; nothing:
  /// unknown.
  std::optional<double> clock_fast_ppm, clock_fast_sd_ppm;
  friend bool operator==(const SessionTrial&, const SessionTrial&) = default;  ///< all fields alike
};

/// A file and its checksum.
struct ManifestEntry {
  std::string file;  ///< from the session's folder
  std::string hex;   ///< XXH3, 64 bits, 16 lower-case digits
};

/// What is said of a session when it is made or continued.
struct SessionAbout {
  std::string subject;  ///< empty: not known, or that of the session
  std::filesystem::path
      rig;  ///< rig.toml of the trials, which is copied; empty: none, or that of the session
};

/// A session whose folder is there.
///
/// FOLDER/session.toml says who and what, FOLDER/raw/ holds the recordings, FOLDER/MANIFEST their checksums.
/// A recording is part of the session once it stands in MANIFEST; it is then read-only. Programs that add to
/// one session at the same time wait for each other.
class Session {
 public:
  /// Make a session in a folder that is absent or empty, or continue the one that is there. Closed recordings
  /// of raw/ that MANIFEST does not name (their program was killed) are taken in; those that were not closed
  /// are named in notes(). Code::usage for a folder of something else and for another subject or rig than the
  /// session has; else as read().
  [[nodiscard]] static Result<Session> open(const std::filesystem::path& folder, const SessionAbout& about);
  /// The session of a folder; nothing is written. Code::io where a file is missing or cannot be read,
  /// Code::bad_input, naming file and place, for one that makes no sense.
  [[nodiscard]] static Result<Session> read(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path raw() const { return folder_ / "raw"; }  ///< where trials are recorded
  [[nodiscard]] const std::string& subject() const { return subject_; }        ///< empty: not known
  [[nodiscard]] std::filesystem::path rig() const;  ///< the copy of it; empty: none
  [[nodiscard]] const std::vector<SessionTrial>& trials() const { return trials_; }  ///< in their order
  /// What was found when it was continued, a sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Whose session it is, where that was not known. Code::usage where another subject is.
  [[nodiscard]] Status set_subject(const std::string& subject);
  /// Take a closed recording of raw() in: it becomes read-only. Code::bad_input for one that is not closed;
  /// Code::io where the disk fails: the recording stays, and the session takes it in when it is continued.
  [[nodiscard]] Status add(const std::filesystem::path& recording);
  /// Every recording of MANIFEST is there, and as it was. Reads them all. Code::io for one that is missing,
  /// Code::bad_input for one that was changed.
  [[nodiscard]] Status check() const;

 private:
  explicit Session(std::filesystem::path folder) : folder_(std::move(folder)) {}
  [[nodiscard]] Status take_about(const SessionAbout& about);
  [[nodiscard]] Status take_strays();
  [[nodiscard]] Status load(bool may_lack_manifest);
  [[nodiscard]] Status save() const;
  [[nodiscard]] Status add_locked(const std::filesystem::path& recording);

  std::filesystem::path folder_;
  std::string subject_;
  bool has_rig_ = false;
  std::vector<SessionTrial> trials_;
  std::vector<ManifestEntry> manifest_;
  std::vector<std::string> notes_;
};

/// Whether a folder holds a session.
[[nodiscard]] bool is_session(const std::filesystem::path& folder);

}  // namespace kinemark::pipeline
