// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The library as a program for tests/acceptance/c3d_ezc3d.py:
//   write FILE MARKERS FRAMES CHANNELS [gapless]   a simulated C3D file, and FILE.x FILE.state FILE.residual
//   FILE.analog beside it read FILE REPEATS THREADS                      JSON: best time, memory, checksum of
//   the coordinates corpus FOLDER                                  small files of all kinds, to start a
//   fuzzer from
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "kinemark/io/plates/plate_forces.h"

namespace {

using namespace kinemark;
namespace fs = std::filesystem;

int report(const Status& status) {
  if (status) return 0;
  fmt::print(stderr, "{}\n", status.error().message);
  return exit_status(status.error().code);
}

template <class T>
void dump(const fs::path& path, const Array<T>& values) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
}

/// A simulated trial with everything a C3D file can hold.
data::Trial rich_trial(const io::internal::SimulatedTrial& options) {
  data::Trial trial = io::internal::simulate_trial(options);
  trial.events.push_back({.label = "Foot Strike", .context = "Left", .time_s = 0.05});
  trial.events.push_back({.label = "Foot Off", .context = "Right", .time_s = 65.5});
  if (options.channels >= 6) {
    trial.force_plates.push_back(
        {.type = 2,
         .corners_in_world = {Eigen::Vector3d{0.6, 0.4, 0.0}, Eigen::Vector3d{0.0, 0.4, 0.0},
                              Eigen::Vector3d{0.0, 0.0, 0.0}, Eigen::Vector3d{0.6, 0.0, 0.0}},
         .origin_in_plate = {0.001, -0.002, -0.04},
         .channel_idx = {0, 1, 2, 3, 4, 5}});
  }
  return trial;
}

int write(const fs::path& path, const io::internal::SimulatedTrial& options) {
  const data::Trial trial = rich_trial(options);
  dump(path.string() + ".x", trial.markers.x_in_world);
  dump(path.string() + ".state", trial.markers.state);
  dump(path.string() + ".residual", trial.residual_m);
  dump(path.string() + ".analog", trial.analog.values);
  return report(io::write_c3d(path, trial, {.force = true}));
}

/// Largest resident memory of this program so far. getrusage() would count what the parent process held.
long peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024L * std::stol(line.substr(6));
  return 0;
}

int read(const fs::path& path, int repeats, int threads) {
  const long before = peak_bytes();
  double best_s = HUGE_VAL;
  double first_s = 0.0;
  double sum_m = 0.0;
  long peak = 0;
  std::size_t decoded = 0;
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const auto trial = io::read_c3d(path, {.threads = threads});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!trial) return report(std::unexpected(trial.error()));
    best_s = std::min(best_s, seconds);
    if (i > 0) continue;
    first_s = seconds;
    peak = peak_bytes() - before;
    decoded = trial->markers.x_in_world.size() * sizeof(double) + trial->markers.state.size() +
              trial->residual_m.size() * sizeof(float) + trial->camera_mask.size() +
              trial->analog.values.size() * sizeof(double);
    for (const double v : trial->markers.x_in_world)
      if (!std::isnan(v)) sum_m += v;
  }
  fmt::print(
      "{{\"best_s\": {}, \"first_s\": {}, \"file_bytes\": {}, \"peak_bytes\": {}, \"decoded_bytes\": {}, "
      "\"sum_m\": {}}}\n",
      best_s, first_s, fs::file_size(path), peak, decoded, sum_m);
  return 0;
}

/// The complete plate data, for comparison: nothing subtracted, nothing left out.
int forces(const fs::path& path) {
  const auto trial = io::read_c3d(path);
  if (!trial) return report(std::unexpected(trial.error()));
  const auto read = io::plate_forces(*trial, {.contact_force_n = 0.0, .baseline = false});
  if (!read) return report(std::unexpected(read.error()));
  fmt::print("{{");
  for (const data::Wrench& wrench : read->wrenches.items)
    fmt::print("{}\"{}\": {{\"force\": [{:.9g}], \"moment\": [{:.9g}], \"point\": [{:.9g}]}}",
               &wrench == &read->wrenches.items.front() ? "" : ", ", wrench.name,
               fmt::join(wrench.force, ", "), fmt::join(wrench.moment, ", "), fmt::join(wrench.point, ", "));
  fmt::print("}}\n");
  return 0;
}

int corpus(const fs::path& folder) {
  fs::create_directories(folder);
  for (const io::Processor processor : {io::Processor::intel, io::Processor::dec, io::Processor::mips}) {
    for (const bool integers : {false, true}) {
      const fs::path path =
          folder / fmt::format("{}_{}.c3d", io::to_string(processor), integers ? "integer" : "float");
      const data::Trial trial =
          rich_trial({.markers = 3, .frames = 4, .channels = 6, .samples_per_frame = 2});
      if (const int status = report(
              io::write_c3d(path, trial, {.force = true, .processor = processor, .integers = integers}));
          status != 0)
        return status;
    }
  }
  return report(
      io::write_c3d(folder / "no_analog.c3d", rich_trial({.markers = 2, .frames = 2}), {.force = true}));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() >= 5 && arguments[0] == "write")
    return write(arguments[1], {.markers = std::stol(arguments[2]),
                                .frames = std::stol(arguments[3]),
                                .channels = std::stol(arguments[4]),
                                .gaps = arguments.size() < 6});
  if (arguments.size() == 4 && arguments[0] == "read")
    return read(arguments[1], std::stoi(arguments[2]), std::stoi(arguments[3]));
  if (arguments.size() == 2 && arguments[0] == "forces") return forces(arguments[1]);
  if (arguments.size() == 2 && arguments[0] == "corpus") return corpus(arguments[1]);
  fmt::print(stderr,
             "usage: write FILE MARKERS FRAMES CHANNELS [gapless] | read FILE REPEATS THREADS | forces FILE "
             "| corpus FOLDER\n");
  return 2;
}
