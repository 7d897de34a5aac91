// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Is a still recording fit to build on? Every marker and every pair is asked whether it explains what a body
// cannot be: one marker elsewhere, two exchanged. Theory: docs/theory/foundations.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::motion {

struct StandingBody;

/// Options of judge_foundation().
struct FoundationOptions {
  double least_score = 12.0;  ///< of a finding: twice the log of how much likelier it makes the recording
  double least_score_beside = 5.0;  ///< of a single marker beside a movement, which tells its place
  /// Of a single marker: fall of the cost by the spreads as they are. The score alone accuses clean subjects
  /// whose markers lie better than the spreads say.
  double least_fall = 8.0;
  double least_fall_beside = 4.0;  ///< beside a movement
  double still_sd_m = 0.003;       ///< of a marker in the still frame, per axis
  double moving_sd_m = 0.006;      ///< of a marker on its segment in a movement, per axis: soft tissue
  double between_sd_m = 0.004;     ///< of a marker between two recordings, per axis
  int moving_frames = 6;           ///< of each movement, evenly picked
  int most_findings = 4;           ///< of one recording

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

/// Which of two recordings that contradict each other holds a mistake.
enum class MistakeIn : std::uint8_t { still, movement, either };

/// A marker that lies elsewhere, or a pair that is exchanged.
struct FoundationFinding {
  std::string marker;   ///< as in the recording
  std::string partner;  ///< exchanged with it; empty: the marker lies elsewhere
  Eigen::Vector3d shift_m =
      Eigen::Vector3d::Zero();  ///< seen less expected: forward, up, to the right of the body
  Eigen::Vector3d shift_sd_m = Eigen::Vector3d::Zero();  ///< 1 SD of each
  double score = 0.0;                                    ///< as FoundationOptions::least_score
  bool by_movement = false;            ///< movements show it; the still recording alone does not
  MistakeIn where = MistakeIn::still;  ///< of one by_movement: what each recording by itself tells
  std::vector<std::string> rivals;     ///< other explanations that are nearly as likely, in words
};

/// What is known of a still recording.
struct FoundationJudgement {
  std::vector<FoundationFinding> findings;  ///< likeliest first
  std::vector<std::string> judged;          ///< markers that were asked
  std::int64_t frame = -1;                  ///< middle of the stillest part, which was judged; -1: none
  int movements = 0;                        ///< recordings that it was compared with
  double seen_at_50_mm = 0.0;  ///< share of single markers and directions in which 50 mm would be a finding
  bool mirrored = false;       ///< its mirror image shows the body; findings are that image's
};

/// Judge the stillest part of a recording against a body, and against movements of the same session, in which
/// markers keep their places on the segments. Markers of the body that the recording lacks take no part;
/// fewer than six, or on fewer than two segments: nothing is judged. About 0.2 s for 40 markers, a second
/// where something is wrong.
[[nodiscard]] Result<FoundationJudgement> judge_foundation(
    const StandingBody& body, const data::Trajectories& still,
    std::span<const data::Trajectories* const> movements, const FoundationOptions& options = {});

/// Pairs of pelvis and legs that are exchanged throughout a recording in which somebody moves:
/// FoundationOptions::moving_frames frames are asked, and the score is the mean over them. Singles are not
/// asked, as a posture may explain them. Fails where the options do.
[[nodiscard]] Result<std::vector<FoundationFinding>> judge_movement(const StandingBody& body,
                                                                    const data::Trajectories& movement,
                                                                    const FoundationOptions& options = {});

/// Which of two bodies a recording in which somebody moves shows: the one of its names, or that of two of
/// them exchanged throughout. Mean score over FoundationOptions::moving_frames frames that see both, of what
/// moves with them (pelvis and legs, or all): above 0 the exchange explains more, below 0 the names as they
/// are. Nothing where one of the two is no landmark, both are of one cluster, or fewer than six are seen; the
/// mirror image is asked where that shows the body. About 20 ms.
[[nodiscard]] std::optional<double> score_exchange(const StandingBody& body,
                                                   const data::Trajectories& movement, const std::string& one,
                                                   const std::string& other,
                                                   const FoundationOptions& options = {});

/// Whether the mirror image of a recording of any movement shows the body, and the recording does not: in
/// most of three evenly picked frames. False where fewer than six markers of the body are seen. About 0.1 s.
[[nodiscard]] bool shows_mirrored_body(const StandingBody& body, const data::Trajectories& recording);

/// "cal.c3d shows a mirrored body: ...", with the causes that look alike.
[[nodiscard]] std::string describe_mirrored(const std::string& recording);

/// "LTOE and LHEE are exchanged in the static trial" or "LKNE lies 52 mm (SD 8) from where it should in the
/// static trial: 48 mm forward, 20 mm down", with the rivals.
[[nodiscard]] std::string describe(const FoundationFinding& finding, const std::string& recording);

}  // namespace kinemark::motion
