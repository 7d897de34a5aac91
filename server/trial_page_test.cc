// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_page.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/report_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"
#include "server/served_page.h"

namespace kinemark::server {
namespace {

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
