// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/simulate_subject_job.h"

#include <gmock/gmock.h>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/pipeline/testing/test_files.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(SimulateSubject, TheFilesAgreeWithEachOther) {
  const testing_support::ScratchFolder scratch;
  const auto files = testing::simulate_into(scratch / "subject");
  EXPECT_EQ(files.size(), 5U);
  const auto model = model::Model::compile(io::read_osim(scratch / "subject/model.osim").value()).value();
  const auto q = io::read_table(scratch / "subject/truth.mot").value();
  const auto truth = io::read_markers(scratch / "subject/truth.trc").value().markers;
  EXPECT_EQ(truth.count_missing(), 0);
  // The written angles put the written model's markers where the written truth has them.
  model::Workspace w(model);
  Eigen::VectorXd pose(model.coordinate_count());
  for (int k = 0; k < pose.size(); ++k) {
    const auto& c = model.description().coordinates[static_cast<std::size_t>(k)];
    pose[k] = q(7, q.find(c.name)) * (c.is_rotation ? kRadPerDeg : 1.0);
  }
  model::kinematics(model, w, model::state_from_coordinates(model, pose));
  for (int m = 0; m < model.marker_count(); ++m) EXPECT_LT((w.marker.col(m) - truth.x(7, m)).norm(), 1e-6);

  const auto c3d = io::read_markers(scratch / "subject/markers.c3d").value().markers;
  const auto trc = io::read_markers(scratch / "subject/markers.trc").value().markers;
  EXPECT_EQ(c3d.count_missing(), trc.count_missing());
  const double share = static_cast<double>(c3d.count_missing()) / static_cast<double>(c3d.state.size());
  EXPECT_NEAR(share, 0.2, 0.08);
}

TEST(SimulateSubject, OneSeedOneRecording) {
  const testing_support::ScratchFolder scratch;
  testing::simulate_into(scratch / "a");
  testing::simulate_into(scratch / "b");
  EXPECT_EQ(io::read_text(scratch / "a/markers.trc").value().substr(200),
            io::read_text(scratch / "b/markers.trc").value().substr(200));
}

TEST(SimulateSubject, FilesNameTheirSet) {
  const testing_support::ScratchFolder scratch;
  const auto files = testing::simulate_into(scratch / "a");
  const std::string set = set_in(files.front());
  EXPECT_EQ(set.size(), 16U);
  for (const auto& file : files) EXPECT_EQ(set_in(file), set) << file;
  testing::simulate_into(scratch / "same");
  EXPECT_EQ(set_in(scratch / "same/truth.trc"), set) << "a digest of what it is, not of where or when";
  SimulateSubjectJob other;
  other.folder = scratch / "other";
  other.seed = 99;
  other.options.duration_s = 0.2;
  ASSERT_TRUE(run_simulate_subject(other));
  EXPECT_NE(set_in(scratch / "other/truth.trc"), set);
}

TEST(SimulateSubject, RefusesToReplaceAndLeavesNoNewFolderBehind) {
  const testing_support::ScratchFolder scratch;
  fs::create_directories(scratch / "full");
  ASSERT_TRUE(io::write_text(scratch / "full/truth.mot", "mine", false));
  SimulateSubjectJob job;
  job.folder = scratch / "full";
  EXPECT_THAT(run_simulate_subject(job).error().message, HasSubstr("exists already"));
  EXPECT_EQ(io::read_text(scratch / "full/truth.mot").value(), "mine");
  job.folder = scratch / "new" / "deeper";
  job.options.duration_s = -1.0;
  EXPECT_FALSE(run_simulate_subject(job));
  EXPECT_FALSE(fs::exists(scratch / "new"));
}

TEST(SimulateSubject, StopsWhenAskedAndKeepsNothing) {
  const testing_support::ScratchFolder scratch;
  SimulateSubjectJob job;
  job.folder = scratch / "half";
  job.options.duration_s = 0.2;
  job.progress = [](std::int64_t done, std::int64_t) { return done < 2; };
  const auto stopped = run_simulate_subject(job);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Code::cancelled);
  EXPECT_FALSE(fs::exists(scratch / "half"));
}

TEST(SimulateSubject, NamesTheModelThatCannotBeUsed) {
  const testing_support::ScratchFolder scratch;
  SimulateSubjectJob job;
  job.folder = scratch / "out";
  job.model = scratch / "none.osim";
  EXPECT_THAT(run_simulate_subject(job).error().message, HasSubstr("none.osim"));
}

TEST(HumanModel, IsWholeAndHasAPlausibleBody) {
  const auto human = human_model().value();
  double mass = 0.0;
  for (const auto& body : human.bodies) mass += body.mass;
  EXPECT_GT(mass, 50.0);
  EXPECT_LT(mass, 100.0);
  EXPECT_EQ(human.coordinates.size(), 40U);
  EXPECT_EQ(human.markers.size(), 40U);
  EXPECT_TRUE(model::Model::compile(human));
}

}  // namespace
}  // namespace kinemark::pipeline
