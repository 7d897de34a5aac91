// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/sim_rig.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "kinemark/pipeline/simulate/simulate_rig_job.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

using stream::Block;
using stream::ReadResult;
using testing::HasSubstr;

TEST(SimRig, GivesWhatSimulateRigRecords) {
  const testing_support::ScratchFolder scratch;
  SimulateRigJob job;
  job.folder = scratch / "rig";
  job.scene = RigSceneKind::sign;
  job.recording.rate_hz = 120.0;
  job.duration_s = 1.5;
  job.seed = 6;
  ASSERT_TRUE(run_simulate_rig(job));
  const auto recorded = io::read_counts(job.folder / "recording.mcap").value().counts;
  const auto device = open_device("sim:rig?scene=sign&rate=120&seconds=1.5&seed=6&fast").value();
  const auto granted = device->configure({}).value();
  EXPECT_EQ(granted.layout.rig_id, recorded.rig_id);
  EXPECT_EQ(granted.layout.leds, recorded.leds);
  ASSERT_TRUE(device->start());
  Block block;
  std::vector<std::int16_t> counts;
  while (device->read(block, std::chrono::milliseconds(1)).value() == ReadResult::block)
    counts.insert(counts.end(), block.counts.begin(), block.counts.end());
  EXPECT_TRUE(std::ranges::equal(counts, recorded.counts));
}

TEST(SimRig, HasEightLedsAndTwoCamerasUnlessAskedForOthers) {
  const auto all = open_device("sim:rig").value();
  EXPECT_EQ(all->capabilities().most_leds, 8);
  EXPECT_EQ(all->capabilities().cameras, 2);
  EXPECT_EQ(all->capabilities().speed, 1.0);
  EXPECT_NEAR(all->configure({}).value().plan.rate_hz, 138.27, 0.01);
  const auto one = open_device("sim:rig?scene=tree&leds=2&cameras=1&dark&speed=3").value();
  EXPECT_EQ(one->capabilities().most_leds, 2);
  EXPECT_EQ(one->capabilities().cameras, 1);
  EXPECT_TRUE(one->capabilities().has_dark_slot);
  EXPECT_EQ(one->capabilities().speed, 3.0);
  EXPECT_EQ(open_device("sim:rig?speed=fast").value()->capabilities().speed, 0.0);
}

TEST(SimRig, RefusesSettingsThatAreNone) {
  const auto said = [](const char* uri) {
    const auto device = open_device(uri);
    EXPECT_FALSE(device) << uri;
    return device ? "" : device.error().message;
  };
  EXPECT_THAT(said("sim:rig?scene=dance"),
              HasSubstr("there is no scene 'dance'; there are wheel, sign, tree"));
  EXPECT_THAT(said("sim:rig?scene=sign&leds=5"), HasSubstr("has 4 LEDs"));
  EXPECT_THAT(said("sim:rig?leds=9"), HasSubstr("from 1 to 8"));
  EXPECT_THAT(said("sim:rig?colour=red"), HasSubstr("'colour' is no setting"));
  EXPECT_THAT(said("sim:rig?speed=slow"), HasSubstr("speed must be a number"));
}

}  // namespace
}  // namespace kinemark::pipeline
