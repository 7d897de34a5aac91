// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/report_job.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class RunReport : public testing::RecordedTest<IkJob> {
 protected:
  static Result<ReportOutcome> page(const fs::path& solved, const fs::path& target, bool force = false) {
    ReportJob job;
    job.input = solved;
    job.page = target;
    job.force = force;
    return run_report(job);
  }
  /// What a page carries for its script.
  static nlohmann::json data_of(const fs::path& file) {
    const auto text = io::read_text(file).value();
    const std::string begin = "id=\"kinemark-data\">";
    const auto first = text.find(begin) + begin.size();
    return nlohmann::json::parse(text.substr(first, text.find("</script>", first) - first));
  }
};

TEST_F(RunReport, AReportMadeLaterIsTheReportMadeAtOnce) {
  auto with_page = job("R.mot");
  with_page.report = at("at_once.html");
  ASSERT_TRUE(run_ik(with_page));
  ASSERT_TRUE(page(at("R.mot"), at("later.html")));
  ASSERT_TRUE(page(at("R_report.json"), at("from_json.html")));
  EXPECT_EQ(io::read_text(at("later.html")).value(), io::read_text(at("from_json.html")).value());
  const auto once = io::read_text(at("at_once.html")).value(),
             later = io::read_text(at("later.html")).value();
  EXPECT_NEAR(static_cast<double>(once.size()), static_cast<double>(later.size()),
              0.05 * static_cast<double>(once.size()));
  const auto scene = data_of(at("at_once.html"))["scene"], scene_later = data_of(at("later.html"))["scene"];
  for (const char* key : {"names", "markers", "up", "points"}) EXPECT_EQ(scene[key], scene_later[key]) << key;
  EXPECT_TRUE(scene["model_m"].is_object());
  EXPECT_EQ(page(at("R.mot"), at("later.html")).error().code, Code::io) << "exists already";
}

TEST_F(RunReport, AReportMadeLaterListsTheSameSamplesLeftOut) {
  auto trial = io::read_marker_input({.path = at("in/markers.c3d")}).value().trial;
  for (const std::int64_t frame : {8, 14, 15}) {
    std::int64_t marker = 0;
    while (!trial.markers.present(frame, marker)) ++marker;
    trial.markers.x(frame, marker) += Eigen::Vector3d(0.2, -0.1, 0.15);
  }
  ASSERT_TRUE(io::write_trc(at("spoilt.trc"), trial, {}));
  auto with_page = job("S.mot", "spoilt.trc");
  with_page.report = at("S_once.html");
  ASSERT_TRUE(run_ik(with_page));
  ASSERT_TRUE(page(at("S.mot"), at("S_later.html")));
  const auto once = data_of(at("S_once.html")), later = data_of(at("S_later.html"));
  EXPECT_EQ(once["summary"]["rejected_samples"], 3);
  EXPECT_GE(once["summary"]["rejected"].size(), 1U);
  for (const char* key : {"rejected", "rejected_samples", "rejected_fraction", "markers", "findings"})
    EXPECT_EQ(once["summary"][key], later["summary"][key]) << key;
  EXPECT_EQ(once["series"]["gaps"], later["series"]["gaps"]) << "the map shows what was left out";
}

TEST_F(RunReport, LabelsExchangedBackAreThePagesOfTheCleanRecording) {
  auto trial = io::read_marker_input({.path = at("in/markers.c3d")}).value().trial;
  ASSERT_TRUE(io::write_trc(at("whole.trc"), trial, {}));
  std::int64_t one = 0, other = 1, count = 0;
  while ((trial.markers.x(0, one) - trial.markers.x(0, other)).norm() < 0.1) ++other;
  for (std::int64_t f = 1; f < trial.markers.frames(); f += 3) {
    if (!trial.markers.present(f, one) || !trial.markers.present(f, other)) continue;
    const Eigen::Vector3d x = trial.markers.x(f, one);
    trial.markers.x(f, one) = trial.markers.x(f, other);
    trial.markers.x(f, other) = x;
    ++count;
  }
  ASSERT_TRUE(io::write_trc(at("exchanged.trc"), trial, {}));
  for (const auto* name : {"whole", "exchanged"}) {
    auto with_page = job(std::string(name) + ".mot", std::string(name) + ".trc");
    with_page.report = at(std::string(name) + "_once.html");
    ASSERT_TRUE(run_ik(with_page));
    ASSERT_TRUE(page(at(std::string(name) + ".mot"), at(std::string(name) + "_later.html")));
  }
  const auto whole = data_of(at("whole_once.html")), once = data_of(at("exchanged_once.html")),
             later = data_of(at("exchanged_later.html"));
  EXPECT_EQ(whole["summary"]["exchanged"].size(), 0U);
  ASSERT_EQ(once["summary"]["exchanged"].size(), 1U);
  EXPECT_EQ(once["summary"]["exchanged"][0]["count"], count);
  EXPECT_EQ(once["summary"]["rejected_samples"], 0);
  for (const char* key : {"exchanged", "coordinates", "markers", "findings"})
    EXPECT_EQ(once["summary"][key], later["summary"][key]) << key;
  EXPECT_EQ(once["scene"]["markers"], later["scene"]["markers"]);
  EXPECT_EQ(once["scene"]["markers"], whole["scene"]["markers"]) << "markers are drawn where they were";
}

TEST_F(RunReport, AReportOfMissingOrForeignFilesIsOneSentence) {
  EXPECT_EQ(page(at("nothing.mot"), at("n.html")).error().code, Code::io);
  ASSERT_TRUE(io::write_text(at("X_report.json"), "{ not json", false));
  EXPECT_THAT(page(at("X.mot"), at("n.html")).error().message, HasSubstr("is not JSON"));
  EXPECT_FALSE(fs::exists(at("n.html")));
}

TEST_F(RunReport, TheGapMapNeedsTheRecordingAndTheRestDoesNot) {
  fs::copy_file(at("in/markers.c3d"), at("lent.c3d"));
  ASSERT_TRUE(run_ik(job("lent.mot", "lent.c3d")));
  ASSERT_TRUE(page(at("lent.mot"), at("with.html")));
  fs::remove(at("lent.c3d"));
  const auto without = page(at("lent.mot"), at("without.html"));
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_THAT(without->written, ElementsAre(at("without.html")));
  EXPECT_EQ(without->exit_status(), 0);
  const auto there = data_of(at("with.html"))["summary"], gone = data_of(at("without.html"))["summary"];
  EXPECT_EQ(there["frames"], gone["frames"]);
  EXPECT_EQ(there["coordinates"], gone["coordinates"]);
}

TEST_F(RunReport, FilesThatDoNotBelongTogetherAreBadInput) {
  ASSERT_TRUE(run_ik(job("mixed.mot")));
  auto shorter = io::read_table(at("mixed_marker_errors.sto")).value();
  shorter.time_s.pop_back();
  shorter.values.resize(shorter.values.size() - shorter.columns.size());
  ASSERT_TRUE(io::write_table(at("mixed_marker_errors.sto"), shorter,
                              {.force = true, .set = set_in(at("mixed.mot"))}));
  const auto refused = page(at("mixed.mot"), at("mixed.html"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("mixed.mot"));
  ASSERT_TRUE(io::write_text(at("mixed_report.json"), "{}", true));
  EXPECT_EQ(page(at("mixed.mot"), at("mixed.html")).error().code, Code::bad_input);
  fs::remove(at("mixed_marker_errors.sto"));
  EXPECT_FALSE(page(at("mixed.mot"), at("mixed.html")));
  EXPECT_FALSE(fs::exists(at("mixed.html")));
}

}  // namespace
}  // namespace kinemark::pipeline
