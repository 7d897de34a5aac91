// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/ik_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

IkSetup setup_of(const fs::path& path) {
  auto setup = read_ik_setup(path);
  EXPECT_TRUE(setup) << setup.error().message;
  return setup.value_or(IkSetup{});
}

std::size_t applied(const IkTasks& tasks) {
  std::size_t n = 0;
  for (const auto& task : tasks.markers) n += task.apply && task.weight > 0.0;
  return n;
}

TEST(IkSetup, EveryRealSetup) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  struct Case {
    const char* path;
    std::size_t markers, applied, coordinates;
    double begin_s, end_s, constraint_weight, accuracy;
    const char *model, *trial;
  };
  const Case cases[] = {
      {"opensim-core-ik/subject01_Setup_InverseKinematics.xml", 31, 31, 0, 0.4, 1.6, 10.0, 1e-5,
       "opensim-core-ik/subject01_simbody.osim", "opensim-core-ik/subject01_synthetic_marker_data.trc"},
      {"opensim-core-ik/setup_ik_abdbonepin.xml", 11, 10, 0, 0.0, 19.0, INFINITY, 1e-6,
       "opensim-core-ik/subject1_abdbonepin.osim", "opensim-core-ik/abdbonepin.trc"},
      {"opensim-gait2354/subject01_Setup_IK.xml", 31, 31, 4, 0.4, 1.6, 20.0, 1e-5,
       "opensim-gait2354/subject01_simbody.osim", "opensim-gait2354/subject01_walk1.trc"},
      {"opensim-hamner-fullbody/Setup_IK.xml", 38, 37, 0, 0.0, 9.983, INFINITY, 1e-4,
       "opensim-hamner-fullbody/subject01_registered.osim", "opensim-hamner-fullbody/subject02_running.trc"},
      {"opensim-arm26/arm26_Setup_InverseKinematics.xml", 3, 3, 0, 0.0, 1.0, INFINITY, 1e-5,
       "opensim-arm26/arm26.osim", "opensim-arm26/arm26_elbow_flex.trc"},
      {"bmc-rajagopal-run/IK/IK_setup.xml", 64, 39, 0, 0.0, 0.813, INFINITY, 1e-4,
       "bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim",
       "bmc-rajagopal-run/ExpData/motion_capture_run.trc"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.path);
    const IkSetup setup = setup_of(data / c.path);
    EXPECT_EQ(setup.tasks.markers.size(), c.markers);
    EXPECT_EQ(applied(setup.tasks), c.applied);
    EXPECT_EQ(setup.tasks.coordinates.size(), c.coordinates);
    EXPECT_DOUBLE_EQ(setup.time_begin_s, c.begin_s);
    EXPECT_DOUBLE_EQ(setup.time_end_s, c.end_s);
    EXPECT_EQ(setup.constraint_weight, c.constraint_weight);
    EXPECT_DOUBLE_EQ(setup.accuracy, c.accuracy);
    EXPECT_EQ(setup.model_file, data / c.model);
    EXPECT_EQ(setup.marker_file, data / c.trial);
    EXPECT_TRUE(setup.coordinate_file.empty()) << "'Unassigned' names no file";
  }
}

TEST(IkSetup, WeightsAndOutputsOfGait2354) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const IkSetup setup = setup_of(data / "opensim-gait2354/subject01_Setup_IK.xml");
  EXPECT_EQ(setup.name, "subject01");
  EXPECT_EQ(setup.output_motion_file, data / "opensim-gait2354/subject01_walk1_ik.mot");
  EXPECT_TRUE(setup.report_errors) << "OpenSim's default";
  EXPECT_EQ(setup.tasks.markers[1].name, "R.Acromium");
  EXPECT_EQ(setup.tasks.markers[1].weight, 0.5);
  for (const auto& task : setup.tasks.coordinates) {
    EXPECT_EQ(task.weight, 1000.0);
    EXPECT_EQ(task.target, IkCoordinateTask::Target::default_value);
  }
  const IkSetup hamner = setup_of(data / "opensim-hamner-fullbody/Setup_IK.xml");
  EXPECT_EQ(hamner.results_directory, data / "opensim-hamner-fullbody/ResultsIK");
  EXPECT_TRUE(hamner.report_marker_locations);
}

TEST(IkSetup, TaskFilesEvenWithAClosingTagThatNobodyOpened) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto stray = read_ik_tasks(data / "opensim-core-ik/gait2354_IK_Tasks.xml");
  ASSERT_TRUE(stray) << stray.error().message;
  EXPECT_EQ(stray->markers.size(), 31U);
  EXPECT_EQ(stray->coordinates.size(), 4U);
  EXPECT_EQ(stray->coordinates.back().name, "mtp_angle_l");
  EXPECT_EQ(stray->coordinates.back().weight, 10.0);
  EXPECT_EQ(read_ik_tasks(data / "opensim-core-ik/gait2354_IK_Tasks_uniform.xml").value().markers.size(),
            31U);
  EXPECT_EQ(read_ik_tasks(data / "opensim-hamner-fullbody/Tasks_IK.xml").value().markers.size(), 38U);
}

class SmallSetup : public testing::Test {
 protected:
  /// The message of reading `xml` as a setup, or "".
  std::string refusal(const std::string& inside, const std::string& tag = "InverseKinematicsTool") {
    const auto setup = read(inside, tag);
    return setup ? "" : setup.error().message;
  }
  Result<IkSetup> read(const std::string& inside, const std::string& tag = "InverseKinematicsTool") {
    const auto path = scratch_ / "sub";
    fs::create_directories(path);
    EXPECT_TRUE(write_text(
        path / "s.xml",
        "<OpenSimDocument Version=\"40000\"><" + tag + ">" + inside + "</" + tag + "></OpenSimDocument>",
        true));
    return read_ik_setup(path / "s.xml");
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(SmallSetup, DefaultsAreOpenSims) {
  const IkSetup setup = read("").value();
  EXPECT_EQ(setup.time_begin_s, -INFINITY);
  EXPECT_EQ(setup.time_end_s, INFINITY);
  EXPECT_EQ(setup.constraint_weight, INFINITY);
  EXPECT_EQ(setup.accuracy, 1e-5);
  EXPECT_TRUE(setup.tasks.markers.empty());
  EXPECT_TRUE(setup.model_file.empty());
}

TEST_F(SmallSetup, PathsAreSeenFromTheSetupsFolderOnEverySystem) {
  const IkSetup setup =
      read("<model_file> ..\\models\\m.osim </model_file><marker_file>/data/t.trc</marker_file>").value();
  EXPECT_EQ(setup.model_file, scratch_ / "models/m.osim");
  EXPECT_EQ(setup.marker_file, "/data/t.trc");
}

TEST_F(SmallSetup, FilesThatMovedAreFoundBesideTheSetupAndItIsSaid) {
  fs::create_directories(scratch_ / "sub");
  ASSERT_TRUE(write_text(scratch_ / "sub/walk.trc", "", true));
  const IkSetup setup = read(
                            "<model_file>C:\\Users\\me\\m.osim</model_file>"
                            "<marker_file>C:\\Users\\me\\walk.trc</marker_file>"
                            "<output_motion_file>..\\walk.trc</output_motion_file>")
                            .value();
  EXPECT_EQ(setup.marker_file, scratch_ / "sub/walk.trc");
  EXPECT_EQ(setup.model_file.filename(), "m.osim");
  EXPECT_EQ(setup.output_motion_file, scratch_ / "walk.trc") << "where results go is not looked for";
  ASSERT_EQ(setup.notes.size(), 1U);
  EXPECT_NE(setup.notes[0].find("<marker_file> names 'C:\\Users\\me\\walk.trc'"), std::string::npos)
      << setup.notes[0];
}

TEST_F(SmallSetup, CoordinateTasks) {
  const IkSetup setup = read(R"(<IKTaskSet><objects>
    <IKCoordinateTask name="a"><weight>2</weight><value_type> manual_value </value_type><value>0.5</value></IKCoordinateTask>
    <IKCoordinateTask name="b"><apply>false</apply><value_type>From_File</value_type></IKCoordinateTask>
    <IKMarkerTask name="a"><weight>1e1</weight></IKMarkerTask></objects></IKTaskSet>)")
                            .value();
  ASSERT_EQ(setup.tasks.coordinates.size(), 2U);
  EXPECT_EQ(setup.tasks.coordinates[0].target, IkCoordinateTask::Target::manual_value);
  EXPECT_EQ(setup.tasks.coordinates[0].value, 0.5);
  EXPECT_EQ(setup.tasks.coordinates[1].target, IkCoordinateTask::Target::from_file);
  EXPECT_FALSE(setup.tasks.coordinates[1].apply);
  EXPECT_EQ(setup.tasks.markers[0].weight, 10.0);
}

TEST_F(SmallSetup, ToolsOfBefore23HaveTheirTrialInside) {
  const IkSetup setup = read(R"(<model_file>m.osim</model_file>
    <IKTaskSet><objects><IKMarkerTask name="M"><weight>3</weight></IKMarkerTask></objects></IKTaskSet>
    <IKTrialSet><objects><IKTrial name="walk"><marker_file>w.trc</marker_file><time_range>1 2</time_range>
    </IKTrial></objects></IKTrialSet>)",
                             "IKTool")
                            .value();
  EXPECT_EQ(setup.marker_file.filename(), "w.trc");
  EXPECT_EQ(setup.time_begin_s, 1.0);
  ASSERT_EQ(setup.tasks.markers.size(), 1U);
  EXPECT_EQ(setup.constraint_weight, 20.0);
}

TEST_F(SmallSetup, NamesTheFilesItIsPutTogetherFrom) {
  EXPECT_TRUE(read("<marker_file>w.trc</marker_file>").value().parts.empty());
  ASSERT_TRUE(write_text(scratch_ / "sub/tasks.xml",
                         "<OpenSimDocument><IKTaskSet><objects><IKMarkerTask name=\"M\"><weight>3</weight>"
                         "</IKMarkerTask></objects></IKTaskSet></OpenSimDocument>",
                         false));
  const IkSetup setup = read("<IKTaskSet file=\"tasks.xml\"/>").value();
  ASSERT_EQ(setup.tasks.markers.size(), 1U);
  EXPECT_EQ(setup.parts, std::vector{scratch_ / "sub/tasks.xml"});
}

TEST_F(SmallSetup, OneSentenceForEachMistake) {
  EXPECT_THAT(refusal("<time_range>2 1</time_range>"), HasSubstr("<time_range>: '2 1' is not a range"));
  EXPECT_THAT(refusal("<time_range>soon</time_range>"), HasSubstr("is not a range"));
  EXPECT_THAT(refusal("<accuracy>high</accuracy>"), HasSubstr("<accuracy>: 'high' is not a number"));
  EXPECT_THAT(refusal("<accuracy>0</accuracy>"), HasSubstr("must be above 0"));
  EXPECT_THAT(refusal("<constraint_weight>-1</constraint_weight>"), HasSubstr("must be 0 or more"));
  EXPECT_THAT(refusal("<constraint_weight>nan</constraint_weight>"), HasSubstr("must be 0 or more"));
  EXPECT_THAT(refusal("<report_errors>maybe</report_errors>"), HasSubstr("neither true nor false"));
  EXPECT_THAT(refusal("<IKTaskSet file=\"none.xml\"/>"), HasSubstr("none.xml: cannot be opened"));
  EXPECT_THAT(refusal("", "CMCTool"), HasSubstr("has no <InverseKinematicsTool>"));
  const auto task = [&](const std::string& t) {
    return refusal("<IKTaskSet><objects>" + t + "</objects></IKTaskSet>");
  };
  EXPECT_THAT(task("<IKMarkerTask name=\"M\"><weight>nan</weight></IKMarkerTask>"),
              HasSubstr("IKMarkerTask 'M', <weight>: is nan"));
  EXPECT_THAT(task("<IKMarkerTask name=\"M\"><weight>-2</weight></IKMarkerTask>"),
              HasSubstr("need a finite number, 0 or more"));
  EXPECT_THAT(task("<IKMarkerTask name=\"M\"/><IKMarkerTask name=\"M\"/>"), HasSubstr("'M': occurs twice"));
  EXPECT_THAT(task("<IKMarkerTask/>"), HasSubstr("has no name"));
  EXPECT_THAT(task("<IKCoordinateTask name=\"c\"><value_type>guess</value_type></IKCoordinateTask>"),
              HasSubstr("is 'guess'"));
  EXPECT_EQ(read_ik_setup(scratch_ / "absent.xml").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
