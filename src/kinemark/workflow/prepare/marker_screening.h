// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the recorder spoiled or made of a recording, found and dealt with as a job says, before anything is
// estimated from it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/upsampling.h"

namespace kinemark::workflow {

/// What becomes of samples that the recorder interpolated.
enum class RecorderMade : std::uint8_t {
  keep,      ///< told, not touched
  mark,      ///< their state becomes `upsampled`
  missing,   ///< only real samples stay
  decimate,  ///< real samples at the rate at which they were taken
};

[[nodiscard]] std::string_view to_string(RecorderMade made);  ///< "keep", "mark", "missing", "decimate"
/// The choice of that name; the failure lists all names.
[[nodiscard]] Result<RecorderMade> parse_recorder_made(std::string_view name);

/// Points of a recording that are no markers, as indices of its markers, rising.
struct PointsApart {
  std::vector<std::int64_t> computed;  ///< that a model made of markers, and middles of two of them
  std::vector<std::int64_t> unnamed;   ///< that nobody named (data::is_unlabelled())

  /// Both, rising.
  [[nodiscard]] std::vector<std::int64_t> all() const;
  /// "36 computed points (PELO, PELA, ...) and 2 without a name"; empty where there are none.
  [[nodiscard]] std::string describe(const std::vector<std::string>& names) const;
};

/// Which points of a recording are no markers. Computed ones are known by their names (joint centres, axes'
/// ends, angles: skeleton::find_model_outputs()), or by being, in every frame that shows all three, the
/// middle of two markers that move against each other. None where no other marker is left: who selects such
/// points alone asks for them. O(F M + M^3).
[[nodiscard]] PointsApart find_points_apart(const data::Trajectories& markers);

/// What to look for in a recording, and what to do about it.
struct ScreeningRules {
  bool find_upsampling = true;                      ///< look for samples that the recorder made
  RecorderMade recorder_made = RecorderMade::keep;  ///< what becomes of them
  bool find_defects = true;                         ///< look for defects
  bool exchange_back = false;  ///< markers that surely carry each other's label get their own
  std::vector<std::pair<std::string, std::string>> swapped =
      {};  ///< those that edits swap: a person has decided, and they stay as they are
  std::vector<std::int64_t> apart = {};  ///< points that are no markers (PointsApart): no defect is theirs
  bool reject_defects = false;           ///< those that are sure become `rejected`
  double sure = 0.8;  ///< confidence, 0 to 1; clock jumps have no wrong samples and are never sure
  /// Share of all samples. Where sure defects take more, nothing is rejected: a recording that breaks its
  /// paths everywhere has no paths, its frames are poses of their own.
  double most_rejected = std::numeric_limits<double>::infinity();
  bool made_first =
      false;  ///< look for defects in what is left once the recorder's own samples are dealt with
};

/// What was noticed in a recording and what was done about it.
struct Screening {
  std::vector<data::Finding> defects;    ///< all defects
  std::vector<data::Finding> sure;       ///< those that reject_defects is about
  std::vector<data::Finding> exchanged;  ///< label swaps that were exchanged back; none of `sure`
  std::vector<data::Finding> edited;     ///< sure label swaps that stay, as edits have them; none of `sure`
  double sure_share = 0.0;               ///< of all samples
  bool rejected = false;                 ///< the sure ones were
  std::optional<data::UpsamplingAccount> upsampling;  ///< when looked for
  std::int64_t made_left_out = 0;  ///< samples that are not present any more because the recorder made them
  std::vector<std::string> warnings;  ///< what had to go with the old frames
};

/// Look for defects and for interpolation, and change the trial's markers as the rules say. Where frames
/// change (RecorderMade::decimate) what belongs to the old ones is left out, with a warning. Fails as
/// trajectory::screen(), detect_upsampling() and keep_real_samples().
[[nodiscard]] Result<Screening> screen_markers(data::Trial& trial, const ScreeningRules& rules);

/// Of how many frames one was measured, where the others were made between those; 1: no frame was. Looks at
/// 2,048 frames of 12 markers. Fails as trajectory::detect_upsampling().
[[nodiscard]] Result<int> made_factor(const data::Trajectories& markers);

/// That the recorder made frames between those that it measured, and at what rate it measured; empty where
/// none are seen. As made_factor().
[[nodiscard]] Result<std::string> note_on_upsampling(const data::Trajectories& markers);

/// A sentence on each label swap that was exchanged back, and on each that stays, as edits have it.
[[nodiscard]] std::vector<std::string> swap_sentences(const Screening& screening, const TimeBase& time);

/// For what counts measured samples alone: marks what the recorder made, exchanges back and rejects what
/// screening is sure of unless `keep_defects`, and adds what was exchanged and
/// left out to the warnings: five sentences, then how many more.
/// @param swapped  markers that edits swap (ScreeningRules)
[[nodiscard]] Status leave_out_defects(data::Trial& trial, bool keep_defects,
                                       const std::vector<std::pair<std::string, std::string>>& swapped,
                                       std::vector<std::string>& warnings);

/// The markers of each frame at its own time, where they were measured one after another
/// (Trajectories::sample_offset_s, as of LEDs that shine in turns): a body's markers have one pose only at
/// one time. Each sample becomes the cubic through the two before that time and the two behind it, with the
/// covariance of these; a sample without another beside it becomes missing. Markers that have the same
/// instant in each frame stay as they are. O(samples).
/// @return one sentence on what was done; empty where nothing was
[[nodiscard]] std::string bring_to_one_time(data::Trajectories& markers);

}  // namespace kinemark::workflow
