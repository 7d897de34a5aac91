// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/acquire_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/desk/plan_text.h"
#include "kinemark/stages/simulation/rig_physics.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;
using testing::Not;

// A desk whose rig runs: 3 LEDs as fast as they are asked for.
struct Rig {
  testing_support::ScratchFolder folder;
  AcquireDesk desk{{.folder = folder / "trials"}};
  stream::DeviceCapabilities device = *desk.open("sim:rig?leds=3&speed=20");
  stream::GrantedPlan granted = *desk.run(plan_of({}, device)->scan);

  // Until it has seen that many frames, or a minute.
  LiveView after(std::int64_t frames) {
    for (int i = 0; i < 6000; ++i) {
      LiveView view = desk.live();
      if (view.frames >= frames) return view;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
  }
};

TEST(AcquireDesk, ListsTheSimulatedRig) {
  AcquireDesk desk({});
  const auto sources = desk.sources();
  EXPECT_TRUE(std::ranges::any_of(sources, [](const auto& s) { return s.uri.starts_with("sim:rig"); }));
}

TEST(AcquireDesk, ShowsWhatTheRigSeesWhileNothingIsRecorded) {
  Rig rig;
  const LiveView view = rig.after(100);
  ASSERT_EQ(view.seen.size(), 6U);
  EXPECT_GT(view.seen[0].light_counts, 0.0);
  EXPECT_LT(view.seen[0].noise_counts, 5.0);
  EXPECT_FALSE(view.spots[0].empty());
  EXPECT_EQ(view.acknowledged, 0);
  EXPECT_FALSE(std::filesystem::exists(rig.folder / "trials"));
}

TEST(AcquireDesk, ATrialOfAGivenLengthIsKeptWithItsName) {
  Rig rig;
  ASSERT_TRUE(rig.desk.record({"S1", "reach_01", 1.0}));
  LiveView view;
  for (int i = 0; i < 6000 && !view.ended; ++i) {
    view = rig.desk.live();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(view.ended);
  const auto check = rig.desk.stop();
  ASSERT_TRUE(check);
  EXPECT_THAT((*check)[0].text, HasSubstr("came and are kept"));
  const auto file = rig.desk.keep();
  ASSERT_TRUE(file);
  const auto recorded = io::read_counts(*file);
  ASSERT_TRUE(recorded) << recorded.error().message;
  EXPECT_EQ(recorded->end, io::RecordingEnd::closed);
  EXPECT_EQ(recorded->counts.frames(), std::llround(rig.granted.plan.rate_hz));
  EXPECT_EQ(recorded->metadata.at(0).values.at("subject"), "S1");
  EXPECT_GT(rig.after(1).frames, 0);  // the live view goes on
}

TEST(AcquireDesk, ATrialThatIsDiscardedIsGone) {
  Rig rig;
  ASSERT_TRUE(rig.desk.record({"", "01", 0.0}));
  (void)rig.after(10);
  ASSERT_TRUE(rig.desk.stop());
  EXPECT_TRUE(std::filesystem::exists(rig.folder / "trials/01.mcap"));
  EXPECT_TRUE(rig.desk.discard());
  EXPECT_FALSE(std::filesystem::exists(rig.folder / "trials/01.mcap"));
}

TEST(AcquireDesk, TrialsOfASessionArePartOfIt) {
  const testing_support::ScratchFolder folder;
  AcquireDesk desk(TrialFiles{.session = Session::open(folder / "day1", {}).value()});
  const auto device = desk.open("sim:rig?leds=3&speed=20").value();
  ASSERT_TRUE(desk.run(plan_of({}, device)->scan));
  const auto trial = [&](const std::string& subject, const std::string& name) {
    const auto begun = desk.record({subject, name, 0.0});
    return begun ? desk.stop() : Result<std::vector<TrialNote>>(std::unexpected(begun.error()));
  };
  ASSERT_TRUE(trial("S1", "01"));
  EXPECT_EQ(desk.keep(), (folder / "day1/raw/01.mcap").string());
  EXPECT_EQ(desk.free_name("01"), "02");
  ASSERT_TRUE(trial("S1", "02"));
  ASSERT_TRUE(desk.discard());
  const auto other = trial("S2", "02");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("of subject 'S1', not 'S2'"));
  ASSERT_TRUE(trial("S1", "03"));
  desk.close();  // nobody has judged it: it is kept
  const auto session = Session::read(folder / "day1").value();
  ASSERT_EQ(session.trials().size(), 2U);
  EXPECT_EQ(session.trials()[1].file, "raw/03.mcap");
  EXPECT_EQ(session.subject(), "S1");
  EXPECT_TRUE(session.check());
}

TEST(AcquireDesk, ATrialThatItsSessionCannotTakeInStays) {
  const testing_support::ScratchFolder folder;
  AcquireDesk desk(TrialFiles{.session = Session::open(folder / "day1", {}).value()});
  const auto device = desk.open("sim:rig?leds=3&speed=20").value();
  ASSERT_TRUE(desk.run(plan_of({}, device)->scan));
  ASSERT_TRUE(desk.record({"", "01", 0.0}));
  ASSERT_TRUE(desk.stop());
  std::ofstream(folder / "day1/MANIFEST") << "rubbish\n";
  EXPECT_TRUE(desk.keep());
  EXPECT_TRUE(std::filesystem::exists(folder / "day1/raw/01.mcap"));
  EXPECT_THAT(desk.live().trouble, HasSubstr("MANIFEST: line 1"));
}

TEST(AcquireDesk, AFileThatIsThereIsNeverReplaced) {
  Rig rig;
  std::filesystem::create_directories(rig.folder / "trials");
  std::ofstream(rig.folder / "trials/01.mcap") << "mine";
  const auto begun = rig.desk.record({"", "01", 0.0});
  ASSERT_FALSE(begun);
  EXPECT_THAT(begun.error().message, HasSubstr("01.mcap"));
  std::string text;
  std::ifstream(rig.folder / "trials/01.mcap") >> text;
  EXPECT_EQ(text, "mine");
  EXPECT_GT(rig.after(1).frames, 0);
}

TEST(AcquireDesk, NamesThatAreNoFilesAreRefused) {
  Rig rig;
  EXPECT_FALSE(rig.desk.record({"", "../01", 0.0}));
  EXPECT_FALSE(std::filesystem::exists(rig.folder / "01.mcap"));
}

TEST(AcquireDesk, IntensityChangesTheLight) {
  Rig rig;
  const double before = rig.after(100).seen[0].light_counts;
  ASSERT_TRUE(rig.desk.set_intensity(0, 0.5));
  EXPECT_NEAR(rig.after(100).seen[0].light_counts / before, 0.5, 0.1);
}

TEST(AcquireDesk, RefusesARateThatTheLedsLeaveNoRoomFor) {
  Rig rig;
  auto plan = rig.granted.plan;
  plan.rate_hz = 100000.0;
  const auto granted = rig.desk.run(plan);
  ASSERT_FALSE(granted);
  EXPECT_THAT(granted.error().message, HasSubstr("at most"));
  EXPECT_GT(rig.after(10).frames, 0);  // what ran before goes on
}

TEST(AcquireDesk, SaysThatTheDeviceIsAwayWhileItIs) {
  AcquireDesk desk({});
  const auto device = desk.open("sim:rig?leds=1&speed=20&unplug_at=2&unplug_for=1000");
  ASSERT_TRUE(desk.run(plan_of({.leds = "1"}, *device)->scan));
  EXPECT_THAT(desk.live().trouble, Not(HasSubstr(": the device does not answer; look at its plug")));
  std::string trouble;
  for (int i = 0; i < 6000 && trouble.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    trouble = desk.live().trouble;
  }
  EXPECT_THAT(trouble, HasSubstr(": the device does not answer; look at its plug"));
}

TEST(AcquireDesk, SaysThatADeviceHasEnded) {
  AcquireDesk desk({});
  const auto device = desk.open("sim:rig?leds=1&speed=20&seconds=2");
  ASSERT_TRUE(desk.run(plan_of({.leds = "1"}, *device)->scan));
  EXPECT_THAT(desk.live().trouble, Not(HasSubstr(": the device gives no more frames; start it again")));
  std::string trouble;
  for (int i = 0; i < 6000 && trouble.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    trouble = desk.live().trouble;
  }
  EXPECT_THAT(trouble, HasSubstr(": the device gives no more frames; start it again"));
}

TEST(AcquireDesk, NamesOfTrialsAreFree) {
  const testing_support::ScratchFolder folder;
  const AcquireDesk desk({.folder = folder.path()});
  EXPECT_EQ(desk.free_name("01"), "01");
  std::ofstream(folder / "01.mcap") << "mine";
  std::filesystem::create_symlink(folder / "absent", folder / "02.mcap");
  EXPECT_EQ(desk.free_name("01"), "03");
}

TEST(AcquireDesk, ADeviceThatCannotBeOpenedIsAFailureUntilOneIs) {
  AcquireDesk desk({});
  EXPECT_FALSE(desk.open("serial:/absent"));
  ASSERT_TRUE(desk.failure());
  EXPECT_EQ(desk.failure()->code, Code::device);
  EXPECT_TRUE(desk.open("sim:rig"));
  EXPECT_FALSE(desk.failure());
}

TEST(AcquireDesk, GuidesTheAlignmentWhereTheRigIsKnown) {
  simulation::RigDrawOptions drawn;
  AcquireDesk desk({.wanted_rig = simulation::draw_rig(drawn)->nominal});
  const auto device = desk.open("sim:rig?scene=tree&speed=20");
  ASSERT_TRUE(desk.run(plan_of({}, *device)->scan));
  std::string guide;
  for (int i = 0; i < 6000 && !guide.contains("1 of 4"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    guide = desk.live().guide;
  }
  EXPECT_THAT(guide, HasSubstr("1 of 4"));  // the tree of this scene stays where it is
  ASSERT_TRUE(desk.run(plan_of({.leds = "2"}, *device)->scan));
  EXPECT_THAT(desk.live().guide, HasSubstr("3 LEDs; there are 2"));
}

TEST(AcquireDesk, ClosingKeepsTheTrial) {
  Rig rig;
  ASSERT_TRUE(rig.desk.record({"", "01", 0.0}));
  (void)rig.after(10);
  rig.desk.close();
  const auto recorded = io::read_counts(rig.folder / "trials/01.mcap");
  ASSERT_TRUE(recorded);
  EXPECT_EQ(recorded->end, io::RecordingEnd::closed);
}

}  // namespace
}  // namespace kinemark::pipeline
