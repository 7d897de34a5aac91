// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Bad samples in recordings of a body whose motion is known: what must be left out and said, and what must
// not.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kinemark/core/units.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion {
namespace {

using data::FindingKind;
using data::SampleState;
using Eigen::Vector3d;

constexpr std::int64_t kFrames = 120;
constexpr double kNoise_m = 0.5e-3;

class JudgedSamples : public ::testing::Test {
 protected:
  JudgedSamples()
      : model(model::Model::compile(testing_body::description()).value()),
        markers(testing_body::record(model, kFrames, kNoise_m, 3)),
        clean(solve_ik(model, markers).value()) {}

  /// Largest difference from the clean angles, degrees.
  [[nodiscard]] double off_deg(const IkResult& result) const {
    double worst = 0.0;
    for (std::size_t i = 0; i < clean.motion.q.size(); ++i)
      if (clean.motion.is_rotation[i % clean.motion.coordinates.size()])
        worst = std::max(worst, kDegPerRad * std::abs(result.motion.q[i] - clean.motion.q[i]));
    return worst;
  }

  [[nodiscard]] static std::int64_t left_out(const IkResult& result) {
    return std::ranges::count(result.motion.marker_state, SampleState::rejected);
  }

  [[nodiscard]] SampleState state(const IkResult& result, std::int64_t frame, std::int64_t marker) const {
    return result.motion.marker_state[static_cast<std::size_t>(frame * markers.markers() + marker)];
  }

  [[nodiscard]] static std::int64_t findings_of(const IkResult& result, std::string_view marker,
                                                std::int64_t frame) {
    return std::ranges::count_if(result.fit.findings, [&](const data::Finding& f) {
      return f.kind == FindingKind::outlier && f.subject == marker && f.first_frame <= frame &&
             frame <= f.last_frame;
    });
  }

  model::Model model;
  data::Trajectories markers;
  IkResult clean;
};

TEST_F(JudgedSamples, NothingIsLeftOutOfACleanRecordingAndItsAnglesAreTheSameBits) {
  EXPECT_EQ(left_out(clean), 0);
  EXPECT_TRUE(clean.fit.findings.empty());
  for (const auto& marker : clean.fit.markers) EXPECT_EQ(marker.rejected_frames, 0) << marker.name;
  const auto believed = solve_ik(model, markers, {.judge_samples = false}).value();
  EXPECT_EQ(believed.motion.q, clean.motion.q);
  EXPECT_EQ(believed.motion.q_sd.size(), clean.motion.q_sd.size());
}

TEST_F(JudgedSamples, ASpikeIsLeftOutInEveryMarkerAndFrameNamedAndDoesNoHarm) {
  for (const std::int64_t frame : {std::int64_t{0}, std::int64_t{1}, std::int64_t{57}, kFrames - 1})
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      auto bad = markers;
      bad.x(frame, m) += Vector3d(0.08, -0.05, 0.06);
      const auto result = solve_ik(model, bad).value();
      const auto& name = markers.names[static_cast<std::size_t>(m)];
      EXPECT_EQ(state(result, frame, m), SampleState::rejected) << name << " " << frame;
      EXPECT_EQ(left_out(result), 1) << name << " " << frame;
      EXPECT_EQ(result.fit.markers[static_cast<std::size_t>(m)].rejected_frames, 1) << name << " " << frame;
      EXPECT_EQ(findings_of(result, name, frame), 1) << name << " " << frame;
      EXPECT_LT(off_deg(result), 1.0) << name << " " << frame;
      EXPECT_TRUE(std::isnan(
          result.motion.marker_error[static_cast<std::size_t>(3 * (frame * markers.markers() + m))]));
    }
}

TEST_F(JudgedSamples, BelievedTheSameSpikeWouldHaveSpoiltTheAngles) {
  auto bad = markers;
  bad.x(57, 0) += Vector3d(0.3, -0.2, 0.2);
  const auto believed = solve_ik(model, bad, {.judge_samples = false}).value();
  EXPECT_GT(off_deg(believed), 5.0);
  EXPECT_EQ(left_out(believed), 0);
}

TEST_F(JudgedSamples, AllOtherFramesKeepTheirBits) {
  auto bad = markers;
  bad.x(57, 4) += Vector3d(0.2, 0.0, 0.0);
  const auto result = solve_ik(model, bad).value();
  for (std::int64_t f = 0; f < kFrames; ++f) {
    if (std::abs(f - 57) <= 3) continue;  // those behind were extrapolated from the spike
    for (std::int64_t k = 0; k < clean.motion.size(); ++k)
      EXPECT_NEAR(result.motion.q[clean.motion.index(f, k)], clean.motion.q[clean.motion.index(f, k)], 1e-9)
          << f;
  }
}

TEST_F(JudgedSamples, ExchangedLabelsAreExchangedBackSaidOnceAndNothingIsLeftOut) {
  std::vector<std::int64_t> held, third, irregular{3, 7, 8, 20, 21, 22, 50, 77, 90};
  for (std::int64_t f = 40; f < 70; ++f) held.push_back(f);
  for (std::int64_t f = 1; f < kFrames; f += 3) third.push_back(f);
  for (const auto& frames : {held, third, irregular, std::vector<std::int64_t>{57}}) {
    auto bad = markers;
    for (const auto f : frames) {
      const Vector3d a = bad.x(f, 1), b = bad.x(f, 9);
      bad.x(f, 1) = b;
      bad.x(f, 9) = a;
    }
    const auto result = solve_ik(model, bad).value();
    EXPECT_EQ(left_out(result), 0) << frames.size();
    ASSERT_EQ(result.fit.findings.size(), 1U) << frames.size();
    const data::Finding& finding = result.fit.findings.front();
    EXPECT_EQ(finding.kind, FindingKind::label_swap);
    EXPECT_EQ(finding.subject, markers.names[1]);
    EXPECT_EQ(finding.partner, markers.names[9]);
    EXPECT_EQ(finding.first_frame, frames.front());
    EXPECT_EQ(finding.last_frame, frames.back());
    EXPECT_EQ(finding.frame_count(), std::ssize(frames));
    EXPECT_EQ(finding.detail, "exchanged back");
    EXPECT_EQ(result.motion.q, clean.motion.q) << "the very samples of the clean recording";
  }
}

TEST_F(JudgedSamples, AMarkerInAnothersPlaceAloneIsLeftOutAndNotExchanged) {
  auto bad = markers;
  for (const std::int64_t f : {40, 43, 46}) bad.x(f, 1) = bad.x(f, 9);
  const auto result = solve_ik(model, bad).value();
  EXPECT_EQ(left_out(result), 3);
  for (const auto& finding : result.fit.findings) EXPECT_NE(finding.kind, FindingKind::label_swap);
}

TEST_F(JudgedSamples, AValueHeldWhileTheBodyMovesIsLeftOutAfterItsFirstFrame) {
  auto bad = markers;
  for (std::int64_t f = 31; f < 51; ++f) bad.x(f, 7) = bad.x(30, 7);
  const auto result = solve_ik(model, bad).value();
  EXPECT_EQ(state(result, 30, 7), SampleState::measured);
  for (std::int64_t f = 31; f < 51; ++f) EXPECT_EQ(state(result, f, 7), SampleState::rejected) << f;
  EXPECT_LT(off_deg(result), 2.0);
}

TEST_F(JudgedSamples, ACoordinateOfZeroIsLeftOut) {
  auto bad = markers;
  ASSERT_GT(std::abs(bad.x(64, 2).y()), 0.05);
  bad.x(64, 2).y() = 0.0;
  const auto result = solve_ik(model, bad).value();
  EXPECT_EQ(state(result, 64, 2), SampleState::rejected);
  EXPECT_EQ(left_out(result), 1);
}

TEST_F(JudgedSamples, AGapIsNoBadSample) {
  auto gap = markers;
  for (std::int64_t f = 20; f < 60; ++f) gap.set_missing(f, 5);
  for (std::int64_t f = 45; f < 90; ++f) gap.set_missing(f, 11);
  const auto result = solve_ik(model, gap).value();
  EXPECT_EQ(left_out(result), 0);
  EXPECT_TRUE(result.fit.findings.empty());
  EXPECT_EQ(state(result, 30, 5), SampleState::missing);
}

TEST_F(JudgedSamples, TheOnlyMarkerOfASegmentComesBackWhereTheSegmentWent) {
  auto gap = testing_body::record(model, 240, kNoise_m, 3);
  for (std::int64_t f = 0; f < 240; ++f) gap.set_missing(f, 6);
  for (const std::int64_t frames : {10, 50, 100}) {
    auto away = gap;
    for (std::int64_t f = 77; f < 77 + frames; ++f) away.set_missing(f, 7);
    EXPECT_EQ(left_out(solve_ik(model, away).value()), 0) << frames;
    away.x(77 + frames, 7) = gap.x(77 + frames, 2);
    const auto wrong = solve_ik(model, away).value();
    EXPECT_EQ(left_out(wrong), 1) << frames;
    EXPECT_EQ(findings_of(wrong, gap.names[7], 77 + frames), 1) << frames;
  }
}

TEST_F(JudgedSamples, ABlowToTheWholeBodyIsNoBadSample) {
  auto blow = markers;
  const Eigen::AngleAxisd rotation(0.3, Vector3d::UnitZ());
  for (std::int64_t f = 60; f < kFrames; ++f)
    for (std::int64_t m = 0; m < blow.markers(); ++m)
      blow.x(f, m) = rotation * Vector3d(blow.x(f, m)) + Vector3d(0.1, 0.0, 0.05);
  const auto result = solve_ik(model, blow).value();
  EXPECT_EQ(left_out(result), 0);
}

TEST_F(JudgedSamples, AMarkerThatStaysElsewhereIsNamed) {
  auto slipped = testing_body::record(model, 500, kNoise_m, 3);
  for (std::int64_t f = 250; f < 500; ++f) slipped.x(f, 6) += Vector3d(0.0, 0.03, 0.0);
  const auto result = solve_ik(model, slipped).value();
  const auto about = [&](std::int64_t frame) {
    return std::ranges::any_of(result.fit.findings, [&](const data::Finding& f) {
      return f.subject == markers.names[6] && f.first_frame <= frame && frame <= f.last_frame;
    });
  };
  EXPECT_TRUE(about(250));
  EXPECT_FALSE(about(249));
}

}  // namespace
}  // namespace kinemark::motion
