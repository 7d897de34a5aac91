// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/acquire_job.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/recording/counts_recording.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using Kind = TrialBegin::Kind;

class Acquire : public testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;

  AcquireJob job(const std::string& source = "sim:rig?leds=4&fast") {
    AcquireJob out;
    out.source = source;
    out.output = scratch_ / "trial.mcap";
    out.frames = 500;
    return out;
  }
  std::string said(const AcquireJob& asked) {
    const auto outcome = run_acquire(asked);
    EXPECT_FALSE(outcome);
    EXPECT_FALSE(std::filesystem::exists(asked.output));
    return outcome ? "" : outcome.error().message;
  }
};

TEST_F(Acquire, RecordsATrialWithWhatIsKnownOfIt) {
  auto asked = job();
  asked.rate_hz = 200.0;
  asked.subject = "S01";
  asked.trial = "reach";
  asked.leds = "hand,wrist";
  asked.intensity = {{"wrist", 0.5}};
  const auto outcome = run_acquire(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->exit_status(), 0);
  EXPECT_THAT(outcome->written, ElementsAre(asked.output));
  EXPECT_THAT(outcome->notes, Contains(Field(&TrialNote::text, "all 500 frames came and are kept")));
  const auto read = io::read_counts(asked.output).value();
  EXPECT_EQ(read.counts.leds, (std::vector<std::string>{"hand", "wrist"}));
  EXPECT_EQ(read.counts.frames(), 500);
  const auto& about = read.metadata.front().values;
  EXPECT_EQ(about.at("subject"), "S01");
  EXPECT_EQ(about.at("trial"), "reach");
  EXPECT_EQ(about.at("intensity wrist"), "0.5");
  EXPECT_EQ(about.at("source"), asked.source);
  EXPECT_THAT(about.at("started"), testing::MatchesRegex("....-..-..T..:..:..Z"));
  EXPECT_EQ(read.metadata[1].name, "device");
}

TEST_F(Acquire, DurationIsInSecondsOfTheDevice) {
  auto asked = job();
  asked.frames = 0;
  asked.duration_s = 2.0;
  asked.rate_hz = 150.0;
  EXPECT_EQ(run_acquire(asked)->recorded.progress.frames, 300);
  asked.force = true;
  asked.frames = 200;
  EXPECT_EQ(run_acquire(asked)->recorded.progress.frames, 200);
  asked.frames = 400;
  EXPECT_EQ(run_acquire(asked)->recorded.progress.frames, 300);
}

TEST_F(Acquire, JsonHasFiguresAndNullWhereNoneIsKnown) {
  const auto json = acquire_json(run_acquire(job()).value());
  EXPECT_EQ(json["frames"], 500);
  EXPECT_EQ(json["dropped_here"], 0);
  EXPECT_TRUE(json["clock"].is_null());
  EXPECT_TRUE(json["error"].is_null());
  EXPECT_EQ(json["leds"].size(), 8U);
  EXPECT_EQ(json["leds"][3]["led"], "rim 2");
  EXPECT_EQ(json["leds"][3]["camera"], "B");
  EXPECT_EQ(json["ended"], "complete");
  EXPECT_EQ(progress_json({.frames = 3}).dump(),
            R"({"frames":3,"acknowledged":0,"dropped_by_device":0,"dropped_here":0})");
}

TEST_F(Acquire, LostFramesMissTheGate) {
  auto asked = job("sim:rig?leds=2&fast&unplug_at=1&unplug_for=1");
  asked.rate_hz = 100.0;
  const auto outcome = run_acquire(asked).value();
  EXPECT_EQ(outcome.exit_status(), 1);
  EXPECT_THAT(outcome.notes, Contains(Field(&TrialNote::text, HasSubstr("the device lost"))));
}

TEST_F(Acquire, StopsWhenAskedAndKeepsTheTrial) {
  auto asked = job();
  asked.frames = 0;
  asked.stop = [] { return true; };
  const auto outcome = run_acquire(asked).value();
  EXPECT_EQ(outcome.recorded.end, RecorderEnd::stopped);
  EXPECT_EQ(io::read_counts(asked.output).value().end, io::RecordingEnd::closed);
}

TEST_F(Acquire, RefusesWhatCannotBe) {
  auto asked = job();
  asked.rate_hz = 1000.0;
  EXPECT_THAT(said(asked), HasSubstr("frames per second at most"));
  asked = job();
  asked.leds = "9";
  EXPECT_THAT(said(asked), HasSubstr("LEDs: 9 were asked for; the device has 4"));
  asked = job();
  asked.intensity = {{"nose", 0.5}};
  EXPECT_THAT(said(asked), HasSubstr("there is no LED 'nose'; there are rim 1"));
  asked = job();
  asked.begin = {.kind = Kind::digital};
  EXPECT_THAT(said(asked), HasSubstr("no digital line"));
  asked = job();
  asked.begin = {.kind = Kind::threshold, .led = "nose"};
  EXPECT_THAT(said(asked), HasSubstr("no LED 'nose'"));
  asked = job();
  asked.duration_s = -1.0;
  EXPECT_THAT(said(asked), HasSubstr("cannot be negative"));
  asked = job();
  asked.output = scratch_ / "trial.c3d";
  EXPECT_THAT(said(asked), HasSubstr(".mcap"));
}

TEST_F(Acquire, BeginsWithAKeyATimeOrALight) {
  auto asked = job();
  asked.begin = {.kind = Kind::key};
  int waited = 0;
  EXPECT_TRUE(run_acquire(asked, [&] { return ++waited == 1; }));
  EXPECT_EQ(waited, 1);
  asked.force = true;
  EXPECT_EQ(run_acquire(asked, [] { return false; }).error().code, Code::cancelled);
  asked.begin = {.kind = Kind::time, .value = 0.01};
  EXPECT_TRUE(run_acquire(asked));
  asked.begin = {.kind = Kind::time, .value = 100.0};
  asked.stop = [] { return true; };
  EXPECT_EQ(run_acquire(asked).error().code, Code::cancelled);
  asked.stop = {};
  asked.begin = {.kind = Kind::threshold, .value = 10.0, .led = "rim 2"};
  EXPECT_TRUE(run_acquire(asked));
}

TEST(ParseBegin, KnowsFourWords) {
  EXPECT_EQ(parse_begin("key")->kind, Kind::key);
  EXPECT_EQ(parse_begin("digital")->kind, Kind::digital);
  EXPECT_EQ(parse_begin("time=2.5")->value, 2.5);
  EXPECT_EQ(parse_begin("threshold=900")->led, "");
  EXPECT_EQ(parse_begin("threshold=a:b:900")->led, "a:b");
  EXPECT_EQ(parse_begin("threshold=a:b:900")->value, 900.0);
  for (const char* text :
       {"", "now", "time", "time=x", "time=-1", "threshold=", "threshold=hand:", "light=3"})
    EXPECT_THAT(parse_begin(text).error().message, HasSubstr("is none of key, digital, time=S")) << text;
}

}  // namespace
}  // namespace kinemark::pipeline
