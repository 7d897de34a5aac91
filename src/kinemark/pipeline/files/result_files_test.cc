// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/result_files.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class WriteResults : public ::testing::Test {
 protected:
  fs::path at(const std::string& name) const { return scratch_ / name; }
  static ResultFile text(fs::path target, const std::string& content) {
    return text_file(std::move(target), [content] { return content; });
  }
  static data::Trial one_marker() {
    data::Trial trial;
    trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 3});
    for (std::int64_t f = 0; f < 3; ++f) {
      trial.markers.x(f, 0) = Eigen::Vector3d(0.1 * static_cast<double>(f), 1.0, -0.5);
      trial.markers.state[trial.markers.index(f, 0)] = data::SampleState::measured;
    }
    return trial;
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(WriteResults, EveryKindReadsBack) {
  const auto trial = one_marker();
  const auto model = human_model().value();
  const std::string model_text = io::format_osim(model).value();
  data::Table table;
  table.columns = {"a"};
  table.time_s = {0.0, 0.1};
  table.values.assign({1.0, 2.0});
  auto staging = Staging::create({at("t.txt"), at("t.sto"), at("t.trc"), at("t.osim")}, {}, {}).value();
  const auto written =
      write_results(staging,
                    {text(at("t.txt"), "words"), table_file(at("t.sto"), [&] { return table; }),
                     marker_file(at("t.trc"), trial), model_file(at("t.osim"), model_text)},
                    {}, "work");
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(*written, staging.targets());
  EXPECT_EQ(io::read_text(at("t.txt")).value(), "words");
  EXPECT_EQ(io::read_table(at("t.sto")).value().values, table.values);
  EXPECT_LT((io::read_markers(at("t.trc")).value().markers.x(2, 0) - trial.markers.x(2, 0)).norm(), 1e-7);
  EXPECT_EQ(io::read_osim(at("t.osim")).value().markers.size(), model.markers.size());
}

TEST_F(WriteResults, OnlyWhatWasWrittenIsReportedInTheOrderOfTheStaging) {
  auto staging = Staging::create({at("a"), at("b"), at("c")}, {}, {}).value();
  const auto written = write_results(staging, {text(at("c"), "C"), text(at("a"), "A")}, {}, "work");
  ASSERT_TRUE(written);
  EXPECT_THAT(*written, ElementsAre(at("a"), at("c")));
  EXPECT_FALSE(fs::exists(at("b")));
  EXPECT_EQ(scratch_.count_files(), 2);
}

TEST_F(WriteResults, AFailureNamesTheTargetAndLeavesNothing) {
  data::Trial nothing;
  {
    auto staging = Staging::create({at("a"), at("markers.xyz")}, {}, {}).value();
    const auto written =
        write_results(staging, {text(at("a"), "A"), marker_file(at("markers.xyz"), nothing)}, {}, "work");
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, HasSubstr(at("markers.xyz").string()));
    EXPECT_THAT(written.error().message, Not(HasSubstr(".kinemark-")))
        << "the hidden folder is no business of users";
  }
  EXPECT_EQ(scratch_.count_files(), 0);
}

TEST_F(WriteResults, ProgressCountsFilesAndMayStop) {
  std::vector<std::pair<std::int64_t, std::int64_t>> reported;
  const Progress all = [&](std::int64_t done, std::int64_t total) {
    reported.emplace_back(done, total);
    return true;
  };
  auto staging = Staging::create({at("a"), at("b")}, {}, {}).value();
  ASSERT_TRUE(write_results(staging, {text(at("a"), ""), text(at("b"), "")}, all, "work"));
  EXPECT_THAT(reported, ElementsAre(std::pair(1, 2), std::pair(2, 2)));
  auto again = Staging::create({at("c"), at("d")}, {}, {}).value();
  const auto stopped = write_results(
      again, {text(at("c"), ""), text(at("d"), "")}, [](std::int64_t done, std::int64_t) { return done < 2; },
      "the walk");
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
  EXPECT_EQ(stopped.error().message, "the walk was stopped");
  EXPECT_FALSE(fs::exists(at("c"))) << "written, but never shown";
}

}  // namespace
}  // namespace kinemark::pipeline
