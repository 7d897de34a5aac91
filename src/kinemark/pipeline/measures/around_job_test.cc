// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/around_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/nwb.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A session of 10 s at 100 Hz: one marker swings, one unit fires each second.
class AroundJobTest : public ::testing::Test {
 protected:
  void SetUp() override { write("s.nwb", 1000); }

  void write(const char* name, std::int64_t frames) {
    auto markers = data::Trajectories::all_missing({"hand"}, {.rate_hz = 100.0, .frames = frames});
    for (std::int64_t f = 0; f < frames; ++f) {
      markers.x(f, 0) = Eigen::Vector3d(0.2 * std::sin(0.0628318530718 * static_cast<double>(f)), 0.0, 1.0);
      markers.state[markers.index(f, 0)] = data::SampleState::measured;
    }
    data::Neural neural;
    neural.units = {{.id = "1", .labels = {}, .times_s = {}}};
    for (double t = 0.5; t < 0.01 * static_cast<double>(frames); t += 1.0)
      neural.units[0].times_s.push_back(t);
    if (neural.units[0].times_s.empty()) neural.units[0].times_s = {0.005};
    auto writer = io::NwbWriter::create(scratch_ / name, io::NwbOutline::of(markers, nullptr));
    ASSERT_TRUE(writer && writer->write(markers) && writer->write_neural(neural, {}) && writer->commit());
  }
  [[nodiscard]] AroundJob job() const {
    AroundJob out;
    out.input = scratch_ / "s.nwb";
    out.what = "units";
    out.from_s = -0.1;
    out.to_s = 0.1;
    out.bin_s = 0.1;
    return out;
  }

  testing_support::ScratchFolder scratch_;
};

TEST_F(AroundJobTest, AveragesPositionsAndSpeeds) {
  const auto out = run_around(job());
  ASSERT_TRUE(out) << out.error().message;
  ASSERT_EQ(out->curves.size(), 4U);
  EXPECT_EQ(out->curves[3].id, "speed");
  // The swing has a period of 1 s: at each spike the phase is the same, 0.5 s, where the speed is largest.
  EXPECT_NEAR(out->curves[3].bins[0].mean, 0.2 * 6.28318530718 * std::sin(0.628318530718) / 0.628318530718,
              0.02);
  EXPECT_NEAR(out->curves[0].bins[0].mean, -out->curves[0].bins[1].mean, 1e-6);
  EXPECT_EQ(out->curves[0].used, 10);
  ASSERT_EQ(out->inputs.size(), 1U) << "the recording holds the spikes";
}

TEST_F(AroundJobTest, WritesEachFormat) {
  for (const char* name : {"a.csv", "a.json", "a.nwb"}) {
    auto asked = job();
    asked.output = scratch_ / name;
    const auto out = run_around(asked);
    ASSERT_TRUE(out) << out.error().message;
    EXPECT_THAT(out->written, ElementsAre(asked.output));
    EXPECT_TRUE(std::filesystem::file_size(asked.output) > 0);
    EXPECT_THAT(out->warnings, Not(Contains(HasSubstr("no speeds"))));
  }
  auto other = job();
  other.output = scratch_ / "a.txt";
  const auto refused = run_around(other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::usage);
  const auto json = around_outcome_json(run_around(job()).value(), job());
  EXPECT_EQ(json["around"].size(), 4U);
}

TEST_F(AroundJobTest, AMarkerWithoutSpeedIsSaid) {
  write("short.nwb", 2);
  auto asked = job();
  asked.input = scratch_ / "short.nwb";
  asked.from_s = 0.0;
  asked.to_s = asked.bin_s = 0.002;
  const auto out = run_around(asked);
  ASSERT_TRUE(out) << out.error().message;
  EXPECT_EQ(out->curves[0].used, 1);
}

TEST_F(AroundJobTest, MotionsStandBesideSpikesOfAnotherFile) {
  std::string text = "q\nversion=1\nnRows=1000\nnColumns=2\ninDegrees=yes\nendheader\ntime\telbow\n";
  for (int i = 0; i < 1000; ++i) text += std::to_string(0.01 * i) + "\t" + std::to_string(i % 100) + "\n";
  ASSERT_TRUE(io::write_text(scratch_ / "q.mot", text, false));
  auto asked = job();
  asked.input = scratch_ / "q.mot";
  const auto nothing = run_around(asked);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Code::usage);
  EXPECT_THAT(nothing.error().message, HasSubstr("holds no spikes; --spikes FILE.nwb"));
  asked.spikes = scratch_ / "s.nwb";
  const auto out = run_around(asked);
  ASSERT_TRUE(out) << out.error().message;
  ASSERT_EQ(out->curves.size(), 1U);
  EXPECT_NEAR(out->curves[0].bins[0].mean, 45.0 * 0.01745329252, 1e-6);
  EXPECT_EQ(out->inputs.size(), 2U);
  asked.what = "movement";
  const auto movement = run_around(asked);
  ASSERT_FALSE(movement);
  EXPECT_THAT(movement.error().message, HasSubstr("starts are those of markers"));
}

}  // namespace
}  // namespace kinemark::pipeline
