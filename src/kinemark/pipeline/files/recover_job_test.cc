// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recover_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/files/info_json.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;

class RecoverJobTest : public testing::Test {
 protected:
  void SetUp() override {
    data::Counts counts = data::Counts::zeros({"hand", "wrist"}, {"A", "B"},
                                              {.rate_hz = 100.0, .t0_s = 0.0, .frames = 50}, true);
    counts.rig_id = "one";
    counts.flags[3] = data::kCountOccluded;
    counts.flags[4] = data::kCountSaturated | data::kCountOccluded;
    const std::vector<io::RecordingMetadata> metadata{{"scenario", {{"name", "tree"}}}};
    ASSERT_TRUE(io::write_counts(whole_, counts, metadata, false));
  }
  /// The recording without its last bytes.
  void cut(std::size_t bytes) {
    std::string text = io::read_text(whole_).value();
    text.resize(text.size() - bytes);
    ASSERT_TRUE(io::write_text(cut_, text, true));
  }

  static Result<RecoverOutcome> recover(const std::filesystem::path& in, const std::filesystem::path& out,
                                        bool force = false) {
    RecoverJob job;
    job.in = in;
    job.out = out;
    job.force = force;
    return run_recover(job);
  }
  static Result<nlohmann::ordered_json> facts_of(const std::filesystem::path& file) {
    InfoJob job;
    job.file = file;
    const auto found = run_info(job);
    if (!found) return std::unexpected(found.error());
    return info_json(*found);
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path whole_ = scratch_ / "whole.mcap", cut_ = scratch_ / "cut.mcap",
                        out_ = scratch_ / "out.mcap";
};

TEST_F(RecoverJobTest, TellsWhatWasKeptAndWhatWasNot) {
  cut(2000);
  const auto done = recover(cut_, out_);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->end, io::RecordingEnd::cut);
  EXPECT_GT(done->messages, 10);
  EXPECT_LT(done->messages, 50);
  ASSERT_EQ(done->damage.size(), 1U);
  EXPECT_EQ(done->damage[0].bytes, done->bytes_left_out);
  EXPECT_THAT(done->warnings.at(0), HasSubstr("ends within a record"));
  EXPECT_EQ(io::read_counts(out_)->counts.frames(), done->messages);
  EXPECT_EQ(done->exit_status(), 1) << "bytes had to be left out";
  const auto json = recover_json(*done);
  EXPECT_EQ(json["original"], cut_.string());
  EXPECT_EQ(json["written"], nlohmann::json({out_.string()}));
  EXPECT_EQ(json["end"], "cut");
  EXPECT_EQ(json["messages"], done->messages);
  EXPECT_EQ(json["damage"][0]["bytes"], json["bytes_left_out"]);
}

TEST_F(RecoverJobTest, AWholeRecordingPassesItsGate) {
  const auto done = recover(whole_, out_);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->exit_status(), 0);
  EXPECT_EQ(done->messages, 50);
  EXPECT_TRUE(done->warnings.empty());
  EXPECT_EQ(recover(whole_, out_).error().code, Code::io) << "nothing is replaced unasked";
  EXPECT_TRUE(recover(whole_, out_, true));
}

TEST_F(RecoverJobTest, PassesFailuresOn) {
  EXPECT_EQ(recover(scratch_ / "absent.mcap", out_).error().code, Code::io);
  EXPECT_EQ(recover(whole_, whole_, true).error().code, Code::usage);
}

TEST_F(RecoverJobTest, FactsOfARecordingOfCounts) {
  const auto facts = facts_of(whole_);
  ASSERT_TRUE(facts) << facts.error().message;
  EXPECT_EQ(facts->at("kind"), "recording");
  EXPECT_EQ(facts->at("end"), "closed");
  EXPECT_EQ(facts->at("messages"), 50);
  EXPECT_EQ(facts->at("channels"), nlohmann::json({"/counts"}));
  EXPECT_EQ(facts->at("metadata"), nlohmann::json({"scenario"}));
  EXPECT_EQ(facts->at("frames"), 50);
  EXPECT_EQ(facts->at("rate_hz"), 100.0);
  EXPECT_EQ(facts->at("rig"), "one");
  EXPECT_EQ(facts->at("cameras"), nlohmann::json({"A", "B"}));
  EXPECT_EQ(facts->at("labels"), nlohmann::json({"hand", "wrist"}));
  EXPECT_EQ(facts->at("saturated"), 1);
  EXPECT_EQ(facts->at("occluded"), 2);
  EXPECT_EQ(facts->at("lost"), 0);
  EXPECT_TRUE(facts->at("dark_slot").get<bool>());
  EXPECT_TRUE(facts->at("warnings").empty());
  InfoJob job;
  job.file = whole_;
  EXPECT_THAT(info_text(run_info(job).value()), HasSubstr("cameras           A B\n"));
}

TEST_F(RecoverJobTest, FactsOfACutRecordingWarn) {
  cut(2000);
  const auto facts = facts_of(cut_);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->at("end"), "cut");
  EXPECT_EQ(facts->at("warnings").size(), 1U);
}

}  // namespace
}  // namespace kinemark::pipeline
