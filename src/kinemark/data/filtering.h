// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is known of the filter that markers went through: marked on the samples, told in words, taken back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kinemark/data/trajectories.h"

namespace kinemark::data {

/// True where a filter is named: neither nothing nor "none".
[[nodiscard]] bool is_filter(const FilterUsed& used);

/// True when the recording says that this marker went through a filter.
[[nodiscard]] bool was_filtered(const Trajectories& t, std::int64_t marker);

/// True when a sample of this marker from before its filter is there.
[[nodiscard]] bool keeps_unfiltered(const Trajectories& t, std::int64_t marker);

/// Name of the method of measured samples that a filter changed: "smoothed by kalman".
[[nodiscard]] std::string smoothed_by(std::string_view filter);

/// Note on every measured sample of a marker that a filter changed it. A method that was there stays before
/// it ("edited, smoothed by kalman"); samples that were made keep theirs.
void mark_smoothed(Trajectories& t, std::int64_t marker, std::string_view filter);

/// What two filters one after the other are: both names, the lower cut-off, the later order. Which noise went
/// into the first is not known then.
[[nodiscard]] FilterUsed one_after_other(const FilterUsed& first, const FilterUsed& then);

/// The samples as they were before their filter, where all filtered markers have them: what is not among them
/// becomes missing (rejected stays so), and filters, the names of smoothed samples and covariances, which
/// were those of smoothed ones, go.
/// @return false, and nothing is changed, where no marker was filtered or one has no samples from before
bool restore_unfiltered(Trajectories& t);

/// One sentence: how many markers were filtered, by what, and whether the samples from before are there;
/// empty where none was. "2 of 3 markers were smoothed by kalman (order 5, -3 dB at 6.4 to 9.1 Hz; noise
/// before it 0.21 to 0.4 mm); the samples from before are kept beside them".
[[nodiscard]] std::string describe_filters(const Trajectories& t);

/// What to know where noise is found from the samples: that it is that of smoothed ones; empty where no
/// marker was filtered.
[[nodiscard]] std::string note_on_noise(const Trajectories& t);

}  // namespace kinemark::data
