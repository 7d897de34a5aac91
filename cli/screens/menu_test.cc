// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/menu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/pipeline/desk/testing/fake_desk.h"

namespace kinemark::screens {
namespace {

using pipeline::DeskStep;
using pipeline::FakeDesk;
using pipeline::for_seconds;
using pipeline::rig_at;
using pipeline::Wanted;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

void type(Menu& menu, const std::u32string& keys) {
  for (const char32_t c : keys) menu.press(Key::of(c));
}
void press(Menu& menu, Key::Kind kind, int times = 1) {
  for (int i = 0; i < times; ++i) menu.press({kind});
}
std::string shown(const Menu& menu, int rows = 24, int columns = 80) {
  return menu.draw(rows, columns).to_text();
}

TEST(Menu, FromTheSourceToAKeptTrial) {
  FakeDesk desk;
  Menu menu(desk, {});
  EXPECT_THAT(shown(menu), HasSubstr("> sim:rig"));
  press(menu, Key::Kind::enter);
  EXPECT_THAT(shown(menu), HasSubstr("rig 1986: up to 8 LEDs, 2 cameras, 12 bits"));
  press(menu, Key::Kind::enter);
  EXPECT_EQ(menu.state().step, DeskStep::live);
  EXPECT_THAT(desk.asked.leds, testing::SizeIs(8));  // all that the device has
  EXPECT_THAT(desk.asked.cameras, ElementsAre("A", "B"));
  type(menu, U"r");
  EXPECT_EQ(menu.state().step, DeskStep::recording);
  type(menu, U"s");
  EXPECT_THAT(shown(menu), HasSubstr("! LED 2 is dark in camera B: look at its wire"));
  type(menu, U"k");
  EXPECT_EQ(menu.state().step, DeskStep::live);
  EXPECT_THAT(menu.state().kept, ElementsAre("raw/01.mcap"));
  EXPECT_THAT(shown(menu), HasSubstr("Kept: raw/01.mcap"));
  type(menu, U"rsk");
  EXPECT_THAT(menu.state().kept, ElementsAre("raw/01.mcap", "raw/02.mcap"));
  type(menu, U"q");
  EXPECT_EQ(menu.state().step, DeskStep::ended);
  EXPECT_EQ(desk.calls.back(), "close");
}

TEST(Menu, ATrialIsDiscardedOnlyAfterASecondKey) {
  FakeDesk desk;
  Menu menu(desk, rig_at());
  press(menu, Key::Kind::enter);
  type(menu, U"rsd");
  EXPECT_THAT(shown(menu), HasSubstr("Discard 01? Its frames are gone then."));
  type(menu, U"n");
  EXPECT_EQ(menu.state().step, DeskStep::check);
  EXPECT_THAT(desk.calls, Not(testing::Contains("discard")));
  EXPECT_THAT(shown(menu), Not(HasSubstr("Discard 01?")));
  type(menu, U"d");
  press(menu, Key::Kind::none, 20);  // two seconds without a key
  EXPECT_THAT(shown(menu), HasSubstr("Discard 01?"));
  type(menu, U"y");
  EXPECT_EQ(desk.calls.back(), "discard");
  EXPECT_THAT(shown(menu), HasSubstr("Discarded: 01"));
  EXPECT_TRUE(menu.state().kept.empty());
}

TEST(Menu, ARateThatDoesNotFitIsRefusedWithTheHighest) {
  FakeDesk desk;
  Menu menu(desk, rig_at("8", "200"));
  press(menu, Key::Kind::enter);
  EXPECT_EQ(menu.state().step, DeskStep::plan);
  EXPECT_THAT(shown(menu), HasSubstr("8 LEDs at 200 Hz do not fit: the highest rate is 138 Hz"));
  press(menu, Key::Kind::down);
  press(menu, Key::Kind::backspace, 3);
  type(menu, U"138");
  press(menu, Key::Kind::enter);
  EXPECT_EQ(menu.state().step, DeskStep::live);
  EXPECT_THAT(shown(menu), Not(HasSubstr("do not fit")));
}

TEST(Menu, ASourceThatAnotherHasIsRefusedAndTheListStays) {
  FakeDesk desk;
  Menu menu(desk, {});
  EXPECT_THAT(shown(menu), HasSubstr("in use by another program"));
  press(menu, Key::Kind::down, 5);
  press(menu, Key::Kind::enter);
  EXPECT_EQ(menu.state().step, DeskStep::source);
  EXPECT_THAT(shown(menu), HasSubstr("serial:/dev/ttyACM0: another program has it"));
}

TEST(Menu, AnAddressCanBeTyped) {
  FakeDesk desk;
  desk.there.clear();
  Menu menu(desk, {});
  EXPECT_THAT(shown(menu), HasSubstr("No device was found"));
  press(menu, Key::Kind::enter);
  EXPECT_EQ(menu.state().step, DeskStep::source);
  type(menu, U"o");
  type(menu, U"sim:rigq");
  press(menu, Key::Kind::backspace);
  press(menu, Key::Kind::enter);
  EXPECT_EQ(menu.state().step, DeskStep::plan);
  EXPECT_EQ(desk.calls.back(), "open sim:rig");
}

TEST(Menu, ATrialEndsWhenItsTimeIsUp) {
  FakeDesk desk;
  Menu menu(desk, for_seconds("5"));
  press(menu, Key::Kind::enter);
  type(menu, U"r");
  desk.now.recorded_s = 4.9;
  menu.tick();
  EXPECT_EQ(menu.state().step, DeskStep::recording);
  desk.now.recorded_s = 5.0;
  menu.tick();
  EXPECT_EQ(menu.state().step, DeskStep::check);
}

TEST(Menu, ADiskThatIsFullIsSaidBeforeTheTrial) {
  FakeDesk desk;
  desk.disk = fail(Code::io, "the disk has room for 2 minutes");
  Menu menu(desk, rig_at());
  press(menu, Key::Kind::enter);
  type(menu, U"r");
  EXPECT_EQ(menu.state().step, DeskStep::live);
  EXPECT_THAT(shown(menu), HasSubstr("the disk has room for 2 minutes"));
}

TEST(Menu, LightGoesInStepsWithinItsRange) {
  FakeDesk desk;
  Menu menu(desk, rig_at());
  press(menu, Key::Kind::enter);
  type(menu, U"-");
  EXPECT_NEAR(desk.light, 0.9, 1e-12);
  type(menu, U"----------------");
  EXPECT_NEAR(desk.light, 0.1, 1e-12);
  EXPECT_THAT(shown(menu), HasSubstr("10%"));
  type(menu, U"++++++++++++++++");
  EXPECT_NEAR(desk.light, 1.0, 1e-12);
}

TEST(Menu, LightThatCannotBeSetIsSaid) {
  FakeDesk desk;
  desk.device.sets_intensity = false;
  Menu menu(desk, rig_at());
  press(menu, Key::Kind::enter);
  EXPECT_THAT(shown(menu), Not(HasSubstr("its light")));
  type(menu, U"+");
  EXPECT_EQ(desk.light, 1.0);
  EXPECT_THAT(shown(menu), HasSubstr("cannot be set"));
}

TEST(Menu, TheLiveViewShowsSpotsLevelsAndWhatIsWrong) {
  FakeDesk desk;
  workflow::LedInCamera good, dark, clipping;
  good.highest_share = 0.6;
  good.noise_counts = 0.7;
  dark.occluded_share = 1.0;
  clipping.highest_share = 1.0;
  clipping.saturated_share = 0.5;
  desk.now.seen = {good, dark, clipping, good, good, good};
  desk.now.spots.assign(6, {{0.0, 0.0}});
  desk.now.guide = "roll camera A clockwise by 0.62 deg";
  Menu menu(desk, rig_at("hand, elbow, wrist"));
  press(menu, Key::Kind::enter);
  const std::string text = shown(menu);
  EXPECT_THAT(text, HasSubstr("dark"));
  EXPECT_THAT(text, HasSubstr("clips"));
  EXPECT_THAT(text, HasSubstr("0.7"));
  EXPECT_THAT(text, HasSubstr("elbow"));
  EXPECT_THAT(text, HasSubstr("Alignment: roll camera A clockwise by 0.62 deg"));
  EXPECT_THAT(text, HasSubstr("a align anew"));
  type(menu, U"a");
  EXPECT_EQ(desk.calls.back(), "restart_guide");
  desk.now.seen.assign(6, good);
  menu.tick();
  EXPECT_THAT(shown(menu), Not(testing::AnyOf(HasSubstr("dark"), HasSubstr("clips"))));
}

TEST(Menu, InterruptedItKeepsWhatIsRecorded) {
  for (const std::u32string& keys : {U"r", U"rs", U""}) {
    FakeDesk desk;
    Menu menu(desk, rig_at());
    press(menu, Key::Kind::enter);
    type(menu, keys);
    press(menu, Key::Kind::interrupt);
    EXPECT_EQ(menu.state().step, DeskStep::ended);
    EXPECT_EQ(menu.state().kept.size(), keys.empty() ? 0U : 1U);
    EXPECT_EQ(desk.calls.back(), "close");
  }
}

TEST(Menu, SaysWhenTheTerminalIsTooSmall) {
  FakeDesk desk;
  const Menu menu(desk, {});
  EXPECT_THAT(shown(menu, 15, 60), HasSubstr("This terminal is 60 x 15:\nmake it 80 x 24 or larger."));
  EXPECT_THAT(shown(menu, 24, 80), Not(HasSubstr("This terminal")));
  EXPECT_EQ(menu.draw(1, 3).rows(), 1);
  EXPECT_EQ(menu.draw(0, 0).rows(), 0);
}

TEST(Menu, FitsIntoTheSmallestScreenAndUsesALargeOne) {
  FakeDesk desk;
  desk.now.seen.resize(16);
  desk.now.spots.resize(16);
  Menu menu(desk, rig_at("8"));
  press(menu, Key::Kind::enter);
  const Canvas small = menu.draw(24, 80), large = menu.draw(60, 200);
  EXPECT_THAT(small.to_text(), HasSubstr("  8        100%"));
  EXPECT_EQ(small.at(2, 1).glyph, U'┌');
  EXPECT_THAT(large.to_text(), HasSubstr("r record"));
  EXPECT_EQ(large.at(2, 1).glyph, U'┌');
  EXPECT_EQ(large.at(46, 1).glyph, U'└') << large.to_text();
}

TEST(Menu, WrongLinesOfTheSetUpAreNamed) {
  Wanted unnamed = rig_at();
  unnamed.trial = " ";
  for (const auto& [wanted, said] :
       std::vector<std::pair<Wanted, std::string>>{{rig_at("0"), "no whole number from 1"},
                                                   {rig_at("a,,b"), "a name is missing"},
                                                   {rig_at("a, a"), "named twice"},
                                                   {rig_at("3", "fast"), "Rate: 'fast' is no number above 0"},
                                                   {for_seconds("-1"), "Duration: '-1'"},
                                                   {unnamed, "Trial: a name is missing"}}) {
    FakeDesk desk;
    Menu menu(desk, wanted);
    press(menu, Key::Kind::enter);
    EXPECT_EQ(menu.state().step, DeskStep::plan) << said;
    EXPECT_THAT(shown(menu), HasSubstr(said));
  }
}

TEST(Menu, TroubleOfTheDeviceIsShown) {
  FakeDesk desk;
  Menu menu(desk, rig_at());
  press(menu, Key::Kind::enter);
  EXPECT_THAT(shown(menu), Not(HasSubstr("unplugged")));
  desk.now.trouble = "serial:/dev/ttyACM0: the device was unplugged";
  menu.tick();
  EXPECT_THAT(shown(menu), HasSubstr("the device was unplugged"));
}

}  // namespace
}  // namespace kinemark::screens
