// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/io/nwb/internal/input.h"

namespace kinemark::io::internal {

/// One series of positions in a file, which becomes a marker.
struct PositionSeries {
  std::string marker;
  std::string path;
  int width = 3;  ///< coordinates
  double metres_per_number = 1.0, metres_offset = 0.0;
  TimeBase time;
  Array<double> stamps_s;  ///< F times when they are uneven, else empty
  std::string reference_frame;
};

/// The markers of a file, on one clock.
struct PositionGroup {
  std::vector<PositionSeries> series;  ///< one or more
  std::vector<std::string>
      series_names;        ///< of files that we wrote: how a series is called in every container
  Array<double> offset_s;  ///< of files that we wrote, where every marker has its own
  std::vector<std::string> warnings;

  [[nodiscard]] bool ours() const { return !series_names.empty(); }
};

/// Find the positions of a file: by the table of markers that we write, else by walking over all groups.
/// Messages do not name the file.
[[nodiscard]] Result<PositionGroup> find_positions(Input& in);

}  // namespace kinemark::io::internal
