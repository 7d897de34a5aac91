// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/analysis_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

class AnalysisSetups : public ::testing::Test {
 protected:
  Result<AnalysisSetup> read(const std::string& content) {
    const fs::path path = folder_ / "s.xml";
    EXPECT_TRUE(write_text(
        path, R"(<?xml version="1.0"?><OpenSimDocument Version="40000">)" + content + "</OpenSimDocument>",
        true));
    return read_analysis_setup(path);
  }
  /// An AnalyzeTool with these elements and analyses.
  Result<AnalysisSetup> analyze(const std::string& elements, const std::string& analyses) {
    return read("<AnalyzeTool name=\"walk\">" + elements + "<AnalysisSet><objects>" + analyses +
                "</objects></AnalysisSet></AnalyzeTool>");
  }
  std::string refused(const std::string& elements, const std::string& analyses = "") {
    const auto setup = analyze(elements, analyses);
    return setup ? std::string() : setup.error().message;
  }

  testing_support::ScratchFolder folder_;
};

TEST_F(AnalysisSetups, AnAnalyzeTool) {
  const auto setup = analyze(R"(
      <model_file>sub\m.osim</model_file><coordinates_file>q.mot</coordinates_file>
      <results_directory>out</results_directory><external_loads_file>Unassigned</external_loads_file>
      <initial_time>0.25</initial_time><final_time>1.5</final_time>
      <lowpass_cutoff_frequency_for_coordinates>6</lowpass_cutoff_frequency_for_coordinates>)",
                             R"(
      <Kinematics name="K"><coordinates>hip knee</coordinates><in_degrees>false</in_degrees></Kinematics>
      <BodyKinematics><bodies>pelvis center_of_mass</bodies>
        <express_results_in_body_local_frame>true</express_results_in_body_local_frame></BodyKinematics>
      <PointKinematics name="P"><body_name>calcn_r</body_name><relative_to_body_name>pelvis</relative_to_body_name>
        <point_name>heel</point_name><point>0.1 0.2 0.3</point></PointKinematics>
      <PointKinematics name="second"><point>1 2 3</point></PointKinematics>)")
                         .value();
  EXPECT_EQ(setup.name, "walk");
  EXPECT_EQ(setup.model_file, folder_ / "sub/m.osim");
  EXPECT_EQ(setup.coordinates_file, folder_ / "q.mot");
  EXPECT_EQ(setup.results_directory, folder_ / "out");
  EXPECT_TRUE(setup.external_loads_file.empty());
  EXPECT_EQ(setup.time_begin_s, 0.25);
  EXPECT_EQ(setup.time_end_s, 1.5);
  EXPECT_EQ(setup.cutoff_hz, 6.0);
  EXPECT_FALSE(setup.torques);
  ASSERT_TRUE(setup.kinematics);
  EXPECT_EQ(setup.kinematics->name, "K");
  EXPECT_THAT(setup.kinematics->coordinates, ElementsAre("hip", "knee"));
  EXPECT_FALSE(setup.kinematics->in_degrees);
  ASSERT_TRUE(setup.bodies);
  EXPECT_EQ(setup.bodies->name, "BodyKinematics") << "it has no name of its own";
  EXPECT_THAT(setup.bodies->bodies, ElementsAre("pelvis", "center_of_mass"));
  EXPECT_TRUE(setup.bodies->in_degrees);
  EXPECT_TRUE(setup.bodies->in_body);
  ASSERT_EQ(setup.points.size(), 2U);
  EXPECT_EQ(setup.points[0].point, "heel");
  EXPECT_EQ(setup.points[0].body, "calcn_r");
  EXPECT_EQ(setup.points[0].relative_to, "pelvis");
  EXPECT_EQ(setup.points[0].x_in_body, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(setup.points[1].body, "ground");
  EXPECT_EQ(setup.points[1].relative_to, "ground");
  EXPECT_THAT(setup.notes, IsEmpty());
}

TEST_F(AnalysisSetups, WhatIsSwitchedOffDoesNotCountAndWhatIsUnknownIsSaid) {
  const auto setup = analyze("", R"(<Kinematics name="k"><on>false</on></Kinematics>
      <MuscleAnalysis name="muscles"/><JointReaction/><StaticOptimization name="so"><on>false</on></StaticOptimization>
      <InverseDynamics name="id"/><BodyKinematics name="b"/>)")
                         .value();
  EXPECT_FALSE(setup.kinematics);
  EXPECT_TRUE(setup.torques);
  ASSERT_TRUE(setup.bodies);
  EXPECT_THAT(setup.bodies->bodies, ElementsAre("all")) << "none named";
  EXPECT_THAT(setup.notes,
              ElementsAre(HasSubstr("'muscles' is passed over"), HasSubstr("'JointReaction' is passed")));
  EXPECT_EQ(setup.cutoff_hz, 0.0);
  EXPECT_TRUE(std::isinf(setup.time_begin_s));
}

TEST_F(AnalysisSetups, TimesOfAnAnalysisWithinThoseOfTheToolAreSaid) {
  const auto notes = [&](const std::string& times) {
    return analyze("<initial_time>0.5</initial_time><final_time>1</final_time>",
                   "<Kinematics name=\"k\">" + times + "</Kinematics>")
        .value()
        .notes;
  };
  EXPECT_THAT(notes("<start_time>0</start_time><end_time>2</end_time><step_interval>1</step_interval>"),
              IsEmpty());
  EXPECT_THAT(notes("<start_time>0.6</start_time>"), ElementsAre(HasSubstr("of 'k' are passed over")));
  EXPECT_THAT(notes("<end_time>0.9</end_time>"), ElementsAre(HasSubstr("of 'k' are passed over")));
  EXPECT_THAT(notes("<step_interval>10</step_interval>"), ElementsAre(HasSubstr("of 'k' are passed over")));
}

TEST_F(AnalysisSetups, AnInverseDynamicsTool) {
  const auto setup = read(R"(<InverseDynamicsTool name="id"><time_range>0.1 0.9</time_range>
      <external_loads_file>loads.xml</external_loads_file><coordinates_file>q.mot</coordinates_file>
      <lowpass_cutoff_frequency_for_coordinates>-1</lowpass_cutoff_frequency_for_coordinates>
      <output_gen_force_file>../../elsewhere/t.sto</output_gen_force_file></InverseDynamicsTool>)")
                         .value();
  EXPECT_TRUE(setup.torques);
  EXPECT_EQ(setup.time_begin_s, 0.1);
  EXPECT_EQ(setup.time_end_s, 0.9);
  EXPECT_EQ(setup.external_loads_file, folder_ / "loads.xml");
  EXPECT_EQ(setup.force_file, "t.sto") << "a name, in the folder of the results";
  EXPECT_EQ(setup.cutoff_hz, 0.0) << "-1 is none";
  EXPECT_FALSE(setup.bodies);
}

TEST_F(AnalysisSetups, FilesAreLookedForBesideTheSetup) {
  ASSERT_TRUE(write_text(folder_ / "m.osim", "x", true));
  const auto setup = analyze(R"(<model_file>C:\Users\x\m.osim</model_file>)", "").value();
  EXPECT_EQ(setup.model_file, folder_ / "m.osim");
  EXPECT_THAT(setup.notes, ElementsAre(HasSubstr("'m.osim' beside the setup is read instead")));
}

TEST_F(AnalysisSetups, WhatIsWrongIsOneSentence) {
  EXPECT_THAT(
      refused("<states_file>s.sto</states_file>"),
      AllOf(HasSubstr("s.xml"), HasSubstr("names states; a motion is needed, in <coordinates_file>")));
  EXPECT_THAT(refused("<initial_time>2</initial_time><final_time>1</final_time>"),
              HasSubstr("must not be before <initial_time>"));
  EXPECT_THAT(refused("<initial_time>nan</initial_time>"), HasSubstr("initial_time"));
  EXPECT_THAT(
      refused("<lowpass_cutoff_frequency_for_coordinates>six</lowpass_cutoff_frequency_for_coordinates>"),
      HasSubstr("lowpass_cutoff_frequency_for_coordinates"));
  EXPECT_THAT(refused("", "<Kinematics/><Kinematics name=\"k2\"/>"), HasSubstr("is the second of its kind"));
  EXPECT_THAT(refused("", "<PointKinematics name=\"p\"><point>1 2</point></PointKinematics>"),
              HasSubstr("point"));
  const auto other = read("<CMCTool name=\"x\"/>");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("has no <AnalyzeTool> and no <InverseDynamicsTool>"));
  EXPECT_EQ(read_analysis_setup(folder_ / "none.xml").error().code, Code::io);
}

}  // namespace
}  // namespace kinemark::io
