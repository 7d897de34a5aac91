// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/list_page.h"

#include <gmock/gmock.h>

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHostile = "</script><img src=x onerror=\"alert('x')\">&amp;";

TrialRow row(std::uint32_t number, const std::string& name) {
  return {.number = number,
          .name = name,
          .folder = "study",
          .state = RowState::read,
          .kind = "markers",
          .markers = 40,
          .frames = 1000,
          .rate_hz = 240.0,
          .duration_s = 1000.0 / 240.0,
          .measured = 0.9876};
}

TEST(ListPage, HasALineForEachTrialWithALinkToItsPage) {
  const auto page = list_page({row(1, "a.c3d"), row(7, "b.trc")}, {}, "/s/");
  EXPECT_THAT(page, HasSubstr("<a href=\"/s/trial/1\">a.c3d</a>"));
  EXPECT_THAT(page, HasSubstr("<a href=\"/s/trial/7\">b.trc</a>"));
  for (const char* cell : {">40<", ">1000<", ">240<", ">4.17<", ">98.8 %<", ">markers<"})
    EXPECT_THAT(page, HasSubstr(cell));
  EXPECT_THAT(page, HasSubstr("2 trials"));
  EXPECT_THAT(page, HasSubstr("<p class=\"model\">study</p>"));
  EXPECT_THAT(page, Not(HasSubstr("data-reading")));
}

TEST(ListPage, NamesAreText) {
  auto hostile = row(1, kHostile);
  hostile.folder = hostile.kind = hostile.said = kHostile;
  auto other = row(2, "b");
  const auto page = list_page({hostile, other}, {kHostile}, "/s/");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("onerror=\"")));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;img src=x onerror=&quot;alert"));
  EXPECT_THAT(page, HasSubstr("&amp;amp;"));
  EXPECT_EQ(page.find("</script>"), page.rfind("</script>")) << "that of list.js alone";
}

TEST(ListPage, VerdictsAreWords) {
  auto good = row(1, "a"), attention = row(2, "b"), broken = row(3, "c");
  good.verdict = "good";
  attention.verdict = "attention";
  broken.state = RowState::unreadable;
  broken.said = "c: is empty";
  const auto page = list_page({good, attention, broken}, {}, "/s/");
  EXPECT_THAT(page, HasSubstr(">Good<"));
  EXPECT_THAT(page, HasSubstr(">Needs attention<"));
  EXPECT_THAT(page, HasSubstr(">not readable<"));
  EXPECT_THAT(page, HasSubstr("c: is empty"));
  EXPECT_THAT(page, HasSubstr("3 trials, 1 in need of attention, 1 not readable"));
}

TEST(ListPage, OnlyAllOfThemIsAHundredPercent) {
  auto nearly = row(1, "a"), whole = row(2, "b"), none = row(3, "c");
  nearly.measured = 0.99999;
  whole.measured = 1.0;
  none.measured = 0.0;
  const auto page = list_page({nearly, whole, none}, {}, "/s/");
  EXPECT_THAT(page, HasSubstr(">99.9 %<"));
  EXPECT_THAT(page, HasSubstr(">100 %<"));
  EXPECT_THAT(page, HasSubstr(">0.0 %<"));
}

TEST(ListPage, WhatIsBeingReadIsSaidAndAskedAgain) {
  const auto page = list_page({{.number = 1, .name = "a"}, row(2, "b")}, {}, "/s/");
  EXPECT_THAT(page, HasSubstr("<main id=\"trials\" data-reading>"));
  EXPECT_THAT(page, HasSubstr("1 being read"));
  EXPECT_THAT(page, HasSubstr(">being read<"));
}

TEST(ListPage, FoldersAreShownWhereThereAreSeveral) {
  auto other = row(2, "a.c3d");
  other.folder = "second";
  const auto page = list_page({row(1, "a.c3d"), other}, {}, "/s/");
  EXPECT_THAT(page, HasSubstr("<small>study</small>"));
  EXPECT_THAT(page, HasSubstr("<small>second</small>"));
  EXPECT_THAT(list_page({row(1, "a.c3d")}, {}, "/s/"), Not(HasSubstr("<small>")));
}

TEST(ListPage, WithoutATrialSaysWhy) {
  const auto page = list_page({}, {"study: the folder holds no file"}, "/s/");
  EXPECT_THAT(page, HasSubstr("0 trials"));
  EXPECT_THAT(page, HasSubstr("study: the folder holds no file"));
  EXPECT_THAT(page, Not(HasSubstr("<table>")));
}

TEST(ErrorPage, HasOneSentenceAndTheWayBack) {
  const auto page = error_page(kHostile, std::string(kHostile) + " is gone", "/s/");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, HasSubstr("is gone"));
  EXPECT_THAT(page, HasSubstr("<a href=\"/s/\">All trials</a>"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
}

TEST(OwnPolicy, LetsNoScriptInThePageRun) {
  EXPECT_THAT(std::string(kOwnPolicy), HasSubstr("script-src 'self'"));
  EXPECT_THAT(std::string(kOwnPolicy), Not(HasSubstr("unsafe")));
  // And none stands there.
  const auto page = list_page({row(1, "a")}, {}, "/s/");
  EXPECT_THAT(page, Not(HasSubstr("<style")));
  EXPECT_THAT(page, Not(HasSubstr(" style=")));
  EXPECT_THAT(page, Not(HasSubstr(" onclick=")));
}

}  // namespace
}  // namespace kinemark::server
