// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A device that a test plays, and recordings of it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/pipeline/acquire/recorder.h"
#include "kinemark/stream/device.h"
#include "support/scratch.h"

namespace kinemark::pipeline::testing {

/// A device that does what the test says; it has one LED and one camera.
class PlayedDevice final : public stream::Device {
 public:
  explicit PlayedDevice(double speed = 0.0) { capabilities_.speed = speed; }
  std::function<Result<stream::ReadResult>(PlayedDevice&, stream::Block&)> play;
  std::function<Status(PlayedDevice&)> come_back = [](PlayedDevice&) { return Status(); };
  std::int64_t next = 0;
  double rate_hz = 100.0;
  Status starts, ends;
  void pauses() { capabilities_.pauses = true; }

  [[nodiscard]] const stream::DeviceCapabilities& capabilities() const override { return capabilities_; }
  [[nodiscard]] Result<stream::GrantedPlan> configure(const stream::ScanPlan& plan) override {
    return stream::GrantedPlan{.plan = plan,
                               .layout = data::Counts::zeros({"hand"}, {"A"}, {.rate_hz = rate_hz}, false),
                               .facts = {}};
  }
  [[nodiscard]] Status start() override { return starts; }
  [[nodiscard]] Result<stream::ReadResult> read(stream::Block& block, std::chrono::milliseconds) override {
    return play(*this, block);
  }
  [[nodiscard]] Status stop() override { return ++stops, ends; }
  [[nodiscard]] Status reopen() override { return come_back(*this); }
  [[nodiscard]] Status write_analog(int, double) override { return {}; }
  [[nodiscard]] Status write_digital(int, bool) override { return {}; }
  int stops = 0;

  stream::ReadResult give(stream::Block& block, std::int64_t frames) {
    block.first_frame = next;
    block.frames = frames;
    block.counts.clear();
    for (; next < block.first_frame + frames; ++next)
      for (int k = 0; k < 4; ++k) block.counts.push_back(static_cast<std::int16_t>(next % 4000));
    block.flags.assign(static_cast<std::size_t>(frames), 0);
    block.host_after_ns = next * 10'000'000;
    return stream::ReadResult::block;
  }

 private:
  stream::DeviceCapabilities capabilities_{.name = "played", .most_leds = 1, .cameras = 1};
};

/// Records from a device into a file of its own, and reads what was kept.
class RecorderTest : public ::testing::Test {
 protected:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path file_ = scratch_ / "trial.mcap";

  Recorded record(stream::Device& device, RecorderOptions options = {}, const stream::ScanPlan& plan = {}) {
    if (options.file.empty()) options.file = file_;
    const auto granted = device.configure(plan).value();
    return Recorder::start(device, granted, std::move(options)).value()->finish();
  }
  static void expect_adds_up(const RecorderProgress& p) {
    EXPECT_EQ(p.frames, p.received + p.dropped_by_device);
    EXPECT_EQ(p.received, p.acknowledged + p.dropped_here);
  }
  static std::string value(const io::CountsRecording& read, const char* name, const char* key) {
    for (const auto& one : read.metadata)
      if (one.name == name) return one.values.at(key);
    return "absent";
  }
};

}  // namespace kinemark::pipeline::testing
