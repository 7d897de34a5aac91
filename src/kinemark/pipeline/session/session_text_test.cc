// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/session/session_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kTrial =
    "format = 1\n[[trial]]\nfile = \"raw/a.mcap\"\nrate_hz = 138.5\nframes = 10\ndropped_by_device = 1\n"
    "dropped_here = 0\n";

SessionFile example() {
  SessionFile out{.subject = "S \"01\"\tö", .has_rig = true, .trials = {}};
  out.trials.push_back({.file = "raw/reach (1).mcap",
                        .source = "sim:rig?leds=8&rate=138",
                        .started = "2026-05-04T09:12:45Z",
                        .rate_hz = 138.12345678901234,
                        .frames = 4'000'000'000,
                        .dropped_by_device = 3,
                        .dropped_here = 2,
                        .clock_fast_ppm = -12.25,
                        .clock_fast_sd_ppm = 0.5});
  out.trials.push_back({.file = "raw/b.mcap", .source = "", .started = "", .rate_hz = 60.0});
  return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string refused(const std::string& text) {
  const auto parsed = parse_session(text, "s.toml");
  if (parsed) return "accepted";
  EXPECT_EQ(parsed.error().code, Code::bad_input);
  return parsed.error().message;
}

TEST(SessionText, ComesBackAsItWas) {
  const auto back = parse_session(session_text(example()), "s.toml").value();
  EXPECT_EQ(back.subject, example().subject);
  EXPECT_TRUE(back.has_rig);
  EXPECT_EQ(back.trials, example().trials);
  const auto empty = parse_session(session_text({}), "s.toml").value();
  EXPECT_EQ(empty.subject, "");
  EXPECT_FALSE(empty.has_rig);
  EXPECT_THAT(empty.trials, IsEmpty());
}

TEST(SessionText, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(refused("format = 2\n"), HasSubstr("s.toml: format"));
  EXPECT_THAT(refused("subject = \"x\"\n"), HasSubstr("format"));
  EXPECT_THAT(refused("format = 1\nsubjct = \"x\"\n"), HasSubstr("subjct"));
  EXPECT_THAT(refused("format = 1\nrig = \"../rig.toml\"\n"), HasSubstr("rig.toml"));
  EXPECT_THAT(refused("format ="), HasSubstr("s.toml"));
  ASSERT_TRUE(parse_session(kTrial, "s.toml"));
  EXPECT_THAT(refused(replaced(kTrial, "raw/a.mcap", "../a.mcap")),
              HasSubstr("file must be a recording in raw/"));
  EXPECT_THAT(refused(replaced(kTrial, "raw/a.mcap", "raw/../a.mcap")),
              HasSubstr("file must be a recording in raw/"));
  EXPECT_THAT(refused(replaced(kTrial, "raw/a.mcap", "raw/.a.mcap")),
              HasSubstr("file must be a recording in raw/"));
  EXPECT_THAT(refused(replaced(kTrial, "frames = 10", "frames = 1.5")),
              HasSubstr("a whole number from 0 on"));
  EXPECT_THAT(refused(replaced(kTrial, "frames = 10", "frames = -1")), HasSubstr("a whole number from 0 on"));
  EXPECT_THAT(refused(replaced(kTrial, "frames = 10\n", "")), HasSubstr("line 2: trial"));
  const std::string twice = std::string(kTrial).substr(std::string(kTrial).find("[[trial]]"));
  EXPECT_THAT(refused(kTrial + twice), HasSubstr("raw/a.mcap stands there twice"));
}

TEST(Manifest, ComesBackAsItWas) {
  const std::vector<ManifestEntry> entries = {{"raw/a (1) = 2.mcap", "0123456789abcdef"},
                                              {"raw/b.mcap", "ffffffffffffffff"}};
  const auto text = manifest_text(entries);
  EXPECT_EQ(text, "XXH3 (raw/a (1) = 2.mcap) = 0123456789abcdef\nXXH3 (raw/b.mcap) = ffffffffffffffff\n");
  const auto back = parse_manifest(text, "MANIFEST").value();
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].file, entries[0].file);
  EXPECT_EQ(back[1].hex, entries[1].hex);
  EXPECT_THAT(parse_manifest("", "MANIFEST").value(), IsEmpty());
}

TEST(Manifest, WhatIsNoChecksumIsNamedByItsLine) {
  const std::string good = "XXH3 (raw/b.mcap) = ffffffffffffffff\n";
  for (const char* bad :
       {"raw/b.mcap ffffffffffffffff", "XXH3 (raw/b.mcap) = ffff", "XXH3 (raw/b.mcap) = FFFFFFFFFFFFFFFF",
        "XXH3 (/etc/b.mcap) = ffffffffffffffff", "XXH3 (raw/../b.mcap) = ffffffffffffffff", "",
        "XXH3 (raw/.mcap) = ffffffffffffffff", "XXH3 (raw/b.c3d) = ffffffffffffffff"}) {
    const auto parsed = parse_manifest(good + bad + "\n", "MANIFEST");
    ASSERT_FALSE(parsed) << bad;
    EXPECT_THAT(parsed.error().message, HasSubstr("MANIFEST: line 2: ")) << bad;
  }
  EXPECT_THAT(parse_manifest(good + good, "M").error().message, HasSubstr("line 2: raw/b.mcap stands there"));
}

}  // namespace
}  // namespace kinemark::pipeline
