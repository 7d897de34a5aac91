// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/settings_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SettingsFile : public ::testing::Test {
 protected:
  Result<Settings> read(const std::string& text) {
    const auto path = scratch_.path() / "s.toml";
    EXPECT_TRUE(io::write_text(path, text, true));
    return read_settings(path);
  }
  std::string refusal(const std::string& text) {
    const auto settings = read(text);
    return settings ? "" : settings.error().message;
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(SettingsFile, ReadsEveryKindOfOptionInTheOrderOfTheFile) {
  const auto settings = read(
      "command = \"ik\"\nnoise = 0.5\nmax-rms = 20\nno-limits = true\nforce = false\nweight = [\"LASI=2\", "
      "3]\n");
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(settings->command, "ik");
  ASSERT_EQ(settings->list.size(), 5U);
  EXPECT_EQ(settings->list[0].name, "noise");
  EXPECT_THAT(settings->list[0].values, ElementsAre("0.5"));
  EXPECT_EQ(settings->list[0].line, 2);
  EXPECT_THAT(settings->list[1].values, ElementsAre("20"));
  EXPECT_TRUE(settings->list[2].is_switch && settings->list[2].on);
  EXPECT_TRUE(settings->list[3].is_switch && !settings->list[3].on);
  EXPECT_THAT(settings->list[4].values, ElementsAre("LASI=2", "3"));
}

TEST_F(SettingsFile, WhatIsWrittenIsReadBack) {
  Settings settings{.command = "simulate rig"};
  for (const auto* value : {"5", "-5", "0.25", "1e-3", "007", ".5", "5.", "x -90", "a \"quoted\" \\ name", "",
                            "nan", "12345678901234567890", "tab\there", "Gr\u00F6\u00DFe", "-"})
    settings.list.push_back({.name = "o" + std::to_string(settings.list.size()), .values = {value}});
  settings.list.push_back({.name = "many", .values = {"a,b", "2"}});
  settings.list.push_back({.name = "flag", .is_switch = true});
  const auto back = read(settings_text(settings));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->command, settings.command);
  ASSERT_EQ(back->list.size(), settings.list.size());
  for (std::size_t i = 0; i < settings.list.size(); ++i) {
    EXPECT_EQ(back->list[i].name, settings.list[i].name);
    EXPECT_EQ(back->list[i].values, settings.list[i].values);
    EXPECT_EQ(back->list[i].is_switch, settings.list[i].is_switch);
  }
}

TEST_F(SettingsFile, NumbersStandWithoutQuotes) {
  EXPECT_THAT(
      settings_text(
          {.command = "ik", .list = {{.name = "noise", .values = {"0.5"}}, {.name = "up", .values = {"z"}}}}),
      HasSubstr("command = \"ik\"\nnoise = 0.5\nup = \"z\"\n"));
}

TEST_F(SettingsFile, SaysFileLineAndWhatWasExpected) {
  EXPECT_THAT(refusal("noise = 1\n\n[ik]\nup = \"z\"\n"),
              HasSubstr("s.toml: line 3: 'ik' is a table; need a number"));
  EXPECT_THAT(refusal("day = 2026-01-02\n"), HasSubstr("line 1: 'day'"));
  EXPECT_THAT(refusal("weight = [1, [2]]\n"), HasSubstr("numbers and texts in the list"));
  EXPECT_THAT(refusal("command = 5\n"), HasSubstr("the name of a command"));
  EXPECT_THAT(refusal("noise = \n"), HasSubstr("line 1"));
  EXPECT_EQ(read_settings(scratch_.path() / "none.toml").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::pipeline
