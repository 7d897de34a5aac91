// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A rig of a few lines on a pseudo-terminal: answers like docs/formats/serial-rig.md says, sends what the
// test says.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "kinemark/stream/serial/testing/rig_bytes.h"

namespace kinemark::stream::testing {

class PtyRig {
 public:
  /// The line is `link`, a symbolic link to the pseudo-terminal.
  explicit PtyRig(std::filesystem::path link);
  PtyRig(const PtyRig&) = delete;
  PtyRig& operator=(const PtyRig&) = delete;
  ~PtyRig();

  [[nodiscard]] std::string path() const { return link_.string(); }
  /// Bytes to the host.
  void send(const Bytes& bytes);
  /// telling_frame() from `first` on, of the plan that was granted.
  void send_frames(std::uint32_t first, std::uint32_t count, std::uint32_t dropped = 0);
  /// Wait until a command that begins so was obeyed `times` times.
  void wait_for(const std::string& command, int times = 1);
  /// The plug is pulled; plug_in() makes a new line under the same link.
  void unplug();
  void plug_in();
  /// What it says when it is asked "?"; empty: it is silent.
  std::string facts =
      "rig name=pty version=0.1 protocol=1 leds=8 cameras=2 bits=10 clock=2000000 settle=40 conversion=128 "
      "off=60 longest=60000 period=2000000 hold=16 levels=255 dark=1 outputs=2 trigger=1 millivolts=5000";

 private:
  void listen();
  std::string obey(const std::string& line);
  std::filesystem::path link_;
  int master_ = -1, wake_[2] = {-1, -1};
  int slots_ = 1;
  std::mutex mutex_;
  std::condition_variable obeyed_;
  std::vector<std::string> commands_;
  std::thread thread_;
};

}  // namespace kinemark::stream::testing
