// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/desk/acquire_desk.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>

#include "kinemark/pipeline/acquire/acquire_job.h"
#include "kinemark/pipeline/acquire/open_device.h"
#include "kinemark/pipeline/acquire/recording_room.h"
#include "kinemark/pipeline/acquire/trial_notes.h"
#include "kinemark/pipeline/session/trial_name.h"
#include "kinemark/workflow/rig/alignment_guide.h"

namespace kinemark::pipeline {
namespace {

constexpr int kSeconds = 1;  // of frames that the live view shows

std::size_t size_of(std::int64_t n) { return static_cast<std::size_t>(n); }

}  // namespace

// Looks at frames on the recorder's thread for followers; the screens ask for what it saw.
class AcquireDesk::Watcher final : public BlockFollower {
 public:
  Watcher(const stream::GrantedPlan& plan, const TrialFiles& files)
      : observations_(size_of(plan.layout.led_count() * plan.layout.camera_count())),
        cameras_(size_of(plan.layout.camera_count())),
        monitor_(plan.layout, std::max(4, static_cast<int>(kSeconds * plan.plan.rate_hz))) {
    if (!files.wanted_rig) return;
    auto guide = workflow::AlignmentGuide::create(plan.layout, *files.wanted_rig, files.tree_sides_m);
    if (guide)
      guide_ = std::move(*guide);
    else
      no_guide_ = guide.error().message;
  }

  void take(const stream::Block& block) override {
    guide(block);
    const std::scoped_lock lock(mutex_);
    const std::size_t dark = block.dark.empty() ? 0 : 4 * cameras_;
    for (std::size_t f = 0; f < size_of(block.frames); ++f)
      monitor_.push(block.first_frame + static_cast<std::int64_t>(f),
                    std::span(block.counts).subspan(4 * observations_ * f, 4 * observations_),
                    std::span(block.flags).subspan(observations_ * f, observations_),
                    std::span(block.dark).subspan(dark * f, dark));
  }

  void restart_guide() {
    const std::scoped_lock lock(guide_mutex_);
    if (guide_) guide_->restart();
  }

  void tell(LiveView& view) const {
    view.guide = guide_sentence();
    const std::scoped_lock lock(mutex_);
    view.frames = monitor_.frames();
    for (std::size_t o = 0; o < observations_; ++o) {
      const int led = static_cast<int>(o / cameras_), camera = static_cast<int>(o % cameras_);
      view.seen.push_back(monitor_.seen(led, camera));
      view.spots.push_back(monitor_.spots(led, camera));
    }
  }

 private:
  // Under a lock of its own: a new pose takes a while, and the live numbers do not wait for it.
  void guide(const stream::Block& block) {
    const std::scoped_lock lock(guide_mutex_);
    if (!guide_) return;
    for (std::size_t f = 0; f < size_of(block.frames); ++f)
      guide_->push(std::span(block.counts).subspan(4 * observations_ * f, 4 * observations_),
                   std::span(block.flags).subspan(observations_ * f, observations_));
    const std::scoped_lock said(mutex_);
    sentence_ = guide_->sentence();
  }
  [[nodiscard]] std::string guide_sentence() const {
    const std::scoped_lock lock(mutex_);
    return guide_ ? sentence_ : no_guide_;
  }

  std::size_t observations_, cameras_;
  mutable std::mutex guide_mutex_, mutex_;  // the second is of monitor and sentence
  std::optional<workflow::AlignmentGuide> guide_;
  std::string sentence_, no_guide_;
  workflow::CountsMonitor monitor_;
};

AcquireDesk::AcquireDesk(TrialFiles files) : files_(std::move(files)) {}
AcquireDesk::~AcquireDesk() { close(); }

std::vector<stream::DeviceInfo> AcquireDesk::sources() { return enumerate_devices(); }

Result<stream::DeviceCapabilities> AcquireDesk::open(const std::string& uri) {
  close();
  auto device = open_device(uri, files_.seed);
  if (!device) {
    failure_ = device.error();
    return std::unexpected(device.error());
  }
  failure_.reset();
  uri_ = uri;
  device_ = std::move(*device);
  return device_->capabilities();
}

// A device that was away is looked for once.
Result<stream::GrantedPlan> AcquireDesk::configure(const stream::ScanPlan& plan) {
  auto granted = device_->configure(plan);
  if (granted || granted.error().code != Code::device || !device_->reopen()) return granted;
  (void)device_->stop();
  return device_->configure(plan);
}

Result<stream::GrantedPlan> AcquireDesk::run(const stream::ScanPlan& plan) {
  recorder_.reset();
  auto granted = configure(plan);
  if (!granted) {
    // What ran before goes on, where the device is there.
    if (watcher_)
      if (const auto again = start({}); !again) trouble_ = again.error().message;
    return std::unexpected(granted.error());
  }
  granted_ = std::move(*granted);
  if (const auto started = start({}); !started) return std::unexpected(started.error());
  return granted_;
}

// Whatever ran before has ended.
Status AcquireDesk::start(RecorderOptions options) {
  recorder_.reset();
  trouble_.clear();
  watcher_ = std::make_shared<Watcher>(granted_, files_);
  options.followers.push_back(watcher_);
  auto recorder = Recorder::start(*device_, granted_, std::move(options));
  if (!recorder) return std::unexpected(recorder.error());
  recorder_ = std::move(*recorder);
  return {};
}

LiveView AcquireDesk::live() {
  LiveView view;
  if (watcher_) watcher_->tell(view);
  view.trouble = trouble_;
  if (!recorder_) return view;
  const RecorderProgress progress = recorder_->progress();
  if (progress.away)
    view.trouble = uri_ + (recording_ ? ": the device does not answer; look at its plug. What came is kept"
                                      : ": the device does not answer; look at its plug");
  if (!recording_ && recorder_->wait_for(std::chrono::milliseconds(0)))
    view.trouble = uri_ + ": the device gives no more frames; start it again from the set-up";
  if (!recording_) return view;
  view.acknowledged = progress.acknowledged;
  view.dropped_by_device = progress.dropped_by_device;
  view.dropped_here = progress.dropped_here;
  view.recorded_s = static_cast<double>(progress.frames) / granted_.plan.rate_hz;
  view.ended = recorder_->wait_for(std::chrono::milliseconds(0));
  return view;
}

Status AcquireDesk::set_intensity(int led, double intensity) {
  stream::ScanPlan plan = granted_.plan;
  if (plan.intensity.empty()) plan.intensity.assign(plan.leds.size(), 1.0);
  plan.intensity[static_cast<std::size_t>(led)] = intensity;
  const auto granted = run(plan);
  return granted ? Status{} : std::unexpected(granted.error());
}

void AcquireDesk::restart_guide() {
  if (watcher_) watcher_->restart_guide();
}

std::filesystem::path AcquireDesk::folder() const {
  return files_.session ? files_.session->raw() : files_.folder;
}

std::string AcquireDesk::free_name(const std::string& trial) const { return free_trial(folder(), trial); }

std::vector<io::RecordingMetadata> AcquireDesk::about(const TrialName& name) const {
  AcquireJob job;
  job.source = uri_;
  job.subject = name.subject;
  job.trial = name.trial;
  return acquisition_metadata(job, granted_, device_->capabilities());
}

Status AcquireDesk::record(const TrialName& name) {
  std::error_code failed;
  std::filesystem::create_directories(folder(), failed);
  if (failed)
    return fail(Code::io, fmt::format("{}: cannot be made: {}", folder().string(), failed.message()));
  if (const auto named = check_trial_name(name.trial); !named) return named;
  if (files_.session)
    if (const auto same = files_.session->set_subject(name.subject); !same) return same;
  const auto file = trial_file(folder(), name.trial);
  if (const auto room = check_room(file, false, granted_, name.duration_s); !room) return room;
  trial_ = file;
  RecorderOptions options;
  options.file = trial_;
  options.recording = files_.recording;
  options.metadata = about(name);
  options.frames = std::llround(name.duration_s * granted_.plan.rate_hz);
  if (const auto started = start(std::move(options)); !started) {
    if (const auto again = start({}); !again) trouble_ = again.error().message;
    return started;
  }
  recording_ = true;
  return {};
}

Result<std::vector<TrialNote>> AcquireDesk::stop() {
  recorder_->stop();
  const Recorded recorded = recorder_->finish();
  recording_ = false;
  std::vector<TrialNote> lines;
  failure_ = recorded.error;
  if (recorded.error) lines.push_back({recorded.error->message, false});
  std::ranges::move(describe_trial(recorded, granted_.layout), std::back_inserter(lines));
  if (const auto again = start({}); !again) trouble_ = again.error().message;
  return lines;
}

Result<std::string> AcquireDesk::keep() {
  const auto file = std::exchange(trial_, {});
  if (files_.session && !file.empty())
    if (const auto added = files_.session->add(file); !added) trouble_ = added.error().message;
  return file.string();
}

Status AcquireDesk::discard() {
  std::error_code failed;
  std::filesystem::remove(trial_, failed);
  if (failed)
    return fail(Code::io, fmt::format("{}: cannot be removed: {}", trial_.string(), failed.message()));
  trial_.clear();
  return {};
}

void AcquireDesk::close() {
  if (recorder_) {
    recorder_->stop();
    (void)recorder_->finish();  // a trial that was recorded is closed and stays
  }
  recorder_.reset();
  watcher_.reset();
  device_.reset();
  recording_ = false;
  (void)keep();
}

}  // namespace kinemark::pipeline
