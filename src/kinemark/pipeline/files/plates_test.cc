// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/plates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/selection.h"
#include "support/test_data.h"

namespace kinemark::pipeline {
namespace {

data::Trial walk_over_three_plates(const std::filesystem::path& path) {
  auto input = read_marker_input({.path = path, .needs_samples = true});
  EXPECT_TRUE(input) << input.error().message;
  return std::move(input->trial);
}

TEST(PlatesOf, RecordingWithoutPlatesHasNone) {
  const data::Trial trial;
  EXPECT_FALSE(plates_of("walk.c3d", trial));
}

TEST(PlatesOf, OtherFilesThanC3dHaveNone) {
  data::Trial trial;
  trial.force_plates.emplace_back();
  EXPECT_FALSE(plates_of("walk.trc", trial));
}

TEST(PlatesOf, ForcesAreOnTheFramesThatAreTaken) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto path = data / "btk-others" / "PiG_Motion3_FF.c3d";
  auto trial = walk_over_three_plates(path);
  const auto whole = plates_of(path, trial);
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->items.size(), 3U);
  EXPECT_EQ(whole->frames(), 293);
  Selection part;
  part.first_time_s = 8.0;
  part.last_time_s = 8.5;
  ASSERT_TRUE(take_selection(part, trial));
  const auto cut = plates_of(path, trial);
  ASSERT_TRUE(cut);
  ASSERT_EQ(cut->frames(), trial.markers.frames());
  const auto skipped =
      static_cast<std::int64_t>(std::lround((trial.markers.time.t0_s - whole->time.t0_s) * 100.0));
  EXPECT_GT(skipped, 0);
  for (std::int64_t i = 0; i < 3 * cut->frames(); ++i)
    EXPECT_EQ(cut->items[0].force[static_cast<std::size_t>(i)],
              whole->items[0].force[static_cast<std::size_t>(3 * skipped + i)]);
}

}  // namespace
}  // namespace kinemark::pipeline
