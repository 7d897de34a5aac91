// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/info_json.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <string>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/testing/test_files.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Result<nlohmann::ordered_json> facts_of(const std::filesystem::path& file, double rate_hz = 0.0) {
  InfoJob job;
  job.file = file;
  job.rate_hz = rate_hz;
  const auto found = run_info(job);
  if (!found) return std::unexpected(found.error());
  return info_json(*found);
}

TEST(RunInfo, MarkersTablesAndModels) {
  const testing_support::ScratchFolder scratch;
  testing::simulate_into(scratch / "in");
  const auto markers = io::read_markers(scratch / "in/markers.c3d").value().markers;
  const auto facts = facts_of(scratch / "in/markers.c3d").value();
  EXPECT_EQ(facts["kind"], "markers");
  EXPECT_EQ(facts["points"], markers.markers());
  EXPECT_EQ(facts["frames"], markers.frames());
  EXPECT_EQ(facts["rate_hz"], 60.0);
  EXPECT_EQ(facts["missing"], markers.count_missing());
  EXPECT_EQ(facts["last_frame"].get<int>() - facts["first_frame"].get<int>() + 1, markers.frames());
  EXPECT_EQ(facts["labels"].size(), markers.names.size());
  EXPECT_EQ(facts["analog_channels"], 0);

  const auto table = facts_of(scratch / "in/truth.mot").value();
  EXPECT_EQ(table["kind"], "table");
  EXPECT_EQ(table["rows"], markers.frames());
  EXPECT_EQ(table["in_degrees"], true);
  EXPECT_NEAR(table["last_time_s"].get<double>(), markers.time.time_s(markers.frames() - 1), 1e-9);

  const auto model = facts_of(scratch / "in/model.osim").value();
  EXPECT_EQ(model["kind"], "model");
  EXPECT_GE(model["joints"], 25);
  EXPECT_EQ(model["coordinates"], 40);
  EXPECT_EQ(model["markers"], 40);
  EXPECT_NEAR(model["mass_kg"].get<double>(), 75.0, 25.0);
}

TEST(RunInfo, OrientationsBesideMarkersOrAloneInOtherFormats) {
  const testing_support::ScratchFolder scratch;
  const auto bodies = scratch / "bodies.tsv", motive = scratch / "bodies.csv";
  ASSERT_TRUE(io::write_text(
      bodies,
      "NO_OF_FRAMES\t2\nNO_OF_BODIES\t1\nFREQUENCY\t100\nDATA_INCLUDED\t6D\nBODY_NAMES\tstick\n"
      "100\t200\t300\t0\t0\t0\t0.3\t0\t1\t0\t-1\t0\t0\t0\t0\t1\n"
      "0.000\t0.000\t0.000\t0\t0\t0\t-1\t0\t0\t0\t0\t0\t0\t0\t0\t0\n",
      true));
  const auto besides = facts_of(bodies).value();
  EXPECT_EQ(besides["kind"], "markers") << "origins are points";
  EXPECT_EQ(besides["orientation_rate_hz"], 100.0);
  EXPECT_EQ(besides["orientation_frames"], 2);
  EXPECT_EQ(besides["orientation_missing"], 1);
  ASSERT_EQ(besides["orientations"].size(), 1U);
  EXPECT_EQ(besides["orientations"][0]["name"], "stick");
  ASSERT_TRUE(
      io::write_text(motive,
                     "Format Version,1.23,Export Frame Rate,100,Length Units,Meters\n\n"
                     ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n,Name,stick,stick,stick,stick\n"
                     ",ID,1,1,1,1\n,,Rotation,Rotation,Rotation,Rotation\n"
                     "Frame,Time (Seconds),X,Y,Z,W\n0,0,0,0,0,1\n1,0.01,,,,\n2,0.02,0,0,0,1\n",
                     true));
  const auto alone = facts_of(motive).value();
  EXPECT_EQ(alone["kind"], "orientations");
  EXPECT_EQ(alone["missing"], 1);
  EXPECT_EQ(alone["sensors"][0]["name"], "stick");
  testing::simulate_into(scratch / "in");
  EXPECT_FALSE(facts_of(scratch / "in/markers.c3d").value().contains("orientations"));
}

TEST(RunInfo, OrientationsAreSensorsAndNoTable) {
  const testing_support::ScratchFolder scratch;
  const auto file = scratch / "walk.sto";
  ASSERT_TRUE(
      io::write_text(file,
                     "DataRate=50\nDataType=Quaternion\nversion=3\nendheader\ntime\tpelvis_imu\ttibia_r_imu\n"
                     "1\t1,0,0,0\tnan,nan,nan,nan\n1.02\t0.6,0.8,0,0\t0,0,1,0\n1.04\t1,0,0,0\t1,0,0,0\n",
                     true));
  const auto facts = facts_of(file).value();
  EXPECT_EQ(facts["kind"], "orientations");
  EXPECT_EQ(facts["frames"], 3);
  EXPECT_NEAR(facts["rate_hz"].get<double>(), 50.0, 1e-6);
  EXPECT_EQ(facts["first_time_s"], 1.0);
  EXPECT_NEAR(facts["last_time_s"].get<double>(), 1.04, 1e-9);
  EXPECT_EQ(facts["missing"], 1);
  ASSERT_EQ(facts["sensors"].size(), 2U);
  EXPECT_EQ(facts["sensors"][0]["name"], "pelvis_imu");
  EXPECT_EQ(facts["sensors"][1]["missing"], 1);
  EXPECT_EQ(facts["sensors"][1]["first_w_x_y_z"], nlohmann::json::array({0.0, 0.0, 1.0, 0.0}));
  InfoJob job;
  job.file = file;
  EXPECT_THAT(info_text(run_info(job).value()), HasSubstr("pelvis_imu (1 0 0 0 first, 0 missing)"));
}

TEST(RunInfo, ChannelsAreNoMarkers) {
  const testing_support::ScratchFolder scratch;
  auto trial = testing::trial_with_channel();
  ASSERT_TRUE(io::write_markers(scratch / "t.c3d", trial, false));
  const auto facts = facts_of(scratch / "t.c3d").value();
  EXPECT_EQ(facts["points"], 2);
  EXPECT_EQ(facts["labels"], nlohmann::ordered_json({"LASI", "*12"}));
  EXPECT_EQ(facts["unlabelled"], nlohmann::ordered_json({"*12"}));
  EXPECT_EQ(facts["computed"], nlohmann::ordered_json::array());
  ASSERT_EQ(facts["channels"].size(), 1U);
  EXPECT_EQ(facts["channels"][0]["name"], "LKneeAngles");
  EXPECT_EQ(facts["channels"][0]["kind"], "angle");
  EXPECT_EQ(facts["channels"][0]["unit"], "deg");
  EXPECT_EQ(facts["channels"][0]["rate_hz"], 100.0);
  EXPECT_EQ(facts["channels"][0]["missing"], 0);
  auto named = trial;
  named.markers.names[1] = "LFEO";
  ASSERT_TRUE(io::write_markers(scratch / "named.c3d", named, false));
  EXPECT_EQ(facts_of(scratch / "named.c3d").value()["computed"], nlohmann::ordered_json({"LFEO"}));
  auto gap = trial;
  for (std::size_t i = 0; i < 3; ++i) gap.channels.values[i] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(io::write_markers(scratch / "gap.c3d", gap, false));
  EXPECT_EQ(facts_of(scratch / "gap.c3d").value()["channels"][0]["missing"], 1);
  InfoJob job;
  job.file = scratch / "t.c3d";
  EXPECT_THAT(info_text(run_info(job).value()), HasSubstr("channels          LKneeAngles (angle, deg)\n"));
}

TEST(RunInfo, AMarkerSetIsNamedWithWhatIsMissing) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  std::vector<std::string> names;
  for (const char* stem : {"ASI", "PSI", "THI", "KNE", "TIB", "ANK", "HEE", "TOE"})
    for (const char* side : {"Ann:l_", "Ann:r_"}) names.push_back(std::string(side) + stem);
  names.pop_back();
  trial.markers = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = 2});
  for (std::int64_t m = 0; m < trial.markers.markers(); ++m) {
    trial.markers.x(0, m) = Eigen::Vector3d(0.1 * static_cast<double>(m), 0.2, 1.0);
    trial.markers.state[trial.markers.index(0, m)] = data::SampleState::measured;
  }
  ASSERT_TRUE(io::write_markers(scratch / "set.csv", trial, false));
  InfoJob job;
  job.file = scratch / "set.csv";
  const auto named = run_info(job).value();
  const auto facts = info_json(named);
  EXPECT_EQ(facts["marker_set"]["name"], "Plug-in Gait");
  EXPECT_EQ(facts["marker_set"]["part"], "lower body");
  EXPECT_EQ(facts["marker_set"]["markers"], 16);
  EXPECT_EQ(facts["marker_set"]["missing"], nlohmann::ordered_json({"RTOE"}));
  EXPECT_EQ(facts["marker_set"]["said"], "Plug-in Gait, lower body: 15 of 16 markers, without RTOE");
  EXPECT_THAT(info_text(named),
              HasSubstr("marker_set        Plug-in Gait, lower body: 15 of 16 markers, without RTOE\n"));
  for (std::size_t m = 0; m < names.size(); ++m) trial.markers.names[m] = "M" + std::to_string(m);
  ASSERT_TRUE(io::write_markers(scratch / "none.csv", trial, false));
  job.file = scratch / "none.csv";
  const auto nameless = run_info(job).value();
  EXPECT_FALSE(info_json(nameless).contains("marker_set"));
  EXPECT_THAT(info_text(nameless), ::testing::Not(HasSubstr("marker_set")));
}

TEST(RunInfo, AnEmptyTableHasNoTimes) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "none.sto",
                             "none\nversion=1\nnRows=0\nnColumns=2\ninDegrees=no\nendheader\ntime\ta\n",
                             false));
  const auto facts = facts_of(scratch / "none.sto").value();
  EXPECT_EQ(facts["rows"], 0);
  EXPECT_TRUE(facts["first_time_s"].is_null());
  EXPECT_TRUE(facts["last_time_s"].is_null());
}

TEST(RunInfo, SaysWhatIsWrongWithAFile) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "a.v3d",
                             "\ts\ts\ts\n\tA\tA\tA\n\tTARGET\tTARGET\tTARGET\n\tp\tp\tp\n"
                             "ITEM\tX\tY\tZ\n1\t1\t2\t3\n",
                             false));
  EXPECT_TRUE(facts_of(scratch / "a.v3d").value()["rate_hz"].is_null()) << "the file tells none";
  EXPECT_EQ(facts_of(scratch / "a.v3d", 179.0).value()["rate_hz"], 179.0);
  EXPECT_EQ(facts_of(scratch / "absent.c3d").error().code, Code::io);
  ASSERT_TRUE(io::write_text(scratch / "broken.osim", "<OpenSimDocument", false));
  EXPECT_EQ(facts_of(scratch / "broken.osim").error().code, Code::bad_input);
  ASSERT_TRUE(io::write_text(scratch / "notes.docx", "hello", false));
  EXPECT_EQ(facts_of(scratch / "notes.docx").error().code, Code::not_supported);
}

TEST(InfoText, OneFactALineAndEveryWarning) {
  InfoOutcome outcome;
  outcome.file = "a.c3d";
  outcome.facts = MarkerFileFacts{.points = 3, .labels = {"A", "B"}};
  outcome.warnings = {"first oddity", "second oddity"};
  const auto text = info_text(outcome);
  EXPECT_THAT(text, HasSubstr("kind              markers\n"));
  EXPECT_THAT(text, HasSubstr("points            3\n"));
  EXPECT_THAT(text, HasSubstr("labels            A B\n"));
  EXPECT_THAT(text, HasSubstr("rate_hz           null\n")) << "not known";
  EXPECT_THAT(text, HasSubstr("warning           first oddity\nwarning           second oddity\n"));
}

TEST(InfoText, TheWorstThatIsContradictedInOneLine) {
  InfoOutcome outcome;
  outcome.file = "a.c3d";
  outcome.facts = MarkerFileFacts{.points = 3, .labels = {"A", "B"}};
  EXPECT_THAT(info_text(outcome), Not(HasSubstr("contradicted")));
  outcome.contradicted = {"the body is mirrored"};
  EXPECT_THAT(info_text(outcome), HasSubstr("contradicted      the body is mirrored\n"));
  EXPECT_THAT(info_text(outcome), Not(HasSubstr("more, which 'kinemark validate' says")));
  outcome.contradicted.insert(outcome.contradicted.end(), {"a plate is empty", "an event is missing"});
  EXPECT_THAT(info_text(outcome), HasSubstr("contradicted      the body is mirrored (and 2 more, which "
                                            "'kinemark validate' says)\n"));
  EXPECT_THAT(info_text(outcome), Not(HasSubstr("a plate is empty")));
  EXPECT_EQ(info_json(outcome)["contradicted"].size(), 3U);
}

TEST(InfoText, ManyNamesTakeSeveralLines) {
  InfoOutcome outcome;
  outcome.file = "a.c3d";
  MarkerFileFacts facts;
  for (int i = 0; i < 100; ++i) facts.labels.push_back("subject:marker" + std::to_string(i));
  facts.labels.emplace_back(5000, 'M');
  outcome.facts = facts;
  const auto text = info_text(outcome);
  std::size_t longest = 0, names = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    longest = std::max(longest, end - begin);
    begin = end + 1;
  }
  for (std::size_t at = text.find("subject:"); at != std::string::npos; at = text.find("subject:", at + 1))
    ++names;
  EXPECT_EQ(names, 100U);
  EXPECT_LT(longest, 400U);
  EXPECT_THAT(text, HasSubstr("labels            subject:marker0 subject:marker1 "));
  EXPECT_THAT(text, HasSubstr("\n                  subject:marker"));
}

TEST(RunInfo, TellsThatMarkersWereSmoothedAndNothingOfOthers) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 3});
  for (std::int64_t f = 0; f < 3; ++f) {
    trial.markers.x(f, 0) = Eigen::Vector3d(0.1, 0.2, 0.3);
    trial.markers.state[static_cast<std::size_t>(f)] = data::SampleState::measured;
  }
  ASSERT_TRUE(io::write_markers(scratch / "raw.c3d", trial, false));
  trial.markers.filters = {{.method = "kalman", .order = 5, .cutoff_hz = 6.4, .noise_sd_m = 2e-4}};
  ASSERT_TRUE(io::write_markers(scratch / "told.c3d", trial, false));
  trial.markers.unfiltered_in_world = trial.markers.x_in_world;
  ASSERT_TRUE(io::write_markers(scratch / "kept.c3d", trial, false));
  EXPECT_FALSE(facts_of(scratch / "raw.c3d").value().contains("filtered"));
  EXPECT_FALSE(facts_of(scratch / "raw.c3d").value().contains("calibration_error"));
  EXPECT_EQ(facts_of(scratch / "told.c3d").value()["filtered"],
            "1 marker was smoothed by kalman (order 5; -3 dB at 6.4 Hz; noise before it 0.2 mm); the samples "
            "from before are not there");
  const auto kept = facts_of(scratch / "kept.c3d").value();
  EXPECT_THAT(kept["filtered"].get<std::string>(), HasSubstr("the samples from before are kept"));
  EXPECT_EQ(kept["points"], 1) << "they are no markers";
  trial.calibration_error.fields = {data::CalibrationError::Field::Zero()};
  trial.calibration_error.fields[0](0, 1) = 2e-4;
  ASSERT_TRUE(io::write_markers(scratch / "rig.c3d", trial, false));
  EXPECT_EQ(facts_of(scratch / "rig.c3d").value()["calibration_error"],
            "the calibration leaves unknown 0.2 mm of positions, in common (RMS over samples)");
}

}  // namespace
}  // namespace kinemark::pipeline
