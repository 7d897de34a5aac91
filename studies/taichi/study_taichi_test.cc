// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/study_taichi.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/check.h"
#include "kinemark/core/units.h"
#include "kinemark/io/osim/osim_model.h"
#include "studies/taichi/landmarks.h"
#include "studies/taichi/least_squares.h"
#include "studies/taichi/subject.h"
#include "studies/taichi/taichi_figures.h"
#include "support/test_data.h"

namespace kinemark::studies {
namespace {

using testing::HasSubstr;

data::ModelDescription human() {
  return io::read_osim(testing_support::project_folder() / "models/human.osim").value();
}

/// The first `frames` frames.
data::Trajectories cut(const data::Trajectories& landmarks, std::int64_t frames) {
  auto out = data::Trajectories::all_missing(
      landmarks.names, {.rate_hz = landmarks.time.rate_hz, .t0_s = landmarks.time.t0_s, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = landmarks.x(f, m);
      out.state[out.index(f, m)] = landmarks.state[landmarks.index(f, m)];
    }
  return out;
}

/// A simulated subject sized by medians, two seconds long, made once.
struct Scene {
  data::Trajectories landmarks;
  data::ModelDescription description;
  model::Model model;
  motion::IkResult ik;
  data::Trajectories made;
};
const Scene& scene() {
  static const Scene kScene = [] {
    auto landmarks = cut(simulate_tai_chi(human(), 3).value().landmarks, 121);
    auto description = scale_by_medians(human(), landmarks, {.lock_unseen = true}).value();
    auto model = model::Model::compile(description).value();
    auto ik = motion::solve_ik(model, landmarks, landmark_ik_options(description)).value();
    auto made = carried_landmarks(model, ik.motion);
    return Scene{.landmarks = std::move(landmarks),
                 .description = std::move(description),
                 .model = std::move(model),
                 .ik = std::move(ik),
                 .made = std::move(made)};
  }();
  return kScene;
}

TEST(LeastSquares, CarriedLandmarksAreWhatItsErrorsSay) {
  const auto& s = scene();
  ASSERT_TRUE(s.made.validate());
  double square = 0.0;
  for (std::int64_t f = 0; f < s.made.frames(); ++f)
    for (std::int64_t m = 0; m < s.made.markers(); ++m)
      square +=
          (s.landmarks.x(f, m) - s.made.x(f, s.made.find(s.landmarks.names[static_cast<std::size_t>(m)])))
              .squaredNorm();
  const double rms = std::sqrt(square / static_cast<double>(s.made.frames() * s.made.markers()));
  EXPECT_NEAR(landmark_rms(s.ik.motion, 0, s.ik.motion.frames()), rms, 1e-9);
  EXPECT_GE(landmark_max(s.ik.motion), rms);
  EXPECT_LT(rms, 0.03);
}

TEST(LeastSquares, OnlyNamedLandmarksCount) {
  const auto& s = scene();
  const std::vector<std::string> two{"RWrist", "LWrist"};
  const auto ik = motion::solve_ik(s.model, s.landmarks, landmark_ik_options(s.description, two)).value();
  EXPECT_EQ(ik.motion.markers.size(), 2U);
  EXPECT_LT(ik.fit.rms_error_m, 1e-4) << "two points are always reached";
}

TEST(LandmarkSets, AreWhatTheyAreCalled) {
  EXPECT_EQ(paper_set().all(), (std::vector<std::string>{"RShoulder", "LWrist", "LElbow", "RWrist"}));
  EXPECT_EQ(pelvis_paper_set().levels.size(), 3U);
  EXPECT_EQ(upper_body_set().all().size(), 12U);
  EXPECT_EQ(upper_body_pelvis_set().all().size(), 15U);
  for (const auto& set : {whole_body_set(), three_level_set()}) {
    auto names = set.all();
    std::vector<std::string> expected(kTaiChiLandmarks.begin(), kTaiChiLandmarks.end());
    std::ranges::sort(names);
    std::ranges::sort(expected);
    EXPECT_EQ(names, expected) << set.name;
  }
}

TEST(Compare, CountsAnglesOfEveryTurnAndLeavesTheRootOut) {
  const auto& s = scene();
  motion::TrackResult tracked;
  tracked.motion = s.ik.motion;
  tracked.rank.assign(static_cast<std::size_t>(tracked.motion.frames()), 30);
  tracked.rank[5] = 29;
  tracked.undetermined_coordinates = {"neck_rotation"};
  tracked.locked_coordinates = {"arm_rot_l"};
  const auto shift = [&](const char* name, double by) {
    for (std::int64_t f = 0; f < tracked.motion.frames(); ++f)
      tracked.motion.q[tracked.motion.index(f, tracked.motion.find(name))] += by;
  };
  shift("pelvis_tilt", 0.5);
  shift("arm_rot_l", 0.5);
  shift("elbow_flex_l", 0.1 + 2.0 * M_PI);
  shift("neck_rotation", 0.4);
  const auto c = compare(s.model, tracked, s.ik, "x");
  // 34 joint coordinates, four locked by the model; what the tracker locks is not determined either.
  EXPECT_EQ(c.coordinates, 30);
  EXPECT_EQ(c.determined, 28);
  EXPECT_NEAR(c.angle_rms_rad, 0.1 / std::sqrt(28.0), 1e-9);
  EXPECT_NEAR(c.angle_max_rad, 0.1, 1e-9);
  EXPECT_NEAR(c.all_angles_rms_rad, std::sqrt((0.01 + 0.16 + 0.25) / 30.0), 1e-9);
  EXPECT_EQ(c.rank_min, 29);
  EXPECT_EQ(c.rank_max, 30);
  EXPECT_NEAR(c.control_rms_m, landmark_rms(s.ik.motion, 60, 121), 1e-12) << "from one second on";
  EXPECT_EQ(c.control_rms_m, c.least_squares_rms_m);
  EXPECT_FALSE(c.failed());
}

TEST(Compare, CountsWhatEquationsAndTruthSay) {
  const auto& s = scene();
  motion::TrackResult tracked;
  tracked.motion = s.ik.motion;
  tracked.rank.assign(static_cast<std::size_t>(tracked.motion.frames()), 36);
  const auto numbers = tracked.motion.q.size();
  tracked.goal_error.assign(numbers, 0.0);
  tracked.goal_bound.assign(numbers, 1e-3);
  const auto elbow = tracked.motion.find("elbow_flex_l");
  for (std::int64_t f = 0; f < tracked.motion.frames(); ++f)
    tracked.motion.q[tracked.motion.index(f, elbow)] += f % 2 == 0 ? 0.5e-3 : 2e-3;
  // From one second on: frames 60 to 120, 30 odd ones; equation 15 says nothing is missing, 16 allows 1 mrad.
  auto c = compare(s.model, tracked, s.ik, "x");
  EXPECT_EQ(c.bounded, 61 * 30);
  EXPECT_EQ(c.held_16, c.bounded - 30);
  EXPECT_EQ(c.held_15, c.bounded - 61);
  EXPECT_TRUE(std::isnan(c.control_truth_rms_rad));
  for (std::int64_t f = 0; f < tracked.motion.frames(); ++f)
    tracked.goal_error[tracked.motion.index(f, elbow)] = -2e-3;
  c = compare(s.model, tracked, s.ik, "x", &s.ik.motion);
  EXPECT_EQ(c.held_15, c.bounded) << "the size counts, in either direction";
  EXPECT_EQ(c.least_squares_truth_rms_rad, 0.0) << "least squares was given as the truth";
  EXPECT_NEAR(c.control_truth_rms_rad, c.angle_rms_rad, 1e-12);
}

TEST(RunControl, FollowsGoalsThatTheModelMade) {
  const auto& s = scene();
  const auto tracked =
      run_control(s.model, s.made, whole_body_set(), {.step_s = 0.002}, first_pose(s.ik.motion));
  ASSERT_TRUE(tracked) << tracked.error().message;
  const auto c = compare(s.model, *tracked, s.ik, "whole body");
  EXPECT_EQ(c.flagged_frames, 0);
  EXPECT_LT(c.control_rms_m, 1e-3);
  EXPECT_EQ(c.rank_max, 36);
  const auto part =
      run_control(s.model, s.made, paper_set(), {.step_s = 0.002, .first_frame = 30, .last_frame = 60},
                  first_pose(s.ik.motion));
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_EQ(part->fit.first_frame, 30);
  EXPECT_EQ(part->motion.frames(), 31);
  EXPECT_LE(*std::ranges::max_element(part->rank), 11) << "elbow and wrist lie on one forearm";
  EXPECT_THROW((void)run_control(s.model, s.made, paper_set(), {}, Eigen::VectorXd::Zero(3)), ContractError);
}

TEST(LandmarkGeometry, HasAsManyNumbersAsThePlanSays) {
  const auto model = with_landmarks(human()).value();
  EXPECT_EQ(landmark_geometry(model, Freedom::none)->size(), 0U);
  EXPECT_EQ(landmark_geometry(model, Freedom::centres)->size(), 72U);
  EXPECT_EQ(landmark_geometry(model, Freedom::positions)->size(), 111U);
}

TEST(FitGeometry, WithoutFreedomOnlySolves) {
  const auto& s = scene();
  const auto fit = fit_geometry(s.description, s.landmarks, Freedom::none, 0, s.landmarks.frames());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->rms_m, landmark_rms(s.ik.motion, 0, 121), 1e-9);
  const double halves = std::sqrt(
      (60.0 * fit->rms_first_m * fit->rms_first_m + 61.0 * fit->rms_second_m * fit->rms_second_m) / 121.0);
  EXPECT_NEAR(halves, fit->rms_m, 1e-9);
}

/// An outcome whose numbers are easy to find again.
TaiChiSubject numbered(double scale) {
  ControlComparison c{.set = "s",
                      .least_squares_rms_m = 0.010,
                      .least_squares_max_m = 0.05,
                      .control_rms_m = 0.010 + 1e-5 * scale,
                      .control_max_m = 0.05,
                      .angle_rms_rad = 0.1 * kRadPerDeg * scale,
                      .control_truth_rms_rad = 4.2 * kRadPerDeg,
                      .least_squares_truth_rms_rad = 4.0 * kRadPerDeg,
                      .bounded = 1000,
                      .held_15 = 1000,
                      .held_16 = 1000,
                      .determined = 30,
                      .coordinates = 30,
                      .rank_min = 11,
                      .rank_max = 11,
                      .free_speeds = 36};
  ControlComparison reached = c;
  reached.control_rms_m = 1e-5 * scale;
  const SetOutcome set{
      .recorded_fine = c, .recorded_coarse = c, .reachable_fine = reached, .reachable_coarse = reached};
  TaiChiSubject out;
  for (auto fit : {&out.medians, &out.centres, &out.positions, &out.clavicle_medians, &out.clavicle_centres,
                   &out.clavicle_positions, &out.held_out, &out.clavicle_held_out})
    *fit = {.rms_m = 0.001 * scale, .rms_first_m = 0.001, .rms_second_m = 0.002};
  out.whole = out.three = out.paper = out.pelvis_paper = out.upper = set;
  out.forearm_min_m = 0.274 - 0.01 * scale;
  out.forearm_max_m = 0.303;
  return out;
}

const StudyRow& row(const std::vector<StudyRow>& rows, std::string_view quantity) {
  const auto at = std::ranges::find(rows, quantity, &StudyRow::quantity);
  if (at == rows.end()) throw std::runtime_error("no row " + std::string(quantity));
  return *at;
}

TEST(TaiChiRows, ShowTheWorstSubjectAndHoldIt) {
  EXPECT_TRUE(taichi_rows({}, true).empty());
  const auto rows = taichi_rows({numbered(1.0), numbered(2.0), numbered(1.5)}, true);
  EXPECT_TRUE(std::ranges::all_of(rows, &StudyRow::pass));
  EXPECT_NEAR(row(rows, "least squares, 21 landmarks: RMS, as scaled by medians").ours, 2.0, 1e-12);
  EXPECT_NEAR(row(rows, "whole body, 1 ms: RMS above that of least squares").ours, 0.02, 1e-9);
  EXPECT_NEAR(*row(rows, "whole body, 1 ms: landmarks to goals, RMS").classic, 10.0, 1e-9);
  EXPECT_NEAR(row(rows, "left elbow to left wrist as recorded, shortest").ours, 254.0, 1e-9);
  EXPECT_EQ(row(rows, "the paper's four landmarks: smallest rank of all frames").at_least, 11.0);
}

TEST(TaiChiRows, FailWhatIsTooMuch) {
  const auto fails = [](auto change, bool recorded = true) {
    TaiChiSubject bad = numbered(1.0);
    change(bad);
    int count = 0;
    for (const auto& r : taichi_rows({numbered(1.0), bad}, recorded)) count += !r.pass();
    return count;
  };
  EXPECT_EQ(fails([](auto&) {}), 0);
  EXPECT_EQ(fails([](auto& s) { s.medians.rms_m = 0.0121; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.medians.rms_m = 0.0121; }, false), 0)
      << "a simulated subject is another one";
  EXPECT_EQ(fails([](auto& s) { s.clavicle_positions.rms_m = 0.0031; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.recorded_fine.angle_rms_rad = 0.6 * kRadPerDeg; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.recorded_coarse.angle_rms_rad = 0.6 * kRadPerDeg; }), 0);
  EXPECT_EQ(fails([](auto& s) { s.whole.reachable_fine.control_rms_m = 6e-5; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.paper.recorded_fine.flagged_frames = 1; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.recorded_fine.held_15 = 999; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.recorded_coarse.held_16 = 999; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.reachable_coarse->held_16 = 999; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.recorded_coarse.control_truth_rms_rad = 4.5 * kRadPerDeg; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.whole.recorded_fine.bounded = s.whole.recorded_fine.held_15 = 0; }), 1)
      << "nothing bounded is no bound that holds";
  EXPECT_EQ(fails([](auto& s) { s.paper.recorded_fine.rank_min = 10; }), 1);
  EXPECT_EQ(fails([](auto& s) { s.paper.recorded_fine.rank_min = 10; }, false), 0) << "a straight right arm";
  EXPECT_EQ(fails([](auto& s) { s.paper.recorded_fine.rank_min = 9; }, false), 1);
  EXPECT_EQ(fails([](auto& s) { s.paper.recorded_fine.rank_max = 12; }), 1) << "a forearm has one length";
  EXPECT_EQ(
      fails([](auto& s) { s.whole.recorded_fine.control_rms_m = std::numeric_limits<double>::quiet_NaN(); }),
      1)
      << "no number is no pass";
}

TEST(TaiChiPage, DrawsEveryFigureAndTheTable) {
  const auto& s = scene();
  TaiChiStudy study;
  study.subjects.push_back(numbered(1.0));
  auto& drawing = study.subjects[0].drawing.emplace();
  drawing.goals = s.landmarks;
  drawing.whole = run_control(s.model, s.landmarks, whole_body_set(),
                              {.step_s = 1.0 / 60.0, .error_bars = true}, first_pose(s.ik.motion))
                      .value();
  drawing.paper = drawing.whole;
  study.table.rows = taichi_rows(study.subjects, false);
  const auto page = taichi_page(study);
  ASSERT_EQ(page.figures.size(), 4U);
  for (int number = 1; number <= 4; ++number) {
    const auto& figure = page.figures[static_cast<std::size_t>(number - 1)];
    EXPECT_EQ(figure.title(), fmt::format("Demircan 2008, figure {}", number));
    EXPECT_THAT(report::figure_svg(figure.figure), testing::Not(HasSubstr("nan"))) << number;
    EXPECT_FALSE(figure.curves.empty()) << number;
  }
  // Largest and smallest are those of equation 16 over the joints of a frame.
  const auto& curves = page.figures[3].curves;
  const auto curve = [&](std::string_view name) {
    return std::ranges::find(curves, name, &FigureCurve::name)->points;
  };
  const auto largest = curve("largest joint error, all 21 landmarks, deg"),
             smallest = curve("smallest joint error, all 21 landmarks, deg");
  const auto elbow = drawing.whole.motion.find("elbow_flex_r");
  for (std::int64_t f = 0; f < drawing.whole.motion.frames(); f += 10) {
    const double error = kDegPerRad * drawing.whole.goal_bound[drawing.whole.motion.index(f, elbow)];
    EXPECT_LE(smallest(f, 1), largest(f, 1));
    EXPECT_GT(smallest(f, 1), 0.0) << "what is held or locked does not count";
    if (!(error > 0.0)) continue;
    EXPECT_LE(error, largest(f, 1) + 1e-12);
    EXPECT_GE(error, smallest(f, 1) - 1e-12);
  }
  EXPECT_THAT(page.description, HasSubstr("Simulated subjects"));
  EXPECT_THAT(page.description, HasSubstr("264 to 303 mm"));
  EXPECT_THAT(study_html(page), HasSubstr("Demircan 2008, figure 4: margins"));
  EXPECT_THROW((void)taichi_page(TaiChiStudy{}), ContractError);
}

TEST(StudyTaiChi, RefusesWhatItCannotStudy) {
  TaiChiJob job{.human = human(), .seeds = {}};
  EXPECT_EQ(study_taichi(job).error().code, Code::usage);
  job.recording = data::Trajectories::all_missing({"A"}, {.rate_hz = 60.0, .frames = 10});
  EXPECT_THAT(study_taichi(job).error().message, HasSubstr("the recording lacks FHead"));
  job.recording = scene().landmarks;
  const auto stopped = study_taichi(job, [](std::int64_t, std::int64_t) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
}

}  // namespace
}  // namespace kinemark::studies
