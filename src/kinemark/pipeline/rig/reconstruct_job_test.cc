// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/reconstruct_json.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/simulate/simulate_rig_job.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A signing arm before a known rig, written once for all tests.
class RunReconstruct : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new testing_support::ScratchFolder;
    SimulateRigJob job;
    job.folder = *scratch_ / "lab";
    job.scene = RigSceneKind::sign;
    job.duration_s = 0.5;
    job.occlusions = {"hand:B:10-14"};
    run_simulate_rig(job).value();
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }
  static fs::path at(const std::string& name) { return *scratch_ / name; }
  static ReconstructJob job(const std::string& output, ReconstructJob::Method method) {
    ReconstructJob out;
    out.recording = at("lab/recording.mcap");
    out.rig = at("lab/rig_true.toml");
    out.output = at(output);
    out.method = method;
    return out;
  }
  /// RMS distance to the truth over the samples that both cameras saw, mm; and how many there are, bridged
  /// ones too.
  static std::pair<double, std::int64_t> error_of(const fs::path& file) {
    const auto points = io::read_markers(file).value().markers;
    const auto truth = io::read_markers(at("lab/truth.trc")).value().markers;
    double squares = 0.0;
    std::int64_t n = 0, seen = 0;
    for (std::int64_t f = 0; f < points.frames(); ++f)
      for (std::int64_t m = 0; m < points.markers(); ++m) {
        if (!points.present(f, m)) continue;
        ++n;
        if (points.names[static_cast<std::size_t>(m)] == "hand" && f >= 10 && f <= 14) continue;  // occluded
        ++seen;
        squares += (points.x(f, m) - truth.x(f, truth.find(points.names[static_cast<std::size_t>(m)])))
                       .squaredNorm();
      }
    return {1e3 * std::sqrt(squares / static_cast<double>(seen)), n};
  }

 private:
  static inline testing_support::ScratchFolder* scratch_ = nullptr;
};

TEST_F(RunReconstruct, FramesAloneFindThePointsThatTwoCamerasSee) {
  const auto outcome = run_reconstruct(job("frames.csv", ReconstructJob::Method::frames));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->frames, 50);
  EXPECT_THAT(outcome->written, ElementsAre(at("frames.csv")));
  EXPECT_TRUE(outcome->fits.empty());
  ASSERT_EQ(outcome->leds.size(), 4U);
  for (const auto& led : outcome->leds) {
    EXPECT_EQ(led.frames, 50);
    EXPECT_EQ(led.occluded, led.name == "hand" ? 5 : 0) << led.name;
    EXPECT_EQ(led.located + led.occluded + led.saturated + led.inconsistent, 50) << led.name;
  }
  const auto [rms_mm, points] = error_of(at("frames.csv"));
  EXPECT_EQ(points, 195);
  EXPECT_LT(rms_mm, 5.0) << "the LEDs of a frame shine one after the other, while the arm moves";
}

TEST_F(RunReconstruct, TheSmootherBridgesAndTellsHowItSmoothed) {
  const auto outcome = run_reconstruct(job("smooth.csv", ReconstructJob::Method::smoother));
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->fits.size(), 4U);
  for (const auto& fit : outcome->fits) {
    EXPECT_GT(fit.bandwidth.cutoff_hz, 0.0);
    EXPECT_NEAR(fit.chi2_per_dof, 1.0, 0.5) << fit.name;
  }
  const auto [rms_mm, points] = error_of(at("smooth.csv"));
  EXPECT_EQ(points, 200) << "the hidden frames are bridged";
  ASSERT_TRUE(run_reconstruct(job("alone.csv", ReconstructJob::Method::frames)));
  EXPECT_LT(rms_mm, error_of(at("alone.csv")).first) << "nearer to the truth than frame by frame";
}

TEST_F(RunReconstruct, AnyNumberOfThreadsGivesTheSameFile) {
  auto one = job("one.csv", ReconstructJob::Method::smoother);
  auto two = job("two.csv", ReconstructJob::Method::smoother);
  two.threads = 2;
  ASSERT_TRUE(run_reconstruct(one));
  ASSERT_TRUE(run_reconstruct(two));
  EXPECT_EQ(io::read_text(at("one.csv")).value(), io::read_text(at("two.csv")).value());
}

TEST_F(RunReconstruct, RefusesWhatDoesNotFitAndWritesNothing) {
  auto wrong = job("none.csv", ReconstructJob::Method::frames);
  wrong.recording = at("lab/none.mcap");
  EXPECT_EQ(run_reconstruct(wrong).error().code, Code::io);
  wrong = job("none.csv", ReconstructJob::Method::frames);
  wrong.rig = at("lab/truth.trc");
  EXPECT_EQ(run_reconstruct(wrong).error().code, Code::bad_input);
  wrong = job("none.csv", ReconstructJob::Method::frames);
  wrong.frames.dim_share = -1.0;
  EXPECT_FALSE(run_reconstruct(wrong));
  wrong = job("none.xyz", ReconstructJob::Method::frames);
  EXPECT_EQ(run_reconstruct(wrong).error().code, Code::usage);
  EXPECT_FALSE(fs::exists(at("none.csv")));
  auto again = job("mine.csv", ReconstructJob::Method::frames);
  ASSERT_TRUE(io::write_text(at("mine.csv"), "mine", false));
  EXPECT_EQ(run_reconstruct(again).error().code, Code::io) << "nothing is replaced unasked";
  EXPECT_EQ(io::read_text(at("mine.csv")).value(), "mine");
  again.force = true;
  EXPECT_TRUE(run_reconstruct(again));
}

TEST(ReconstructJson, HasTheFitOnlyWhereThereIsOne) {
  ReconstructOutcome outcome;
  outcome.method = ReconstructJob::Method::classic;
  outcome.frames = 7;
  outcome.written = {"p.csv"};
  outcome.warnings = {"odd"};
  outcome.leds = {{.name = "hand", .frames = 7, .located = 5, .occluded = 2}};
  EXPECT_EQ(reconstruct_json(outcome).dump(),
            R"({"method":"classic","frames":7,"written":"p.csv","warnings":["odd"],"leds":[{"name":"hand",)"
            R"("frames":7,"located":5,"occluded":2,"saturated":0,"inconsistent":0,"near_edge":0}]})");
  outcome.fits.emplace_back().chi2_per_dof = 1.5;
  outcome.fits[0].bandwidth.order = 3;
  outcome.fits[0].flicker_counts = {0.5, 0.25};
  const auto led = reconstruct_json(outcome)["leds"][0];
  EXPECT_EQ(led["order"], 3);
  EXPECT_EQ(led["chi2_per_dof"], 1.5);
  EXPECT_EQ(led["flicker_counts"], nlohmann::json({0.5, 0.25}));
}

}  // namespace
}  // namespace kinemark::pipeline
