// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// From the results of all subjects to the rows of the table.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/units.h"
#include "studies/taichi/study_taichi.h"

namespace kinemark::studies {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMostOverTruth = 1.1;
// The paper's four landmarks have 12 coordinates; the left elbow and wrist lie on one forearm, whose length
// is fixed, so that 11 can be moved at will.
constexpr double kMostRank = 11.0;
using Subjects = std::vector<TaiChiSubject>;

/// Largest over subjects; NaN if any is NaN.
template <class Get>
double worst(const Subjects& subjects, double unit, const Get& get) {
  double out = -1e300;
  for (const auto& subject : subjects) {
    const double value = unit * get(subject);
    if (!std::isnan(out) && !(value <= out)) out = value;
  }
  return out;
}

void add_geometry(const Subjects& subjects, bool recorded, std::vector<StudyRow>& rows) {
  struct Line {
    const char* what;
    GeometryFit TaiChiSubject::* fit;
    double most;
  };
  for (const auto& [what, fit, most] :
       {Line{"as scaled by medians", &TaiChiSubject::medians, 12.0},
        {"joints adapted", &TaiChiSubject::centres, 9.0},
        {"joints and landmark positions adapted", &TaiChiSubject::positions, 7.5},
        {"clavicles, as scaled by medians", &TaiChiSubject::clavicle_medians, 7.5},
        {"clavicles, joints adapted", &TaiChiSubject::clavicle_centres, 4.5},
        {"clavicles, joints and landmark positions adapted", &TaiChiSubject::clavicle_positions, 3.0}}) {
    StudyRow row{.quantity = fmt::format("least squares, 21 landmarks: RMS, {}", what),
                 .unit = "mm",
                 .ours = worst(subjects, kMillimetres, [&](auto& s) { return (s.*fit).rms_m; })};
    if (recorded) row.at_most = most;
    rows.push_back(row);
  }
  struct Held {
    const char* what;
    GeometryFit TaiChiSubject::* fit;
  };
  for (const auto& [what, fit] : {Held{"joints adapted", &TaiChiSubject::held_out},
                                  {"clavicles, joints adapted", &TaiChiSubject::clavicle_held_out}})
    for (const bool second : {false, true})
      rows.push_back({.quantity = fmt::format("held out: {} on the first half, RMS of the {} half", what,
                                              second ? "second" : "first"),
                      .unit = "mm",
                      .ours = worst(subjects, kMillimetres, [&](auto& s) {
                        return second ? (s.*fit).rms_second_m : (s.*fit).rms_first_m;
                      })});
}

/// Bounds of one run of control.
struct Asked {
  std::optional<double> over_least_squares_mm, rms_mm, angle_deg;
  bool truth = false, bounds = false;
};

template <class Get>
void add_run(const Subjects& subjects, const std::string& what, const Asked& asked, const Get& run,
             std::vector<StudyRow>& rows) {
  rows.push_back(
      {.quantity = what + ": landmarks to goals, RMS",
       .unit = "mm",
       .classic = worst(subjects, kMillimetres, [&](auto& s) { return run(s).least_squares_rms_m; }),
       .ours = worst(subjects, kMillimetres, [&](auto& s) { return run(s).control_rms_m; }),
       .at_most = asked.rms_mm});
  if (asked.over_least_squares_mm)
    rows.push_back({.quantity = what + ": RMS above that of least squares",
                    .unit = "mm",
                    .ours = worst(subjects, kMillimetres,
                                  [&](auto& s) { return run(s).control_rms_m - run(s).least_squares_rms_m; }),
                    .at_most = asked.over_least_squares_mm});
  rows.push_back(
      {.quantity = what + ": landmarks to goals, largest",
       .unit = "mm",
       .classic = worst(subjects, kMillimetres, [&](auto& s) { return run(s).least_squares_max_m; }),
       .ours = worst(subjects, kMillimetres, [&](auto& s) { return run(s).control_max_m; })});
  if (asked.bounds)
    rows.push_back({.quantity = what + ": determined angles, in frames that determine all",
                    .unit = "%",
                    .ours = -worst(subjects, -100.0, [&](auto& s) {
                      return static_cast<double>(run(s).bounded) / static_cast<double>(run(s).values);
                    })});
  if (asked.bounds)
    for (const bool fifteen : {true, false})
      rows.push_back({.quantity = fmt::format("{}: angles that equation {} bounds against least squares",
                                              what, fifteen ? "15" : "16"),
                      .unit = "%",
                      .ours = -worst(subjects, -100.0,
                                     [&](auto& s) {
                                       const auto& c = run(s);
                                       return static_cast<double>(fifteen ? c.held_15 : c.held_16) /
                                              static_cast<double>(c.bounded);
                                     }),
                      .at_least = 100.0});
  if (asked.truth && std::ranges::none_of(
                         subjects, [&](auto& s) { return std::isnan(run(s).least_squares_truth_rms_rad); })) {
    rows.push_back(
        {.quantity = what + ": determined angles against the truth, RMS",
         .unit = "deg",
         .classic = worst(subjects, kDegPerRad, [&](auto& s) { return run(s).least_squares_truth_rms_rad; }),
         .ours = worst(subjects, kDegPerRad, [&](auto& s) { return run(s).control_truth_rms_rad; })});
    rows.push_back({.quantity = what + ": error against the truth over that of least squares",
                    .unit = "1",
                    .ours = worst(subjects, 1.0,
                                  [&](auto& s) {
                                    return run(s).control_truth_rms_rad / run(s).least_squares_truth_rms_rad;
                                  }),
                    .at_most = kMostOverTruth});
  }
  if (std::ranges::all_of(subjects, [&](auto& s) { return run(s).determined > 0; }))
    rows.push_back({.quantity = what + ": determined angles against least squares, RMS",
                    .unit = "deg",
                    .ours = worst(subjects, kDegPerRad, [&](auto& s) { return run(s).angle_rms_rad; }),
                    .at_most = asked.angle_deg});
  rows.push_back(
      {.quantity = what + ": frames that failed",
       .unit = "1",
       .ours = worst(subjects, 1.0, [&](auto& s) { return static_cast<double>(run(s).flagged_frames); }),
       .at_most = 0.0});
}

template <class Get>
void add_rank(const Subjects& subjects, const std::string& what, double asked, const Get& run,
              std::vector<StudyRow>& rows) {
  StudyRow low{.quantity = what + ": smallest rank of all frames",
               .unit = "1",
               .ours = -worst(subjects, -1.0, [&](auto& s) { return static_cast<double>(run(s).rank_min); })};
  StudyRow high{.quantity = what + ": largest rank of all frames",
                .unit = "1",
                .ours = worst(subjects, 1.0, [&](auto& s) { return static_cast<double>(run(s).rank_max); })};
  if (asked > 0.0) {
    low.at_least = asked;
    high.at_most = kMostRank;
  }
  rows.push_back(low);
  rows.push_back(high);
  rows.push_back(
      {.quantity = what + ": coordinates that the landmarks determine",
       .unit = "1",
       .ours = -worst(subjects, -1.0, [&](auto& s) { return static_cast<double>(run(s).determined); })});
}

}  // namespace

std::vector<StudyRow> taichi_rows(const Subjects& subjects, bool recorded) {
  std::vector<StudyRow> rows;
  if (subjects.empty()) return rows;
  add_geometry(subjects, recorded, rows);
  const auto whole = [](auto& s) -> const SetOutcome& { return s.whole; };
  add_run(
      subjects, "whole body, 1 ms",
      {.over_least_squares_mm = 0.1, .angle_deg = 0.5, .truth = true, .bounds = true},
      [&](auto& s) -> auto& { return whole(s).recorded_fine; }, rows);
  add_run(
      subjects, "whole body, 1/60 s",
      {.over_least_squares_mm = 0.1, .angle_deg = 1.0, .truth = true, .bounds = true},
      [&](auto& s) -> auto& { return whole(s).recorded_coarse; }, rows);
  add_run(
      subjects, "whole body, goals that the model made, 1 ms", {.rms_mm = 0.05, .bounds = true},
      [&](auto& s) -> auto& { return whole(s).reachable_fine; }, rows);
  add_run(
      subjects, "whole body, goals that the model made, 1/60 s", {.rms_mm = 1.0, .bounds = true},
      [&](auto& s) -> auto& { return *whole(s).reachable_coarse; }, rows);
  add_rank(subjects, "whole body", 0.0, [&](auto& s) -> auto& { return whole(s).recorded_fine; }, rows);
  add_run(
      subjects, "three strict levels, 1 ms", {}, [](auto& s) -> auto& { return s.three.recorded_fine; },
      rows);
  add_run(subjects, "upper body, 1 ms", {}, [](auto& s) -> auto& { return s.upper.recorded_fine; }, rows);
  add_run(
      subjects, "the paper's four landmarks, 1 ms", {},
      [](auto& s) -> auto& { return s.paper.recorded_fine; }, rows);
  // Elbow and wrist of the left arm lie on one forearm: 11 of 12. A straight right arm holds its shoulder and
  // wrist apart, too; that of the recording never is, a simulated one may be.
  add_rank(
      subjects, "the paper's four landmarks", recorded ? 11.0 : 10.0,
      [](auto& s) -> auto& { return s.paper.recorded_fine; }, rows);
  add_run(
      subjects, "pelvis, then the paper's four, 1 ms", {},
      [](auto& s) -> auto& { return s.pelvis_paper.recorded_fine; }, rows);
  add_rank(
      subjects, "pelvis, then the paper's four", 0.0,
      [](auto& s) -> auto& { return s.pelvis_paper.recorded_fine; }, rows);
  rows.push_back({.quantity = "left elbow to left wrist as recorded, shortest",
                  .unit = "mm",
                  .ours = -worst(subjects, -kMillimetres, [](auto& s) { return s.forearm_min_m; })});
  rows.push_back({.quantity = "left elbow to left wrist as recorded, longest",
                  .unit = "mm",
                  .ours = worst(subjects, kMillimetres, [](auto& s) { return s.forearm_max_m; })});
  return rows;
}

}  // namespace kinemark::studies
