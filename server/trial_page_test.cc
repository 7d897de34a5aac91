// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/report_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"
#include "server/served_page.h"

namespace kinemark::server {
namespace {

Page page_of(std::size_t bytes, char letter = 'x') {
  return {.html = std::make_shared<const std::string>(bytes, letter), .policy = "policy"};
}

Stamps stamps(std::int64_t changed_ns) { return {Stamp{.bytes = 1, .changed_ns = changed_ns}, std::nullopt}; }

TEST(PageShelf, KeepsAPageUntilItsFilesChange) {
  PageShelf shelf(100);
  EXPECT_FALSE(shelf.find(1, stamps(1)));
  shelf.keep(1, stamps(1), page_of(10, 'a'));
  const auto page = shelf.find(1, stamps(1));
  ASSERT_TRUE(page);
  EXPECT_EQ(*page->html, std::string(10, 'a'));
  EXPECT_EQ(page->policy, "policy");
  EXPECT_FALSE(shelf.find(2, stamps(1)));
  EXPECT_FALSE(shelf.find(1, stamps(2)));
  EXPECT_FALSE(shelf.find(1, stamps(1))) << "the older file does not come back";
}

TEST(PageShelf, ACompanionIsAFileOfThePageToo) {
  PageShelf shelf(100);
  shelf.keep(1, stamps(1), page_of(10));
  auto with_companion = stamps(1);
  with_companion.back() = Stamp{.bytes = 5};
  EXPECT_FALSE(shelf.find(1, with_companion));
}

TEST(PageShelf, ANewerPageTakesThePlaceOfTheOlder) {
  PageShelf shelf(100);
  shelf.keep(1, stamps(1), page_of(90, 'a'));
  shelf.keep(1, stamps(2), page_of(90, 'b'));
  EXPECT_EQ(shelf.find(1, stamps(2))->html->front(), 'b');
}

TEST(PageShelf, WhatNobodyAskedForLongestGoesFirst) {
  PageShelf shelf(100);
  for (std::uint32_t n = 1; n <= 3; ++n) shelf.keep(n, stamps(1), page_of(33));
  EXPECT_TRUE(shelf.find(1, stamps(1)));
  shelf.keep(4, stamps(1), page_of(33));
  EXPECT_FALSE(shelf.find(2, stamps(1)));
  for (const std::uint32_t n : {1U, 3U, 4U}) EXPECT_TRUE(shelf.find(n, stamps(1))) << n;
  shelf.keep(5, stamps(1), page_of(100));
  for (const std::uint32_t n : {1U, 3U, 4U}) EXPECT_FALSE(shelf.find(n, stamps(1))) << n;
  EXPECT_TRUE(shelf.find(5, stamps(1)));
}

TEST(PageShelf, APageThatIsTooLargeIsNotKeptNorTheOlderOne) {
  PageShelf shelf(100);
  shelf.keep(1, stamps(1), page_of(10));
  shelf.keep(2, stamps(1), page_of(10));
  shelf.keep(1, stamps(2), page_of(101));
  EXPECT_FALSE(shelf.find(1, stamps(2)));
  EXPECT_FALSE(shelf.find(1, stamps(1)));
  EXPECT_TRUE(shelf.find(2, stamps(1))) << "others stay";
}

TEST(PageShelf, APageThatIsBeingSentOutlivesTheShelf) {
  PageShelf shelf(10);
  shelf.keep(1, stamps(1), page_of(10, 'a'));
  const auto sent = shelf.find(1, stamps(1));
  shelf.keep(2, stamps(1), page_of(10, 'b'));
  EXPECT_FALSE(shelf.find(1, stamps(1)));
  EXPECT_EQ(*sent->html, std::string(10, 'a'));
}

using pipeline::IkJob;
using ::testing::HasSubstr;
using ::testing::Not;

class PageOfTrial : public pipeline::testing::RecordedTest<IkJob> {};

TEST_F(PageOfTrial, OfMarkersIsTheirReportWithANonce) {
  const auto page = make_trial_page(at("in/markers.c3d"), "/s/").value();
  EXPECT_THAT(page.policy, HasSubstr("script-src 'nonce-"));
  EXPECT_THAT(*page.html, HasSubstr("kinemark.markers_report"));
  EXPECT_THAT(*page.html, HasSubstr("<script nonce=\""));
}

TEST_F(PageOfTrial, OfMarkersMayAskThisServerAndNobodyElse) {
  const auto page = make_trial_page(at("in/markers.c3d"), "/s/").value();
  EXPECT_THAT(page.policy, HasSubstr("default-src 'none'; connect-src 'self'; script-src 'nonce-"));
  EXPECT_THAT(*page.html, HasSubstr("content=\"default-src 'none'; connect-src 'self'; script-src 'sha256-"));
  EXPECT_THAT(*page.html, HasSubstr("\"editing\":{\"journal\":\"markers_edits.jsonl\""));
  const auto file = pipeline::page_of(at("in/markers.c3d")).value();
  EXPECT_THAT(file, Not(HasSubstr("connect-src 'self'")));
  EXPECT_THAT(file, Not(HasSubstr("\"editing\":")));
}

TEST_F(PageOfTrial, OfASolvedTrialIsItsReportWithANonce) {
  ASSERT_TRUE(pipeline::run_ik(job("Q.mot")));
  const auto page = make_trial_page(at("Q.mot"), "/s/").value();
  const auto plain = pipeline::page_of(at("Q.mot")).value();
  EXPECT_THAT(*page.html, HasSubstr("<script nonce=\""));
  EXPECT_THAT(*page.html, HasSubstr("<style nonce=\""));
  EXPECT_EQ(page.html->size(),
            plain.size() + 2 * std::string(R"( nonce="00112233445566778899aabbccddeeff")").size());
  EXPECT_THAT(page.policy, Not(HasSubstr("unsafe")));
  EXPECT_THAT(page.policy, Not(HasSubstr("connect-src")));
  EXPECT_NE(page.policy, make_trial_page(at("Q.mot"), "/s/")->policy) << "another nonce for another page";
}

TEST_F(PageOfTrial, OfASolvedTrialWhoseFilesAreOfTwoRunsIsASentence) {
  ASSERT_TRUE(pipeline::run_ik(job("P.mot")));
  std::filesystem::remove(at("P_marker_errors.sto"));
  const auto page = make_trial_page(at("P.mot"), "/s/");
  ASSERT_FALSE(page);
  EXPECT_THAT(page.error().message, HasSubstr("P_marker_errors.sto"));
}

TEST_F(PageOfTrial, OfOtherFilesShowsWhatTheyHold) {
  EXPECT_EQ(make_trial_page(at("in/truth.mot"), "/s/")->policy, kOwnPolicy);
  EXPECT_THAT(*make_trial_page(at("in/truth.mot"), "/s/")->html, HasSubstr("\"trial\": \"truth.mot\""));
  EXPECT_THAT(*make_trial_page(at("in/truth.mot"), "/s/")->html, Not(HasSubstr(at("in").string())))
      << "where it lies is nobody's business";
  EXPECT_THAT(*make_trial_page(at("in/truth.mot"), "/s/")->html, HasSubstr("\"name\": \"rows\""));
  EXPECT_THAT(*make_trial_page(at("in/model.osim"), "/s/")->html, HasSubstr("mass, kg"));
  EXPECT_EQ(make_trial_page(at("absent.trc"), "/s/").error().code, Code::io);
}

TEST(Shielded, OnlyTheFirstStyleAndTheLastScriptMayRun) {
  const std::string html =
      "<style>a</style><script type=\"application/json\">1</script><script type=\"module\">evil</script>"
      "<style>evil</style><script type=\"module\">ours</script>";
  const auto page = shielded(html, "N");
  EXPECT_EQ(
      *page.html,
      "<style nonce=\"N\">a</style><script type=\"application/json\">1</script><script type=\"module\">evil"
      "</script><style>evil</style><script nonce=\"N\" type=\"module\">ours</script>");
  EXPECT_THAT(page.policy, HasSubstr("script-src 'nonce-N'; style-src 'nonce-N'"));
  EXPECT_THAT(page.policy, HasSubstr("default-src 'none'"));
}

TEST(Shielded, APageWithoutThemStaysAsItIs) {
  EXPECT_EQ(*shielded("<p>nothing</p>", "N").html, "<p>nothing</p>");
}

}  // namespace

}  // namespace kinemark::server
