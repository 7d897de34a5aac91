// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/validate_job.h"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/info_json.h"
#include "kinemark/pipeline/testing/test_files.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;

class RunValidate : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(io::write_text(
        good_, "good\nversion=1\nnRows=1\nnColumns=2\ninDegrees=no\nendheader\ntime\ta\n0\t1\n", false));
    ASSERT_TRUE(io::write_text(
        odd_, "odd\nversion=1\nnRows=5\nnColumns=2\ninDegrees=no\nendheader\ntime\ta\n0\t1\n", false));
    ASSERT_TRUE(io::write_text(broken_, "<OpenSimDocument", false));
  }
  testing_support::ScratchFolder scratch_;
  std::filesystem::path good_ = scratch_ / "good.sto", odd_ = scratch_ / "odd.sto",
                        broken_ = scratch_ / "broken.osim", absent_ = scratch_ / "absent.c3d";
  static ValidateOutcome validate(std::vector<std::filesystem::path> files) {
    ValidateJob job;
    job.files = std::move(files);
    return run_validate(job).value();
  }
};

TEST_F(RunValidate, EveryFileHasItsOwnStatusAndTheWorstCounts) {
  const auto outcome = validate({good_, odd_, broken_, absent_});
  ASSERT_EQ(outcome.files.size(), 4U);
  EXPECT_EQ(outcome.files[0].exit_status(), 0);
  EXPECT_EQ(outcome.files[1].exit_status(), 1);
  EXPECT_EQ(outcome.files[2].exit_status(), 3);
  EXPECT_EQ(outcome.files[3].exit_status(), 4);
  EXPECT_EQ(outcome.exit_status(), 4);
  EXPECT_THAT(outcome.files[1].warnings.at(0), HasSubstr("5"));
  ASSERT_TRUE(outcome.files[2].error);
  EXPECT_THAT(outcome.files[2].error->message, HasSubstr("broken.osim"));
  EXPECT_EQ(validate({good_}).exit_status(), 0);
  EXPECT_EQ(validate({}).exit_status(), 0);
}

TEST_F(RunValidate, EventsThatTheMarkersContradictAreNamedAsGaitNamesThem) {
  const analysis::testing::KnownWalk walk;
  data::Trial trial{.markers = walk.markers(0.0003, 3)};
  for (const bool exchanged : {false, true}) {
    trial.events.clear();
    for (const auto& event : walk.events()) {
      const bool left = (event.side == data::Side::left) != exchanged;
      trial.events.push_back(
          {std::string(data::to_string(event.what)), left ? "Left" : "Right", event.time_s});
    }
    const auto file = scratch_ / "walk.c3d";
    const auto written = io::write_markers(file, trial, true);
    ASSERT_TRUE(written) << written.error().message;
    const auto outcome = validate({file});
    const auto& warnings = outcome.files.at(0).warnings;
    const bool said = std::ranges::any_of(warnings, [](const std::string& warning) {
      return warning.starts_with("left and right of the file's events are exchanged: ");
    });
    EXPECT_EQ(said, exchanged);
    EXPECT_EQ(outcome.exit_status(), exchanged ? 1 : 0) << (warnings.empty() ? "" : warnings[0]);
  }
}

TEST_F(RunValidate, TheJsonHasWarningsOrAnError) {
  const auto json = validate_json(validate({good_, odd_, broken_}));
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0], nlohmann::ordered_json({{"file", good_.string()},
                                             {"exit_status", 0},
                                             {"warnings", nlohmann::ordered_json::array()}}));
  EXPECT_EQ(json[1]["warnings"].size(), 1U);
  EXPECT_FALSE(json[1].contains("error"));
  EXPECT_EQ(json[2]["exit_status"], 3);
  EXPECT_THAT(json[2]["error"].get<std::string>(), HasSubstr("broken.osim"));
  EXPECT_FALSE(json[2].contains("warnings"));
}

TEST_F(RunValidate, ProgressCountsFilesAndMayStop) {
  ValidateJob job;
  job.files = {good_, good_, good_};
  std::int64_t seen = 0;
  job.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 3);
    seen = done;
    return done < 2;
  };
  EXPECT_EQ(run_validate(job).error().code, Code::cancelled);
  EXPECT_EQ(seen, 2);
}

TEST(OutcomeJson, TellsWhatWasWrittenAndWarned) {
  JobOutcome outcome;
  EXPECT_EQ(outcome_json(outcome).dump(), R"({"written":[],"warnings":[]})");
  outcome.written = {"a/b.trc"};
  outcome.warnings = {"odd"};
  EXPECT_EQ(outcome_json(outcome).dump(), R"({"written":["a/b.trc"],"warnings":["odd"]})");
}

TEST_F(RunValidate, ATableIsHeldBesideAModel) {
  const auto model = testing_support::project_folder() / "models" / "human.osim";
  data::Table table{.name = "Coordinates", .in_degrees = true, .columns = {"knee_angle_r"}};
  for (int r = 0; r < 40; ++r) {
    table.time_s.push_back(0.01 * r);
    table.values.push_back(r < 20 ? 5.0 : 0.0);
  }
  ValidateJob job;
  job.files = {scratch_ / "q.mot"};
  ASSERT_TRUE(io::write_table(job.files[0], table, {.force = true}));
  job.model = model;
  EXPECT_EQ(run_validate(job).value().exit_status(), 0);
  const auto description = io::read_osim(model).value();
  const auto& knee =
      description.coordinates[static_cast<std::size_t>(description.find_coordinate("knee_angle_r"))];
  for (int r = 0; r < 20; ++r) table.values[static_cast<std::size_t>(r)] = knee.range_max * 57.2957795 + 30.0;
  ASSERT_TRUE(io::write_table(job.files[0], table, {.force = true}));
  const auto outcome = run_validate(job).value();
  EXPECT_EQ(outcome.exit_status(), 1);
  EXPECT_THAT(
      outcome.files[0].warnings,
      ::testing::ElementsAre(HasSubstr("'knee_angle_r' lies up to 30 deg above its range in the model")));
  job.model.clear();
  EXPECT_EQ(run_validate(job).value().exit_status(), 0) << "without a model nobody knows";
  job.model = scratch_ / "absent.osim";
  EXPECT_EQ(run_validate(job).error().code, Code::io);
  job.files = {model};
  EXPECT_EQ(run_validate(job).error().code, Code::usage);
}

TEST_F(RunValidate, ThatARecordingWasSmoothedIsANoteAndNotOdd) {
  const auto smoothed = scratch_ / "smoothed.csv", raw = scratch_ / "raw.csv";
  const std::string header = "frame,time_s,marker,x_m,y_m,z_m", rows[] = {"1,0,A,1,1,1", "2,0.01,A,1,1,1"};
  ASSERT_TRUE(io::write_text(raw, header + "\n" + rows[0] + "\n" + rows[1] + "\n", false));
  ASSERT_TRUE(io::write_text(
      smoothed, header + ",filter\n" + rows[0] + ",butterworth\n" + rows[1] + ",butterworth\n", false));
  const auto outcome = validate({smoothed, raw});
  EXPECT_EQ(outcome.exit_status(), 0);
  ASSERT_EQ(outcome.files[0].notes.size(), 1U);
  EXPECT_THAT(outcome.files[0].notes[0],
              HasSubstr("smoothed by butterworth; the samples from before are not"));
  EXPECT_TRUE(outcome.files[1].notes.empty());
  const auto json = validate_json(outcome);
  EXPECT_EQ(json[0]["notes"].size(), 1U);
  EXPECT_FALSE(json[1].contains("notes"));
}

TEST_F(RunValidate, AModelsSmallFaultsAreNotesAndThoseThatMatterAreOdd) {
  const auto write = [&](const char* name, const char* trunk, const char* toe) {
    const auto body = [](const char* of, const char* mass, const char* inertia) {
      return fmt::format("<Body name='{}'><mass>{}</mass><inertia>{}</inertia></Body>", of, mass, inertia);
    };
    const auto joint = [](const char* parent, const char* child) {
      return fmt::format(
          "<PinJoint name='{0}_pin'><socket_parent_frame>{1}</socket_parent_frame>"
          "<socket_child_frame>/bodyset/{0}</socket_child_frame></PinJoint>",
          child, parent);
    };
    const auto path = scratch_ / name;
    EXPECT_TRUE(io::write_text(
        path,
        "<OpenSimDocument Version='40000'><Model name='m'><BodySet><objects>" + body("trunk", "30", trunk) +
            body("toe", "0.2", toe) + "</objects></BodySet><JointSet><objects>" + joint("/ground", "trunk") +
            joint("/bodyset/trunk", "toe") +
            "</objects></JointSet><MarkerSet><objects><Marker name='HEAD'><socket_parent_frame>/bodyset/trunk"
            "</socket_parent_frame><location>0 1.5 0</location></Marker></objects></MarkerSet></Model>"
            "</OpenSimDocument>",
        false));
    return path;
  };
  const auto outcome = validate({write("good.osim", "1 0.9 0.8 0 0 0", "0.0002 0.0002 0.0003 0 0 0"),
                                 write("toe.osim", "1 0.9 0.8 0 0 0", "0.0001 0.0002 0.001 0 0 0"),
                                 write("trunk.osim", "3 0.9 0.8 0 0 0", "0.0002 0.0002 0.0003 0 0 0")});
  ASSERT_EQ(outcome.files.size(), 3U);
  for (const auto& checked : outcome.files) EXPECT_FALSE(checked.error) << checked.file;
  EXPECT_TRUE(outcome.files[0].notes.empty() && outcome.files[0].warnings.empty());
  EXPECT_EQ(outcome.files[1].exit_status(), 0);
  ASSERT_EQ(outcome.files[1].notes.size(), 1U);
  EXPECT_THAT(outcome.files[1].notes[0], HasSubstr("body 'toe' has a moment of inertia that exceeds"));
  EXPECT_EQ(outcome.files[2].exit_status(), 1);
  ASSERT_EQ(outcome.files[2].warnings.size(), 1U);
  EXPECT_THAT(outcome.files[2].warnings[0], HasSubstr("body 'trunk' has a moment of inertia that exceeds"));
}

}  // namespace
}  // namespace kinemark::pipeline
