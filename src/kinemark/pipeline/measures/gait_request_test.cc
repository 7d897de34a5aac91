// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/gait_request.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kinemark/pipeline/measures/event_table.h"

namespace kinemark::pipeline {
namespace {

using data::FootEvent;
using data::Side;

analysis::Gait two_events() {
  analysis::Gait gait;
  gait.events = {{Side::left, FootEvent::strike, 1.25, 0.006, data::EventSource::plate, "plate 1, east"},
                 {Side::right, FootEvent::off, 1.4, kNaN, data::EventSource::file, "the file"}};
  return gait;
}
const TimeBase kWalkTime{.rate_hz = 100.0, .t0_s = 0.4, .frames = 400, .first_number = 41};

TEST(GaitRequest, RefusesWhatIsNone) {
  EXPECT_TRUE(GaitRequest{}.check());
  EXPECT_FALSE(GaitRequest{}.wanted());
  EXPECT_EQ(GaitRequest{.events = "plate"}.check().error().code, Code::usage);
  EXPECT_EQ(GaitRequest{.write_events = "a.xlsx"}.check().error().message,
            "a.xlsx: events are written as .csv, .c3d or .nwb");
  EXPECT_FALSE(GaitRequest{.write_cycles = "a.c3d"}.check());
  EXPECT_FALSE(GaitRequest{.angles = "Q.mot"}.check());
  EXPECT_FALSE(GaitRequest{.write_events = "a.csv"}.wanted());
  EXPECT_TRUE(GaitRequest{.events = "movement"}.check());
  EXPECT_FALSE(GaitRequest{.events = "movement"}.wanted());
  EXPECT_TRUE(GaitRequest{.events = "movement"}.of_movement());
  const auto both = GaitRequest{.events = "movement", .markers = {"left_heel=A"}}.check();
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, Code::usage);
}

TEST(GaitRequest, NothingIsAskedOfWalkingWhereNothingOfItIsWritten) {
  EXPECT_TRUE(GaitRequest{}.check_idle());
  EXPECT_EQ(GaitRequest{.events = "plates"}.check_idle().error().message,
            "--events is of walking, of which nothing is written or drawn; need --write-events, "
            "--write-cycles, --figures or --report too");
  EXPECT_TRUE(
      GaitRequest{.markers = {"left_heel=A"}}.check_idle().error().message.starts_with("--gait-marker is"));
  EXPECT_EQ(GaitRequest{.events = "movement"}.check_idle().error().code, Code::usage);
  EXPECT_EQ(GaitRequest{.events = "plate"}.check_idle().error().message,
            GaitRequest{.events = "plate"}.check().error().message);
}

TEST(GaitOptions, ReadsRoles) {
  const auto options = gait_options({.events = "file", .markers = {"left_heel=A=B"}});
  ASSERT_TRUE(options);
  EXPECT_EQ(options->choice, analysis::EventChoice::file);
  EXPECT_EQ(options->markers, (std::vector<analysis::MarkerRole>{{"left_heel", "A=B"}}));
  EXPECT_EQ(gait_options({.markers = {"LHEE"}}).error().code, Code::usage);
  EXPECT_FALSE(gait_options({.markers = {"nowhere.toml"}}));
}

TEST(GaitJson, HasNullWhereNothingIsKnown) {
  auto gait = two_events();
  auto json = gait_json(gait);
  EXPECT_TRUE(json["belt_speed"].is_null());
  EXPECT_TRUE(json["events"][1]["sd_s"].is_null());
  gait.treadmill = true, gait.belt_speed_m_per_s = 1.25;
  EXPECT_EQ(gait_json(gait)["belt_speed"], 1250.0);
  EXPECT_TRUE(gait_json(gait)["treadmill"]);
  EXPECT_EQ(events_text(gait).find("over ground"), std::string::npos);  // no kind was judged
  gait.kind = {.manner = analysis::GaitManner::sprint,
               .direction = analysis::GaitDirection::backward,
               .stride_s = 0.46};
  gait.treadmill = false, gait.person = "Ann";
  EXPECT_EQ(gait_json(gait)["type"], "sprint");
  EXPECT_FALSE(gait_json(gait)["treadmill"]);
  EXPECT_EQ(gait_json(gait)["direction"], "backward");
  EXPECT_EQ(gait_json(gait)["person"], "Ann");
  EXPECT_EQ(gait_json(gait)["stride_time_s"], 0.46);
  gait.kind.longer_than_s = 0.3;  // no stride was seen whole
  EXPECT_TRUE(gait_json(gait)["stride_time_s"].is_null());
  EXPECT_NE(events_text(gait).find("sprinting over ground, backward"), std::string::npos);
  EXPECT_NE(events_text(gait).find("Left  Foot Strike    1.250 +- 0.006 s  plate 1"), std::string::npos);
}

TEST(GaitCurves, AreCutByTheCyclesOfTheirSide) {
  data::Trial trial;
  trial.markers.time = kWalkTime;
  trial.channels = {.names = {"LKneeAngles", "PelvisAngles", "LKneeForce"},
                    .kinds = {data::ChannelKind::angle, data::ChannelKind::angle, data::ChannelKind::force},
                    .units = {"deg", "deg", "N"},
                    .rate_hz = 100.0,
                    .frames = 400,
                    .values = Array<double>(400 * 9, 10.0)};
  const std::vector<analysis::GaitCycle> cycles{{.side = Side::left, .start_s = 1.0, .end_s = 2.0},
                                                {.side = Side::right, .start_s = 1.5, .end_s = 2.5}};
  const auto curves = gait_curves(trial, cycles, {});
  ASSERT_TRUE(curves);
  ASSERT_EQ(curves->size(), 9u);  // three components: left knee by one foot, pelvis by two
  EXPECT_EQ((*curves)[0].id, "LKneeAngles x");
  const auto csv = curves_csv({{"", {(*curves)[0]}}}, {.file = "walk.c3d"});
  EXPECT_NE(csv.find("walk.c3d,,,,,LKneeAngles x,Left,,1,50,10,,,deg\n"), std::string::npos);
  EXPECT_NE(csv.find("walk.c3d,,,,,LKneeAngles x,Left,,mean,100,10,,,deg\n"), std::string::npos);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 2 * 101);
  EXPECT_FALSE(gait_curves(trial, {}, {}));
  trial.channels = {};
  EXPECT_NE(gait_curves(trial, cycles, {}).error().message.find("--angles"), std::string::npos);
}

TEST(GaitRequestFiles, AreRolesAnglesWithTheirDeviationsAndNorms) {
  GaitRequest request;
  EXPECT_TRUE(files_of(request).empty());
  request.markers = {"left_heel=LHEE", "roles.toml"};
  request.angles = "day/q.mot";
  request.sheet.norms = {"norm.csv"};
  const auto files = files_of(request);
  for (const char* name : {"roles.toml", "day/q.mot", "day/q_sd.sto", "norm.csv"})
    EXPECT_NE(std::ranges::find(files, std::filesystem::path(name)), files.end()) << name;
}

}  // namespace
}  // namespace kinemark::pipeline
