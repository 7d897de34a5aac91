// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/screens/form.h"

#include <gtest/gtest.h>

namespace kinemark::screens {
namespace {

Form form() { return Form({{"LEDs", "3", "how many"}, {"Trial", "", "a name"}}); }

TEST(Form, UpAndDownGoAround) {
  Form f = form();
  EXPECT_TRUE(f.press({Key::Kind::up}));
  f.press(Key::of(U'x'));
  EXPECT_EQ(f.value(1), "x");
  f.press({Key::Kind::down});
  f.press(Key::of(U'1'));
  EXPECT_EQ(f.value(0), "31");
}

TEST(Form, BackspaceTakesAWholeCharacter) {
  Form f = form();
  f.press({Key::Kind::down});
  for (const char32_t c : {U'a', U'é', U'😀'}) f.press(Key::of(c));
  EXPECT_EQ(f.value(1), "aé😀");
  f.press({Key::Kind::backspace});
  EXPECT_EQ(f.value(1), "aé");
  for (int i = 0; i < 5; ++i) f.press({Key::Kind::backspace});
  EXPECT_EQ(f.value(1), "");
}

TEST(Form, EnterAndEscapeAreOfOthers) {
  Form f = form();
  EXPECT_FALSE(f.press({Key::Kind::enter}));
  EXPECT_FALSE(f.press({Key::Kind::escape}));
  EXPECT_FALSE(f.press({}));
}

TEST(Form, ShowsWhichLineIsChosenAndItsHint) {
  Canvas canvas(4, 30);
  form().draw(canvas, 0, 0);
  EXPECT_EQ(canvas.to_text(), "> LEDs   3_\n  Trial\n\n  how many\n");
}

TEST(Form, AValueDoesNotGrowWithoutEnd) {
  Form f = form();
  for (int i = 0; i < 1000; ++i) f.press(Key::of(U'9'));
  EXPECT_LE(f.value(0).size(), 200U);
}

}  // namespace
}  // namespace kinemark::screens
