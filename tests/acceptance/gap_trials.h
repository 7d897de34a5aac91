// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The real trials of the gap protocol: physical markers only, at most 20 s.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/data/trajectories.h"

namespace kinemark::testing_support {

struct GapTrial {
  std::string file;
  data::Trajectories markers;
};

/// The 23 trials, in order, as paths below the data folder.
[[nodiscard]] const std::vector<std::string>& gap_trial_files();
/// Markers without what a vendor's model made (joint centres, angles, forces: exact functions of the markers,
/// which would leak the answer), seen in 30 % of the frames or more. At most 2400 frames, from a place that
/// the seed decides, or from the start.
[[nodiscard]] GapTrial load_gap_trial(const std::filesystem::path& data, const std::string& file,
                                      std::int64_t max_frames, std::uint64_t seed, bool from_start);

/// Segment of a marker from the data: a set (of at most six, the marker first) whose mutual distances
/// have SDs below 10 mm.
[[nodiscard]] std::vector<std::int64_t> find_segment(const data::Trajectories& markers, std::int64_t marker);

/// Every sample of [first, end) is present.
[[nodiscard]] bool complete(const data::Trajectories& markers, std::int64_t marker, std::int64_t first,
                            std::int64_t end);

}  // namespace kinemark::testing_support
