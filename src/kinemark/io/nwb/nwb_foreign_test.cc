// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Files as other programs write them: without kinemark's table, with any path, unit, clock and number of
// coordinates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/nwb.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using internal::Handle;
using internal::Output;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kFrames = 4;

/// Writes NWB files by hand.
class ForeignFile {
 public:
  explicit ForeignFile(const std::filesystem::path& path) : out_(path.string(), "foreign") {
    out_.declare(out_.file(), "NWBFile");
    out_.group(out_.file(), "processing");
    out_.group(out_.file(), "acquisition");
  }
  ~ForeignFile() { EXPECT_TRUE(out_.close()); }
  ForeignFile(const ForeignFile&) = delete;
  ForeignFile& operator=(const ForeignFile&) = delete;

  Output& out() { return out_; }
  Handle group(const char* path, const char* type = "") { return out_.group(out_.file(), path, type); }

  /// Data of shape kFrames x width: frame f is f, f + 0.25, f + 0.5 plus `first`.
  Handle series(hid_t parent, const char* name, const char* unit, int width = 3, double first = 0.0,
                const char* type = "SpatialSeries") {
    Handle made = out_.group(parent, name, type);
    const Handle data = out_.samples(made.id(), "data", H5T_IEEE_F32LE, kFrames, width, 0.0, 1);
    std::vector<double> values;
    for (std::int64_t f = 0; f < kFrames; ++f)
      for (int k = 0; k < width; ++k) values.push_back(first + static_cast<double>(f) + 0.25 * k);
    out_.write(data, H5T_NATIVE_DOUBLE, 0, kFrames, width, values.data());
    if (*unit != '\0') out_.attribute(data.id(), "unit", unit);
    return made;
  }
  void even(const Handle& series, double rate_hz, double t0_s = 0.0) {
    const Handle start = out_.number(series.id(), "starting_time", t0_s);
    out_.attribute(start.id(), "rate", rate_hz, H5T_IEEE_F32LE);
  }
  void numbers(const Handle& series, const char* name, const std::vector<double>& values) {
    const Handle made =
        out_.samples(series.id(), name, H5T_IEEE_F64LE, static_cast<std::int64_t>(values.size()), 1, 0.0, 0);
    out_.write(made, H5T_NATIVE_DOUBLE, 0, static_cast<std::int64_t>(values.size()), 1, values.data());
  }

 private:
  internal::Quiet quiet_;
  Output out_;
};

TEST(ForeignNwb, PositionsInMillimetresOfAnyGroup) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle module = file.group("/processing/mocap", "ProcessingModule");
    const Handle position = file.out().group(module.id(), "Position", "Position");
    file.even(file.series(position.id(), "wrist", "mm", 3, 1000.0), 59.94, 2.0);
    file.even(file.series(position.id(), "elbow", "millimeters"), 59.94, 2.0);
  }
  const auto back = read_nwb(scratch / "a.nwb");
  ASSERT_TRUE(back) << back.error().message;
  const auto& t = back->trial.markers;
  EXPECT_THAT(t.names, ElementsAre("elbow", "wrist"));
  EXPECT_EQ(t.time.rate_hz, 59.94) << "stored in single precision, meant as the decimal";
  EXPECT_EQ(t.time.t0_s, 2.0);
  EXPECT_LT((t.x(3, 1) - Eigen::Vector3d(1.003, 1.00325, 1.0035)).norm(), 1e-15);
  EXPECT_EQ(t.count_missing(), 0);
  EXPECT_FALSE(back->derivatives);
  EXPECT_THAT(back->warnings, IsEmpty());
}

TEST(ForeignNwb, SeriesOfAnythingElseAreListed) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle module = file.group("/processing/mocap", "ProcessingModule");
    const Handle position = file.out().group(module.id(), "Position", "Position");
    file.even(file.series(position.id(), "wrist", "mm"), 100.0);
    const Handle many = file.out().group(module.id(), "Many", "BehavioralTimeSeries");
    file.even(file.series(many.id(), "speed", "m/s", 1, 0.0, "TimeSeries"), 100.0);
    file.even(file.series(file.group("/acquisition/emg").id(), "probe", "volts", 2, 0.0, "ElectricalSeries"),
              1000.0);
  }
  const auto back = read_nwb(scratch / "a.nwb");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->trial.unread, IsEmpty());
  ASSERT_EQ(back->trial.beside.objects.size(), 2U);
  const auto& probe = back->trial.beside.objects[0];
  EXPECT_EQ(probe.path, "/acquisition/emg/probe");
  EXPECT_EQ(probe.unit, "volts");
  EXPECT_EQ(probe.rate_hz, 1000.0);
  EXPECT_EQ(back->trial.beside.objects[1].path, "/processing/mocap/Many/speed");
  EXPECT_THAT(back->warnings, IsEmpty());
}

TEST(ForeignNwb, ConversionAndOffsetLeadToTheUnit) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle series = file.series(file.group("/acquisition/Position", "Position").id(), "nose", "cm");
    const Handle data(H5Dopen2(series.id(), "data", H5P_DEFAULT), H5Dclose);
    file.out().attribute(data.id(), "conversion", 0.5, H5T_IEEE_F32LE);
    file.out().attribute(data.id(), "offset", 3.0, H5T_IEEE_F32LE);
    file.even(series, 30.0);
  }
  const auto t = read_nwb(scratch / "a.nwb").value().trial.markers;
  EXPECT_LT((t.x(2, 0) - 0.01 * Eigen::Vector3d(4.0, 4.125, 4.25)).norm(), 1e-15);
}

TEST(ForeignNwb, TwoCoordinatesLieInAPlane) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    file.even(file.series(file.group("/acquisition/Position", "Position").id(), "mouse", "", 2), 30.0);
  }
  const auto back = read_nwb(scratch / "a.nwb").value();
  EXPECT_EQ(back.trial.markers.x(1, 0), Eigen::Vector3d(1.0, 1.25, 0.0)) << "metres where no unit is told";
  EXPECT_THAT(back.warnings, ElementsAre(HasSubstr("the third is set to 0")));
}

TEST(ForeignNwb, PosesWithConfidence) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle pose = file.group("/processing/pose", "PoseEstimation");
    const Handle paw = file.series(pose.id(), "paw", "meters", 3, 0.0, "PoseEstimationSeries");
    file.even(paw, 100.0);
    file.numbers(paw, "confidence", {0.9, 0.0, std::nan(""), 1.0});
  }
  const auto t = read_nwb(scratch / "a.nwb").value().trial.markers;
  EXPECT_TRUE(t.present(0, 0));
  EXPECT_FALSE(t.present(1, 0));
  EXPECT_FALSE(t.present(2, 0));
  EXPECT_TRUE(t.present(3, 0));
}

TEST(ForeignNwb, UnevenTimestampsAreKept) {
  const testing_support::ScratchFolder scratch;
  const std::vector<double> stamps{1.0, 1.12, 1.19, 1.3};
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle position = file.group("/acquisition/Position", "Position");
    for (const char* name : {"a", "b"})
      file.numbers(file.series(position.id(), name, "m"), "timestamps", stamps);
  }
  const auto back = read_nwb(scratch / "a.nwb").value();
  EXPECT_NEAR(back.trial.markers.time.rate_hz, 10.0, 1e-12);
  for (std::int64_t f = 0; f < kFrames; ++f)
    for (std::int64_t m = 0; m < 2; ++m)
      EXPECT_NEAR(back.trial.markers.time_s(f, m), stamps[static_cast<std::size_t>(f)], 1e-15);
  EXPECT_THAT(back.warnings, ElementsAre(HasSubstr("timestamps are uneven")));
}

TEST(ForeignNwb, EvenTimestampsAreAClock) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle series = file.series(file.group("/acquisition/Position", "Position").id(), "a", "m");
    file.numbers(series, "timestamps", {5.0, 5.5, 6.0, 6.5});
  }
  const auto back = read_nwb(scratch / "a.nwb").value();
  EXPECT_EQ(back.trial.markers.time, (TimeBase{.rate_hz = 2.0, .t0_s = 5.0, .frames = 4}));
  EXPECT_TRUE(back.trial.markers.sample_offset_s.empty());
  EXPECT_THAT(back.warnings, IsEmpty());
}

TEST(ForeignNwb, TheLargestGroupOnOneClockIsRead) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle small = file.group("/acquisition/Position", "Position");
    file.even(file.series(small.id(), "raw", "m"), 30.0);
    const Handle large = file.group("/processing/big", "Position");
    for (const char* name : {"a", "b"}) file.even(file.series(large.id(), name, "m"), 100.0);
    file.even(file.series(large.id(), "slow", "m"), 50.0);
    file.even(file.series(large.id(), "gaze", "degrees"), 100.0);
    file.series(large.id(), "timeless", "m");
    file.even(file.series(large.id(), "flat", "m", 1), 100.0);
  }
  const auto back = read_nwb(scratch / "a.nwb").value();
  EXPECT_THAT(back.trial.markers.names, ElementsAre("a", "b"));
  EXPECT_THAT(back.warnings,
              ElementsAre(HasSubstr("/processing/big/flat: data are not numbers"),
                          HasSubstr("/processing/big/gaze: is in 'degrees'"),
                          HasSubstr("/processing/big/timeless: has neither a starting_time nor 4 timestamps"),
                          HasSubstr("1 series do not share the clock"), HasSubstr("1 other series")));
}

TEST(ForeignNwb, ProcessedPositionsGoBeforeRawOnes) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "a.nwb");
    file.even(file.series(file.group("/acquisition/Position", "Position").id(), "raw", "m"), 30.0);
    file.even(file.series(file.group("/processing/Position", "Position").id(), "clean", "m"), 30.0);
  }
  EXPECT_THAT(read_nwb(scratch / "a.nwb").value().trial.markers.names, ElementsAre("clean"));
}

TEST(ForeignNwb, AFileWithoutUsablePositionsSaysWhy) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "empty.nwb");
  }
  {
    ForeignFile file(scratch / "pixels.nwb");
    const Handle pose = file.group("/processing/pose", "PoseEstimation");
    file.even(file.series(pose.id(), "paw", "", 2, 0.0, "PoseEstimationSeries"), 100.0);
  }
  {
    ForeignFile file(scratch / "back.nwb");
    const Handle series = file.series(file.group("/acquisition/Position", "Position").id(), "a", "m");
    file.numbers(series, "timestamps", {5.0, 5.5, 5.5, 6.5});
  }
  {
    ForeignFile file(scratch / "rate.nwb");
    file.even(file.series(file.group("/acquisition/Position", "Position").id(), "a", "m"), -1.0);
  }
  EXPECT_THAT(read_nwb(scratch / "empty.nwb").error().message, HasSubstr("empty.nwb: holds no positions"));
  const auto pixels = read_nwb(scratch / "pixels.nwb");
  EXPECT_EQ(pixels.error().code, Code::not_supported);
  EXPECT_THAT(pixels.error().message,
              HasSubstr("/processing/pose/paw: is in 'pixels', which is not a unit of length"));
  EXPECT_THAT(read_nwb(scratch / "back.nwb").error().message,
              HasSubstr("has a timestamp 5.5 after sample 2"));
  EXPECT_THAT(read_nwb(scratch / "rate.nwb").error().message, HasSubstr("runs at -1 Hz"));
}

TEST(ForeignNwb, LinksInCirclesAndToOtherFilesEnd) {
  const testing_support::ScratchFolder scratch;
  {
    ForeignFile file(scratch / "b.nwb");
    file.even(file.series(file.group("/processing/Position", "Position").id(), "other", "m"), 30.0);
  }
  {
    ForeignFile file(scratch / "a.nwb");
    const Handle loop = file.group("/processing/loop");
    H5Lcreate_hard(file.out().file(), "/processing", loop.id(), "again", H5P_DEFAULT, H5P_DEFAULT);
    file.out().soft_link(loop.id(), "root", "/");
    file.out().soft_link(loop.id(), "nowhere", "/nowhere");
    H5Lcreate_external((scratch / "b.nwb").c_str(), "/processing", loop.id(), "out", H5P_DEFAULT,
                       H5P_DEFAULT);
    file.out().soft_link(loop.id(), "round", "/processing/loop/out/Position");
  }
  EXPECT_THAT(read_nwb(scratch / "a.nwb").error().message, HasSubstr("holds no positions"));
}

}  // namespace
}  // namespace kinemark::io
