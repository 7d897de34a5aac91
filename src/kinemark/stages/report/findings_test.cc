// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

namespace kinemark::report::internal {
namespace {

using data::FrameStatus;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// Ten good frames of two coordinates and one marker.
data::JointMotion good_motion() {
  data::JointMotion m;
  m.coordinates = {"hip", "knee"};
  m.is_rotation = {true, true};
  m.markers = {"A"};
  m.time = {.rate_hz = 10.0, .t0_s = 1.0, .frames = 10};
  m.q.assign(20, 0.0);
  m.determined.assign(20, 1);
  m.marker_error.assign(30, 0.0);
  m.status.assign(10, FrameStatus::converged);
  return m;
}

std::vector<Notice> findings_of(const data::JointMotion& motion, IkRun run = {}) {
  const auto summary = summarize(std::move(run), motion, nullptr);
  EXPECT_TRUE(summary);
  return summary->notices;
}

TEST(Findings, AGoodTrialHasNone) { EXPECT_THAT(findings_of(good_motion()), IsEmpty()); }

TEST(Findings, ACoordinateAtALimitIsNamedAndOneNearItIsNot) {
  auto m = good_motion();
  for (const std::size_t f : {4U, 7U}) m.q[2 * f] = 1.0;
  m.q[2 * 8 + 1] = 0.99;
  const std::vector<CoordinateLimits> limits{{"hip", -2.0, 1.0}, {"knee", -1.0, 1.0}};
  const auto found = findings_of(m, {.limits = limits});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].level, Verdict::good);
  EXPECT_EQ(found[0].text, "hip lies at a limit of its range in 2 of 10 frames (20 %).");
  EXPECT_DOUBLE_EQ(found[0].time_s, 1.4);
  m.determined[2 * 4] = m.determined[2 * 7] = 0;
  for (const auto& finding : findings_of(m, {.limits = limits}))
    EXPECT_THAT(finding.text, Not(HasSubstr("lies at a limit of its range in")))
        << "undetermined values are at no limit";
  EXPECT_THAT(findings_of(good_motion(), {.locked_coordinates = {"hip"}, .limits = {{"hip", 0.0, 1.0}}}),
              IsEmpty())
      << "a locked coordinate is meant to stay where it is";
}

TEST(Findings, AFailedGateIsSeriousAndAPassedOneSilent) {
  const auto found = findings_of(good_motion(), {.exit_status = 1,
                                                 .gates = {{"a", true, 1, 2, "mm", "fine"},
                                                           {"b", false, 3, 2, "mm", "3 mm is above 2 mm."}}});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].level, Verdict::attention);
  EXPECT_EQ(found[0].subject, "b");
  EXPECT_EQ(found[0].text, "3 mm is above 2 mm.");
  EXPECT_THAT(found[0].text, Not(HasSubstr("The run ended with exit status"))) << "the gate says why";
}

TEST(Findings, AnExitStatusWithoutAFailedGateIsNotSilent) {
  const auto found = findings_of(good_motion(), {.exit_status = 1});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].text, HasSubstr("The run ended with exit status 1."));
}

TEST(Findings, SharesHaveTwoDigitsAndNoExponent) {
  for (const auto& [bad, all, share] : {std::tuple{1, 1000, "(0.1 %)"},
                                        {25, 1000, "(2.5 %)"},
                                        {123, 1000, "(12 %)"},
                                        {994, 1000, "(99 %)"},
                                        {995, 1000, "(99.5 %)"},
                                        {1000, 1000, "(100 %)"}}) {
    auto m = good_motion();
    m.time.frames = all;
    const auto frames = static_cast<std::size_t>(all);
    m.q.assign(2 * frames, 0.0);
    m.determined.assign(2 * frames, 1);
    m.marker_error.assign(3 * frames, 0.0);
    m.status.assign(frames, FrameStatus::converged);
    for (int f = 0; f < bad; ++f) m.status[static_cast<std::size_t>(f)] = FrameStatus::not_converged;
    const auto found = findings_of(m);
    ASSERT_THAT(found, SizeIs(1)) << share;
    EXPECT_THAT(found[0].text, HasSubstr(share));
  }
}

TEST(Findings, FramesThatDidNotConvergeOrHadNoMarkerSayHowManyAndWhere) {
  data::JointMotion m = good_motion();
  m.status[4] = m.status[7] = FrameStatus::not_converged;
  m.status[9] = FrameStatus::no_markers;
  const auto found = findings_of(m);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].text, "2 of 10 frames (20 %) did not converge: the best pose found is given.");
  EXPECT_DOUBLE_EQ(found[0].time_s, 1.4);
  EXPECT_THAT(found[1].text, HasSubstr("1 of 10 frames (10 %) had no marker"));
  EXPECT_THAT(found[1].text, Not(HasSubstr("did not converge: the best pose found is given")));
  EXPECT_DOUBLE_EQ(found[1].time_s, 1.9);
}

TEST(Findings, CoordinatesSometimesAndNeverDeterminedDiffer) {
  data::JointMotion m = good_motion();
  m.determined[m.index(3, 0)] = 0;
  for (int f = 0; f < 10; ++f) m.determined[m.index(f, 1)] = 0;
  auto found = findings_of(m);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].level, Verdict::attention) << "the serious ones first";
  EXPECT_EQ(found[0].subject, "knee");
  EXPECT_THAT(found[0].text, HasSubstr("never determined"));
  EXPECT_EQ(found[1].level, Verdict::good);
  EXPECT_THAT(found[1].text, HasSubstr("hip is not determined in 1 of 10 frames"));
  EXPECT_THAT(found[0].text, Not(HasSubstr("is not determined in")));
  EXPECT_DOUBLE_EQ(found[1].time_s, 1.3);

  found = findings_of(m, {.locked_coordinates = {"knee"}});
  ASSERT_THAT(found, SizeIs(1)) << "a locked coordinate needs no marker";
  EXPECT_EQ(found[0].subject, "hip");
}

TEST(Findings, WhereAPoseIsHeldFromIsComputed) {
  const auto said = [](std::initializer_list<int> frames, std::initializer_list<std::pair<int, int>> same) {
    data::JointMotion m = good_motion();
    for (int f = 0; f < 10; ++f)
      for (int c = 0; c < 2; ++c) m.q[m.index(f, c)] = f + 0.1 * c;
    for (const auto& [f, g] : same)
      for (int c = 0; c < 2; ++c) m.q[m.index(f, c)] = m.q[m.index(g, c)];
    for (const int f : frames) m.status[static_cast<std::size_t>(f)] = FrameStatus::no_markers;
    return findings_of(m).at(0).text;
  };
  const auto before = said({4, 5}, {{4, 3}, {5, 3}}), behind = said({0, 1}, {{0, 2}, {1, 2}}),
             both = said({0, 9}, {{0, 1}, {9, 8}}), neither = said({4}, {});
  EXPECT_THAT(before, HasSubstr(": the pose is held from the frame before."));
  EXPECT_THAT(before, Not(AnyOf(HasSubstr(": the pose is that of the first frame behind that has one"),
                                HasSubstr("or behind where none is before"))));
  EXPECT_THAT(behind, HasSubstr(": the pose is that of the first frame behind that has one."));
  EXPECT_THAT(behind, Not(HasSubstr(": the pose is held from the frame before")));
  EXPECT_THAT(both, HasSubstr(": the pose is held from the frame before, or behind where none is before."));
  EXPECT_THAT(neither, ::testing::EndsWith("had no marker.")) << "it lies elsewhere: nothing is claimed";
}

TEST(Findings, OfSeveralStretchesWithoutMarkersEachIsLookedAt) {
  data::JointMotion m = good_motion();
  for (int f = 0; f < 10; ++f) m.q[m.index(f, 0)] = f;
  for (const int f : {0, 4, 9}) m.status[static_cast<std::size_t>(f)] = FrameStatus::no_markers;
  m.q[m.index(4, 0)] = 3.0;
  m.q[m.index(9, 0)] = 8.0;
  EXPECT_THAT(findings_of(m).at(0).text, HasSubstr("3 of 10 frames (30 %) had no marker: the pose is held"));
  m.status.assign(10, FrameStatus::no_markers);
  EXPECT_EQ(findings_of(m).at(0).text, "10 of 10 frames (100 %) had no marker.") << "held from nowhere";
}

TEST(Findings, WhatMarkersFixIsSaidOnlyWhereItIsKnown) {
  data::JointMotion m = good_motion();
  for (int f = 0; f < 10; ++f) m.determined[m.index(f, 1)] = 0;
  EXPECT_EQ(findings_of(m).at(0).text, "knee is never determined.");
  m.open_frames = {0, 10};
  EXPECT_THAT(findings_of(m).at(0).text, HasSubstr("no visible marker fixes it"));
  EXPECT_THAT(findings_of(m).at(0).text, Not(HasSubstr("the visible markers fix it no better than to")));
  m.open_frames = {0, 0};
  EXPECT_THAT(findings_of(m).at(0).text, Not(HasSubstr("no visible marker fixes it")));
  EXPECT_THAT(findings_of(m).at(0).text, Not(HasSubstr("fixes it, in the others")));
  EXPECT_THAT(findings_of(m).at(0).text,
              HasSubstr("the visible markers fix it no better than to 0.5 rad, or"));
  m.open_frames = {0, 4};
  EXPECT_THAT(findings_of(m).at(0).text, HasSubstr("in 4 of them no visible marker fixes it, in the others"));
  m.is_rotation = {true, false};
  EXPECT_THAT(findings_of(m).at(0).text, HasSubstr("fix it no better than to 0.5 m, or two poses fit them"));
}

TEST(Findings, WhatSensorsAloneFixIsSaidOfSensors) {
  data::JointMotion m = good_motion();
  m.markers.clear();
  m.marker_error.clear();
  for (int f = 0; f < 10; ++f) m.determined[m.index(f, 1)] = 0;
  m.status[9] = FrameStatus::no_markers;
  m.open_frames = {0, 10};
  const auto found = findings_of(m, {.by_sensors = true});
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_THAT(found[0].text, HasSubstr("1 of 10 frames (10 %) had no sensor"));
  EXPECT_EQ(found[1].text, "knee is never determined: no sensor fixes it.");
  m.open_frames = {0, 0};
  EXPECT_THAT(findings_of(m, {.by_sensors = true}).at(1).text,
              HasSubstr("the sensors fix it no better than to 0.5 rad"));
}

TEST(Findings, OfSomeFramesWhatMarkersFixIsSaidOfThose) {
  data::JointMotion m = good_motion();
  for (const int f : {3, 4}) m.determined[m.index(f, 1)] = 0;
  m.open_frames = {0, 2};
  EXPECT_EQ(findings_of(m).at(0).text,
            "knee is not determined in 2 of 10 frames (20 %): the visible markers do not fix it there.");
  m.open_frames = {0, 0};
  const auto loosely = findings_of(m).at(0).text;
  EXPECT_THAT(loosely, HasSubstr("no better than to 0.5 rad, or two poses fit them there."));
  EXPECT_THAT(loosely, Not(HasSubstr(": the visible markers do not fix it there")));
}

TEST(Findings, MarkersAndWarningsAreNotes) {
  data::JointMotion m = good_motion();
  m.marker_error.assign(30, kNaN);
  const auto found =
      findings_of(m, {.fit = {.excluded = {{"L.Bicep", "it is at the origin in every frame."}}},
                      .warnings = {"the header lies."}});
  ASSERT_THAT(found, SizeIs(3));
  EXPECT_EQ(found[0].text, "Marker L.Bicep was left out: it is at the origin in every frame.");
  EXPECT_EQ(found[1].text, "Marker A is never seen.");
  EXPECT_EQ(found[2].text, "the header lies.");
  EXPECT_THAT(found[0].text, Not(AnyOf(HasSubstr("markers were left out:"), HasSubstr("is never seen."))));
  for (const Notice& f : found) EXPECT_EQ(f.level, Verdict::good);
}

TEST(Findings, MarkersLeftOutForOneReasonShareALine) {
  const auto found = findings_of(
      good_motion(),
      {.fit = {.excluded = {{"B", "never seen"}, {"C", "given the weight 0"}, {"D", "never seen"}}}});
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].text, "2 markers were left out: never seen: B, D");
  EXPECT_EQ(found[0].subject, "");
  EXPECT_THAT(found[0].text, Not(HasSubstr("was left out:")));
  EXPECT_EQ(found[1].text, "Marker C was left out: given the weight 0");
  EXPECT_EQ(found[1].subject, "C");
}

}  // namespace
}  // namespace kinemark::report::internal
