// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/time_base.h"
#include "kinemark/data/filter_used.h"
#include "kinemark/io/nwb/internal/output.h"

namespace kinemark::io::internal {

/// What the table of markers says of M markers.
struct MarkerTable {
  std::vector<std::string> names;           ///< M
  std::vector<std::string> series_names;    ///< M, as Position calls them
  TimeBase time;                            ///< of all
  std::optional<std::int64_t> first_frame;  ///< its number; none: not known
  std::vector<double> offset_s;             ///< M, or empty where markers have none of their own
  std::vector<data::FilterUsed> filters;    ///< M, or empty
};

/// Write it as the table `markers` of the module.
void write_marker_table(Output& out, hid_t module, const MarkerTable& table);

}  // namespace kinemark::io::internal
