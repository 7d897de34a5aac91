// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Streams that a recorder interpolated: found with factor and phase, no false alarms, limits reported.
// Arguments: number of single-marker streams (default 2000), "no-recordings" to leave the real files out.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "acceptance/upsampled_streams.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/trajectory/screening/real_samples.h"
#include "kinemark/stages/trajectory/screening/upsampling.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using namespace kinemark::acceptance;
using data::BandVerdict;
using data::InterpolationKernel;
using testing_support::print_row;

constexpr std::array kKernels{InterpolationKernel::hold,     InterpolationKernel::linear,
                              InterpolationKernel::spline,   InterpolationKernel::catmull_rom,
                              InterpolationKernel::lagrange, InterpolationKernel::pchip,
                              InterpolationKernel::akima};
constexpr double kLowRate = 60.0;
constexpr std::uint64_t kSeed = 20261121;

int pick(Random& random, int count) {
  return std::min(count - 1, static_cast<int>(random.uniform(0.0, static_cast<double>(count))));
}

struct Truth {
  int factor = 1, phase = 0;
  InterpolationKernel kernel = InterpolationKernel::none;
  double noise_mm = 0.0;
  std::string what;
};

Stream sampled(const Path& path, std::int64_t count, double rate_hz) {
  Stream s;
  for (std::int64_t i = 0; i < count; ++i) s.push_back(path(static_cast<double>(i) / rate_hz));
  return s;
}

double random_noise_mm(Random& random) { return 0.02 * std::exp(random.uniform() * std::log(50.0)); }

/// One stream as a recorder that interpolates would give it.
Stream positive(Random& random, const MotionLibrary& library, double duration_s, Truth& truth) {
  const Path path = random_path(random, library, duration_s);
  Stream low = sampled(path, static_cast<std::int64_t>(duration_s * kLowRate), kLowRate);
  add_noise(low, truth.noise_mm, random);
  Stream s = interpolate(low, truth.factor, truth.kernel, random.uniform() < 0.5);
  const int cut = (truth.factor - truth.phase) % truth.factor;
  s.erase(s.begin(), s.begin() + cut);
  return s;
}

/// One stream that was not interpolated, at 60 to 360 Hz.
Stream negative(Random& random, const MotionLibrary& library, double duration_s, double rate_hz,
                Truth& truth) {
  const Path path = random_path(random, library, duration_s);
  Stream s = sampled(path, static_cast<std::int64_t>(duration_s * rate_hz), rate_hz);
  const int kind = pick(random, 7);
  truth.what = std::array{"white",    "white",        "low-pass 6 Hz",       "low-pass 12 Hz",
                          "coloured", "0.1 mm steps", "gaps filled by lines"}[static_cast<std::size_t>(kind)];
  if (kind == 4)
    add_coloured_noise(s, truth.noise_mm, random);
  else
    add_noise(s, truth.noise_mm, random);
  if (kind == 2 || kind == 3) low_pass(s, kind == 2 ? 6.0 : 12.0, rate_hz);
  if (kind == 5) round_to(s, 0.1);
  if (kind == 6) {
    const auto n = static_cast<int>(s.size());
    for (int gap = 0; gap < 4; ++gap) {
      const auto length = static_cast<int>(random.uniform(0.1, 0.6) * rate_hz);
      const int first = 8 + pick(random, n - length - 16);
      for (int i = 0; i < length; ++i)
        s[static_cast<std::size_t>(first + i)] =
            s[static_cast<std::size_t>(first - 1)] +
            (s[static_cast<std::size_t>(first + length)] - s[static_cast<std::size_t>(first - 1)]) *
                (i + 1.0) / (length + 1.0);
    }
  }
  return s;
}

void check_streams(int count, const MotionLibrary& library) {
  int right = 0;
  int false_alarms = 0;
  std::array<int, 7> total{};
  std::array<int, 7> good{};
  std::string wrong;
  for (int i = 0; i < count; ++i) {
    Random random(kSeed, static_cast<std::uint64_t>(i));
    Truth truth;
    const double duration_s = std::array{3.0, 5.0, 10.0}[static_cast<std::size_t>(pick(random, 3))];
    truth.noise_mm = random_noise_mm(random);
    const bool fine_steps = random.uniform() < 0.5;
    Stream s;
    if (i % 2 == 0) {
      truth.factor = 2 + pick(random, 5);
      truth.phase = pick(random, truth.factor);
      truth.kernel = kKernels[static_cast<std::size_t>(pick(random, 7))];
      truth.what = to_string(truth.kernel);
      s = positive(random, library, duration_s, truth);
    } else {
      s = negative(random, library, duration_s, kLowRate * (1 + pick(random, 6)), truth);
    }
    round_to(s, fine_steps && truth.what != "0.1 mm steps" ? 0.01 : 0.0);
    const auto found =
        trajectory::detect_upsampling(recording({s}, kLowRate * truth.factor)).value().markers.front();
    const bool ok = found.factor == truth.factor && found.phase == truth.phase;
    right += ok ? 1 : 0;
    false_alarms += truth.factor == 1 && found.factor > 1 ? 1 : 0;
    ++total[static_cast<std::size_t>(truth.factor)];
    good[static_cast<std::size_t>(truth.factor)] += ok ? 1 : 0;
    if (!ok)
      wrong += fmt::format(
          "; stream {} {} x{} phase {} noise {:.3f} mm{} called x{} phase {} (ratio {:.2f}, {} blocks)", i,
          truth.what, truth.factor, truth.phase, truth.noise_mm, fine_steps ? " 0.01 mm steps" : "",
          found.factor, found.phase, found.ratio, found.blocks);
  }
  std::string per_factor;
  for (std::size_t f = 1; f < 7; ++f) per_factor += fmt::format(" x{} {}/{}", f, good[f], total[f]);
  print_row(right >= 0.998 * count, fmt::format("{} simulated streams, factors 1-6, seven kernels", count),
            "factor and phase right in >= 99.8 %",
            fmt::format("{:.2f} %:{}{}", 100.0 * right / count, per_factor, wrong));
  print_row(false_alarms == 0, "simulated negatives", "no false alarm",
            fmt::format("{} in {}", false_alarms, total[1]));
}

/// Whole recordings of 16 markers, a third of them at rest, as of the macaque arm: 60 to 240 Hz.
void check_recordings(int count, const MotionLibrary& library) {
  int right = 0;
  int markers_wrong = 0;
  int exact = 0;
  for (int i = 0; i < count; ++i) {
    Random random(kSeed + 1, static_cast<std::uint64_t>(i));
    Truth truth{.factor = 4,
                .phase = pick(random, 4),
                .kernel = i % 2 == 0 ? InterpolationKernel::linear : InterpolationKernel::spline};
    std::vector<Stream> streams;
    for (int m = 0; m < 16; ++m) {
      truth.noise_mm = random_noise_mm(random);
      streams.push_back(positive(random, library, 5.0, truth));
      round_to(streams.back(), 0.01);
    }
    const data::Trajectories t = recording(streams, 240.0);
    const auto report = trajectory::detect_upsampling(t).value();
    right += report.recording.factor == 4 && report.recording.phase == truth.phase ? 1 : 0;
    for (const auto& u : report.markers)
      markers_wrong += u.factor != 4 || u.phase != truth.phase || u.runs.size() != 1 ? 1 : 0;
    const auto low = trajectory::keep_real_samples(t, report, trajectory::MadeSamples::decimate).value();
    bool same = low.time.rate_hz == 60.0;
    for (std::int64_t k = 0; k < low.frames(); ++k)
      for (std::int64_t m = 0; m < 16; ++m)
        same &= low.x(k, m) == t.x(4 * k + truth.phase, m) &&
                std::abs(low.time_s(k, m) - t.time.time_s(4 * k + truth.phase)) < 1e-12;
    exact += same ? 1 : 0;
  }
  print_row(
      right == count && markers_wrong == 0 && exact == count,
      fmt::format("{} recordings of 16 markers, 60 to 240 Hz", count),
      "recording and all markers right; the real samples kept unchanged at their times",
      fmt::format("{} recordings right, {} markers wrong, {} kept exactly", right, markers_wrong, exact));
}

/// Real instants that wander against the recorder's clock, and clocks that lose frames.
void check_jitter(int count, const MotionLibrary& library) {
  for (const double jitter : {0.1, 0.2, 0.3}) {
    int right = 0;
    for (int i = 0; i < count; ++i) {
      Random random(kSeed + 2, static_cast<std::uint64_t>(i));
      const int factor = i % 2 == 0 ? 4 : 2;
      const double noise_mm = 0.05 + random.uniform() * 0.45;
      const Path path = random_path(random, library, 5.0);
      Stream low = sampled(path, 300, kLowRate);
      add_noise(low, noise_mm, random);
      std::vector<double> at;
      for (std::size_t k = 0; k < low.size(); ++k)
        at.push_back(static_cast<double>(k) * factor + std::clamp(jitter * random.gaussian(), -0.9, 0.9));
      Stream s;
      std::size_t k = 0;
      for (int n = 1; n + factor < static_cast<int>(low.size()) * factor - 1; ++n) {
        while (at[k + 1] <= n) ++k;
        s.push_back(low[k] + (low[k + 1] - low[k]) * (n - at[k]) / (at[k + 1] - at[k]));
      }
      round_to(s, 0.01);
      const auto u = trajectory::detect_upsampling(recording({s}, kLowRate * factor)).value().markers.front();
      right += u.factor == factor && u.phase == factor - 1 ? 1 : 0;
    }
    print_row(
        right >= (jitter < 0.25 ? 0.95 : 0.5) * count,
        fmt::format("{} linear streams whose real instants wander by {:.1f} frames (SD)", count, jitter),
        jitter < 0.25 ? "right in >= 95 %" : "right in >= 50 %", fmt::format("{}", right));
  }
  int right = 0;
  std::int64_t farthest = 0;
  for (int i = 0; i < count; ++i) {
    Random random(kSeed + 3, static_cast<std::uint64_t>(i));
    Truth truth{.factor = 4, .phase = 0, .kernel = kKernels[static_cast<std::size_t>(i % 7)]};
    truth.noise_mm = random_noise_mm(random) + 0.05;
    Stream s = positive(random, library, 10.0, truth);
    round_to(s, 0.0);
    const auto lost = static_cast<std::int64_t>(random.uniform(0.3, 0.7) * static_cast<double>(s.size()));
    s.erase(s.begin() + lost);
    const auto u = trajectory::detect_upsampling(recording({s}, 240.0)).value().markers.front();
    if (u.factor != 4 || u.runs.size() != 2 || u.runs[0].phase != 0 || u.runs[1].phase != 3) continue;
    const std::int64_t off = std::abs(u.runs[1].first_frame - lost);
    farthest = std::max(farthest, off);
    right += off <= 8 ? 1 : 0;
  }
  print_row(right >= 0.95 * count, fmt::format("{} streams that lose one frame", count),
            "both phases right, the change found within two real samples in >= 95 %",
            fmt::format("{}, farthest {} frames off", right, farthest));
}

/// What cannot be detected must not be reported as something else, and the spectrum must show it.
void check_limits(int count, const MotionLibrary& library) {
  struct Limit {
    const char* what;
    bool sinc;
    double cutoff_hz;
  };
  for (const Limit& limit : {Limit{"linear or spline, then a 10 Hz low-pass", false, 10.0},
                             Limit{"band-limited resampling", true, 0.0}}) {
    int called = 0;
    int reported = 0;
    for (int i = 0; i < count; ++i) {
      Random random(kSeed + 4, static_cast<std::uint64_t>(i));
      const int factor = i % 4 < 2 ? 4 : 2;
      const Path path = random_path(random, library, 5.0);
      Stream low = sampled(path, 300, kLowRate);
      add_noise(low, 0.2, random);
      Stream s =
          limit.sinc
              ? resample(low, factor)
              : interpolate(low, factor,
                            i % 2 == 0 ? InterpolationKernel::linear : InterpolationKernel::spline, false);
      if (limit.cutoff_hz > 0.0) low_pass(s, limit.cutoff_hz, kLowRate * factor);
      round_to(s, i % 3 == 0 ? 0.01 : 0.0);
      const auto report = trajectory::detect_upsampling(recording({s}, kLowRate * factor)).value();
      called += report.markers.front().found() ? 1 : 0;
      reported += report.band.verdict == BandVerdict::low_passed ? 1 : 0;
    }
    const bool quiet = limit.sinc || called == 0;
    print_row(quiet && reported >= 0.95 * count, fmt::format("limit: {}, {} streams", limit.what, count),
              limit.sinc ? "spectrum says low-passed in >= 95 %"
                         : "spectrum says low-passed in >= 95 %, none called interpolated",
              fmt::format("low-passed {}, called interpolated {}", reported, called));
  }
}

void check_real(const std::filesystem::path& folder) {
  int files = 0;
  std::int64_t streams = 0;
  std::string called;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    std::string ending = entry.path().extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".c3d" || ending == ".trc") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  for (const auto& path : paths) {
    const auto trial = io::read_markers(path);
    if (!trial || trial->markers.frames() < 60 || trial->markers.markers() == 0) continue;
    const auto report = trajectory::detect_upsampling(trial->markers).value();
    ++files;
    for (std::size_t m = 0; m < report.markers.size(); ++m) {
      streams += report.markers[m].blocks > 0 ? 1 : 0;
      if (report.markers[m].found() && !report.markers[m].inherited)
        called += fmt::format("; {} {} x{} {} ratio {:.2f} blocks {}", path.filename().string(),
                              trial->markers.names[m], report.markers[m].factor,
                              to_string(report.markers[m].kernel), report.markers[m].ratio,
                              report.markers[m].blocks);
    }
    if (report.recording.found()) called += fmt::format("; {} as a whole", path.filename().string());
    if (std::getenv("KINEMARK_SHOW_BANDS") != nullptr)
      fmt::print("  {} {} top {:.4f} middle {:.4f} mm edge {:.1f} Hz\n", path.filename().string(),
                 to_string(report.band.verdict), 1e3 * report.band.top_m, 1e3 * report.band.middle_m,
                 report.band.edge_hz);
  }
  print_row(called.empty() && streams > 1000, fmt::format("real recordings, {} files", files),
            "no false alarm",
            fmt::format("{} streams with evidence, called:{}", streams, called.empty() ? " none" : called));

  struct Known {
    const char* file;
    bool filtered;
  };
  std::string wrong;
  int reported = 0;
  for (const Known& known :
       {Known{"btk-others/PiG_Motion3_FF.c3d", true}, Known{"c3d-org/sample13/Dance.c3d", true},
        Known{"opensim-core-ik/abdbonepin.trc", true}, Known{"opensim-gait2354/subject01_static.trc", true},
        Known{"opensim-hamner-fullbody/subject02_running.trc", true}, Known{"cmu-mocap/85_02.c3d", true},
        Known{"nimble-arnold-synthetic/subject01/trials/walk2/markers.trc", true},
        Known{"biobuddy/right_knee.c3d", false}, Known{"c3d-org/sample01/Eb015pr.c3d", false},
        Known{"btk-others/ADemo1_rewrite_c3d_pc_float.c3d", false},
        Known{"ezc3d-testFiles/Qualisys.c3d", false}, Known{"kineticstoolkit/walkingOptiTrack.c3d", false},
        Known{"c3d-org/sample21/sample21.c3d", false},
        Known{"opensim-gait2354/subject01_walk1.trc", false}}) {
    const auto trial = io::read_markers(folder / known.file);
    const auto band = trajectory::detect_upsampling(trial.value().markers).value().band;
    if ((band.verdict == BandVerdict::low_passed) == known.filtered)
      ++reported;
    else
      wrong += fmt::format("; {} {} (top {:.4f} mm, middle {:.4f} mm)", known.file, to_string(band.verdict),
                           1e3 * band.top_m, 1e3 * band.middle_m);
  }
  print_row(wrong.empty(), "real recordings: 7 filtered by the vendor or made by a model, 7 not",
            "each reported as such", fmt::format("{} of 14{}", reported, wrong));
}

int run_check(int argc, char** argv) {
  const int streams = argc > 1 ? std::stoi(argv[1]) : 2000;
  const bool with_recordings = argc <= 2;
  const auto folder = testing_support::test_data_folder();
  const MotionLibrary library = MotionLibrary::load(folder);
  check_streams(streams, library);
  check_recordings(std::max(2, streams / 100), library);
  check_jitter(std::max(20, streams / 20), library);
  check_limits(std::max(20, streams / 20), library);
  if (with_recordings) {
    if (folder)
      check_real(*folder);
    else
      return testing_support::skip_all("upsampling on real recordings") + testing_support::exit_status();
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("upsampling", run_check);

}  // namespace
