// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_row.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/clean/clean_job.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"

namespace kinemark::server {
namespace {

using pipeline::IkJob;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class DescribeTrial : public pipeline::testing::RecordedTest<IkJob> {};

TEST_F(DescribeTrial, OfMarkersSaysHowManyAndWhatShareWasMeasured) {
  const auto row = describe_trial(at("in/markers.c3d"));
  EXPECT_EQ(row.state, RowState::read);
  EXPECT_EQ(row.kind, "markers");
  EXPECT_EQ(row.name, "markers.c3d");
  EXPECT_EQ(row.markers, 40);
  EXPECT_EQ(row.frames, 30);
  EXPECT_EQ(row.rate_hz, 60.0);
  EXPECT_DOUBLE_EQ(row.duration_s.value(), 0.5);
  EXPECT_NEAR(row.measured.value(), 0.8, 0.05);
  EXPECT_EQ(describe_trial(at("in/truth.trc")).measured, 1.0);
  EXPECT_THAT(row.verdict, IsEmpty()) << "nobody judged it";
}

TEST_F(DescribeTrial, WhatWasFilledIsNotMeasured) {
  pipeline::CleanJob job;
  job.input = at("in/markers.c3d");
  job.output = at("cleaned.c3d");
  ASSERT_TRUE(pipeline::run_clean(job));
  const auto cleaned = describe_trial(at("cleaned.c3d"));
  EXPECT_EQ(cleaned.kind, "cleaned markers");
  EXPECT_THAT(cleaned.verdict, ::testing::AnyOf("good", "attention"));
  EXPECT_LE(cleaned.measured.value(), describe_trial(at("in/markers.c3d")).measured.value());
}

TEST_F(DescribeTrial, OfASolvedTrialSaysTheVerdictOfItsReport) {
  ASSERT_TRUE(pipeline::run_ik(job("Q.mot")));
  EXPECT_TRUE(is_solved(at("Q.mot")));
  const auto row = describe_trial(at("Q.mot"));
  EXPECT_EQ(row.kind, "solved trial");
  EXPECT_THAT(row.verdict, ::testing::AnyOf("good", "attention"));
  EXPECT_EQ(row.frames, 30);
  EXPECT_EQ(row.rate_hz, 60.0);
  EXPECT_EQ(row.markers, 40);
  EXPECT_EQ(row.measured, std::nullopt);
}

TEST_F(DescribeTrial, AReportThatIsNoneMakesNoVerdict) {
  for (const char* report :
       {"", "[]", "{\"schema\": 1}", "{\"schema\": \"other\", \"verdict\": \"good\"}", "{{{"}) {
    ASSERT_TRUE(io::write_text(at("T.mot"), io::read_text(at("in/truth.mot")).value(), true));
    ASSERT_TRUE(io::write_text(at("T_report.json"), report, true));
    EXPECT_FALSE(is_solved(at("T.mot"))) << report;
    EXPECT_EQ(describe_trial(at("T.mot")).kind, "table") << report;
  }
  ASSERT_TRUE(io::write_text(
      at("T_report.json"),
      R"({"schema": "kinemark.ik_report", "verdict": "<b>", "frames": "many", "markers": 7})", true));
  const auto row = describe_trial(at("T.mot"));
  EXPECT_EQ(row.kind, "solved trial");
  EXPECT_THAT(row.verdict, IsEmpty());
  EXPECT_EQ(row.frames, std::nullopt);
  EXPECT_EQ(row.markers, std::nullopt);
}

TEST_F(DescribeTrial, OfTablesAndModels) {
  const auto table = describe_trial(at("in/truth.mot"));
  EXPECT_EQ(table.kind, "table");
  EXPECT_EQ(table.frames, 30);
  EXPECT_NEAR(table.rate_hz.value(), 60.0, 1e-3);
  const auto model = describe_trial(at("in/model.osim"));
  EXPECT_EQ(model.kind, "model");
  EXPECT_EQ(model.markers, 40);
  EXPECT_EQ(model.frames, std::nullopt);
}

TEST_F(DescribeTrial, WhatCannotBeReadSaysWhyInOneSentence) {
  ASSERT_TRUE(io::write_text(at("broken\n.trc"), "nothing", true));
  for (const auto& path : {at("absent.c3d"), at("broken\n.trc"), at("in")}) {
    const auto row = describe_trial(path);
    EXPECT_EQ(row.state, RowState::unreadable) << path;
    EXPECT_FALSE(row.said.empty());
    EXPECT_EQ(row.said.find('\n'), std::string::npos);
    EXPECT_EQ(row.name.find('\n'), std::string::npos);
  }
}

TEST(RowJson, HasEveryKeyAndNullForWhatIsNotKnown) {
  const TrialRow row{.number = 3, .name = "a.c3d", .folder = "study"};
  const auto json = row_json(row);
  EXPECT_EQ(json["number"], 3);
  EXPECT_EQ(json["page"], "/trial/3");
  EXPECT_EQ(json["state"], "reading");
  for (const char* key :
       {"kind", "markers", "frames", "rate_hz", "duration_s", "measured", "verdict", "said"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
  EXPECT_EQ(row_json({.state = RowState::read, .measured = 0.5})["measured"], 0.5);
  EXPECT_EQ(row_json({.state = RowState::unreadable, .said = "why"})["state"], "unreadable");
}

TEST(UnreadRow, HasAPrintableName) {
  const auto row = unread_row("a\x1b[31m/b\xff\n.c3d");
  EXPECT_EQ(row.state, RowState::reading);
  for (const auto& text : {row.name, row.folder}) {
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_THAT(text, HasSubstr("\xef\xbf\xbd"));
  }
}

}  // namespace
}  // namespace kinemark::server
