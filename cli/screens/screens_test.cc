// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/screens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "kinemark/pipeline/desk/testing/fake_desk.h"

namespace kinemark::screens {
namespace {

using pipeline::FakeDesk;

// A terminal whose keys are known before; keeps what it was shown.
struct FakeTerminal final : Terminal {
  std::deque<Key> keys;
  std::vector<std::string> shown;
  [[nodiscard]] int rows() const override { return 24; }
  [[nodiscard]] int columns() const override { return 80; }
  void show(const Canvas& canvas) override { shown.push_back(canvas.to_text()); }
  [[nodiscard]] Key wait(int /*milliseconds*/) override {
    const Key key = keys.empty() ? Key::of(U'q') : keys.front();
    if (!keys.empty()) keys.pop_front();
    return key;
  }
};

TEST(ShowMenus, ShowsAScreenForEachKeyUntilThePersonLeaves) {
  FakeDesk desk;
  FakeTerminal terminal;
  terminal.keys = {{Key::Kind::enter}, {Key::Kind::enter}, Key::of(U'r'), {}, Key::of(U's'), Key::of(U'k')};
  const auto kept = show_menus(desk, {}, terminal, [] { return false; });
  EXPECT_THAT(kept, testing::ElementsAre("raw/01.mcap"));
  EXPECT_EQ(terminal.shown.size(), 7U);
  EXPECT_THAT(terminal.shown[0], testing::HasSubstr("Source"));
  EXPECT_THAT(terminal.shown[3], testing::HasSubstr("RECORDING 01"));
  EXPECT_EQ(desk.calls.back(), "close");
}

TEST(ShowMenus, AskedToEndTheyKeepWhatIsRecorded) {
  FakeDesk desk;
  FakeTerminal terminal;
  terminal.keys = {{Key::Kind::enter}, {Key::Kind::enter}, Key::of(U'r')};
  int asked = 0;
  const auto kept = show_menus(desk, {}, terminal, [&] { return ++asked > 3; });
  EXPECT_THAT(kept, testing::ElementsAre("raw/01.mcap"));
  EXPECT_EQ(terminal.shown.size(), 4U);
}

}  // namespace
}  // namespace kinemark::screens
