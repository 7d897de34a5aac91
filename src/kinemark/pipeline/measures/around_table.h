// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Averages around events as files and people see them: in the units of the field.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "kinemark/io/nwb/nwb_tables.h"
#include "kinemark/pipeline/measures/recording_name.h"
#include "kinemark/stages/analysis/around/around.h"

namespace kinemark::pipeline {

/// A tidy table, one bin a row: file, participant, session, trial, events, subject, curve, from_s, to_s
/// (after the event), mean, sd, low, high, level, unit, count, missing, used, outside. Numbers in their
/// shortest form, to the last bit; empty where not determined. RFC 4180.
[[nodiscard]] std::string around_csv(const std::vector<analysis::AroundCurve>& curves,
                                     const analysis::AroundOptions& options, const RecordingName& recording);

/// An object a curve: "events", "subject", "curve", "unit", "used", "outside" and "bins", each "from_s",
/// "to_s", "mean", "sd", "low", "high", "count", "missing"; null where not determined.
[[nodiscard]] nlohmann::ordered_json around_json(const std::vector<analysis::AroundCurve>& curves,
                                                 const analysis::AroundOptions& options);

/// The rows of around_csv() as the DynamicTable `around`.
[[nodiscard]] io::NwbTable around_nwb(const std::vector<analysis::AroundCurve>& curves,
                                      const analysis::AroundOptions& options, const RecordingName& recording);

/// For people, a line a curve: events used, the smallest and the largest mean and when.
[[nodiscard]] std::string around_text(const std::vector<analysis::AroundCurve>& curves,
                                      const analysis::AroundOptions& options);

}  // namespace kinemark::pipeline
