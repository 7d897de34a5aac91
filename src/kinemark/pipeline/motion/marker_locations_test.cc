// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/marker_locations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/testing/shared_folder.h"
#include "kinemark/pipeline/testing/test_files.h"

namespace kinemark::pipeline {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class MarkerLocations : public testing::SharedFolder<MarkerLocations> {
 public:
  static void make_files() { testing::simulate_into(at("in")); }

 protected:
  static IkJob job(const std::string& output) {
    IkJob job;
    job.model = at("in/model.osim");
    job.markers = at("in/markers.c3d");
    job.output = at(output);
    return job;
  }
};

TEST_F(MarkerLocations, LieAsFarFromTheMeasuredMarkersAsTheErrorsSay) {
  auto asked = job("a.mot");
  asked.marker_locations = true;
  const auto outcome = run_ik(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_THAT(outcome->written, Contains(at("a_marker_locations.sto")));
  const auto& motion = outcome->result.motion;
  const auto locations = io::read_table(at("a_marker_locations.sto")).value();
  const auto measured = io::read_markers(at("in/markers.c3d")).value().markers;
  ASSERT_EQ(locations.rows(), motion.frames());
  int compared = 0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    EXPECT_NEAR(locations.time_s[static_cast<std::size_t>(f)], motion.time.time_s(f), 1e-9);
    for (std::size_t m = 0; m < motion.markers.size(); ++m) {
      const auto column = locations.find(motion.markers[m] + "_tx");
      ASSERT_GE(column, 0) << motion.markers[m];
      const Eigen::Vector3d place(locations(f, column), locations(f, column + 1), locations(f, column + 2));
      EXPECT_TRUE(place.allFinite()) << "a model marker has a place in every frame";
      const double* error =
          motion.marker_error.data() + 3 * (static_cast<std::size_t>(f) * motion.markers.size() + m);
      if (std::isnan(error[0])) continue;
      const auto recorded = measured.find(motion.markers[m]);
      EXPECT_NEAR((measured.x(f, recorded) - place).norm(), std::hypot(error[0], error[1], error[2]), 1e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 900);
}

TEST_F(MarkerLocations, AreWrittenWhenAskedForHereOrInASetup) {
  ASSERT_TRUE(run_ik(job("b.mot")));
  EXPECT_FALSE(std::filesystem::exists(at("b_marker_locations.sto")));
  std::string tasks;
  for (const char* marker : {"LASI", "RASI", "LPSI", "RPSI"})
    tasks += std::string("<IKMarkerTask name=\"") + marker +
             "\"><apply>true</apply><weight>1</weight></IKMarkerTask>";
  ASSERT_TRUE(io::write_text(at("setup.xml"),
                             "<OpenSimDocument Version=\"40500\"><InverseKinematicsTool name=\"t\">"
                             "<report_marker_locations>true</report_marker_locations><IKTaskSet><objects>" +
                                 tasks +
                                 "</objects></IKTaskSet>"
                                 "</InverseKinematicsTool></OpenSimDocument>",
                             true));
  auto asked = job("c.mot");
  asked.setup = at("setup.xml");
  const auto outcome = run_ik(asked);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_TRUE(std::filesystem::exists(at("c_marker_locations.sto")));
}

}  // namespace
}  // namespace kinemark::pipeline
