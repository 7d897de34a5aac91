// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/external_forces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Vector3d of_frame(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

TEST(ExternalForces, APlateAndATableByTheirNames) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto c3d = data / "opensim-core-formats/walking2.c3d";
  const auto plates = read_external_forces(c3d, {.rate_hz = 250.0, .t0_s = 2.0, .frames = 500}, 20.0).value();
  EXPECT_THAT(plates.files, ElementsAre(c3d));
  ASSERT_EQ(plates.wrenches.items.size(), 2u);
  double most = 0.0;
  for (std::int64_t f = 0; f < 500; ++f)
    most = std::max(most, of_frame(plates.wrenches.items[0].force, f).z());
  EXPECT_NEAR(most, 950.0, 10.0);
}

TEST(ExternalForces, APlateThatCannotBeReadIsSaid) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .frames = 4});
  trial.analog = {.rate_hz = 100.0, .samples = 4};
  for (const char* name : {"Fx", "Fy", "Fz", "Mx", "My", "Mz"}) {
    trial.analog.names.emplace_back(name);
    trial.analog.units.emplace_back(name[0] == 'F' ? "N" : "Nmm");
  }
  for (int i = 0; i < 4; ++i) trial.analog.values.insert(trial.analog.values.end(), {0, 0, -700, 0, 0, 0});
  data::ForcePlate plate{.number = 2, .type = 2, .channel_idx = {0, 1, 2, 3, 4, 5}};
  plate.corners_in_world = {Vector3d(0.5, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0.5, 0),
                            Vector3d(0.5, 0.5, 0)};
  trial.force_plates = {{.type = 6, .channel_idx = {0}}, plate};
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_markers(scratch / "p.c3d", trial, false));
  const auto read = read_external_forces(scratch / "p.c3d", trial.markers.time, 20.0);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->wrenches.items.size(), 1U);
  EXPECT_EQ(read->wrenches.items[0].name, "plate 2");
  EXPECT_THAT(read->warnings, ::testing::Contains(HasSubstr("force plate 1 is left out: its type or")));
  for (const auto& warning : read->warnings) EXPECT_THAT(warning, HasSubstr("plate "));
}

TEST(ExternalForces, OtherFilesAreRefusedInASentence) {
  const TimeBase time{.rate_hz = 100.0, .frames = 3};
  const auto trc = read_external_forces("grf.trc", time, 20.0);
  EXPECT_EQ(trc.error().code, Code::usage);
  EXPECT_THAT(trc.error().message,
              HasSubstr("grf.trc: forces are read from the plates of a .c3d or .mat file, from"));
  EXPECT_EQ(read_external_forces("none.mot", time, 20.0).error().code, Code::io);
  EXPECT_EQ(read_external_forces("none.mat", time, 20.0).error().code, Code::io);
  EXPECT_EQ(read_external_forces("none.c3d", time, 20.0).error().code, Code::io);
  EXPECT_EQ(read_external_forces("none.XML", time, 20.0).error().code, Code::io);
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(
      write_text(scratch / "loads.xml",
                 "<OpenSimDocument><ExternalLoads><objects><ExternalForce name=\"a\"><applied_to_body>foot"
                 "</applied_to_body><torque_identifier>t</torque_identifier></ExternalForce></objects>"
                 "<datafile>gone.mot</datafile></ExternalLoads></OpenSimDocument>",
                 false));
  const auto gone = read_external_forces(scratch / "loads.xml", time, 20.0);
  EXPECT_EQ(gone.error().code, Code::io);
  EXPECT_THAT(gone.error().message, HasSubstr("gone.mot"));
  EXPECT_THAT(gone.error().message, HasSubstr("(the <datafile> of "));
}

TEST(ExternalForces, OfDFlowByItsOwnClock) {
  const testing_support::ScratchFolder scratch;
  std::string text = "TimeStamp\tFP1.CopX\tFP1.CopY\tFP1.CopZ\tFP1.ForX\tFP1.ForY\tFP1.ForZ\n";
  for (int f = 0; f < 5; ++f)
    text += "1.0" + std::to_string(f) + "\t0.1\t0\t0.2\t0\t" + std::to_string(500 + 10 * f) + "\t0\n";
  ASSERT_TRUE(write_text(scratch / "f.txt", text, false));
  const auto read =
      read_external_forces(scratch / "f.txt", {.rate_hz = 200.0, .t0_s = 1.0, .frames = 12}, 20.0);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->wrenches.items.size(), 1U);
  EXPECT_NEAR(of_frame(read->wrenches.items[0].force, 3).y(), 515.0, 1e-9);
  EXPECT_TRUE(of_frame(read->wrenches.items[0].force, 11).hasNaN()) << "the file has ended";
  EXPECT_THAT(read->warnings, ElementsAre(HasSubstr("it writes no corners")));
  ASSERT_TRUE(write_text(scratch / "g.txt", "a\tb\n1\t2\n", false));
  EXPECT_THAT(read_external_forces(scratch / "g.txt", {.rate_hz = 100.0, .frames = 2}, 20.0).error().message,
              HasSubstr("labels no forces of D-Flow"));
}

}  // namespace
}  // namespace kinemark::io
