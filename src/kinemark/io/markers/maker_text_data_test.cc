// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Real text exports of camera makers, against what is known of them and against the same trial in another
// format.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kinemark/io/markers/marker_file.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

TEST(MakerTextData, QualisysRecordingIsAsInventoried) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto trial = read_markers(data / "dfki-hand/recording.tsv");
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->format, "QTM TSV");
  EXPECT_EQ(trial->markers.time, (TimeBase{100.0, 0.0, 6000}));
  EXPECT_THAT(trial->markers.names, SizeIs(21));
  EXPECT_EQ(trial->markers.names[0], "hand_top");
  EXPECT_LT((trial->markers.x(0, 0) - Eigen::Vector3d(0.110406, 0.135075, 0.460584)).norm(), 1e-12);
  EXPECT_THAT(trial->warnings, Contains(HasSubstr("mixed or edited")));
}

// Vicon wrote the same trial as C3D and as text.
TEST(MakerTextData, ViconTextHoldsWhatItsC3dHolds) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto text = read_markers(data / "pycgm-rom/Sample_Static.csv");
  ASSERT_TRUE(text) << text.error().message;
  const auto c3d = read_markers(data / "pycgm-rom/Sample_Static.c3d");
  ASSERT_TRUE(c3d) << c3d.error().message;
  EXPECT_EQ(text->markers.time.rate_hz, c3d->markers.time.rate_hz);
  ASSERT_EQ(text->markers.frames(), c3d->markers.frames());
  int compared = 0;
  for (std::int64_t m = 0; m < c3d->markers.markers(); ++m) {
    std::string name = c3d->markers.names[static_cast<std::size_t>(m)];
    if (const auto colon = name.find(':'); colon != std::string::npos) name = name.substr(colon + 1);
    const auto other = text->markers.find(name);
    if (other < 0) continue;
    for (std::int64_t f = 0; f < text->markers.frames(); ++f) {
      if (!c3d->markers.present(f, m) || !text->markers.present(f, other)) continue;
      ASSERT_LT((c3d->markers.x(f, m) - text->markers.x(f, other)).norm(), 1e-6) << name << f;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30 * 275);
}

}  // namespace
}  // namespace kinemark::io
