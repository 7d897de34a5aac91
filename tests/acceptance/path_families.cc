// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/path_families.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace kinemark::acceptance {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Jet operator+(const Jet& a, const Jet& b) { return {a.f + b.f, a.d1 + b.d1, a.d2 + b.d2, a.d3 + b.d3}; }
Jet operator*(double k, const Jet& a) { return {k * a.f, k * a.d1, k * a.d2, k * a.d3}; }

Jet line(double t, double speed) { return {speed * t, speed, 0.0, 0.0}; }

Jet sine(double t, double w, double phase) {
  const double s = std::sin(w * t + phase), c = std::cos(w * t + phase);
  return {s, w * c, -w * w * s, -w * w * w * c};
}

// sin(k theta + phase) of a moving theta.
Jet sine_of(const Jet& theta, double k, double phase) {
  const double s = std::sin(k * theta.f + phase), c = std::cos(k * theta.f + phase);
  const double a = k * theta.d1, b = k * theta.d2, d = k * theta.d3;
  return {s, c * a, -s * a * a + c * b, -c * a * a * a - 3.0 * s * a * b + c * d};
}

// Minimum jerk from 0 to 1.
Jet minimum_jerk(double t, double begin, double duration) {
  const double u = std::clamp((t - begin) / duration, 0.0, 1.0);
  if (u <= 0.0 || u >= 1.0) return {u, 0.0, 0.0, 0.0};
  return {u * u * u * (10.0 - 15.0 * u + 6.0 * u * u), 30.0 * u * u * (1.0 - u) * (1.0 - u) / duration,
          (60.0 * u - 180.0 * u * u + 120.0 * u * u * u) / (duration * duration),
          (60.0 - 360.0 * u + 360.0 * u * u) / (duration * duration * duration)};
}

using Axes = std::array<Jet, 3>;
Axes along(const Jet& jet, const Eigen::Vector3d& d) { return {d[0] * jet, d[1] * jet, d[2] * jet}; }
Axes operator+(const Axes& a, const Axes& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Eigen::Vector3d gaussian3(Random& random) {
  return {random.gaussian(), random.gaussian(), random.gaussian()};
}

std::function<Axes(double)> reach(Random& random, double& duration_s) {
  const double a = random.uniform(100.0, 500.0), d = random.uniform(0.4, 1.0),
               arch = random.uniform(0.0, 0.15);
  duration_s = 1.0 + d;
  return [=](double t) -> Axes {
    const Jet up = minimum_jerk(t, 0.5, 0.6 * d), down = minimum_jerk(t, 0.5 + 0.4 * d, 0.6 * d);
    return {a * minimum_jerk(t, 0.5, d), a * arch * (up + -1.0 * down), Jet{}};
  };
}

std::function<Axes(double)> submovements(Random& random, double& duration_s) {
  struct Part {
    double begin, duration;
    Eigen::Vector3d way;
  };
  std::vector<Part> parts;
  const int count = 2 + std::min(2, static_cast<int>(random.uniform(0.0, 3.0)));
  double begin = 0.5;
  for (int k = 0; k < count; ++k) {
    const double d = random.uniform(0.35, 0.7);
    const Eigen::Vector3d way = (Eigen::Vector3d::UnitX() + 0.5 * gaussian3(random)).normalized();
    parts.push_back({begin, d, random.uniform(60.0, 250.0) * way});
    duration_s = std::max(duration_s, begin + d + 0.5);
    begin += random.uniform(0.45, 0.9) * d;
  }
  return [parts](double t) {
    Axes out{};
    for (const auto& part : parts) out = out + along(minimum_jerk(t, part.begin, part.duration), part.way);
    return out;
  };
}

// An angle that turns `rate` times a second, a little unevenly.
std::function<Jet(double)> uneven(double rate, double first, double second, Random& random) {
  const double w = kTurn * rate, a = random.uniform(0.0, kTurn), b = random.uniform(0.0, kTurn);
  return [=](double t) { return line(t, w) + first * sine(t, 0.31 * w, a) + second * sine(t, 0.47 * w, b); };
}

std::function<Axes(double)> loop(Random& random, double& duration_s, int folds) {
  const double a = random.uniform(60.0, 250.0), b = a * random.uniform(0.25, 0.9),
               rate = random.uniform(0.6, 1.6);
  const double off = random.uniform(0.0, 12.0), phase = random.uniform(0.0, kTurn);
  const auto theta = uneven(rate, 0.10, 0.06, random);
  duration_s = 5.0;
  return [=](double t) -> Axes {
    const Jet angle = theta(t);
    return {a * sine_of(angle, 1.0, 0.5 * std::numbers::pi), b * sine_of(angle, folds, 0.0),
            off * sine_of(angle, 2.0, phase)};
  };
}

std::function<Axes(double)> sign(Random& random, double& duration_s) {
  const double a = random.uniform(100.0, 200.0), b = a * random.uniform(0.3, 0.7),
               rate = random.uniform(1.1, 1.6);
  const double rhythm = random.uniform(0.4, 0.75), off = random.uniform(2.0, 10.0),
               phase = random.uniform(0.0, kTurn);
  const auto turn = uneven(rate, 0.05, 0.03, random);
  duration_s = 4.0;
  return [=](double t) -> Axes {
    const Jet p = turn(t);
    const Jet angle = p + rhythm * sine_of(p, 1.0, 0.0) + 0.06 * sine_of(p, 2.0, 0.0);
    return {a * sine_of(angle, 1.0, 0.5 * std::numbers::pi + 1.05), b * sine_of(angle, 1.0, 1.05),
            off * sine(t, kTurn * 0.31, phase)};
  };
}

std::function<Axes(double)> wheel(Random& random, double& duration_s) {
  const double r = random.uniform(100.0, 250.0), w = kTurn * random.uniform(0.8, 1.6),
               phase = random.uniform(0.0, kTurn);
  duration_s = 4.0;
  return [=](double t) -> Axes {
    return {r * sine(t, w, phase + 0.5 * std::numbers::pi), r * sine(t, w, phase), Jet{}};
  };
}

std::function<Axes(double)> tremor(Random& random, double& duration_s) {
  const double rate = random.uniform(4.5, 11.0);
  const double size = std::exp(random.uniform(std::log(0.3), std::log(4.0))),
               drift = random.uniform(3.0, 15.0);
  const Eigen::Vector3d first = gaussian3(random).normalized(), second = gaussian3(random).normalized(),
                        way = gaussian3(random).normalized();
  std::array<double, 7> phase{};
  for (double& p : phase) p = random.uniform(0.0, kTurn);
  duration_s = 5.0;
  return [=](double t) {
    const Jet main = sine(t, kTurn * rate, phase[0]) + 0.2 * sine(t, kTurn * (rate + 0.7), phase[1]) +
                     0.2 * sine(t, kTurn * (rate - 0.7), phase[2]);
    const Jet beside = 0.5 * sine(t, kTurn * rate, phase[3]) + 0.1 * sine(t, kTurn * (rate + 0.4), phase[4]);
    const Jet slow = drift * minimum_jerk(t, 0.5, 4.0) + 2.0 * sine(t, kTurn * 0.4, phase[5]);
    return along(size * main, first) + along(size * beside, second) + along(slow, way) +
           along(sine(t, kTurn * 0.9, phase[6]), second);
  };
}

std::function<Axes(double)> walk(Random& random, double& duration_s) {
  constexpr std::array<std::array<double, 7>, 3> kHarmonics{
      {{250, 70, 25, 10, 4, 1.5, 0.6}, {70, 45, 18, 8, 3, 1.2, 0.5}, {15, 8, 3, 1.2, 0.5, 0.2, 0.1}}};
  const double rate = random.uniform(0.8, 1.1), speed = random.uniform(900.0, 1500.0);
  std::array<std::array<double, 7>, 3> size{}, phase{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t k = 0; k < 7; ++k) {
      size[a][k] = kHarmonics[a][k] * random.uniform(0.8, 1.2);
      phase[a][k] = random.uniform(0.0, kTurn);
    }
  const auto theta = uneven(rate, 0.06, 0.04, random);
  duration_s = 5.0;
  return [=](double t) {
    const Jet angle = theta(t);
    Axes out{line(t, speed), Jet{}, Jet{}};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k < 7; ++k)
        out[a] = out[a] + size[a][k] * sine_of(angle, static_cast<double>(k + 1), phase[a][k]);
    return out;
  };
}

std::function<Axes(double)> body_of(const std::string& family, Random& random, double& duration_s) {
  if (family == "reach") return reach(random, duration_s);
  if (family == "submovements") return submovements(random, duration_s);
  if (family == "ellipse") return loop(random, duration_s, 1);
  if (family == "eight") return loop(random, duration_s, 2);
  if (family == "sign") return sign(random, duration_s);
  if (family == "wheel") return wheel(random, duration_s);
  if (family == "tremor") return tremor(random, duration_s);
  return walk(random, duration_s);
}

}  // namespace

PathMovement draw_movement(const std::string& family, Random& random) {
  PathMovement out{.family = family};
  const Eigen::Vector4d q(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian());
  const Eigen::Matrix3d turn = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
  const auto body = body_of(family, random, out.duration_s);
  out.at = [turn, body](double t) {
    const Axes own = body(t);
    Axes world{};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const auto to = static_cast<std::size_t>(a);
        world[to] = world[to] + turn(a, b) * own[static_cast<std::size_t>(b)];
      }
    return world;
  };
  return out;
}

analysis::PathSamples sample_movement(const PathMovement& movement, double rate_hz) {
  const auto n = static_cast<std::int64_t>(movement.duration_s * rate_hz);
  analysis::PathSamples out{.rate_hz = rate_hz, .x = analysis::SeriesMatrix(n, 3)};
  out.v = out.a = out.j = out.x;
  for (std::int64_t i = 0; i < n; ++i) {
    const Axes axes = movement.at(static_cast<double>(i) / rate_hz);
    for (int a = 0; a < 3; ++a) {
      const Jet& jet = axes[static_cast<std::size_t>(a)];
      out.x(i, a) = 1e-3 * jet.f, out.v(i, a) = 1e-3 * jet.d1;
      out.a(i, a) = 1e-3 * jet.d2, out.j(i, a) = 1e-3 * jet.d3;
    }
  }
  return out;
}

}  // namespace kinemark::acceptance
