// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/convert_job.h"
#include "kinemark/pipeline/files/edit_session.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/report_job.h"
#include "kinemark/pipeline/motion/track_job.h"
#include "kinemark/pipeline/testing/recorded_test.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using data::EditKind;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

constexpr std::int64_t kMany = 1'000'000;

/// A recording whose journal swaps two markers, cuts one and fills another.
class IkOfEdits : public testing::RecordedTest<IkJob> {
 protected:
  void SetUp() override {
    const auto name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(at(name));
    recording_ = at(std::string(name) + "/walk.c3d");
    fs::copy_file(at("in/markers.c3d"), recording_, fs::copy_options::overwrite_existing);
    fs::remove(io::edits_of(recording_));
  }
  void edit(const data::Edit& one) {
    auto session = EditSession::open(recording_).value();
    ASSERT_TRUE(session.append(one, session.outcome().list.edits.size()).value());
  }
  void swap_and_cut() {
    edit({.kind = EditKind::swap, .marker = "LASI", .other = "RASI", .first_frame = 5, .last_frame = 12});
    edit({.kind = EditKind::cut, .marker = "LKNE", .first_frame = 10, .last_frame = 20});
  }
  [[nodiscard]] IkJob edited(const std::string& output) const {
    auto j = job(output);
    j.markers = recording_;
    j.edits = io::kEditsBeside;
    return j;
  }

  fs::path recording_;
};

nlohmann::json report_of(const fs::path& motion) {
  return nlohmann::json::parse(io::read_text(beside(motion, "_report.json"), 1U << 24).value());
}

/// Bits of both motions, those of the report apart.
void expect_same(const IkOutcome& a, const IkOutcome& b) {
  const auto &x = a.result.motion, &y = b.result.motion;
  EXPECT_EQ(x.time.frames, y.time.frames);
  EXPECT_EQ(std::memcmp(x.q.data(), y.q.data(), x.q.size() * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(x.q_sd.data(), y.q_sd.data(), x.q_sd.size() * sizeof(double)), 0);
}

TEST_F(IkOfEdits, IsTheSolutionOfTheRecordingWithItsEdits) {
  swap_and_cut();
  edit({.kind = EditKind::crop, .first_frame = 3, .last_frame = 27});
  ConvertJob convert;
  convert.in = recording_;
  convert.out = recording_.parent_path() / "edited.c3d";
  convert.edits = io::kEditsBeside;
  ASSERT_TRUE(run_convert(convert));
  auto plain = job("plain.mot");
  plain.markers = convert.out;
  const auto by_file = run_ik(plain), by_edits = run_ik(edited("edited.mot"));
  ASSERT_TRUE(by_file && by_edits) << by_edits.error().message;
  EXPECT_EQ(by_edits->result.motion.time.frames, 25);
  expect_same(*by_file, *by_edits);
}

TEST_F(IkOfEdits, ARecordingWithoutAJournalIsSolvedAsItIs) {
  auto plain = job("unedited.mot");
  plain.markers = recording_;
  const auto by_file = run_ik(plain), by_edits = run_ik(edited("none.mot"));
  ASSERT_TRUE(by_file && by_edits);
  expect_same(*by_file, *by_edits);
  EXPECT_EQ(report_of(at("none.mot"))["kinemark_set"], report_of(at("unedited.mot"))["kinemark_set"]);
}

TEST_F(IkOfEdits, TheRecordNamesJournalAndWhatItComesTo) {
  swap_and_cut();
  ASSERT_TRUE(run_ik(edited("record.mot")));
  const auto report = report_of(at("record.mot"));
  const auto& inputs = report["inputs"];
  EXPECT_TRUE(std::ranges::any_of(inputs, [](const auto& input) { return input["role"] == "edits"; }));
  EXPECT_THAT(report.dump(), HasSubstr("edits in force"));
  EXPECT_THAT(report["warnings"].dump(), HasSubstr("2 edits of"));
}

TEST_F(IkOfEdits, WithoutFilesThePageIsOfTheSameSolution) {
  swap_and_cut();
  edit({.kind = EditKind::fill, .marker = "LKNE"});
  const auto page = ik_page(edited(""), kMany);
  ASSERT_TRUE(page) << page.error().message;
  ASSERT_TRUE(run_ik(edited("files.mot")));
  EXPECT_EQ(page->set, report_of(at("files.mot"))["kinemark_set"].get<std::string>());
  EXPECT_EQ(page->edits, 3U);
  const auto session = EditSession::open(recording_).value();
  EXPECT_EQ(page->digest, io::digest_of(session.outcome().in_force));
  EXPECT_THAT(page->html, HasSubstr("kinemark.ik_report"));
  auto unedited = edited("");
  unedited.edits.clear();
  const auto recorded = ik_page(unedited, kMany);
  ASSERT_TRUE(recorded);
  EXPECT_NE(recorded->set, page->set);
  EXPECT_EQ(recorded->digest, io::digest_of({}));
}

TEST_F(IkOfEdits, APageIsRefusedWhereItIsTooLongAndStoppedWhereThatIsAsked) {
  EXPECT_THAT(ik_page(edited(""), 10).error().message, HasSubstr("walk.c3d: 30 frames of "));
  EXPECT_EQ(ik_page(edited(""), 10).error().code, Code::not_supported);
  auto stopped = edited("");
  stopped.progress = [](std::int64_t, std::int64_t) { return false; };
  EXPECT_EQ(ik_page(stopped, kMany).error().code, Code::cancelled);
  auto nameless = edited("");
  nameless.model.clear();
  EXPECT_EQ(ik_page(nameless, kMany).error().code, Code::usage);
}

TEST_F(IkOfEdits, AReportMadeLaterShowsStatesWithTheEditsUnlessTheyChanged) {
  swap_and_cut();
  ASSERT_TRUE(run_ik(edited("later.mot")));
  const auto with = page_of(at("later.mot")).value();
  edit({.kind = EditKind::cut, .marker = "RKNE", .first_frame = 10, .last_frame = 20});
  const auto without = page_of(at("later.mot")).value();
  EXPECT_NE(with, without) << "states of another journal are not those of the solution";
}

TEST_F(IkOfEdits, EditsOfAnotherRecordingAreRefused) {
  ASSERT_TRUE(io::write_text(io::edits_of(recording_), "nonsense\n", false));
  EXPECT_THAT(run_ik(edited("bad.mot")).error().message, HasSubstr("walk_edits.jsonl: line 1"));
  auto absent = edited("bad.mot");
  absent.edits = at("absent.jsonl");
  EXPECT_EQ(run_ik(absent).error().code, Code::io);
  EXPECT_FALSE(fs::exists(at("bad.mot")));
}

TEST_F(IkOfEdits, TrackTakesThemToo) {
  swap_and_cut();
  TrackJob track;
  track.model = at("in/model.osim");
  track.markers = recording_;
  track.edits = io::kEditsBeside;
  track.output = at("tracked.mot");
  const auto outcome = run_track(track);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->summary.run.inputs.back().role, "edits");
  EXPECT_THAT(outcome->summary.run.options, Contains(Pair("edits in force", HasSubstr("2, XXH3-64"))));
}

}  // namespace
}  // namespace kinemark::pipeline
