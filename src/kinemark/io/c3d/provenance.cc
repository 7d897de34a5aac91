// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/provenance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/data/calibration_error.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::io {
namespace {

constexpr const char* kCalibrationError = "CALIBRATION_ERROR";

using data::SampleState;

constexpr std::size_t kRunBytes = 5;
constexpr std::size_t kRunsPerParameter = 255;
// A section ends at 255 blocks; labels and the rest need their part.
constexpr std::size_t kMaxRuns = 12'000;
constexpr std::int64_t kMaxLength = 65535;
constexpr double kSmallest_m = 1e-6;
constexpr double kStep = 1.05;

/// The stored description of a sample.
struct Stored {
  std::uint8_t state = 0, method = 0, deviation = 0;
  friend bool operator==(const Stored&, const Stored&) = default;
};

struct Run {
  std::int64_t length;
  Stored stored;
};

std::uint8_t deviation_code(const data::Trajectories& t, std::size_t i) {
  const double sd_m = std::sqrt(math::symmetric3_trace(t.covariance.data() + 6 * i) / 3.0);
  if (!(sd_m > 0.0) || !std::isfinite(sd_m)) return 0;
  return static_cast<std::uint8_t>(
      std::clamp(std::round(std::log(sd_m / kSmallest_m) / std::log(kStep)) + 1.0, 1.0, 255.0));
}

double deviation_m(std::uint8_t code) { return kSmallest_m * std::pow(kStep, code - 1); }

/// Runs marker by marker; empty when they are more than fit.
std::vector<Run> runs_of(const data::Trajectories& t, bool deviations) {
  std::vector<Run> out;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    for (std::int64_t f = 0; f < t.frames(); ++f) {
      const std::size_t i = t.index(f, m);
      Stored stored{.state = static_cast<std::uint8_t>(t.state[i])};
      if (!t.method.empty()) stored.method = t.method[i];
      if (deviations && t.present(f, m)) stored.deviation = deviation_code(t, i);
      if (f > 0 && out.back().stored == stored && out.back().length < kMaxLength) {
        ++out.back().length;
        continue;
      }
      if (out.size() == kMaxRuns) return {};
      out.push_back({1, stored});
    }
  }
  return out;
}

bool c3d_tells_all(const data::Trajectories& t) {
  return t.covariance.empty() && std::ranges::all_of(t.method, [](std::uint8_t k) { return k == 0; }) &&
         std::ranges::none_of(t.state, [](SampleState s) {
           return s == SampleState::model_filled || s == SampleState::upsampled || s == SampleState::rejected;
         });
}

/// True when a sample that C3D stores as `word` may have the state `stored`.
bool agree(SampleState word, SampleState stored) {
  switch (stored) {
    case SampleState::missing:
    case SampleState::rejected:
      return word == SampleState::missing;
    case SampleState::measured:
      return word == SampleState::measured;
    case SampleState::interpolated:
    case SampleState::model_filled:
    case SampleState::upsampled:
      return word == SampleState::interpolated;
  }
  return false;
}

}  // namespace

void add_provenance(const data::Trajectories& t, C3dParameters& parameters) {
  if (c3d_tells_all(t)) return;
  std::vector<Run> runs = runs_of(t, !t.covariance.empty());
  if (runs.empty()) runs = runs_of(t, false);
  if (runs.empty()) return;
  C3dGroup& group = parameters.group(kProvenanceGroup);
  group.parameters.push_back(
      {.name = "FRAMES",
       .type = C3dType::int16,
       .dims = {2},
       .numbers = {static_cast<double>(t.frames() & 0xffff), static_cast<double>(t.frames() >> 16)}});
  std::size_t width = 1;
  for (const std::string& name : t.methods) width = std::max(width, std::min<std::size_t>(name.size(), 100));
  std::vector<std::string> methods = t.methods;
  for (std::string& name : methods) name.resize(std::min<std::size_t>(name.size(), 100));
  group.parameters.push_back({.name = "METHODS",
                              .type = C3dType::text,
                              .dims = {static_cast<int>(width), static_cast<int>(methods.size())},
                              .texts = std::move(methods)});
  int part = 1;
  for (std::size_t at = 0; at < runs.size(); at += kRunsPerParameter) {
    const std::size_t n = std::min(kRunsPerParameter, runs.size() - at);
    C3dParameter p{.name = part == 1 ? "RUNS" : fmt::format("RUNS{}", part),
                   .type = C3dType::byte,
                   .dims = {static_cast<int>(kRunBytes), static_cast<int>(n)}};
    for (std::size_t k = at; k < at + n; ++k)
      for (const std::int64_t byte :
           {runs[k].length & 0xFF, runs[k].length >> 8, std::int64_t{runs[k].stored.state},
            std::int64_t{runs[k].stored.method}, std::int64_t{runs[k].stored.deviation}})
        p.numbers.push_back(static_cast<double>(byte));
    group.parameters.push_back(std::move(p));
    ++part;
  }
}

void apply_provenance(const C3dParameters& parameters, data::Trial& trial) {
  // The group may hold the set's name alone.
  if (parameters.find(kProvenanceGroup, "FRAMES") == nullptr &&
      parameters.find(kProvenanceGroup, "RUNS") == nullptr)
    return;
  data::Trajectories& t = trial.markers;
  const auto word = [](double v) { return static_cast<std::int64_t>(v) & 0xFFFF; };
  const std::vector<double> frames = parameters.numbers(kProvenanceGroup, "FRAMES");
  const std::vector<double> numbers = parameters.numbers(kProvenanceGroup, "RUNS");
  const std::vector<std::string> methods = parameters.texts(kProvenanceGroup, "METHODS");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint8_t>(static_cast<int>(numbers[i]) & 0xFF);
  };

  // Read all before anything is changed.
  std::vector<Run> runs;
  std::int64_t samples = 0;
  bool sound = frames.size() == 2 && (word(frames[0]) | word(frames[1]) << 16) == t.frames() &&
               numbers.size() % kRunBytes == 0 && methods.size() <= 255;
  for (std::size_t i = 0; sound && i < numbers.size(); i += kRunBytes) {
    const Run run{byte(i) | byte(i + 1) << 8, {byte(i + 2), byte(i + 3), byte(i + 4)}};
    sound = run.length > 0 && run.stored.state <= static_cast<int>(SampleState::rejected) &&
            run.stored.method <= methods.size() &&
            samples % std::max<std::int64_t>(1, t.frames()) + run.length <= t.frames();
    samples += run.length;
    runs.push_back(run);
  }
  if (!sound || samples != t.frames() * t.markers()) {
    trial.warnings.emplace_back(
        "KINEMARK:RUNS does not fit the samples; the provenance of the samples is known from their residuals "
        "only");
    return;
  }

  t.methods = methods;
  if (std::ranges::any_of(runs, [](const Run& r) { return r.stored.method > 0; }))
    t.method.assign(t.state.size(), 0);
  if (std::ranges::any_of(runs, [](const Run& r) { return r.stored.deviation > 0; }))
    t.covariance.assign(6 * t.state.size(), std::numeric_limits<double>::quiet_NaN());
  std::int64_t at = 0;
  std::int64_t disagreeing = 0;
  for (const Run& run : runs) {
    for (const std::int64_t end = at + run.length; at < end; ++at) {
      const std::size_t i = t.index(at % t.frames(), at / t.frames());
      const auto stored = static_cast<SampleState>(run.stored.state);
      if (!agree(t.state[i], stored)) {
        ++disagreeing;
        continue;
      }
      t.state[i] = stored;
      if (!t.method.empty()) t.method[i] = run.stored.method;
      if (t.covariance.empty() || run.stored.deviation == 0) continue;
      const double sd_m = deviation_m(run.stored.deviation);
      math::pack_isotropic3(sd_m * sd_m, t.covariance.data() + 6 * i);
    }
  }
  if (disagreeing > 0)
    trial.warnings.push_back(fmt::format(
        "KINEMARK:RUNS and the residuals disagree on {} samples; the residuals are used", disagreeing));
}

void add_calibration_error(const data::CalibrationError& error, C3dParameters& parameters) {
  constexpr std::size_t kLine = 240;
  std::string_view text;
  const std::string whole = data::to_text(error);
  std::vector<std::string> lines;
  for (text = whole; !text.empty();) {
    // At a blank: ends of texts lose theirs.
    const auto end = text.size() <= kLine ? text.size() : text.rfind(' ', kLine);
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (lines.empty()) return;
  parameters.group(kProvenanceGroup)
      .parameters.push_back({.name = kCalibrationError,
                             .type = C3dType::text,
                             .dims = {static_cast<int>(kLine), static_cast<int>(lines.size())},
                             .texts = std::move(lines),
                             .description = "fields of displacement, the same in all frames, 1 SD"});
}

void take_calibration_error(const C3dParameters& parameters, data::Trial& trial) {
  std::string whole;
  for (const auto& line : parameters.texts(kProvenanceGroup, kCalibrationError)) whole += line + ' ';
  if (whole.empty()) return;
  if (auto error = data::calibration_error_of(whole))
    trial.calibration_error = std::move(*error);
  else
    trial.warnings.emplace_back("KINEMARK:CALIBRATION_ERROR holds no fields of displacement and is not read");
}

}  // namespace kinemark::io
