// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Cost of a frame until it is acknowledged, and GB/s read; what came back is counted beside them.
#include <benchmark/benchmark.h>

#include <stdexcept>

#include "kinemark/core/random.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/recording/survey.h"
#include "support/scratch.h"

namespace {

using namespace kinemark;

/// Eight LEDs, two cameras, and a dark slot: 160 bytes of counts a frame.
data::Counts make_counts(std::int64_t frames) {
  data::Counts counts = data::Counts::zeros({"1", "2", "3", "4", "5", "6", "7", "8"}, {"A", "B"},
                                            {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames}, true);
  Random random(1, 0);
  for (auto& c : counts.counts) c = static_cast<std::int16_t>(random.uniform(0.0, 4096.0));
  return counts;
}

void push_frames(benchmark::State& state, io::SyncPolicy policy) {
  const testing_support::ScratchFolder scratch;
  const data::Counts counts = make_counts(1);
  auto writer = io::CountsWriter::create(scratch / "a.mcap", counts, {}, {.sync = policy});
  if (!writer) throw std::runtime_error(writer.error().message);
  io::CountsFrame frame{.counts = counts.counts, .flags = counts.flags, .dark = counts.dark};
  for (auto _ : state) {
    frame.time_s = 0.01 * static_cast<double>(frame.frame);
    if (!writer->push(frame)) state.SkipWithError("a frame was not acknowledged");
    ++frame.frame;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["acknowledged_of_pushed"] =
      static_cast<double>(writer->acknowledged()) / static_cast<double>(frame.frame);
}
void BM_PushSyncedNever(benchmark::State& state) { push_frames(state, io::SyncPolicy::never); }
void BM_PushSyncedInBackground(benchmark::State& state) { push_frames(state, io::SyncPolicy::background); }
void BM_PushSyncedAlways(benchmark::State& state) { push_frames(state, io::SyncPolicy::always); }
BENCHMARK(BM_PushSyncedNever)->UseRealTime();
BENCHMARK(BM_PushSyncedInBackground)->UseRealTime();
BENCHMARK(BM_PushSyncedAlways)->UseRealTime();

/// An hour at 100 Hz, written once.
class Hour {
 public:
  static constexpr std::int64_t kFrames = 360'000;
  Hour() : path_(scratch_ / "hour.mcap") {
    if (const auto s = io::write_counts(path_, make_counts(kFrames), {}, true); !s)
      throw std::runtime_error(s.error().message);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(std::filesystem::file_size(path_));
  }

 private:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_;
};

const Hour& hour() {
  static const Hour file;
  return file;
}

void BM_ReadCounts(benchmark::State& state) {
  const std::filesystem::path path = hour().path();
  std::int64_t frames = 0;
  for (auto _ : state) frames = io::read_counts(path)->counts.frames();
  state.SetBytesProcessed(hour().bytes() * state.iterations());
  state.counters["frames_of_written"] = static_cast<double>(frames) / Hour::kFrames;
}
BENCHMARK(BM_ReadCounts)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_Survey(benchmark::State& state) {
  const std::filesystem::path path = hour().path();
  std::int64_t messages = 0;
  for (auto _ : state) messages = io::survey_recording(path)->messages;
  state.SetBytesProcessed(hour().bytes() * state.iterations());
  state.counters["messages_of_written"] = static_cast<double>(messages) / Hour::kFrames;
}
BENCHMARK(BM_Survey)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_WriteCounts(benchmark::State& state) {
  const testing_support::ScratchFolder scratch;
  const data::Counts counts = make_counts(Hour::kFrames);
  for (auto _ : state)
    if (!io::write_counts(scratch / "a.mcap", counts, {}, true)) state.SkipWithError("was not written");
  state.SetBytesProcessed(static_cast<std::int64_t>(std::filesystem::file_size(scratch / "a.mcap")) *
                          state.iterations());
}
BENCHMARK(BM_WriteCounts)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
