// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/contradictions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"
#include "kinemark/stages/motion/foundations/testing/walking_body.h"

namespace kinemark::workflow {
namespace {

using analysis::testing::KnownWalk;
using data::Side;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::vector<std::string> kLegs{"LASI", "RASI", "LPSI", "RPSI", "LKNE", "RKNE", "LANK", "RANK",
                                     "LHEE", "RHEE", "LTOE", "RTOE", "LTHI", "RTHI", "LTIB", "RTIB"};

data::Recording stepping() {
  data::Recording out;
  out.trial.markers = motion::testing::walking_body(kLegs, 60);
  return out;
}

std::vector<std::string> said(const data::Recording& recording, const HeldFacts& facts) {
  return find_contradictions(recording, facts).value();
}

void rename(data::Recording& recording, const std::string& one, const std::string& other) {
  auto& names = recording.trial.markers.names;
  const auto find = [&](const std::string& name) { return std::ranges::find(names, name); };
  std::iter_swap(find(one), find(other));
}

TEST(Contradictions, ABodyAsItsNamesSayIsNone) {
  EXPECT_THAT(said(stepping(), HeldFacts::all()), IsEmpty());
  EXPECT_THAT(said({}, HeldFacts::all()), IsEmpty()) << "no markers";
}

TEST(Contradictions, AMirroredBodyIsOneWhereSidesMatter) {
  auto recording = stepping();
  for (std::size_t i = 2; i < recording.trial.markers.x_in_world.size(); i += 3)
    recording.trial.markers.x_in_world[i] *= -1.0;
  EXPECT_THAT(said(recording, {}), ElementsAre(HasSubstr("the recording shows a mirrored body")));
  EXPECT_THAT(said(recording, {.sides = false}), IsEmpty());
}

TEST(Contradictions, APairOfLegsIsOneWherePairsMatter) {
  auto recording = stepping();
  rename(recording, "LKNE", "RKNE");
  const auto found = said(recording, {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0], HasSubstr("KNE are exchanged in the recording"));
  EXPECT_THAT(said(recording, {.pairs = false}), IsEmpty());
  rename(recording, "LKNE", "RKNE");
  EXPECT_THAT(said(recording, {}), IsEmpty());
}

TEST(Contradictions, OfABodyOfNobodysSizeNothingElseIsAsked) {
  auto recording = stepping();
  for (auto& x : recording.trial.markers.x_in_world) x *= -1000.0;
  EXPECT_THAT(said(recording, {}), ElementsAre(HasSubstr("the unit of length is another one")));
  EXPECT_THAT(said(recording, HeldFacts::none()), IsEmpty());
}

TEST(Contradictions, PlatesAndEventsWhereTheyMatter) {
  const KnownWalk walk;
  data::Recording recording;
  recording.trial.markers = walk.markers(0.0003, 3);
  recording.plates =
      data::Wrenches{.time = recording.trial.markers.time,
                     .items = {walk.plate("plate 1", Side::left, 2), walk.plate("plate 2", Side::right, 2)}};
  EXPECT_THAT(said(recording, HeldFacts::all()), IsEmpty());
  for (auto& plate : recording.plates->items)
    for (auto& newtons : plate.force) newtons *= 10.0;
  constexpr HeldFacts kPlates{.size = false, .sides = false, .pairs = false};
  EXPECT_THAT(said(recording, kPlates), ElementsAre(HasSubstr("which is nobody's mass")));
  EXPECT_THAT(said(recording, {.plates = false}), IsEmpty());
  recording.plates.reset();
  EXPECT_THAT(said(recording, kPlates), IsEmpty()) << "their forces are not used";
  for (const auto& event : walk.events())
    recording.trial.events.push_back({.label = std::string(data::to_string(event.what)),
                                      .context = event.side == Side::left ? "Right" : "Left",
                                      .time_s = event.time_s});
  EXPECT_THAT(said(recording, {.events = true}),
              Contains(HasSubstr("left and right of the file's events are exchanged")));
  EXPECT_THAT(said(recording, {}), IsEmpty()) << "nothing rests on them";
  recording.rate_known = false;
  EXPECT_THAT(said(recording, {.events = true}), IsEmpty()) << "nobody knows when";
}

TEST(AddContradictions, OneGateTakesEachSentenceOnce) {
  std::vector<data::Gate> gates;
  add_contradictions({}, gates);
  EXPECT_THAT(gates, IsEmpty());
  add_contradictions({"the body is mirrored"}, gates);
  ASSERT_EQ(gates.size(), 1U);
  EXPECT_THAT(gates[0].sentence, HasSubstr("What this rests on is contradicted: the body is mirrored."));
  add_contradictions({"the body is mirrored", "plate 1 is empty"}, gates);
  ASSERT_EQ(gates.size(), 1U);
  EXPECT_EQ(gates[0].sentence, "What this rests on is contradicted: the body is mirrored; plate 1 is empty.");
  EXPECT_EQ(gates[0].value, 2.0);
  EXPECT_FALSE(gates[0].passed);
}

TEST(Prepare, WhatIsContradictedIsSaidAndKeptBesideTheNotes) {
  auto recording = stepping();
  EXPECT_THAT(prepare(recording).value().contradicted, IsEmpty());
  rename(recording, "LKNE", "RKNE");
  const auto prepared = prepare(recording).value();
  EXPECT_THAT(prepared.contradicted, ElementsAre(HasSubstr("are exchanged in the recording")));
  EXPECT_EQ(prepared.notes, prepared.contradicted);
  PrepareOptions options;
  options.selection.rename = {"LKNE=RKNE", "RKNE=LKNE"};
  if (const auto mended = prepare(recording, options)) {
    EXPECT_THAT(mended->contradicted, Not(Contains(HasSubstr("are exchanged in the recording"))));
  }
  options = {.facts = HeldFacts::none()};
  EXPECT_THAT(prepare(recording, options).value().contradicted, IsEmpty());
}

}  // namespace
}  // namespace kinemark::workflow
