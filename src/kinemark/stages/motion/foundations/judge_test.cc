// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "kinemark/stages/motion/scaling/scale.h"
#include "support/test_data.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

const data::ModelDescription& human() {
  static const auto kHuman =
      io::read_osim(testing_support::project_folder() / "models" / "human.osim").value();
  return kHuman;
}

/// The model with markers on pelvis and legs alone.
const data::ModelDescription& legs() {
  static const auto kLegs = [] {
    auto out = human();
    std::erase_if(out.markers, [](const auto& marker) {
      const auto landmark = landmark_of(marker.name);
      return !landmark || landmark->part == BodyPart::trunk || landmark->part == BodyPart::head ||
             landmark->part == BodyPart::upper_arm || landmark->part == BodyPart::forearm ||
             landmark->part == BodyPart::hand;
    });
    return out;
  }();
  return kLegs;
}

/// Three normal numbers, drawn in order.
Vector3d some_vector(Random& random) {
  Vector3d out;
  for (int a = 0; a < 3; ++a) out[a] = random.gaussian();
  return out;
}

/// A subject of another size whose markers were placed by hand.
data::ModelDescription subject(std::uint64_t seed, const data::ModelDescription& like = legs()) {
  Random random(seed, 0);
  data::ModelDescription out = like;
  std::vector<Vector3d> factors;
  const double size = 1.0 + 0.06 * random.gaussian();
  for (std::size_t b = 0; b < out.bodies.size(); ++b) factors.push_back(Vector3d::Constant(size));
  apply_factors(out, factors, false);
  for (auto& marker : out.markers)
    for (int a = 0; a < 3; ++a) marker.x_in_body[a] += 0.005 * random.gaussian();
  return out;
}

/// Frames of a model: coordinates that turn are `spread` about their default.
data::Trajectories frames(const data::ModelDescription& description, std::int64_t count, double spread,
                          std::uint64_t seed) {
  const auto model = model::Model::compile(description).value();
  model::Workspace w(model);
  Random random(seed, 0);
  std::vector<std::string> names;
  for (const auto& marker : description.markers) names.push_back(marker.name);
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = count});
  Eigen::VectorXd q(model.coordinate_count());
  for (std::int64_t f = 0; f < count; ++f) {
    if (f == 0 || spread > 0.1)
      for (int c = 0; c < model.coordinate_count(); ++c) {
        const auto& coordinate = description.coordinates[at(c)];
        q[c] =
            coordinate.default_value + (coordinate.is_rotation && c > 5 ? spread * random.gaussian() : 0.0);
      }
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = w.marker.col(m) + 0.0005 * some_vector(random);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

void exchange(data::Trajectories& trial, const std::string& a, const std::string& b) {
  const auto i = trial.find(a), j = trial.find(b);
  for (std::int64_t f = 0; f < trial.frames(); ++f) {
    const Vector3d kept = trial.x(f, i);
    trial.x(f, i) = trial.x(f, j);
    trial.x(f, j) = kept;
  }
}

void move(data::Trajectories& trial, const std::string& a, const Vector3d& by) {
  for (std::int64_t f = 0; f < trial.frames(); ++f) trial.x(f, trial.find(a)) += by;
}

FoundationJudgement by_model(const data::Trajectories& still, int most = 4) {
  static const StandingBody kBody = body_of_model(legs()).value();
  return judge_foundation(kBody, still, {}, {.most_findings = most}).value();
}

FoundationJudgement by_names(const data::Trajectories& still, const data::Trajectories* movement = nullptr,
                             int most = 4) {
  std::vector<const data::Trajectories*> movements;
  if (movement != nullptr) movements.push_back(movement);
  return judge_foundation(body_of_names(still.names), still, movements, {.most_findings = most}).value();
}

TEST(Judge, ACleanStaticTrialIsNotAccused) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto judgement = by_names(frames(subject(seed), 9, 0.08, seed));
    EXPECT_TRUE(judgement.findings.empty()) << describe(judgement.findings.front(), "s");
    EXPECT_EQ(judgement.judged.size(), legs().markers.size());
  }
  const auto judgement = by_model(frames(subject(4), 9, 0.08, 4));
  EXPECT_TRUE(judgement.findings.empty()) << describe(judgement.findings.front(), "s");
  EXPECT_EQ(judgement.judged.size(), legs().markers.size());
}

TEST(Judge, AWholeBodyIsJudged) {
  const auto still = frames(subject(1, human()), 9, 0.08, 1);
  const auto judgement = by_names(still);
  EXPECT_TRUE(judgement.findings.empty()) << describe(judgement.findings.front(), "s");
  EXPECT_EQ(judgement.judged.size(), 40);
  EXPECT_EQ(judgement.movements, 0);
}

TEST(Judge, AFlexedPostureIsNotAMistake) {
  auto description = subject(5);
  for (auto& coordinate : description.coordinates)
    if (coordinate.name == "knee_angle_r" || coordinate.name == "hip_flexion_r")
      coordinate.default_value = 0.6;
  const auto judgement = by_model(frames(description, 9, 0.02, 5));
  EXPECT_TRUE(judgement.findings.empty()) << describe(judgement.findings.front(), "s");
}

void expect_exchange(const FoundationJudgement& judgement, const std::string& a, const std::string& b) {
  ASSERT_EQ(judgement.findings.size(), 1) << a;
  const auto& f = judgement.findings[0];
  EXPECT_TRUE((f.marker == a && f.partner == b) || (f.marker == b && f.partner == a)) << describe(f, "s");
  EXPECT_EQ(f.shift_m, Vector3d::Zero());
}

TEST(Judge, ExchangedPairsAreNamed) {
  for (const auto& [a, b] :
       {std::pair{"LKNE", "LANK"}, std::pair{"LASI", "RASI"}, std::pair{"LASI", "LPSI"}}) {
    auto still = frames(subject(7), 9, 0.05, 7);
    exchange(still, a, b);
    const auto judgement = by_names(still, nullptr, std::string(a) == "LKNE" ? 4 : 1);
    expect_exchange(judgement, a, b);
    for (const auto& f : judgement.findings)
      EXPECT_THAT(describe(f, "cal.c3d"), HasSubstr("are exchanged in cal.c3d"));
  }
}

TEST(Judge, ExchangedPairsAreNamedAgainstAModel) {
  auto still = frames(subject(7), 9, 0.05, 7);
  exchange(still, "LTOE", "LHEE");
  expect_exchange(by_model(still, 1), "LTOE", "LHEE");
}

TEST(Judge, TwoMarkersThatEachLieElsewhereMayBeOneExchange) {
  // Beside a movement the foot is known so well that heel and toe are first seen one by one.
  const auto person = subject(1);
  auto still = frames(person, 9, 0.10, 1);
  const auto movement = frames(person, 60, 0.25, 51);
  exchange(still, "LTOE", "LHEE");
  expect_exchange(by_names(still, &movement), "LTOE", "LHEE");
}

TEST(Judge, AMarkerElsewhereIsNamedWithSizeAndDirection) {
  auto still = frames(subject(8), 9, 0.05, 8);
  move(still, "LASI", Vector3d(0.0, 0.120, 0.0));  // up in the model's axes
  const auto judgement = by_names(still);
  ASSERT_EQ(judgement.findings.size(), 1);
  const auto& f = judgement.findings[0];
  EXPECT_EQ(f.marker, "LASI");
  EXPECT_TRUE(f.partner.empty());
  EXPECT_LT(std::abs(f.shift_m.y() - 0.120), 4.0 * f.shift_sd_m.y());
  EXPECT_THAT(describe(f, "cal.c3d"), HasSubstr(") from where it should in cal.c3d"));
  EXPECT_THAT(describe(f, "cal.c3d"), HasSubstr("mm up"));
  EXPECT_THAT(describe(f, "cal.c3d"), Not(HasSubstr("are exchanged in")));
  EXPECT_THAT(describe(f, "cal.c3d"), Not(HasSubstr(", as the movement shows it")));
}

TEST(Judge, ASingleMarkerNeedsMoreWhereNoMovementTellsItsPlace) {
  auto still = frames(subject(8), 9, 0.05, 8);
  move(still, "LASI", Vector3d(0.0, 0.120, 0.0));
  const auto body = body_of_names(still.names);
  const auto found_with = [&](double least) {
    return judge_foundation(body, still, {}, {.least_fall = least, .most_findings = 1})
        .value()
        .findings.size();
  };
  EXPECT_EQ(found_with(8.0), 1);
  EXPECT_EQ(found_with(2000.0), 0);
  EXPECT_TRUE(judge_foundation(body, still, {}, {.least_score = 2000.0}).value().findings.empty());
}

TEST(Judge, ExchangesAreNotDescribedAsShiftsNorShiftsAsExchanges) {
  FoundationFinding exchanged{.marker = "LTOE", .partner = "LHEE", .rivals = {}};
  EXPECT_EQ(describe(exchanged, "cal.c3d"), "LTOE and LHEE are exchanged in cal.c3d");
  EXPECT_THAT(describe(exchanged, "cal.c3d"), Not(HasSubstr(") from where it should in")));
  exchanged.by_movement = true;
  EXPECT_EQ(describe(exchanged, "cal.c3d"),
            "LTOE and LHEE are exchanged in cal.c3d, as the movement shows it");
  EXPECT_THAT(describe(exchanged, "cal.c3d"),
              Not(HasSubstr(" or in the movement beside it: in which of the two cannot be known")));
  exchanged.where = MistakeIn::either;
  EXPECT_EQ(
      describe(exchanged, "cal.c3d"),
      "LTOE and LHEE are exchanged in cal.c3d or in the movement beside it: in which of the two cannot be "
      "known");
  exchanged.where = MistakeIn::movement;
  EXPECT_EQ(describe(exchanged, "cal.c3d"), "LTOE and LHEE are exchanged in the movement beside cal.c3d");
  FoundationFinding shifted{.marker = "LKNE",
                            .shift_m = Vector3d(-0.048, 0.020, 0.001),
                            .shift_sd_m = Vector3d::Constant(0.008),
                            .rivals = {"LTIB 60 mm off", "LKNE and LANK exchanged"}};
  EXPECT_EQ(
      describe(shifted, "cal.c3d"),
      "LKNE lies 52 mm (SD 8) from where it should in cal.c3d: 48 mm back, 20 mm up (or: LTIB 60 mm off, "
      "LKNE and LANK exchanged)");
  shifted.rivals.clear();
  shifted.shift_m = Vector3d(0.0, -0.03, -0.04);
  EXPECT_EQ(describe(shifted, "s"),
            "LKNE lies 50 mm (SD 8) from where it should in s: 30 mm down, 40 mm to the left");
  EXPECT_THAT(describe(shifted, "s"), Not(HasSubstr("; in which of the two it is off cannot be known")));
  EXPECT_THAT(describe(shifted, "s"), Not(HasSubstr(") from where the movement has it in")));
  shifted.by_movement = true;
  shifted.where = MistakeIn::movement;
  EXPECT_EQ(
      describe(shifted, "s"),
      "LKNE lies 50 mm (SD 8) from where it should in the movement beside s: 30 mm up, 40 mm to the right");
  shifted.where = MistakeIn::either;
  EXPECT_EQ(describe(shifted, "s"),
            "LKNE lies 50 mm (SD 8) from where the movement has it in s: 30 mm down, 40 mm to the left; in "
            "which of the two it is off cannot be known");
}

/// A mistake in one of two recordings is never said to be in the other.
void expect_not_in(const FoundationJudgement& judgement, const std::string& marker, MistakeIn sound) {
  ASSERT_FALSE(judgement.findings.empty()) << marker;
  EXPECT_TRUE(std::ranges::any_of(judgement.findings, [&](const FoundationFinding& finding) {
    return finding.marker == marker || finding.partner == marker;
  })) << marker;
  for (const auto& finding : judgement.findings) {
    EXPECT_FALSE(finding.where == sound) << describe(finding, "cal.c3d");
    EXPECT_TRUE(finding.by_movement || finding.where == MistakeIn::still);
  }
}

TEST(Judge, AMarkerElsewhereInTheMovementDoesNotAccuseTheStaticTrial) {
  for (const auto* const marker : {"LKNE", "RHEE", "LASI", "RTHI"}) {
    const auto person = subject(31);
    const auto still = frames(person, 9, 0.03, 31);
    // Skin and all, the marker sits elsewhere on its segment.
    auto elsewhere = person;
    for (auto& one : elsewhere.markers)
      if (one.name == marker) one.x_in_body += Vector3d(0.05, 0.02, 0.02);
    const auto movement = frames(elsewhere, 40, 0.25, 131);
    expect_not_in(by_names(still, &movement), marker, MistakeIn::still);
    const auto spoilt = frames(elsewhere, 9, 0.03, 31), sound = frames(person, 40, 0.25, 131);
    expect_not_in(by_names(spoilt, &sound), marker, MistakeIn::movement);
  }
}

TEST(Judge, AnExchangeInAMovementOfOneLegDoesNotAccuseTheStaticTrial) {
  const std::vector<std::string> names{"LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB", "LANK"};
  auto model = human();
  std::erase_if(model.markers,
                [&](const auto& marker) { return std::ranges::find(names, marker.name) == names.end(); });
  for (const auto& [a, b] :
       {std::pair{"LKNE", "LANK"}, std::pair{"LTIB", "LANK"}, std::pair{"LTHI", "LKNE"}}) {
    const auto person = subject(41, model);
    const auto still = frames(person, 9, 0.03, 41);
    auto movement = frames(person, 40, 0.25, 141);
    EXPECT_TRUE(by_names(still, &movement).findings.empty());
    exchange(movement, a, b);
    expect_not_in(by_names(still, &movement), a, MistakeIn::still);
  }
}

/// Trunk, pelvis and legs, with two markers of each leg.
data::Trajectories only(const data::Trajectories& trial) {
  const std::vector<std::string> names{"LASI", "RASI", "LPSI", "RPSI", "C7",   "T10",  "CLAV",
                                       "STRN", "LSHO", "RSHO", "LKNE", "RKNE", "LANK", "RANK"};
  auto out = data::Trajectories::all_missing(names, trial.time);
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = trial.x(f, trial.find(names[at(m)]));
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

TEST(Judge, ToesThatBentAreNoMistakeAndAHeelElsewhereIs) {
  const auto person = subject(5);
  auto still = frames(person, 9, 0.03, 5);
  const auto movement = frames(person, 40, 0.25, 15);
  move(still, "LTOE", Vector3d(0.0, -0.030, 0.0));
  EXPECT_TRUE(by_names(still, &movement).findings.empty());
  move(still, "LHEE", Vector3d(0.0, 0.0, 0.050));
  const auto judgement = by_names(still, &movement);
  ASSERT_FALSE(judgement.findings.empty());
  EXPECT_EQ(judgement.findings[0].marker, "LHEE");
}

TEST(Judge, MarkersOfTrunkAndArmsAreNamedBesideAMovement) {
  const auto person = subject(3, human());
  const auto still = frames(person, 9, 0.03, 3), movement = frames(person, 40, 0.25, 13);
  EXPECT_TRUE(by_names(still, &movement).findings.empty());
  for (const auto* const marker : {"T10", "LSHO", "RELB", "LWRA", "RFHD"}) {
    auto spoilt = still;
    move(spoilt, marker, Vector3d(0.0, 0.06, 0.04));
    const auto judgement = by_names(spoilt, &movement);
    ASSERT_FALSE(judgement.findings.empty()) << marker;
    EXPECT_EQ(judgement.findings[0].marker, marker);
  }
}

TEST(Judge, ShouldersThatMovedDoNotHideAnotherMarker) {
  const auto person = subject(4, human());
  auto still = only(frames(person, 9, 0.03, 4));
  const auto movement = only(frames(person, 40, 0.25, 14));
  for (const auto* const shoulder : {"LSHO", "RSHO"}) move(still, shoulder, Vector3d(-0.02, 0.035, 0.0));
  EXPECT_TRUE(by_names(still, &movement).findings.empty());
  move(still, "LASI", Vector3d(0.03, -0.06, 0.0));
  const auto judgement = by_names(still, &movement);
  ASSERT_EQ(judgement.findings.size(), 1);
  EXPECT_EQ(judgement.findings[0].marker, "LASI");
}

TEST(Judge, StatesWhatItWouldSee) {
  const auto person = subject(6);
  const auto still = frames(person, 9, 0.03, 6), movement = frames(person, 40, 0.25, 16);
  const double alone = by_names(still).seen_at_50_mm, beside = by_names(still, &movement).seen_at_50_mm;
  EXPECT_GT(alone, 0.0);
  EXPECT_LT(alone, 0.8);
  EXPECT_GT(beside, 0.85);
  EXPECT_LE(beside, 1.0);
}

TEST(Judge, TheStillestPartIsJudged) {
  auto trial = frames(subject(2), 60, 0.25, 2);
  for (std::int64_t f = 30; f < 50; ++f)
    for (std::int64_t m = 0; m < trial.markers(); ++m) trial.x(f, m) = trial.x(30, m);
  const auto judgement = by_names(trial);
  EXPECT_GE(judgement.frame, 33);
  EXPECT_LE(judgement.frame, 46);
}

TEST(Judge, AMovementWithoutTheBodysMarkersTellsNothing) {
  const auto still = frames(subject(2), 9, 0.03, 2);
  auto movement = data::Trajectories::all_missing({"a", "b"}, {.rate_hz = 100.0, .frames = 20});
  EXPECT_EQ(by_names(still, &movement).movements, 0);
  const data::Trajectories none =
      data::Trajectories::all_missing(still.names, {.rate_hz = 100.0, .frames = 0});
  EXPECT_EQ(by_names(still, &none).movements, 0);
}

TEST(Judge, ARecordingWithoutSamplesIsNotJudged) {
  const auto still =
      data::Trajectories::all_missing(frames(legs(), 1, 0.0, 1).names, {.rate_hz = 100.0, .frames = 5});
  const auto judgement = by_names(still);
  EXPECT_EQ(judgement.frame, -1);
  EXPECT_TRUE(judgement.judged.empty());
}

TEST(Judge, AMovementShowsWhatTheStaticTrialAloneCannot) {
  const auto person = subject(9);
  auto still = frames(person, 9, 0.03, 9);
  const auto movement = frames(person, 40, 0.25, 10);
  EXPECT_TRUE(by_names(still, &movement).findings.empty());
  move(still, "RTHI", Vector3d(0.0, -0.045, 0.0));  // along the thigh: wands stand at any height
  EXPECT_TRUE(by_names(still).findings.empty());
  const auto judgement = by_names(still, &movement);
  EXPECT_EQ(judgement.movements, 1);
  ASSERT_EQ(judgement.findings.size(), 1);
  EXPECT_EQ(judgement.findings[0].marker, "RTHI");
  EXPECT_EQ(judgement.findings[0].where, MistakeIn::either) << "a wand may stand at any height in both";
  EXPECT_THAT(describe(judgement.findings[0], "cal.c3d"),
              HasSubstr("; in which of the two it is off cannot be known"));
  exchange(still, "LTOE", "LHEE");
  for (const auto& finding : by_names(still, &movement).findings)
    EXPECT_EQ(finding.by_movement, finding.marker == "RTHI") << describe(finding, "cal.c3d");
}

TEST(Judge, ExchangesInAMovementAreFoundThereAndSoundOnesAccuseNobody) {
  for (const std::uint64_t seed : {21, 22, 23}) {
    const auto person = subject(seed);
    const auto still = frames(person, 9, 0.03, seed);
    auto movement = frames(person, 40, 0.25, seed + 100);
    const auto body = body_of_names(movement.names);
    const auto sound = judge_movement(body, movement);
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_TRUE(sound->empty()) << seed << " " << sound->front().marker << " " << sound->front().partner;
    exchange(movement, "LTOE", "LHEE");
    const auto found = judge_movement(body, movement);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_EQ(found->size(), 1U) << seed;
    EXPECT_EQ(std::set({found->front().marker, found->front().partner}),
              std::set<std::string>({"LHEE", "LTOE"}));
    EXPECT_GT(found->front().score, FoundationOptions{}.least_score);
  }
  EXPECT_FALSE(judge_movement(body_of_names({"LHEE"}), frames(subject(1), 5, 0.1, 1), {.least_score = 0.0}));
  const auto nobody = data::Trajectories::all_missing({"LHEE", "LTOE"}, {.rate_hz = 100.0, .frames = 5});
  EXPECT_TRUE(judge_movement(body_of_names(nobody.names), nobody)->empty());
}

TEST(Judge, MarkersOfOneClusterThatAreCountedOtherwiseOnTheOtherLegAreNotExchanged) {
  auto person = subject(31);
  const auto thigh_of = [&](const std::string& name) {
    return std::ranges::find(person.markers, name, &data::MarkerDescription::name)->body_idx;
  };
  const auto left = thigh_of("LTHI"), right = thigh_of("RTHI");
  // Down the left thigh 1, 2, 3, down the right one 3, 2, 1.
  for (int k = 0; k < 3; ++k) {
    const double down_m = -0.12 - 0.08 * k;
    for (const bool of_left : {true, false}) {
      auto marker =
          *std::ranges::find(person.markers, of_left ? "LTHI" : "RTHI", &data::MarkerDescription::name);
      marker.name = (of_left ? "LTHI" : "RTHI") + std::to_string(of_left ? k + 1 : 3 - k);
      marker.body_idx = of_left ? left : right;
      marker.x_in_body = Vector3d(0.03 + 0.02 * (k % 2), down_m, (of_left ? -0.07 : 0.07) + 0.01 * k);
      person.markers.push_back(marker);
    }
  }
  auto movement = frames(person, 40, 0.25, 131);
  const auto found = judge_movement(body_of_names(movement.names), movement);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->empty()) << found->front().marker << " " << found->front().partner;
  exchange(movement, "LTOE", "LHEE");
  EXPECT_EQ(judge_movement(body_of_names(movement.names), movement).value().size(), 1U);
}

TEST(Judge, ThighWandsAtDifferentHeightsAreAsPrescribed) {
  auto still = frames(subject(11), 9, 0.03, 11);
  move(still, "LTHI", Vector3d(0.0, -0.06, 0.0));
  EXPECT_TRUE(by_names(still).findings.empty());
}

TEST(Judge, TwoMistakesAreBothFound) {
  auto still = frames(subject(12), 9, 0.03, 12);
  exchange(still, "LTOE", "LHEE");
  exchange(still, "RASI", "RPSI");
  EXPECT_EQ(by_names(still, nullptr, 2).findings.size(), 2);
}

TEST(Judge, TooFewMarkersAreNotJudged) {
  const auto whole = frames(human(), 3, 0.0, 1);
  auto still = data::Trajectories::all_missing({"LASI", "RASI", "LKNE"}, whole.time);
  const auto judgement = by_names(still);
  EXPECT_TRUE(judgement.judged.empty());
  EXPECT_TRUE(judgement.findings.empty());
}

TEST(Judge, OptionsAreChecked) {
  EXPECT_FALSE(FoundationOptions{.least_score = 0.0}.check());
  EXPECT_FALSE(FoundationOptions{.least_score_beside = 0.0}.check());
  EXPECT_FALSE(FoundationOptions{.least_fall = -1.0}.check());
  EXPECT_FALSE(FoundationOptions{.least_fall_beside = 0.0}.check());
  EXPECT_FALSE(FoundationOptions{.most_findings = 0}.check());
  EXPECT_FALSE(FoundationOptions{.between_sd_m = 2.0}.check());
  EXPECT_FALSE(FoundationOptions{.still_sd_m = -1.0}.check());
  EXPECT_FALSE(FoundationOptions{.moving_frames = 0}.check());
  EXPECT_TRUE(FoundationOptions{}.check());
}

TEST(ScoreExchange, IsBelowZeroForTheNamesAsTheyAreAndAboveForExchangedOnes) {
  const auto body = body_of_names(frames(legs(), 1, 0.0, 1).names);
  for (const std::uint64_t seed : {1, 2, 3}) {
    auto movement = frames(subject(seed), 12, 0.25, seed);
    for (const auto& [one, other] :
         {std::pair("LKNE", "RKNE"), std::pair("RHEE", "RTOE"), std::pair("LASI", "LPSI")}) {
      const auto clean = score_exchange(body, movement, one, other);
      ASSERT_TRUE(clean);
      EXPECT_LT(*clean, -12.0) << one << " " << seed;
      exchange(movement, one, other);
      EXPECT_GT(*score_exchange(body, movement, one, other), 12.0) << one << " " << seed;
      exchange(movement, one, other);
    }
  }
}

TEST(ScoreExchange, AsksNothingOfMarkersThatNoBodyHasOrNoFrameShows) {
  auto movement = frames(subject(1), 12, 0.25, 1);
  const auto body = body_of_names(movement.names);
  EXPECT_FALSE(score_exchange(body, movement, "LKNE", "Wand"));
  const auto knee = movement.find("LKNE");
  for (std::int64_t f = 0; f < movement.frames(); ++f) movement.set_missing(f, knee);
  EXPECT_FALSE(score_exchange(body, movement, "LKNE", "RKNE"));
  EXPECT_TRUE(score_exchange(body, movement, "LANK", "RANK"));
}

}  // namespace
}  // namespace kinemark::motion
