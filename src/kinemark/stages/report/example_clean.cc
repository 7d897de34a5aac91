// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "kinemark/core/check.h"
#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/symmetric3.h"
#include "kinemark/stages/report/internal/example_clean.h"

namespace kinemark::report::internal {

namespace {

using data::SampleState;

constexpr double kRateHz = 120.0;
constexpr double kNoiseM = 0.0004;
constexpr std::array<std::string_view, 12> kNames{"C7",           "CLAV",        "R.Acromium",  "R.Bicep",
                                                  "R.Elbow.Lat",  "R.Elbow.Med", "R.Forearm.1", "R.Forearm.2",
                                                  "R.Wrist.Ulna", "R.Wrist.Rad", "R.Hand",      "R.Finger"};
constexpr std::int64_t kBicep = 3, kLateral = 4, kMedial = 5, kFirstMade = 6, kLastMade = 7, kUlna = 8,
                       kRadius = 9, kHand = 10, kFinger = 11;

/// Position of a marker and its first two derivatives along one axis: two waves of an arm that swings.
struct Motion {
  double x, v, a;
};
Motion motion(std::int64_t marker, std::int64_t axis, double t) {
  const double reach = 0.02 + 0.03 * static_cast<double>(marker);  // the hand moves more than the neck
  Motion m{0.1 * static_cast<double>(marker) + (axis == 1 ? 1.2 : 0.3), 0.0, 0.0};
  for (const double hz : {0.8, 2.1}) {
    const double w = 2.0 * std::numbers::pi * hz;
    const double phase = w * t + static_cast<double>(axis) + 0.3 * static_cast<double>(marker);
    const double size = reach / (hz * hz);
    m.x += size * std::sin(phase);
    m.v += size * w * std::cos(phase);
    m.a -= size * w * w * std::sin(phase);
  }
  return m;
}

/// A stretch of one marker that was not measured, and how it was treated; frames as shares of the recording.
struct Hole {
  std::int64_t marker;
  double from, to;
  bool filled;
  SampleState state;
  std::string_view method;
  double max_sd_m;
};
constexpr std::array<Hole, 6> kHoles{{
    {kBicep, 0.30, 0.34, true, SampleState::model_filled, "auto", 0.0009},
    {kBicep, 0.70, 0.71, true, SampleState::interpolated, "cubic", 0.0005},
    {kUlna, 0.45, 0.56, true, SampleState::model_filled, "auto", 0.0142},
    {kRadius, 0.45, 0.52, true, SampleState::model_filled, "auto", 0.0061},
    {kHand, 0.00, 0.02, true, SampleState::model_filled, "rigid", 0.0021},
    {kFinger, 0.60, 0.85, false, SampleState::missing, "", kNaN},
}};

std::int64_t frame_at(double share, std::int64_t frames) {
  return static_cast<std::int64_t>(share * static_cast<double>(frames));
}

void fill_samples(ExampleClean& e, std::uint64_t seed) {
  const auto frames = e.report.time.frames;
  const auto all = 3 * static_cast<std::size_t>(frames) * kNames.size();
  e.after.covariance.assign(2 * all, 0.0);
  for (auto* array : {&e.derivatives.velocity, &e.derivatives.velocity_sd, &e.derivatives.acceleration,
                      &e.derivatives.acceleration_sd})
    array->assign(all, kNaN);
  for (std::int64_t m = 0; m < std::ssize(kNames); ++m) {
    Random random(seed, static_cast<std::uint64_t>(m));
    for (std::int64_t f = 0; f < frames; ++f) {
      const double t = e.report.time.time_s(f);
      const std::size_t i = e.after.index(f, m);
      e.before.state[i] = e.after.state[i] = SampleState::measured;
      if (m >= kFirstMade && m <= kLastMade && f % 2 == 1) e.after.state[i] = SampleState::upsampled;
      for (std::int64_t axis = 0; axis < 3; ++axis) {
        const Motion truth = motion(m, axis, t);
        const std::size_t k = 3 * i + static_cast<std::size_t>(axis);
        // Noise of the sample, and what a filter of 10 Hz or so leaves of it.
        e.before.x_in_world[k] = truth.x + kNoiseM * random.gaussian();
        const double left = std::sin(7.0 * t + static_cast<double>(axis + m));
        e.after.x_in_world[k] = truth.x + 0.00015 * left;
        e.derivatives.velocity[k] = truth.v + 0.009 * left;
        e.derivatives.acceleration[k] = truth.a + 0.5 * left;
        e.derivatives.velocity_sd[k] = 0.008;
        e.derivatives.acceleration_sd[k] = 0.45;
      }
      math::pack_isotropic3(0.00016 * 0.00016, e.after.covariance.data() + 6 * i);
    }
  }
}

/// A missing sample has no standard deviation.
void forget(ExampleClean& e, std::int64_t frame, std::int64_t marker, SampleState why) {
  e.after.set_missing(frame, marker, why);
  const std::size_t i = e.after.index(frame, marker);
  for (auto* array : {&e.derivatives.velocity, &e.derivatives.velocity_sd, &e.derivatives.acceleration,
                      &e.derivatives.acceleration_sd})
    for (std::size_t axis = 0; axis < 3; ++axis) (*array)[3 * i + axis] = kNaN;
  for (std::size_t c = 0; c < 6; ++c) e.after.covariance[6 * i + c] = kNaN;
}

/// The error bar grows towards the middle of a gap.
void cut_hole(ExampleClean& e, const Hole& hole) {
  const std::int64_t frames = e.report.time.frames;
  const std::int64_t first = frame_at(hole.from, frames), last = frame_at(hole.to, frames) - 1;
  for (std::int64_t f = first; f <= last; ++f) {
    e.before.set_missing(f, hole.marker);
    const std::size_t i = e.after.index(f, hole.marker);
    if (!hole.filled) {
      forget(e, f, hole.marker, SampleState::missing);
      continue;
    }
    e.after.state[i] = hole.state;
    const double along = (static_cast<double>(f - first) + 1.0) / (static_cast<double>(last - first) + 2.0);
    const double bulge = std::sin(std::numbers::pi * along);
    const double sd = 0.0002 + hole.max_sd_m * bulge;
    math::pack_isotropic3(sd * sd, e.after.covariance.data() + 6 * i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      e.after.x_in_world[3 * i + axis] += 0.8 * hole.max_sd_m * bulge * (axis == 1 ? -1.0 : 1.0);
      e.derivatives.velocity_sd[3 * i + axis] += 20.0 * hole.max_sd_m * bulge;
      e.derivatives.acceleration_sd[3 * i + axis] += 300.0 * hole.max_sd_m * bulge;
    }
  }
  data::GapAccount gap{.marker = hole.marker,
                       .first_frame = first,
                       .last_frame = last,
                       .at_edge = first == 0,
                       .filled = hole.filled,
                       .method = std::string(hole.method)};
  if (hole.filled) {
    gap.sd_m = 0.7 * hole.max_sd_m;
    gap.max_sd_m = hole.max_sd_m;
    gap.windows = 40;
    gap.window_s = static_cast<double>(last - first + 1) / kRateHz;
    gap.predictors = {"R.Forearm.1", "R.Forearm.2", "R.Elbow.Lat"};
  } else {
    gap.why_open = "2.5 s long; at most 2 s are filled";
  }
  if (hole.method == "auto")
    gap.weights = {{"regression, tied", 0.61, 0.0021, false},
                   {"rigid", 0.31, 0.0034, false},
                   {"cubic", 0.08, 0.0098, false},
                   {"pca", 0.0, 0.021, true}};
  if (hole.marker == kUlna) gap.dropped = {"R.Wrist.Rad"};
  e.report.account.gaps.push_back(std::move(gap));
}

void fill_accounts(ExampleClean& e) {
  for (std::int64_t m = 0; m < std::ssize(kNames); ++m) {
    const auto at = static_cast<double>(m);
    data::MarkerAccount c{.name = std::string(kNames[static_cast<std::size_t>(m)])};
    c.used = {"kalman", m < 4 ? 3 : 4, 6.0 + 0.9 * at, kNoiseM * (1.0 + 0.05 * at)};
    c.description = "Smoother of an integrated random walk; order and cut-off have the least estimated risk.";
    c.noise_from = "data";
    c.criterion_name = "SURE, m^2";
    for (const int order : {2, 3, 4, 5})
      c.candidates.push_back(
          {order, 5.0 + 0.9 * at + 0.4 * order, 1e-8 * (1.0 + 0.1 * std::abs(order - c.used.order))});
    c.residual_rms_m = 0.95 * c.used.noise_sd_m;
    c.white_p = m != kFinger ? 0.37 : 1e-9;
    c.white_departure = m != kFinger ? 0.02 : 0.31;
    for (int lag = 1; lag <= 10; ++lag)
      c.autocorrelation.push_back(c.coloured() ? 0.6 * std::exp(-0.3 * lag)
                                               : 0.03 * std::sin(3.0 * lag + at));
    c.bar_scale = {1.04, 1.11, 1.2, 1.3};
    c.gap_bar_scale = {1.2, 1.3, 1.4, 1.5};
    for (int k = 0; k < 40; ++k) {
      const double hz = 0.25 * std::pow(240.0, k / 39.0);
      const double noise = 3.0 * 2.0 * c.used.noise_sd_m * c.used.noise_sd_m / kRateHz;
      const double high_pass = 1.0 / (1.0 + std::pow(c.used.cutoff_hz / hz, 6.0));
      c.spectrum.frequency_hz.push_back(hz);
      c.spectrum.raw_m2_per_hz.push_back(noise + 1e-4 * std::pow(1.0 + hz, -6.0));
      c.spectrum.residual_m2_per_hz.push_back(noise * high_pass * high_pass);
    }
    e.accounts.push_back(std::move(c));
  }
  for (const data::MarkerAccount& c : e.accounts) e.derivatives.filters.push_back(c.used);
}

void fill_run(ExampleClean& e) {
  CleanRun& run = e.report.run;
  run.trial = "reach_07.c3d";
  run.gap_method = "auto";
  run.filter_method = "auto";
  run.version = "0.1.0";
  run.command_line = "kinemark clean reach_07.c3d reach_07_clean.nwb --gaps auto --filter auto --derivatives";
  run.seed = 1;
  run.clean_s = static_cast<double>(e.report.time.frames) / 21000.0;
  run.options = {{"derivatives", "yes"}, {"filter", "auto"}, {"gaps", "auto"}, {"max_gap_s", "2"}};
  run.inputs = {{"markers", "reach_07.c3d", 812544, "5be1093c77d2a8f0", "XXH3-64"}};
  run.warnings = {"reach_07.c3d: the header says 14 markers; 12 are there."};
  data::UpsamplingAccount& recorder = e.report.account.upsampling;
  recorder.looked = recorder.handled = true;
  recorder.markers.resize(kNames.size());
  for (const std::int64_t m : {kFirstMade, kLastMade}) {
    recorder.markers[at(m)].factor = 2;
    recorder.markers[at(m)].kernel = data::InterpolationKernel::linear;
  }
  recorder.marker_bands.assign(kNames.size(), {.verdict = data::BandVerdict::open});
  recorder.sentences = {"R.Forearm.1 and R.Forearm.2 were interpolated by a factor of 2 (linear).",
                        "Interpolation that was followed by a low-pass filter cannot be seen."};
  recorder.done = "marked as upsampled, not used as measurements";
}

}  // namespace

CleanReport ExampleClean::finished(const ReportOptions& options) const {
  CleanReport out = report;
  for (std::int64_t m = 0; m < after.markers(); ++m)
    add_marker(out, accounts[at(m)],
               {.before = &before,
                .before_marker = m,
                .after = &after,
                .after_marker = m,
                .derivatives = &derivatives},
               options);
  return out;
}

ExampleClean example_clean(std::int64_t frames, std::uint64_t seed) {
  check(frames >= 100, "an example needs at least 100 frames");
  ExampleClean e;
  e.report.time = {.rate_hz = kRateHz, .t0_s = 0.0, .frames = frames};
  const std::vector<std::string> names(kNames.begin(), kNames.end());
  e.report.account.names = names;
  e.before = data::Trajectories::all_missing(names, e.report.time);
  e.after = data::Trajectories::all_missing(names, e.report.time);
  fill_samples(e, seed);
  for (const Hole& hole : kHoles) cut_hole(e, hole);
  fill_accounts(e);
  fill_run(e);

  const std::int64_t spike = frame_at(0.15, frames);
  e.before.x(spike, kFinger)(1) += 0.12;
  forget(e, spike, kFinger, SampleState::rejected);
  e.report.account.defects = {
      {.finding = {.kind = data::FindingKind::spike,
                   .subject = names[kFinger],
                   .first_frame = spike,
                   .last_frame = spike,
                   .size = 0.12,
                   .confidence = 0.98,
                   .description = "R.Finger leaves its path by 120 mm for one sample and comes back"},
       .done = "rejected",
       .handled = true},
      {.finding = {.kind = data::FindingKind::label_swap,
                   .subject = names[kLateral],
                   .partner = names[kMedial],
                   .first_frame = frame_at(0.8, frames),
                   .last_frame = frame_at(0.83, frames),
                   .size = 0.062,
                   .confidence = 0.93,
                   .description =
                       "R.Elbow.Lat and R.Elbow.Med sit in each other's place, 62 mm out of place"},
       .done = "left as it is"}};
  return e;
}

}  // namespace kinemark::report::internal
