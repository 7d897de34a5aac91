// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/counts_reader.h"
#include "kinemark/pipeline/files/address_settings.h"
#include "kinemark/stream/clock.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// A recording of counts that is played again as a device: frame f comes (f + 1) / rate after start(), or
/// when it is asked for (`fast`). Numbers, and so what is missing, are those of the file. A file waits: what
/// is read late is late, not lost. Constant memory.
class ReplayDevice final : public stream::Device {
 public:
  /// "replay:FILE.mcap?rate=HZ&fast". With a rate, frames follow at that one, and all times of the layout are
  /// stretched with it. What follows the last '?' are settings, unless that file is there. Fails as
  /// io::CountsReader::open().
  [[nodiscard]] static Result<std::unique_ptr<stream::Device>> open(AddressSettings settings,
                                                                    std::shared_ptr<stream::HostClock> clock);
  [[nodiscard]] const stream::DeviceCapabilities& capabilities() const override { return capabilities_; }
  /// The plan must be that of the recording; names may be others.
  [[nodiscard]] Result<stream::GrantedPlan> configure(const stream::ScanPlan& plan) override;
  [[nodiscard]] Status start() override;
  [[nodiscard]] Result<stream::ReadResult> read(stream::Block& block,
                                                std::chrono::milliseconds timeout) override;
  [[nodiscard]] Status stop() override;
  [[nodiscard]] Status reopen() override;
  /// It has no outputs.
  [[nodiscard]] Status write_analog(int channel, double volts) override;
  [[nodiscard]] Status write_digital(int line, bool high) override;

 private:
  ReplayDevice(std::filesystem::path file, io::CountsReader reader, std::shared_ptr<stream::HostClock> clock);
  [[nodiscard]] std::int64_t due_ns(std::int64_t frame) const;
  [[nodiscard]] Status look_ahead();
  void take_frame(stream::Block& block);

  std::filesystem::path file_;
  io::CountsReader reader_;
  std::shared_ptr<stream::HostClock> clock_;
  stream::DeviceCapabilities capabilities_;
  data::Counts layout_;
  io::ReadCounts ahead_;  ///< the next frame
  bool has_ahead_ = false, running_ = false;
  std::int64_t start_ns_ = 0, expected_ = 0;
};

}  // namespace kinemark::pipeline
