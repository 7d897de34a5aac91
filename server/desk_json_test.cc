// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/desk_json.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "kinemark/core/missing.h"
#include "kinemark/pipeline/desk/testing/fake_desk.h"

namespace kinemark::server {
namespace {

using pipeline::DeskSession;
using pipeline::FakeDesk;
using ::testing::HasSubstr;

// What a request says of itself; the error's sentence where it is none.
std::string said(const std::string& body) {
  const auto request = parse_desk_request(body, {});
  return request ? "" : request.error().message;
}

TEST(DeskJson, BeforeADeviceIsOpenThereAreSourcesAlone) {
  FakeDesk desk;
  const DeskSession session(desk, {});
  const auto json = desk_json(session.state());
  EXPECT_EQ(json["step"], "source");
  EXPECT_EQ(json["sources"][1].dump(),
            R"({"uri":"serial:/dev/ttyACM0","name":"Arduino Uno","state":"in use by another program"})");
  EXPECT_TRUE(json["device"].is_null());
  EXPECT_TRUE(json["granted"].is_null());
  EXPECT_TRUE(json["live"].is_null());
}

TEST(DeskJson, TheSetUpKnowsWhatTheDeviceCanDo) {
  FakeDesk desk;
  desk.device.fastest = {.settle_s = 2e-4, .conversion_s = 1e-4, .off_s = 0.0, .dark_slot = false};
  const DeskSession session(desk, pipeline::rig_at("4"));
  const auto json = desk_json(session.state());
  EXPECT_EQ(json["step"], "plan");
  EXPECT_EQ(json["wanted"]["leds"], "4");
  EXPECT_EQ(json["device"]["most_leds"], 8);
  EXPECT_EQ(json["device"]["slot_us"], 1000.0) << "settling and 8 conversions";
  EXPECT_EQ(json["device"]["highest_rates_hz"][3], 250.0) << "of 4 LEDs";
  EXPECT_TRUE(json["live"].is_null());
}

TEST(DeskJson, EachLedInEachCameraHasItsNumbersOrNull) {
  FakeDesk desk;
  desk.now.frames = 9;
  desk.now.guide = "roll camera A";
  desk.now.seen.resize(6);
  desk.now.spots.assign(6, {{0.25, -0.5}, {kNaN, kNaN}});
  desk.now.seen[3] = {
      .light_counts = 812.34, .highest_share = 0.5, .noise_counts = 1.234, .occluded_share = 0.1};
  DeskSession session(desk, pipeline::rig_at("3"));
  session.start(pipeline::rig_at("3"));
  const auto json = desk_json(session.state());
  EXPECT_EQ(json["granted"]["cameras"].dump(), R"(["A","B"])");
  EXPECT_EQ(json["granted"]["intensity"].dump(), "[1.0,1.0,1.0]");
  const auto& live = json["live"];
  EXPECT_EQ(live["guide"], "roll camera A");
  ASSERT_EQ(live["seen"].size(), 3U);
  ASSERT_EQ(live["seen"][1].size(), 2U);
  EXPECT_EQ(live["seen"][1][1]["noise_counts"], 1.23);
  EXPECT_EQ(live["seen"][1][1]["light_counts"], 812.3);
  EXPECT_EQ(live["seen"][1][1]["spots"].dump(), "[[0.25,-0.5]]") << "a frame without a spot has none";
  EXPECT_TRUE(live["seen"][0][0]["noise_counts"].is_null());
}

TEST(DeskJson, ManySpotsAreThinnedAndTheNewestIsAmongThem) {
  FakeDesk desk;
  desk.now.seen.resize(6);
  desk.now.spots.resize(6);
  for (int i = 0; i < 1000; ++i) desk.now.spots[0].emplace_back(0.001 * i, 0.0);
  DeskSession session(desk, pipeline::rig_at("3"));
  session.start(pipeline::rig_at("3"));
  const auto spots = desk_json(session.state())["live"]["seen"][0][0]["spots"];
  EXPECT_LE(spots.size(), 30U);
  EXPECT_EQ(spots[0][0], 0.999);
}

TEST(DeskJson, TheCheckAndWhatIsKept) {
  FakeDesk desk;
  DeskSession session(desk, pipeline::rig_at());
  session.start(pipeline::rig_at());
  session.record();
  session.stop();
  EXPECT_EQ(desk_json(session.state())["check"][1]["good"], false);
  session.keep();
  EXPECT_EQ(desk_json(session.state())["kept"].dump(), R"(["raw/01.mcap"])");
}

TEST(DeskRequest, ASetUpTakesTextsAndNumbersAndKeepsWhatIsNotGiven) {
  pipeline::Wanted now;
  now.subject = "S1";
  const auto request =
      parse_desk_request(R"({"do": "start", "leds": 4, "rate_hz": "", "duration_s": 2.5})", now);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->lines.leds, "4");
  EXPECT_EQ(request->lines.duration_s, "2.5");
  EXPECT_EQ(request->lines.subject, "S1");
  EXPECT_EQ(request->lines.trial, "01");
}

TEST(DeskRequest, WhatIsNoneIsASentence) {
  EXPECT_THAT(said("nothing"), HasSubstr("need {\"do\""));
  EXPECT_THAT(said("[]"), HasSubstr("need {\"do\""));
  EXPECT_THAT(said(R"({"do": 1})"), HasSubstr("need {\"do\""));
  EXPECT_THAT(said(R"({"do": "fly"})"), HasSubstr("there is no action 'fly'"));
  EXPECT_THAT(said(R"({"do": "record", "leds": 3})"), HasSubstr("\"leds\" is no member of \"record\""));
  EXPECT_THAT(said(R"({"do": "start", "leds": [3]})"), HasSubstr("\"leds\" is a text or a number"));
  EXPECT_THAT(said(R"({"do": "start", "trial": "a\u0000b"})"),
              HasSubstr("\"trial\" holds a control character"));
  EXPECT_THAT(said(R"({"do": "start", "trial": ")" + std::string(1001, 'x') + "\"}"),
              HasSubstr("longer than"));
  EXPECT_THAT(said(R"({"do": "intensity", "value": 0.5})"), HasSubstr("the number of an LED"));
  EXPECT_THAT(said(R"({"do": "intensity", "led": -1, "value": 0.5})"), HasSubstr("the number of an LED"));
  EXPECT_THAT(said(R"({"do": "intensity", "led": 1, "value": "much"})"), HasSubstr("from 0.1 to 1"));
  EXPECT_EQ(said(R"({"do": "intensity", "led": 1, "value": 0.5})"), "");
}

TEST(DeskRequest, PagesOpenDevicesAndNoFiles) {
  for (const char* uri : {"sim:rig?leds=4", "serial:/dev/ttyACM0", "comedi:/dev/comedi0"})
    EXPECT_EQ(said(fmt::format(R"({{"do": "open", "uri": "{}"}})", uri)), "") << uri;
  for (const char* uri : {"replay:/home/a.mcap", "/dev/ttyACM0", ""})
    EXPECT_THAT(said(fmt::format(R"({{"do": "open", "uri": "{}"}})", uri)),
                HasSubstr("no device that is attached"));
  EXPECT_THAT(said(R"({"do": "open"})"), HasSubstr("needs the address"));
}

TEST(DeskRequest, EachActionIsTheCallOfItsName) {
  FakeDesk desk;
  DeskSession session(desk, {});
  const auto ask = [&session](const std::string& body) {
    const auto request = parse_desk_request(body, session.state().wanted);
    ASSERT_TRUE(request) << body;
    ask_desk(*request, session);
  };
  ask(R"({"do": "look"})");
  ask(R"({"do": "open", "uri": "sim:rig"})");
  ask(R"({"do": "leave_source"})");
  ask(R"({"do": "open", "uri": "sim:rig"})");
  ask(R"({"do": "start", "leds": "2", "rate_hz": 100})");
  EXPECT_EQ(desk.asked.rate_hz, 100.0);
  ask(R"({"do": "set_up"})");
  ask(R"({"do": "start"})");
  ask(R"({"do": "restart_guide"})");
  ask(R"({"do": "intensity", "led": 1, "value": 0.5})");
  EXPECT_EQ(desk.light, 0.5);
  ask(R"({"do": "record"})");
  ask(R"({"do": "stop"})");
  ask(R"({"do": "discard"})");
  ask(R"({"do": "record"})");
  ask(R"({"do": "stop"})");
  ask(R"({"do": "keep"})");
  EXPECT_THAT(desk.calls, ::testing::ElementsAre("open sim:rig", "close", "open sim:rig", "restart_guide",
                                                 "record", "stop", "discard", "record", "stop", "keep"));
}

}  // namespace
}  // namespace kinemark::server
