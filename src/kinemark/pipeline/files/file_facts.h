// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "kinemark/core/result.h"

namespace kinemark::pipeline {

/// What a file holds, by its ending.
///
/// Markers (.c3d, .trc, .nwb, .csv, .v3d): points, frames, rate_hz, first_frame, last_frame, units, missing
/// (marker frames), analog_channels, analog_rate_hz, force_plates, labels, warnings. Tables (.mot, .sto):
/// rows, columns, first_time_s, last_time_s, in_degrees, labels, warnings. Models (.osim): name, bodies,
/// joints, coordinates, markers, couplings, point_constraints, mass_kg, labels (of coordinates), body_names,
/// warnings. Recordings (.mcap): end, bytes, messages, channels, metadata, warnings, and of counts also
/// frames, rate_hz, first_time_s, rig, dark_slot, saturated, occluded, lost (sightings), cameras, labels.
/// Every answer has "file" and "kind". rate_hz: for marker files that store none; with 0 their rate is null.
[[nodiscard]] Result<nlohmann::ordered_json> describe_file(const std::filesystem::path& path,
                                                           double rate_hz = 0.0);

/// The same as text, one fact a line.
[[nodiscard]] std::string facts_text(const nlohmann::ordered_json& facts);

}  // namespace kinemark::pipeline
