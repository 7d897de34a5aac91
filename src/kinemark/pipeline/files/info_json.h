// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What jobs of pipeline/files and pipeline/simulate print with --json; the other jobs have a file of their
// own.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

#include "kinemark/pipeline/files/info_job.h"
#include "kinemark/pipeline/files/recover_job.h"
#include "kinemark/pipeline/files/validate_job.h"

namespace kinemark::pipeline {

/// "written" (paths) and "warnings": all that there is to tell of a job that only writes files.
[[nodiscard]] nlohmann::ordered_json outcome_json(const JobOutcome& outcome);

/// A list with an entry for each file: "file", "exit_status", and "warnings", or "error" where it cannot be
/// read.
[[nodiscard]] nlohmann::ordered_json validate_json(const ValidateOutcome& outcome);

/// "original", "written", "messages" (kept), "end" (of the original: closed, open, cut, damaged),
/// "bytes_left_out", "damage" (a list of offset, bytes, what) and "warnings".
[[nodiscard]] nlohmann::ordered_json recover_json(const RecoverOutcome& outcome);

/// The facts of a file.
///
/// Every answer has "file", "kind", "warnings" and "contradicted" (what contradicts what else is known of it:
/// all in JSON, the worst in text). Markers: format, points, frames, rate_hz (null: unknown),
/// first_frame, last_frame, units, missing (marker frames), analog_channels, analog_rate_hz, force_plates,
/// events, software, labels (of markers), computed (those of them that a model made of others), unlabelled
/// (those that nobody named), marker_set (name, part, markers, missing, and said: all of it in words; absent
/// where the names are of no set known here), channels (points that are no markers: name, kind, unit,
/// rate_hz, missing frames). Tables: rows, columns, first_time_s, last_time_s (null without rows),
/// in_degrees, labels. Models: name, bodies, joints, coordinates, markers, couplings, point_constraints,
/// mass_kg, labels (of coordinates), body_names. Recordings: end, bytes, messages, channels, metadata, and of
/// counts also frames, rate_hz, first_time_s, rig, dark_slot, saturated, occluded, lost (observations),
/// cameras, labels.
[[nodiscard]] nlohmann::ordered_json info_json(const InfoOutcome& outcome);

/// The same for people, one fact a line.
[[nodiscard]] std::string info_text(const InfoOutcome& outcome);

}  // namespace kinemark::pipeline
