// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/recording/writer.h"
#include "kinemark/pipeline/acquire/recorder.h"
#include "kinemark/pipeline/acquire/trial_notes.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stream/device.h"

namespace kinemark::pipeline {

/// What a trial begins with.
struct TrialBegin {
  enum class Kind : std::uint8_t { at_once, key, digital, time, threshold };
  Kind kind = Kind::at_once;
  double value = 0.0;  ///< time: s from now; threshold: counts, sum of the four electrodes
  std::string led;     ///< threshold: whose; empty: the first
};
/// "key", "digital", "time=S", "threshold=COUNTS" or "threshold=LED:COUNTS".
[[nodiscard]] Result<TrialBegin> parse_begin(std::string_view text);

/// What `kinemark acquire` is asked to do.
struct AcquireJob : JobSettings {
  std::string source;             ///< address of a device, see open_device()
  std::filesystem::path output;   ///< .mcap
  std::filesystem::path session;  ///< folder whose next trial it is, in the place of an output; empty: none
  std::filesystem::path rig;      ///< of the session, see SessionAbout
  bool check_up = false;          ///< look at the device for 10 s, or duration_s, and keep nothing
  std::string leds;               ///< as parse_leds() takes them; empty: all that the device has
  double rate_hz = 0.0;           ///< 0: the highest
  double duration_s = 0.0;        ///< 0: until stopped, or the device ends
  std::int64_t frames = 0;        ///< likewise; lost ones count, the shorter length holds
  TrialBegin begin;               ///< what it begins with
  std::vector<std::pair<std::string, double>> intensity;  ///< by name; an empty name means all
  io::SyncPolicy sync = io::SyncPolicy::background;
  std::string subject, trial;                                ///< kept with the recording
  std::function<bool()> stop;                                ///< asked ten times a second; may be empty
  std::function<void(const std::string&)> say;               ///< what happens meanwhile; may be empty
  std::function<void(const RecorderProgress&)> each_second;  ///< may be empty
};

/// What is written before the first frame: source, device, start, rate, subject, trial, intensities.
[[nodiscard]] std::vector<io::RecordingMetadata> acquisition_metadata(
    const AcquireJob& job, const stream::GrantedPlan& plan, const stream::DeviceCapabilities& device);

/// A trial that is kept. A failure of disk or device after its first frame is in recorded.error: the file is
/// there. Gate: frames_missing.
struct AcquireOutcome : JobOutcome {
  stream::GrantedPlan plan;
  Recorded recorded;
  std::vector<TrialNote> notes;  ///< describe_trial(), or check_up()
};

/// Open the device, wait for what begins the trial, record it, check it. Code::device where the device cannot
/// be had, Code::cancelled where it was stopped before it began. The key is asked of `stop`-like polling by
/// the caller: see wait_for_key.
/// @param wait_for_key  returns true once the key was pressed, false where stop() came first
[[nodiscard]] Result<AcquireOutcome> run_acquire(const AcquireJob& job,
                                                 const std::function<bool()>& wait_for_key = {});

/// What the device would record by that job; it is not started. Fails as run_acquire().
[[nodiscard]] Result<stream::GrantedPlan> granted_plan(const AcquireJob& job);

/// "frames", "acknowledged", "dropped_by_device", "dropped_here": a line of progress.
[[nodiscard]] nlohmann::ordered_json progress_json(const RecorderProgress& progress);
/// "written", "ended", the progress, "rate_hz", "clock" (null where it is not known), "leds" (levels of each
/// LED at each camera), "notes", "wrong" (those of them where something is), "warnings", "error".
[[nodiscard]] nlohmann::ordered_json acquire_json(const AcquireOutcome& outcome);

}  // namespace kinemark::pipeline
