// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// GB/s of file read from the page cache, the memory it takes, and a checksum of what was read beside them.
#include <benchmark/benchmark.h>

#include <cmath>

#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "support/scratch.h"

namespace {

using namespace kinemark;

/// A file written once and shared by all benchmarks that want the same one.
class File {
 public:
  File(std::int64_t markers, std::int64_t frames, std::int64_t channels, const io::C3dWriteOptions& options)
      : path_(scratch_ / "large.c3d") {
    const data::Trial trial =
        io::internal::simulate_trial({.markers = markers, .frames = frames, .channels = channels});
    for (std::size_t i = 0; i < trial.markers.x_in_world.size(); ++i)
      if (trial.markers.state[i / 3] != data::SampleState::missing)
        checksum_m_ += trial.markers.x_in_world[i];
    if (const auto status = io::write_c3d(path_, trial, options); !status)
      throw std::runtime_error(status.error().message);
    bytes_ = static_cast<double>(std::filesystem::file_size(path_));
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] double bytes() const { return bytes_; }
  [[nodiscard]] double checksum_m() const { return checksum_m_; }

 private:
  testing_support::ScratchFolder scratch_;
  std::filesystem::path path_;
  double bytes_ = 0.0;
  double checksum_m_ = 0.0;
};

double checksum_m(const data::Trial& trial) {
  double sum = 0.0;
  for (const double v : trial.markers.x_in_world)
    if (!std::isnan(v)) sum += v;
  return sum;
}

void read_whole(benchmark::State& state, const File& file) {
  double read_m = 0.0;
  for (auto _ : state) {
    const auto trial = io::read_c3d(file.path(), {.threads = static_cast<int>(state.range(0))});
    state.PauseTiming();
    read_m = checksum_m(*trial);
    state.ResumeTiming();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(file.bytes()) * state.iterations());
  state.counters["relative_error"] = (read_m - file.checksum_m()) / file.checksum_m();
}

void BM_ReadFloat_60marker_200kframe(benchmark::State& state) {
  static const File file(60, 200000, 0, {});
  read_whole(state, file);
}
BENCHMARK(BM_ReadFloat_60marker_200kframe)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_ReadFloat_60marker_16channel(benchmark::State& state) {
  static const File file(60, 50000, 16, {});
  read_whole(state, file);
}
BENCHMARK(BM_ReadFloat_60marker_16channel)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_ReadDecFloat(benchmark::State& state) {
  static const File file(60, 50000, 0, {.processor = io::Processor::dec});
  read_whole(state, file);
}
BENCHMARK(BM_ReadDecFloat)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_ReadIntelInteger(benchmark::State& state) {
  static const File file(60, 50000, 0, {.integers = true});
  read_whole(state, file);
}
BENCHMARK(BM_ReadIntelInteger)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Frames through the caller's own arrays: what a program needs that never holds the whole recording.
void BM_Stream_60marker_200kframe(benchmark::State& state) {
  static const File file(60, 200000, 0, {});
  const auto reader = io::C3dReader::open(file.path());
  constexpr std::int64_t kPiece = 1000;
  Array<double> x(kPiece * 60 * 3);
  Array<data::SampleState> states(kPiece * 60);
  for (auto _ : state)
    for (std::int64_t f = 0; f < 200000; f += kPiece)
      benchmark::DoNotOptimize(reader->read(f, kPiece, {.x_in_world = x, .state = states}));
  state.SetBytesProcessed(static_cast<std::int64_t>(file.bytes()) * state.iterations());
}
BENCHMARK(BM_Stream_60marker_200kframe)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
