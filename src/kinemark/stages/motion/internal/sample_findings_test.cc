// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/sample_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using data::FindingKind;
using data::SampleState;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SampleFindings : public ::testing::Test {
 protected:
  SampleFindings()
      : model(model::Model::compile(testing_body::description()).value()),
        markers(testing_body::record(model, 20)),
        problem(make_problem(model, markers, {}).value()) {
    motion.time = markers.time;
  }

  std::vector<data::Finding> find(const JudgedFrames& judged) {
    data::MarkerFit fit = problem.fit;
    add_sample_findings(problem, judged, markers, motion, fit);
    rejected.clear();
    for (const auto& marker : fit.markers) rejected.push_back(*marker.rejected_frames);
    return fit.findings;
  }
  /// What is said of the only finding.
  std::string said(const JudgedFrames& judged) {
    const auto findings = find(judged);
    EXPECT_EQ(findings.size(), 1U);
    return findings.empty() ? std::string() : data::describe(findings.front(), markers.time);
  }
  static JudgedFrames with(const Outlier& outlier) {
    JudgedFrames judged;
    judged.rejected = {outlier};
    return judged;
  }
  [[nodiscard]] const std::string& name(std::size_t m) const { return problem.fit.markers[m].name; }

  model::Model model;
  data::Trajectories markers;
  Problem problem;
  data::JointMotion motion;
  std::vector<std::int64_t> rejected;  ///< of each marker, by the last find()
};

TEST_F(SampleFindings, WhyASampleWasLeftOutIsWhatGaveItAway) {
  const Outlier path{.marker = 2, .first_frame = 4, .last_frame = 6, .length_m = 0.08};
  Outlier held = path, zero = path, visits = path;
  held.why = Outlier::Why::held;
  zero.why = Outlier::Why::zero;
  visits.partner = 5;
  EXPECT_THAT(said(with(path)),
              ::testing::EndsWith("80.0 mm from where the model and the frames beside have it"));
  EXPECT_THAT(said(with(path)),
              Not(AnyOf(HasSubstr("it holds one value digit by digit"),
                        HasSubstr("a coordinate is exactly 0"), HasSubstr("it lies where '"))));
  EXPECT_THAT(said(with(held)), HasSubstr(": it holds one value digit by digit"));
  EXPECT_THAT(said(with(held)), Not(HasSubstr("a coordinate is exactly 0")));
  EXPECT_THAT(said(with(zero)), HasSubstr(": a coordinate is exactly 0"));
  EXPECT_THAT(said(with(visits)), HasSubstr("it lies where '" + name(5) + "' should"));
}

TEST_F(SampleFindings, WhereNobodyCanSayWhichSideIsWrongItIsKeptAndSaid) {
  JudgedFrames judged;
  judged.doubtful = {{.marker = 3, .first_frame = 11, .last_frame = 19, .length_m = 0.03}};
  const auto findings = find(judged);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, FindingKind::marker_slip);
  EXPECT_EQ(findings[0].subject, name(3));
  EXPECT_EQ(findings[0].partner, problem.fit.markers[3].body);
  EXPECT_FALSE(findings[0].sure());
  EXPECT_THAT(said(judged), HasSubstr("the samples before or those from there on are wrong; both were kept"));
  EXPECT_EQ(rejected[3], 0);
  const auto left_out = said(with({.marker = 3, .first_frame = 11, .last_frame = 19, .length_m = 0.03}));
  EXPECT_THAT(left_out,
              Not(HasSubstr("the samples before or those from there on are wrong; both were kept")));
}

TEST_F(SampleFindings, AnExchangeNamesBothItsFramesAndHowFarApartTheyWere) {
  JudgedFrames judged;
  judged.exchanges = {{.one = 1, .other = 4, .frames = {2, 5, 8, 11}}};
  auto findings = find(judged);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, FindingKind::label_swap);
  EXPECT_EQ(findings[0].subject, name(1));
  EXPECT_EQ(findings[0].partner, name(4));
  EXPECT_EQ(findings[0].frames, (std::vector<std::int64_t>{2, 5, 8, 11}));
  EXPECT_TRUE(findings[0].validate());
  std::vector<double> apart;
  for (const std::int64_t f : {2, 5, 8, 11})
    apart.push_back((markers.x(f, problem.data_marker[1]) - markers.x(f, problem.data_marker[4])).norm());
  std::ranges::sort(apart);
  EXPECT_GE(findings[0].size, apart[1]);
  EXPECT_LE(findings[0].size, apart[2]);
  EXPECT_THAT(said(judged), HasSubstr("are exchanged in 4 frames: every third frame from 2 to 11"));
  judged.exchanges[0].frames = {2, 3, 4};
  EXPECT_TRUE(find(judged)[0].frames.empty()) << "a span needs no list";
  EXPECT_THAT(said(judged), HasSubstr("in frames 2 to 4"));
}

TEST_F(SampleFindings, StatesAndCountsAreThoseOfTheSamplesThatWereKept) {
  JudgedFrames judged = with({.marker = 2, .first_frame = 4, .last_frame = 6});
  judged.kept = markers;
  for (const std::int64_t f : {4, 5, 6})
    judged.kept->set_missing(f, problem.data_marker[2], SampleState::rejected);
  judged.kept->set_missing(9, problem.data_marker[0]);
  (void)find(judged);
  const auto M = problem.data_marker.size();
  ASSERT_EQ(motion.marker_state.size(), 20 * M);
  EXPECT_EQ(rejected[2], 3);
  EXPECT_EQ(rejected[0], 0);
  EXPECT_EQ(motion.marker_state[5 * M + 2], SampleState::rejected);
  EXPECT_EQ(motion.marker_state[9 * M + 0], SampleState::missing);
  EXPECT_EQ(motion.marker_state[9 * M + 2], SampleState::measured);
}

TEST_F(SampleFindings, OfJudgedFramesWithoutFaultsNothingIsSaid) {
  EXPECT_TRUE(find({}).empty());
  EXPECT_TRUE(std::ranges::all_of(rejected, [](auto n) { return n == 0; })) << "judged, and none left out";
}

}  // namespace
}  // namespace kinemark::motion::internal
