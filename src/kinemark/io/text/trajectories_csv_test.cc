// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/trajectories_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

data::Trial small() {
  data::Trial trial;
  trial.first_frame = 7;
  trial.markers =
      data::Trajectories::all_missing({"A", "B, \"left\""}, {.rate_hz = 4.0, .t0_s = 1.0, .frames = 2});
  trial.markers.x(0, 0) = Eigen::Vector3d(0.1, -2.0, 1.0 / 3.0);
  trial.markers.state[0] = data::SampleState::measured;
  trial.markers.x(1, 1) = Eigen::Vector3d(1.0, 2.0, 3.0);
  trial.markers.state[3] = data::SampleState::interpolated;
  trial.markers.set_method(1, 1, "cubic");
  trial.markers.state[2] = data::SampleState::rejected;
  return trial;
}

TEST(TrajectoriesCsv, OneLineForEveryMarkerAndFrame) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_trajectories_csv(scratch / "m.csv", small(), false));
  EXPECT_EQ(read_text(scratch / "m.csv").value(),
            "frame,time_s,marker,x_m,y_m,z_m,state,method\n"
            "7,1,A,0.1,-2,0.3333333333333333,measured,\n"
            "7,1,\"B, \"\"left\"\"\",,,,missing,\n"
            "8,1.25,A,,,,rejected,\n"
            "8,1.25,\"B, \"\"left\"\"\",1,2,3,interpolated,cubic\n");
}

TEST(TrajectoriesCsv, ComesBackWithStatesMethodsOffsetsAndCovariance) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  trial.markers.sample_offset_s = {0.0, 0.01, 1.0 / 3.0, -0.002};
  trial.markers.covariance.assign(24, std::nan(""));
  for (const std::size_t i : {0U, 3U})
    for (std::size_t k = 0; k < 6; ++k)
      trial.markers.covariance[6 * i + k] = 1e-6 * static_cast<double>(k + 1);
  ASSERT_TRUE(write_trajectories_csv(scratch / "m.csv", trial, false));
  const auto back = read_trajectories_csv(scratch / "m.csv");
  ASSERT_TRUE(back) << back.error().message;
  const auto& got = back->markers;
  const auto& wanted = trial.markers;
  EXPECT_EQ(got.names, wanted.names);
  EXPECT_EQ(got.time, wanted.time);
  EXPECT_EQ(got.state, wanted.state);
  EXPECT_EQ(got.x(0, 0), wanted.x(0, 0));
  EXPECT_EQ(got.x(1, 1), wanted.x(1, 1));
  EXPECT_EQ(got.made_by(1, 1), "cubic");
  EXPECT_EQ(got.made_by(0, 0), "");
  EXPECT_EQ(got.sample_offset_s, wanted.sample_offset_s);
  for (std::size_t i = 0; i < 24; ++i)
    if (std::isnan(wanted.covariance[i]))
      EXPECT_TRUE(std::isnan(got.covariance[i])) << i;
    else
      EXPECT_DOUBLE_EQ(got.covariance[i], wanted.covariance[i]) << i;
  EXPECT_EQ(back->first_frame, 7);
  EXPECT_EQ(back->format, "CSV");
  EXPECT_THAT(back->warnings, ElementsAre());
}

TEST(TrajectoriesCsv, AnyOrderOfColumnsAndLinesAndNoStates) {
  const auto trial = parse_trajectories_csv(
      "marker,z_m,y_m,x_m,time_s,frame,sd_x_m,sd_y_m,sd_z_m,colour\r\n"
      "B,3,2,1,0.5,12,0.1,0.2,0.3,red\r\n"
      "A,,,,0.4,11,,,,\r\n\r\n"
      "A, 6 ,5,4,0.2,9,1,1,1,blue\r\n",
      "a.csv");
  ASSERT_TRUE(trial) << trial.error().message;
  const auto& t = trial->markers;
  EXPECT_THAT(t.names, ElementsAre("B", "A"));
  EXPECT_EQ(trial->first_frame, 9);
  EXPECT_EQ(t.frames(), 4);
  EXPECT_NEAR(t.time.rate_hz, 10.0, 1e-9);
  EXPECT_EQ(t.x(3, 0), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(t.x(0, 1), Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(t.count_missing(), 6);
  EXPECT_DOUBLE_EQ(t.covariance[6 * t.index(3, 0) + 3], 0.04);
  EXPECT_EQ(t.covariance[6 * t.index(3, 0) + 1], 0.0);
  EXPECT_THAT(trial->warnings, ElementsAre(HasSubstr("column 'colour' is not known")));
}

TEST(TrajectoriesCsv, LabelsOfOtherPeopleAreUnderstood) {
  const std::string rows = "1,0,A,250,1,2\n1,0,B,NA,,\n2,10,A,251,1,2\n2,10,B,3,4,5\n";
  const auto trial =
      parse_trajectories_csv("Frame,Time (ms),Name,X (mm),Y (mm),Z (mm)\n" + rows, "t").value();
  EXPECT_THAT(trial.markers.names, ElementsAre("A", "B"));
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 2}));
  EXPECT_DOUBLE_EQ(trial.markers.x(1, 0).x(), 0.251);
  EXPECT_FALSE(trial.markers.present(0, 1));
  // Without frame numbers, marker after marker, and a unit that is given.
  const auto counted =
      parse_trajectories_csv(
          "t,bodypart,x,y,z,score\n0,A,1,2,3,1\n0.5,A,2,2,3,1\n0,B,1,1,1,1\n0.5,B,2,1,1,1\n", "t", "m")
          .value();
  EXPECT_EQ(counted.markers.time, (TimeBase{2.0, 0.0, 2}));
  EXPECT_EQ(counted.markers.x(1, 1), Eigen::Vector3d(2.0, 1.0, 1.0));
  EXPECT_THAT(counted.warnings, ElementsAre("columns that are not read: 'score'"));
  EXPECT_THAT(parse_trajectories_csv("t,bodypart,x,y,z\n0,A,1,2,3\n", "t").error().message,
              HasSubstr("no unit of length is stated; give it with --unit mm, cm or m"));
  EXPECT_THAT(parse_trajectories_csv("t,point,x (ell),y (ell),z (ell)\n0,A,1,2,3\n", "t").error().message,
              HasSubstr("length unit 'ell' is unknown"));
  const auto own = parse_trajectories_csv("frame,time_s,marker,x_m,y_m,z_m\n1,0,A,1,2,3\n", "t", "mm");
  EXPECT_EQ(own.error().code, Code::usage) << "ours are metres";
}

TEST(TrajectoriesCsv, TimeThatLiesIsRefused) {
  const auto with_times = [](const std::vector<std::pair<int, double>>& frames) {
    std::string text = "frame,time_s,marker,x_m,y_m,z_m\n";
    for (const auto& [frame, time_s] : frames)
      text += std::to_string(frame) + "," + std::to_string(time_s) + ",A,1,2,3\n";
    return parse_trajectories_csv(text, "a.csv");
  };
  EXPECT_THAT(with_times({{1, 0.2}, {2, 0.1}}).error().message,
              HasSubstr("a.csv: line 3 (frame 2): time goes back from 0.2 to 0.1 s"));
  EXPECT_THAT(with_times({{1, 0.2}, {2, 0.2}}).error().message,
              HasSubstr("line 3 (frame 2): time stands still"));
  EXPECT_THAT(with_times({{1, 0.0}, {2, 0.1}, {3, 0.2}, {2, 0.4}}).error().message,
              HasSubstr("line 5: frame 2 is at 0.4 s, in line 3 at 0.1 s"));
  EXPECT_THAT(with_times({{1, 0.0}, {2, 0.1}, {3, 0.2}, {4, 0.3}, {5, 0.95}, {6, 1.05}}).error().message,
              HasSubstr("line 6 (frame 5): time jumps from 0.3 to 0.95 s, 6.5 frame intervals"));
  // Frames that the numbers leave out, and frames that the times leave out, are missing alike.
  const auto by_number = with_times({{1, 0.0}, {2, 0.1}, {3, 0.2}, {7, 0.6}});
  const auto by_time = with_times({{1, 0.0}, {2, 0.1}, {3, 0.2}, {4, 0.6}});
  ASSERT_TRUE(by_number && by_time);
  EXPECT_TRUE(by_number->warnings.empty());
  EXPECT_THAT(by_time->warnings, ElementsAre(HasSubstr("1 hole, the first at line 5 (frame 4)")));
  for (const auto& trial : {*by_number, *by_time}) {
    EXPECT_EQ(trial.markers.frames(), 7);
    EXPECT_EQ(trial.markers.count_missing(), 3);
    EXPECT_TRUE(trial.markers.present(6, 0));
  }
}

TEST(TrajectoriesCsv, NamesMayBeInLatin1) {
  const auto trial = parse_trajectories_csv(
      "frame,time_s,marker,x_m,y_m,z_m,state,method\n1,0,Fu\xDF,1,2,3,interpolated,f\xFCr\n", "a.csv");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_THAT(trial->markers.names, ElementsAre("Fuß"));
  EXPECT_THAT(trial->markers.methods, ElementsAre("für"));
  EXPECT_FALSE(
      parse_trajectories_csv("frame,time_s,marker,x_m,y_m,z_m\n1,0,A\x01,1,2,3\n1,0,A\x02,1,2,3\n", "a"))
      << "two spellings of one name";
}

TEST(TrajectoriesCsv, ASingleFrameHasNoRate) {
  const auto trial =
      parse_trajectories_csv("frame,time_s,marker,x_m,y_m,z_m\n1,2.5,A,1,2,3\n", "a.csv").value();
  EXPECT_EQ(trial.markers.time, (TimeBase{.rate_hz = 1.0, .t0_s = 2.5, .frames = 1}));
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("does not determine a rate")));
}

TEST(TrajectoriesCsv, BadFilesGetOneSentenceWithTheLine) {
  const std::string header = "frame,time_s,marker,x_m,y_m,z_m,state\n";
  const auto message = [](const std::string& text) {
    const auto trial = parse_trajectories_csv(text, "a.csv");
    EXPECT_FALSE(trial);
    if (trial) return std::string("was read");
    EXPECT_EQ(trial.error().code, Code::bad_input);
    return trial.error().message;
  };
  EXPECT_THAT(message(""), HasSubstr("a.csv: is empty"));
  EXPECT_THAT(
      message("frame,time_s,x_m,y_m,z_m\n"),
      HasSubstr(
          "line 1: labels the columns frame, time_s, x_m, y_m, z_m; a table of one line a sample has frame, "
          "time_s, marker, x_m, y_m and z_m, of which 'marker' is absent: call the columns so"));
  EXPECT_THAT(
      message("time,acc_x,acc_y,acc_z\n"),
      HasSubstr("line 1: none of its 4 columns is a position of a marker. Need a time and columns such "
                "as"));
  EXPECT_THAT(message("frame,frame\n"), HasSubstr("line 1: column 'frame' occurs twice"));
  EXPECT_THAT(message(header), HasSubstr("has a header but no samples"));
  EXPECT_THAT(message(header + "1,0,A,1,2,3\n"), HasSubstr("line 2: has 6 cells; the header has 7"));
  EXPECT_THAT(message(header + "1,0,A,1,2,x,\n"), HasSubstr("line 2: z_m is 'x'; need a number"));
  EXPECT_THAT(message(header + "1,0,A,1,2,inf,\n"), HasSubstr("line 2: z_m is 'inf'"));
  EXPECT_THAT(message(header + ",0,A,1,2,3,\n"), HasSubstr("line 2: frame is ''"));
  EXPECT_THAT(message(header + "1.5,0,A,1,2,3,\n"), HasSubstr("line 2: frame 1.5 is not a whole number"));
  EXPECT_THAT(message(header + "1,0,,1,2,3,\n"), HasSubstr("line 2: names no marker"));
  EXPECT_THAT(message(header + "1,0,A,1,2,3,filled\n"), HasSubstr("line 2: 'filled' is not a state"));
  EXPECT_THAT(message(header + "1,0,A,1,,3,measured\n"), HasSubstr("line 2: is measured but has not three"));
  EXPECT_THAT(message(header + "1,0,\"A,1,2,3,\n"), HasSubstr("line 2: a quote is not closed"));
  EXPECT_THAT(message(header + "1,0,A,1,2,3,\n1,0,A,1,2,3,\n"), HasSubstr("'A' has two lines for frame 1"));
  EXPECT_THAT(message(header + "1,0,A,1,2,3,\n2,0,A,1,2,3,\n"),
              HasSubstr("line 3 (frame 2): time stands still at 0 s"));
  EXPECT_THAT(message(header + "1,0,A,1,2,3,\n900000000000,1,A,1,2,3,\n"), HasSubstr("but only 2 lines"));
}

TEST(TrajectoriesCsv, RefusesAnInvalidTrialAndAnExistingFile) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  trial.markers.names[1] = "A";
  EXPECT_EQ(write_trajectories_csv(scratch / "m.csv", trial, false).error().code, Code::bad_input);
  EXPECT_EQ(scratch.count_files(), 0);
  ASSERT_TRUE(write_trajectories_csv(scratch / "m.csv", small(), false));
  EXPECT_EQ(write_trajectories_csv(scratch / "m.csv", small(), false).error().code, Code::io);
  EXPECT_TRUE(write_trajectories_csv(scratch / "m.csv", small(), true));
  EXPECT_EQ(read_trajectories_csv(scratch / "absent.csv").error().code, Code::io);
}

TEST(TrajectoriesCsv, LongTrialsComeOutWhole) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 50'000});
  ASSERT_TRUE(write_trajectories_csv(scratch / "m.csv", trial, false));
  const std::string text = read_text(scratch / "m.csv").value();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 50'001);
  EXPECT_THAT(text, testing::EndsWith("\n50000,499.99,A,,,,missing,\n"));
  EXPECT_EQ(parse_trajectories_csv(text, "m.csv").value().markers.time, trial.markers.time);
}

TEST(TrajectoriesCsv, FiltersAndSamplesFromBeforeComeBack) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  auto& t = trial.markers;
  t.filters = {{.method = "kalman, gcv", .order = 5, .cutoff_hz = 1.0 / 3.0, .noise_sd_m = std::nan("")},
               {.method = "none", .order = 0, .cutoff_hz = std::nan(""), .noise_sd_m = std::nan("")}};
  t.unfiltered_in_world.assign(12, std::nan(""));
  for (std::size_t k = 0; k < 3; ++k) t.unfiltered_in_world[k] = 0.1 * static_cast<double>(k) + 1.0 / 7.0;
  ASSERT_TRUE(write_trajectories_csv(scratch / "m.csv", trial, false));
  EXPECT_THAT(read_text(scratch / "m.csv").value(),
              HasSubstr("method,filter,filter_order,filter_cutoff_hz,filter_noise_m,unfiltered_x_m,"));
  const auto back = read_trajectories_csv(scratch / "m.csv");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->warnings, ::testing::IsEmpty());
  ASSERT_EQ(back->markers.filters.size(), 2U);
  EXPECT_EQ(back->markers.filters[0].method, "kalman, gcv");
  EXPECT_EQ(back->markers.filters[0].order, 5);
  EXPECT_EQ(back->markers.filters[0].cutoff_hz, 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(back->markers.filters[0].noise_sd_m));
  EXPECT_EQ(back->markers.filters[1].method, "none");
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_THAT(back->markers.unfiltered_in_world[i],
                ::testing::NanSensitiveDoubleEq(t.unfiltered_in_world[i]));
}

TEST(TrajectoriesCsv, TheErrorOfTheCalibrationStandsInOneLine) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = small();
  trial.calibration_error.middle_in_world = {0.5, -0.25, 2.0};
  trial.calibration_error.fields = {data::CalibrationError::Field::Constant(1.25e-4)};
  ASSERT_TRUE(write_trajectories_csv(scratch / "m.csv", trial, false));
  const std::string text = read_text(scratch / "m.csv").value();
  EXPECT_THAT(text, HasSubstr("method,calibration_error\n"));
  EXPECT_EQ(text.find("0.000125"), text.find("0.000125", text.find('\n')));
  const auto back = read_trajectories_csv(scratch / "m.csv");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->calibration_error.fields, trial.calibration_error.fields);
  EXPECT_EQ(back->calibration_error.middle_in_world, trial.calibration_error.middle_in_world);
  const auto bad = parse_trajectories_csv(
      "frame,time_s,marker,x_m,y_m,z_m,calibration_error\n1,0,A,1,2,3,0 0 0 mm\n", "a.csv");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("line 2: calibration_error holds no fields of displacement"));
}

TEST(TrajectoriesCsv, AMarkerHasOneFilter) {
  const std::string header =
      "frame,time_s,marker,x_m,y_m,z_m,filter,filter_order,filter_cutoff_hz,filter_noise_m\n";
  const std::string first = header + "1,0,A,1,2,3,kalman,4,6,0.001\n";
  EXPECT_TRUE(parse_trajectories_csv(first + "2,0.01,A,1,2,3,kalman,4,6,0.001\n", "a.csv"));
  for (const char* other : {"gcv,4,6,0.001", "kalman,3,6,0.001", "kalman,4,7,0.001", "kalman,4,6,", ",,,"}) {
    const auto bad = parse_trajectories_csv(first + "2,0.01,A,1,2,3," + other + "\n", "a.csv");
    ASSERT_FALSE(bad) << other;
    EXPECT_THAT(bad.error().message,
                HasSubstr("line 3: marker 'A' has another filter than in its first line"));
  }
  EXPECT_FALSE(parse_trajectories_csv(header + "1,0,A,1,2,3,kalman,1e9,6,0.001\n", "a.csv"));
}

}  // namespace
}  // namespace kinemark::io
