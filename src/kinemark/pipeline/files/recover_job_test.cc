// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recover_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/files/file_facts.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using testing::HasSubstr;

class RecoverJob : public testing::Test {
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

  testing_support::ScratchFolder scratch_;
  std::filesystem::path whole_ = scratch_ / "whole.mcap", cut_ = scratch_ / "cut.mcap",
                        out_ = scratch_ / "out.mcap";
};

TEST_F(RecoverJob, TellsWhatWasKeptAndWhatWasNot) {
  cut(2000);
  const auto done = recover_file(cut_, out_, false);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->at("end"), "cut");
  EXPECT_EQ(done->at("written").at(0), out_.string());
  EXPECT_GT(done->at("messages").get<int>(), 10);
  EXPECT_LT(done->at("messages").get<int>(), 50);
  EXPECT_EQ(done->at("damage").size(), 1U);
  EXPECT_EQ(done->at("damage").at(0).at("bytes"), done->at("bytes_left_out"));
  EXPECT_THAT(done->at("warnings").at(0).get<std::string>(), HasSubstr("ends within a record"));
  EXPECT_EQ(io::read_counts(out_)->counts.frames(), done->at("messages").get<int>());
}

TEST_F(RecoverJob, PassesFailuresOn) {
  EXPECT_EQ(recover_file(scratch_ / "absent.mcap", out_, false).error().code, Code::io);
  EXPECT_EQ(recover_file(whole_, whole_, true).error().code, Code::usage);
}

TEST_F(RecoverJob, FactsOfARecordingOfCounts) {
  const auto facts = describe_file(whole_);
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
  EXPECT_THAT(facts_text(*facts), HasSubstr("cameras           A B\n"));
}

TEST_F(RecoverJob, FactsOfACutRecordingWarn) {
  cut(2000);
  const auto facts = describe_file(cut_);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->at("end"), "cut");
  EXPECT_EQ(facts->at("warnings").size(), 1U);
}

}  // namespace
}  // namespace kinemark::pipeline
