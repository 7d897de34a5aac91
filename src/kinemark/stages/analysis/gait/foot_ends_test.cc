// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Heel and toe exchanged on one foot, on both, in walks forward and backward, with and without a pelvis; and
// sides of feet that cross over.
#include "kinemark/stages/analysis/gait/foot_ends.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::KnownWalk;
using ::testing::Not;
using Renaming = std::map<std::string, std::string>;

const Renaming kLeftEnds{{"LHEE", "LTOE"}, {"LTOE", "LHEE"}};
const Renaming kBothEnds{{"LHEE", "LTOE"}, {"LTOE", "LHEE"}, {"RHEE", "RTOE"}, {"RTOE", "RHEE"}};
constexpr auto kSidesExchanged = "the names of the sides are exchanged";

data::Trajectories renamed(data::Trajectories markers, const Renaming& names) {
  for (auto& name : markers.names)
    if (const auto other = names.find(name); other != names.end()) name = other->second;
  return markers;
}

data::Trajectories reversed(const data::Trajectories& walk) {
  auto out = walk;
  for (std::int64_t f = 0; f < walk.frames(); ++f)
    for (std::int64_t m = 0; m < walk.markers(); ++m)
      out.x(f, m) = Eigen::Vector3d(walk.x(walk.frames() - 1 - f, m));
  return out;
}

/// Without some of the markers.
data::Trajectories without(const data::Trajectories& walk, const std::vector<std::string>& names) {
  auto out = walk;
  for (std::int64_t m = 0; m < walk.markers(); ++m)
    if (std::ranges::find(names, walk.names[at(m)]) != names.end())
      for (std::int64_t f = 0; f < walk.frames(); ++f) out.set_missing(f, m);
  return out;
}

Renaming other_side(const data::Trajectories& markers, std::string_view of) {
  Renaming out;
  for (const auto& name : markers.names)
    if (name != "SACR" && (of.empty() || name.substr(1) == of))
      out[name] = (name.front() == 'L' ? "R" : "L") + name.substr(1);
  return out;
}

Gait gait_with(const data::Trajectories& markers) {
  auto gait = analyze_gait(markers, {}, {.refits = 0});
  EXPECT_TRUE(gait) << gait.error().message;
  return gait ? *gait : Gait{};
}

double value_named(const Gait& gait, const std::string& id, const std::string& side) {
  for (const auto& m : gait.measures)
    if (m.id == id && m.context == side) return m.value;
  return kNaN;
}

class FootEndsOf : public ::testing::TestWithParam<bool> {
 protected:
  FootEndsOf() {
    if (GetParam()) body_ = reversed(body_);
  }
  [[nodiscard]] GaitDirection goes() const {
    return GetParam() ? GaitDirection::backward : GaitDirection::forward;
  }
  void expect_as_named(const Gait& gait) const {
    const auto right = gait_with(body_);
    EXPECT_EQ(gait.kind.direction, goes());
    for (const auto* side : {"Left", "Right"})
      for (const auto* id : {"step_length", "stride_length"})
        EXPECT_NEAR(value_named(gait, id, side), value_named(right, id, side), 1e-9) << id << " " << side;
    EXPECT_NEAR(value_named(gait, "step_width", ""), value_named(right, "step_width", ""), 1e-9);
  }
  data::Trajectories body_ = KnownWalk{}.body_markers(0.0003, 5);
};

TEST_P(FootEndsOf, RightNamesAreNotAccused) {
  for (const auto& markers :
       {body_, without(body_, {"LASI", "RASI", "LPSI", "RPSI"}), without(body_, {"LANK", "RANK"}),
        without(body_, {"LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK"})}) {
    const auto gait = gait_with(markers);
    EXPECT_EQ(gait.kind.direction, goes());
    EXPECT_THAT(gait.notes, Not(Contains(HasSubstr("exchanged"))));
    for (const auto& m : gait.measures)
      EXPECT_THAT(m.remark, Not(HasSubstr("forward or backward cannot be known, and so its sign")));
    for (const auto* sentence :
         {"; walking is measured with them exchanged back",
          "whether the body goes forward or backward cannot be known: heel and toe may be exchanged (",
          "the front of the pelvis points against the feet: the names of its front and its back are "
          "exchanged",
          "; forward or backward cannot be known"})
      EXPECT_THAT(gait.notes, Not(Contains(HasSubstr(sentence))));
  }
}

TEST_P(FootEndsOf, OneFootIsNamedAndMeasuredWithBothExchangedBack) {
  const auto names = renamed(body_, kLeftEnds);
  for (const auto& markers :
       {names, without(names, {"LASI", "RASI", "LPSI", "RPSI"}), without(names, {"LANK", "RANK"}),
        without(names, {"LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK"})}) {
    const auto gait = gait_with(markers);
    EXPECT_THAT(gait.notes, Contains(HasSubstr("LHEE and LTOE are exchanged: ")));
    EXPECT_THAT(gait.notes, Contains(HasSubstr("walking is measured with them exchanged back")));
    EXPECT_THAT(gait.notes, Not(Contains(HasSubstr("RHEE and RTOE are exchanged: "))));
    expect_as_named(gait);
  }
  EXPECT_THAT(gait_with(names).notes,
              Contains(HasSubstr("the left foot points against the front of the pelvis, "
                                 "the left foot points against the other one")));
}

TEST_P(FootEndsOf, BothFeetAreNamedWhereThePelvisTells) {
  const auto gait = gait_with(renamed(without(body_, {"LANK", "RANK"}), kBothEnds));
  for (const auto* pair : {"LHEE and LTOE are exchanged: ", "RHEE and RTOE are exchanged: "})
    EXPECT_THAT(gait.notes, Contains(HasSubstr(pair)));
  expect_as_named(gait);
}

TEST_P(FootEndsOf, BothFeetAloneLeaveItOpen) {
  const auto gait =
      gait_with(renamed(without(body_, {"LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK"}), kBothEnds));
  EXPECT_EQ(gait.kind.direction, GaitDirection::unknown);
  EXPECT_THAT(gait.notes,
              Contains(HasSubstr("whether the body goes forward or backward cannot be known: heel and toe "
                                 "may be exchanged (LHEE with LTOE and RHEE with RTOE)")));
  EXPECT_THAT(gait.notes, Contains(HasSubstr("; forward or backward cannot be known")));
  EXPECT_TRUE(std::ranges::none_of(gait.measures, [](const auto& m) { return m.id == "step_width"; }));
  const auto feet = without(body_, {"LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK"});
  for (const bool open : {true, false}) {
    const auto asked =
        analyze_gait(open ? renamed(feet, kBothEnds) : feet, {}, {.measures = {"step_width"}, .refits = 0})
            .value();
    ASSERT_EQ(asked.measures.size(), 1U);
    EXPECT_EQ(asked.measures[0].remark == "forward or backward cannot be known, and so its sign", open);
    EXPECT_EQ(std::isfinite(asked.measures[0].value), !open);
  }
}

TEST_P(FootEndsOf, ThePelvisIsAccusedWhereFeetAndAnklesContradictIt) {
  const Renaming pelvis{{"LASI", "LPSI"}, {"LPSI", "LASI"}, {"RASI", "RPSI"}, {"RPSI", "RASI"}};
  const auto gait = gait_with(renamed(body_, pelvis));
  EXPECT_THAT(gait.notes, Contains(HasSubstr("the names of its front and its back are exchanged")));
  EXPECT_THAT(gait.notes, Not(Contains(HasSubstr("HEE and "))));
  EXPECT_EQ(gait.kind.direction, goes());
}

TEST(FootEndsSentences, NameWhatContradictsTheNamesAndNothingElse) {
  FootEnds ends;
  auto& left = ends.evidence[0];
  left = {.pelvis = 0.9, .way = 0.9, .heel_m = 0.08, .toe_m = 0.15, .heel_rise_m = 0.24, .toe_rise_m = 0.09};
  ends.between = 0.9;
  EXPECT_EQ(left.score(), 4);
  ends.between = -0.9;
  const auto right_names = ends.why(data::Side::left, "LHEE", "LTOE");
  EXPECT_THAT(right_names, Not(HasSubstr(" points against the front of the pelvis")));
  EXPECT_THAT(right_names, Not(HasSubstr("its ankle is ")));
  EXPECT_THAT(right_names, Not(HasSubstr(" rises by ")));
  EXPECT_THAT(right_names, Not(HasSubstr(" points against the way")));
  EXPECT_THAT(right_names, HasSubstr(" points against the other one"));
  left = {.way = -0.9};
  EXPECT_EQ(left.score(), 0);
  EXPECT_THAT(ends.why(data::Side::left, "LHEE", "LTOE"), HasSubstr("the left foot points against the way"));
  left = {
      .pelvis = -0.9, .way = -0.9, .heel_m = 0.15, .toe_m = 0.08, .heel_rise_m = 0.09, .toe_rise_m = 0.24};
  EXPECT_EQ(left.score(), -4);
  ends.between = 0.9;
  EXPECT_EQ(
      ends.why(data::Side::left, "LHEE", "LTOE"),
      "the left foot points against the front of the pelvis, its ankle is 150 mm from LHEE and 80 mm from "
      "LTOE, LHEE rises by 90 mm and LTOE by 240 mm");
  EXPECT_THAT(ends.why(data::Side::left, "LHEE", "LTOE"), Not(HasSubstr(" points against the other one")));
}

INSTANTIATE_TEST_SUITE_P(ForwardAndBackward, FootEndsOf, ::testing::Bool());

// Tandem gait: one line; scissor gait: each foot on the other's side; held against a swaying pelvis.
TEST(SidesOfFeet, ThatCrossOverAreNotAccused) {
  for (const double width : {0.0, -0.04, -0.12, -0.2})
    for (const double sway : {-0.06, 0.02, 0.08}) {
      KnownWalk walk;
      walk.width_m = width, walk.sway_m = sway;
      const auto body = walk.body_markers(0.0003, 7);
      for (const auto& markers :
           {body, without(body, {"LASI", "RASI"}), without(body, {"LANK", "RANK", "LKNE", "RKNE"}),
            without(body, {"LASI", "RASI", "LANK", "RANK", "LKNE", "RKNE"})})
        EXPECT_THAT(gait_with(markers).notes, Not(Contains(HasSubstr("sides are exchanged"))))
            << width << " " << sway;
    }
}

TEST(SidesOfFeet, ThatAreExchangedAreFoundInEveryGait) {
  for (const double width : {0.1, 0.0, -0.12}) {
    KnownWalk walk;
    walk.width_m = width, walk.sway_m = 0.06;
    const auto body = walk.body_markers(0.0003, 7);
    const auto exchanged = renamed(body, other_side(body, ""));
    for (const auto& markers : {exchanged, without(exchanged, {"LKNE", "RKNE", "LANK", "RANK"}),
                                without(exchanged, {"LASI", "RASI"})})
      EXPECT_THAT(gait_with(markers).notes, Contains(HasSubstr(kSidesExchanged))) << width;
  }
}

TEST(SidesOfFeet, ThatAreExchangedAtOnePartAreSaidSo) {
  const auto body = KnownWalk{}.body_markers(0.0003, 7);
  EXPECT_THAT(gait_with(renamed(body, other_side(body, "ASI"))).notes,
              Contains(HasSubstr("mm to the right of the right one, and the left foot has its ankle on the "
                                 "left: the names of the sides are exchanged at one of them")));
  auto feet = other_side(body, "HEE");
  feet.merge(other_side(body, "TOE"));
  feet.merge(other_side(body, "ANK"));
  EXPECT_THAT(gait_with(renamed(body, feet)).notes,
              Contains(HasSubstr("and the left front of the pelvis lies on the left: the names of the sides "
                                 "are exchanged at one of them")));
  for (const auto* sentence : {": the names of the sides are exchanged at one of them",
                               "has its ankle on the left", "lies on the left"})
    EXPECT_THAT(gait_with(body).notes, Not(Contains(HasSubstr(sentence))));
}

}  // namespace
}  // namespace kinemark::analysis
