// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_job.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/pipeline/simulate/simulate_rig_job.h"
#include "kinemark/pipeline/testing/shared_folder.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
namespace fs = std::filesystem;

/// A signing arm before a known rig, written once for all tests.
class RunReconstruct : public testing::SharedFolder<RunReconstruct> {
 public:
  static void make_files() {
    SimulateRigJob job;
    job.folder = at("lab");
    job.scene = RigSceneKind::sign;
    job.duration_s = 0.5;
    job.occlusions = {"hand:B:10-14"};
    run_simulate_rig(job).value();
  }

 protected:
  static ReconstructJob job(const std::string& output, workflow::ReconstructMethod method) {
    ReconstructJob out;
    out.recording = at("lab/recording.mcap");
    out.rig = at("lab/rig_true.toml");
    out.output = at(output);
    out.options.method = method;
    return out;
  }
  /// Distances to the truth over the samples that both cameras saw, RMS, mm.
  struct Misses {
    double found_mm = 0.0, stated_mm = 0.0;  ///< by the truth; by the covariances of the file
    std::int64_t points = 0;                 ///< bridged ones too
  };
  /// `at_slots`: a frame's points are where each LED was in its own slot, not at the time of the frame.
  static Misses misses_of(const fs::path& file, bool at_slots) {
    const auto points = io::read_markers(file).value().markers;
    const auto truth = io::read_markers(at("lab/truth.trc")).value().markers;
    const auto rates = io::read_table(at("lab/truth_derivatives.sto")).value();
    const auto recording = io::read_counts(at("lab/recording.mcap")).value();
    const double delay_s = io::read_rig(at("lab/rig_true.toml")).value().electronics.time_constant_s;
    Misses out;
    double squares = 0.0, variances = 0.0, seen = 0.0;
    for (std::int64_t f = 0; f < points.frames(); ++f)
      for (std::int64_t m = 0; m < points.markers(); ++m) {
        if (!points.present(f, m)) continue;
        ++out.points;
        const std::string& name = points.names[static_cast<std::size_t>(m)];
        if (name == "hand" && f >= 10 && f <= 14) continue;  // occluded
        seen += 1.0;
        variances += math::symmetric3_trace(points.covariance.data() + 6 * points.index(f, m));
        const auto led = truth.find(name);
        Eigen::Vector3d x = truth.x(f, led);
        if (at_slots) {
          double dt = -delay_s;
          for (std::int64_t c = 0; c < 2; ++c) dt += 0.5 * recording.counts.offset_s(led, c).mean();
          for (int axis = 0; axis < 3; ++axis) {
            const std::string of(1, "xyz"[axis]);
            x[axis] += dt * rates(f, rates.find(name + "_v" + of)) +
                       0.5 * dt * dt * rates(f, rates.find(name + "_a" + of));
          }
        }
        squares += (points.x(f, m) - x).squaredNorm();
      }
    out.found_mm = 1e3 * std::sqrt(squares / seen);
    out.stated_mm = 1e3 * std::sqrt(variances / seen);
    return out;
  }
};

TEST_F(RunReconstruct, FramesAloneFindThePointsThatTwoCamerasSee) {
  const auto outcome = run_reconstruct(job("frames.csv", workflow::ReconstructMethod::frames));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->frames, 50);
  EXPECT_THAT(outcome->written, ElementsAre(at("frames.csv")));
  EXPECT_TRUE(outcome->found.fits.empty());
  ASSERT_EQ(outcome->found.leds.size(), 4U);
  for (const auto& led : outcome->found.leds) {
    EXPECT_EQ(led.frames, 50);
    EXPECT_EQ(led.occluded, led.name == "hand" ? 5 : 0) << led.name;
    EXPECT_EQ(led.located + led.occluded + led.saturated + led.inconsistent, 50) << led.name;
  }
  // The mean square of 195 x 3 coordinates has an SD of sqrt(2 / 585), 6 % of itself; four of these on both
  // sides. A frame counts the room's flicker (0.5 counts^2 beside 1.26 of noise) as noise of each channel.
  // Being the same in all four, it goes with the strength where the light is in the middle: from 0.72 to 1 of
  // what is stated.
  const Misses misses = misses_of(at("frames.csv"), true);
  EXPECT_EQ(misses.points, 195);
  EXPECT_GT(std::pow(misses.found_mm / misses.stated_mm, 2), 0.72 * 0.76);
  EXPECT_LT(std::pow(misses.found_mm / misses.stated_mm, 2), 1.24);
  EXPECT_GT(misses_of(at("frames.csv"), false).found_mm, 2.0 * misses.found_mm)
      << "the LEDs of a frame shine one after the other, while the arm moves";
}

TEST_F(RunReconstruct, TheSmootherBridgesAndTellsHowItSmoothed) {
  const auto outcome = run_reconstruct(job("smooth.csv", workflow::ReconstructMethod::smoother));
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->found.fits.size(), 4U);
  for (const auto& fit : outcome->found.fits) {
    EXPECT_GT(fit.bandwidth.cutoff_hz, 0.0);
    EXPECT_NEAR(fit.chi2_per_dof, 1.0, 0.5) << fit.name;
  }
  // Errors of a path are alike over the filter's memory: 0.5 s of four LEDs on three axes hold about 2 * 0.5
  // s * cut-off * 12 independent ones, 100 at 8 Hz, whose mean square has an SD of sqrt(2 / 100) of itself;
  // three.
  const Misses misses = misses_of(at("smooth.csv"), false);
  EXPECT_EQ(misses.points, 200) << "the hidden frames are bridged";
  EXPECT_NEAR(std::pow(misses.found_mm / misses.stated_mm, 2), 1.0, 0.42);
  ASSERT_TRUE(run_reconstruct(job("alone.csv", workflow::ReconstructMethod::frames)));
  EXPECT_LT(misses.found_mm, misses_of(at("alone.csv"), true).stated_mm) << "surer than frame by frame";
}

TEST_F(RunReconstruct, AnyNumberOfThreadsGivesTheSameFile) {
  auto one = job("one.csv", workflow::ReconstructMethod::smoother);
  auto two = job("two.csv", workflow::ReconstructMethod::smoother);
  two.threads = 2;
  ASSERT_TRUE(run_reconstruct(one));
  ASSERT_TRUE(run_reconstruct(two));
  EXPECT_EQ(io::read_text(at("one.csv")).value(), io::read_text(at("two.csv")).value());
}

TEST_F(RunReconstruct, RefusesWhatDoesNotFitAndWritesNothing) {
  auto wrong = job("none.csv", workflow::ReconstructMethod::frames);
  wrong.recording = at("lab/none.mcap");
  EXPECT_EQ(run_reconstruct(wrong).error().code, Code::io);
  wrong = job("none.csv", workflow::ReconstructMethod::frames);
  wrong.rig = at("lab/truth.trc");
  EXPECT_EQ(run_reconstruct(wrong).error().code, Code::bad_input);
  wrong = job("none.csv", workflow::ReconstructMethod::frames);
  wrong.options.frames.dim_share = -1.0;
  EXPECT_FALSE(run_reconstruct(wrong));
  wrong = job("none.xyz", workflow::ReconstructMethod::frames);
  EXPECT_EQ(run_reconstruct(wrong).error().code, Code::usage);
  EXPECT_FALSE(fs::exists(at("none.csv")));
  auto again = job("mine.csv", workflow::ReconstructMethod::frames);
  ASSERT_TRUE(io::write_text(at("mine.csv"), "mine", false));
  EXPECT_EQ(run_reconstruct(again).error().code, Code::io) << "nothing is replaced unasked";
  EXPECT_EQ(io::read_text(at("mine.csv")).value(), "mine");
  again.force = true;
  EXPECT_TRUE(run_reconstruct(again));
}

TEST(ReconstructJson, HasTheFitOnlyWhereThereIsOne) {
  ReconstructOutcome outcome;
  outcome.method = workflow::ReconstructMethod::classic;
  outcome.frames = 7;
  outcome.written = {"p.csv"};
  outcome.warnings = {"odd"};
  outcome.found.leds = {{.name = "hand", .frames = 7, .located = 5, .occluded = 2}};
  EXPECT_EQ(reconstruct_json(outcome).dump(),
            R"({"method":"classic","frames":7,"written":"p.csv","warnings":["odd"],"leds":[{"name":"hand",)"
            R"("frames":7,"located":5,"occluded":2,"saturated":0,"inconsistent":0,"near_edge":0}]})");
  outcome.found.lights.emplace_back();
  EXPECT_EQ(reconstruct_json(outcome)["leds"][0]["light"], nullptr) << "unknown is not 1";
  outcome.found.lights[0] = {.source = reconstruction::LightSource::turning,
                             .light = 0.5,
                             .light_sd = 0.05,
                             .strength_counts = {800.0, 900.0},
                             .seen = {}};
  const auto lit = reconstruct_json(outcome)["leds"][0];
  EXPECT_EQ(lit["light"], 0.5);
  EXPECT_EQ(lit["light_sd"], 0.05);
  EXPECT_EQ(lit["light_source"], "turning");
  EXPECT_EQ(lit["strength_counts"], nlohmann::json({800.0, 900.0}));
  outcome.found.fits.emplace_back().chi2_per_dof = 1.5;
  outcome.found.fits[0].bandwidth.order = 3;
  outcome.found.fits[0].flicker_counts = {0.5, 0.25};
  const auto led = reconstruct_json(outcome)["leds"][0];
  EXPECT_EQ(led["order"], 3);
  EXPECT_EQ(led["chi2_per_dof"], 1.5);
  EXPECT_EQ(led["flicker_counts"], nlohmann::json({0.5, 0.25}));
}

}  // namespace
}  // namespace kinemark::pipeline
