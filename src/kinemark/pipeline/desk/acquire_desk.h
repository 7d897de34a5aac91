// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The desk of the menus: real sources, a recorder, files.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/data/rig.h"
#include "kinemark/io/recording/writer.h"
#include "kinemark/pipeline/acquire/recorder.h"
#include "kinemark/pipeline/desk/desk.h"
#include "kinemark/pipeline/session/session.h"

namespace kinemark::pipeline {

/// Where trials go, and how.
struct TrialFiles {
  std::filesystem::path folder = ".";  ///< of the trials, named TRIAL.mcap; made when it is absent
  std::optional<Session> session;      ///< that trials are part of, in its raw/ then, not in the folder
  std::uint64_t seed = 1;              ///< of simulated sources
  /// That the cameras are to be aligned with, by the tree; nothing: there is no guide.
  std::optional<data::Rig> wanted_rig;
  std::vector<double> tree_sides_m = {0.533, 0.310, 0.310};  ///< LEDs 1-2, 1-3, 2-3
  io::RecordingOptions recording;  ///< forcing to the disk; a file that is there is never replaced
};

/// See Desk. A device runs all the time: into a file while a trial is recorded, for the live view otherwise.
class AcquireDesk final : public Desk {
 public:
  explicit AcquireDesk(TrialFiles files);
  ~AcquireDesk() override;
  [[nodiscard]] std::vector<stream::DeviceInfo> sources() override;
  [[nodiscard]] Result<stream::DeviceCapabilities> open(const std::string& uri) override;
  [[nodiscard]] Result<stream::GrantedPlan> run(const stream::ScanPlan& plan) override;
  [[nodiscard]] LiveView live() override;
  [[nodiscard]] Status set_intensity(int led, double intensity) override;
  void restart_guide() override;
  [[nodiscard]] std::string free_name(const std::string& trial) const override;
  /// Fails where the file is there, the session is of another subject, where the disk has room for less than
  /// the trial or a minute, and as Recorder::start().
  [[nodiscard]] Status record(const TrialName& name) override;
  [[nodiscard]] Result<std::vector<TrialNote>> stop() override;
  /// What a session could not take in is the trouble that is shown: the file stays.
  [[nodiscard]] Result<std::string> keep() override;
  [[nodiscard]] Status discard() override;
  void close() override;
  /// Of the last device that could not be opened, or of the disk or device that ended a trial; nothing: all
  /// went well.
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

 private:
  class Watcher;
  [[nodiscard]] Status start(RecorderOptions options);
  [[nodiscard]] std::filesystem::path folder() const;
  [[nodiscard]] Result<stream::GrantedPlan> configure(const stream::ScanPlan& plan);
  [[nodiscard]] std::vector<io::RecordingMetadata> about(const TrialName& name) const;

  TrialFiles files_;
  std::string uri_;
  std::unique_ptr<stream::Device> device_;
  stream::GrantedPlan granted_;
  std::shared_ptr<Watcher> watcher_;
  std::unique_ptr<Recorder> recorder_;  // after the device, which it uses
  std::filesystem::path trial_;         // that is recorded, or was and is not judged yet
  bool recording_ = false;
  std::string trouble_;
  std::optional<Error> failure_;
};

}  // namespace kinemark::pipeline
