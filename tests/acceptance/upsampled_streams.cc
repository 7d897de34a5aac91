// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/upsampled_streams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "kinemark/io/markers/marker_file.h"

namespace kinemark::acceptance {
namespace {

using data::InterpolationKernel;
using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

Vector3d gaussian3(Random& random) {
  const double x = random.gaussian();
  const double y = random.gaussian();
  const double z = random.gaussian();
  return {x, y, z};
}

int pick(Random& random, int count) {
  return std::min(count - 1, static_cast<int>(random.uniform(0.0, static_cast<double>(count))));
}

/// Slope at every knot, knots one apart, by the textbook of each kernel, one axis.
std::vector<double> slopes(const std::vector<double>& v, InterpolationKernel kernel, bool flat_ends) {
  const auto n = static_cast<int>(v.size());
  std::vector<double> s(v.size(), 0.0);
  const auto at = [&](int i) {  // continued as a straight line
    if (i < 0) return v[0] + i * (v[1] - v[0]);
    if (i >= n) return v[v.size() - 1] + (i - n + 1) * (v[v.size() - 1] - v[v.size() - 2]);
    return v[static_cast<std::size_t>(i)];
  };
  const auto chord = [&](int i) { return at(i + 1) - at(i); };
  if (kernel == InterpolationKernel::spline) {
    // Jacobi-like sweeps of the tridiagonal system until nothing changes; ends flat or free.
    for (int sweep = 0; sweep < 60; ++sweep)
      for (int i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (i == 0)
          s[k] = flat_ends ? 0.0 : (3.0 * chord(0) - s[1]) / 2.0;
        else if (i == n - 1)
          s[k] = flat_ends ? 0.0 : (3.0 * chord(n - 2) - s[k - 1]) / 2.0;
        else
          s[k] = (3.0 * (at(i + 1) - at(i - 1)) - s[k - 1] - s[k + 1]) / 4.0;
      }
    return s;
  }
  for (int i = 0; i < n; ++i) {
    const double left = chord(i - 1);
    const double right = chord(i);
    double& slope = s[static_cast<std::size_t>(i)];
    if (kernel == InterpolationKernel::catmull_rom) slope = (left + right) / 2.0;
    if (kernel == InterpolationKernel::pchip)
      slope = left * right <= 0.0 ? 0.0 : 1.0 / (0.5 / left + 0.5 / right);
    if (kernel == InterpolationKernel::akima) {
      const double a = std::abs(chord(i + 1) - right);
      const double b = std::abs(left - chord(i - 2));
      slope = a + b == 0.0 ? (left + right) / 2.0 : (a * left + b * right) / (a + b);
    }
  }
  return s;
}

}  // namespace

MotionLibrary MotionLibrary::load(const std::optional<std::filesystem::path>& folder) {
  MotionLibrary library;
  if (!folder) return library;
  for (const char* name :
       {"cmu-mocap/cmu_02_05.c3d", "cmu-mocap/85_02.c3d", "biobuddy/right_knee.c3d",
        "btk-others/FunctionalLHip.c3d", "opensim-hamner-fullbody/subject02_running.trc"}) {
    auto trial = io::read_markers(*folder / name);
    if (trial) library.trials.push_back(std::move(trial->markers));
  }
  return library;
}

Path random_path(Random& random, const MotionLibrary& library, double duration_s) {
  const int kind = pick(random, 5);
  if (kind < 2 && !library.trials.empty()) {
    for (int attempt = 0; attempt < 40; ++attempt) {
      const data::Trajectories& t =
          library.trials[static_cast<std::size_t>(pick(random, static_cast<int>(library.trials.size())))];
      const auto marker = static_cast<std::int64_t>(pick(random, static_cast<int>(t.markers())));
      const double start = random.uniform();
      const auto need = static_cast<std::int64_t>((duration_s + 1.0) * t.time.rate_hz);
      if (t.frames() < need) continue;
      const auto first = static_cast<std::int64_t>(start * static_cast<double>(t.frames() - need));
      auto x = std::make_shared<Stream>();
      for (std::int64_t f = first; f < first + need && t.present(f, marker); ++f)
        x->push_back(1e3 * t.x(f, marker));
      if (static_cast<std::int64_t>(x->size()) < need) continue;
      const double rate = t.time.rate_hz;
      const double width_s = std::sqrt(std::numbers::ln2) / (kTwoPi * 8.0);  // -3 dB at 8 Hz
      return [x, rate, width_s](double time_s) {
        const double centre = (time_s + 0.5) * rate;
        const double reach = 5.0 * width_s * rate;
        Vector3d sum = Vector3d::Zero();
        double weights = 0.0;
        const auto last = std::min(static_cast<int>(x->size()) - 1, static_cast<int>(centre + reach));
        for (int i = std::max(0, static_cast<int>(centre - reach)); i <= last; ++i) {
          const double z = (i - centre) / (width_s * rate);
          const double w = std::exp(-0.5 * z * z);
          sum += w * (*x)[static_cast<std::size_t>(i)];
          weights += w;
        }
        return Vector3d(sum / weights);
      };
    }
  }
  if (kind < 3) {
    const double base_hz = random.uniform(0.3, 2.0);
    std::array<Vector3d, 6> amplitude;
    std::array<Vector3d, 6> phase;
    for (std::size_t k = 0; k < 6; ++k) {
      amplitude[k] = gaussian3(random) * 200.0 / static_cast<double>((k + 1) * (k + 1));
      phase[k] = gaussian3(random) * 3.0;
    }
    return [=](double t) {
      Vector3d x = Vector3d::Constant(500.0);
      for (std::size_t k = 0; k < 6; ++k)
        x += amplitude[k].cwiseProduct(
            ((kTwoPi * base_hz * static_cast<double>(k + 1) * t) + phase[k].array()).sin().matrix());
      return x;
    };
  }
  if (kind == 3) {
    const double speed = std::array{0.2, 2.0, 20.0}[static_cast<std::size_t>(pick(random, 3))];
    const Vector3d velocity = gaussian3(random) * speed;
    const double hz = random.uniform(0.03, 0.15);
    const double sway = random.uniform(1.0, 30.0);
    return [=](double t) {
      return Vector3d(Vector3d::Constant(800.0) + velocity * t +
                      sway * Vector3d(std::sin(kTwoPi * hz * t), std::sin(kTwoPi * hz * t + 1.0),
                                      std::sin(kTwoPi * hz * t + 2.0)));
    };
  }
  const Vector3d rest = gaussian3(random) * 800.0;
  return [=](double) { return Vector3d(rest); };
}

Stream interpolate(const Stream& low, int factor, InterpolationKernel kernel, bool flat_ends) {
  const std::size_t intervals = low.size() - 1;
  Stream out(intervals * static_cast<std::size_t>(factor) + 1);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> v;
    for (const Vector3d& x : low) v.push_back(x(axis));
    const std::vector<double> s = slopes(v, kernel, flat_ends);
    for (std::size_t n = 0; n < out.size(); ++n) {
      const std::size_t i = std::min(n / static_cast<std::size_t>(factor), intervals - 1);
      const double u = static_cast<double>(n) / factor - static_cast<double>(i);
      double& y = out[n](axis);
      if (kernel == InterpolationKernel::hold) {
        y = u < 1.0 ? v[i] : v[i + 1];
      } else if (kernel == InterpolationKernel::linear) {
        y = v[i] + u * (v[i + 1] - v[i]);
      } else if (kernel == InterpolationKernel::lagrange) {
        const double before = i == 0 ? 2.0 * v[0] - v[1] : v[i - 1];
        const double after = i + 2 == v.size() ? 2.0 * v[i + 1] - v[i] : v[i + 2];
        const std::array knots{before, v[i], v[i + 1], after};
        y = 0.0;
        for (int a = 0; a < 4; ++a) {
          double product = knots[static_cast<std::size_t>(a)];
          for (int b = 0; b < 4; ++b)
            if (a != b) product *= (u - (b - 1)) / (a - b);
          y += product;
        }
      } else {
        // Cubic with the values and slopes at both ends, by its Taylor coefficients at the left one.
        const double d = v[i + 1] - v[i];
        const double c2 = 3.0 * d - 2.0 * s[i] - s[i + 1];
        const double c3 = s[i] + s[i + 1] - 2.0 * d;
        y = v[i] + u * (s[i] + u * (c2 + u * c3));
      }
    }
  }
  return out;
}

Stream resample(const Stream& low, int factor) {
  constexpr int kLobes = 16;
  Stream out((low.size() - 1) * static_cast<std::size_t>(factor) + 1, Vector3d::Zero());
  for (std::size_t n = 0; n < out.size(); ++n) {
    const double at = static_cast<double>(n) / factor;
    double weights = 0.0;
    for (int k = static_cast<int>(at) - kLobes; k <= static_cast<int>(at) + kLobes; ++k) {
      const double d = at - k;
      if (std::abs(d) >= kLobes) continue;
      const double sinc = d == 0.0 ? 1.0 : std::sin(std::numbers::pi * d) / (std::numbers::pi * d);
      const double w = sinc * (0.5 + 0.5 * std::cos(std::numbers::pi * d / kLobes));
      const int inside = std::clamp(k, 0, static_cast<int>(low.size()) - 1);
      out[n] += w * low[static_cast<std::size_t>(inside)];
      weights += w;
    }
    out[n] /= weights;
  }
  return out;
}

void low_pass(Stream& stream, double cutoff_hz, double rate_hz) {
  const double k = std::tan(std::numbers::pi * cutoff_hz / rate_hz);
  const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
  const double b = k * k * norm;
  const double a1 = 2.0 * (k * k - 1.0) * norm;
  const double a2 = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
  for (int pass = 0; pass < 2; ++pass) {
    Vector3d x1 = stream.front();
    Vector3d x2 = x1;
    Vector3d y1 = x1;
    Vector3d y2 = x1;
    for (Vector3d& x : stream) {
      const Vector3d y = b * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1;
      x1 = x;
      y2 = y1;
      y1 = y;
      x = y;
    }
    std::ranges::reverse(stream);
  }
}

void add_noise(Stream& stream, double sd_mm, Random& random) {
  for (Vector3d& x : stream) x += sd_mm * gaussian3(random);
}

void add_coloured_noise(Stream& stream, double sd_mm, Random& random) {
  Vector3d e = sd_mm * gaussian3(random);
  for (Vector3d& x : stream) {
    e = 0.8 * e + 0.6 * sd_mm * gaussian3(random);
    x += e;
  }
}

void round_to(Stream& stream, double step_mm) {
  for (Vector3d& x : stream) {
    if (step_mm > 0.0) x = (x / step_mm).array().round().matrix() * step_mm;
    x = x.cast<float>().cast<double>();
  }
}

data::Trajectories recording(const std::vector<Stream>& streams, double rate_hz) {
  std::vector<std::string> names;
  std::size_t frames = streams.front().size();
  for (std::size_t m = 0; m < streams.size(); ++m) {
    names.push_back("M" + std::to_string(m + 1));
    frames = std::min(frames, streams[m].size());
  }
  auto t = data::Trajectories::all_missing(
      names, {.rate_hz = rate_hz, .t0_s = 0.0, .frames = static_cast<std::int64_t>(frames)});
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      t.x(f, m) = 1e-3 * streams[static_cast<std::size_t>(m)][static_cast<std::size_t>(f)];
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  return t;
}

}  // namespace kinemark::acceptance
