// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Simulated motions of a leg of two rods: measures of its joints and of its mass centre beside the truth,
// with white errors and with slow ones that a deviation states. Arguments: motions a family (default 40),
// first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/body/body_definitions.h"
#include "kinemark/stages/analysis/body/body_measures.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using Eigen::Index;
using Eigen::MatrixXd;
using testing_support::print_row;

constexpr double kGravity = 9.81;
constexpr double kRods[2] = {0.45, 0.42}, kMasses[2] = {8.0, 4.0};  // m, kg

/// Angles of hip and knee: a mean, a swing and two harmonics each; discrete ones begin and end at rest.
struct Leg {
  double rate_hz, frequency, duration_s;
  bool discrete;
  std::array<double, 2> mean, size, phase, second, third;

  static Leg draw(Random& random, bool discrete) {
    constexpr std::array kRates{60.0, 100.0, 120.0, 200.0};
    Leg leg{.rate_hz = kRates[std::min<std::size_t>(3, static_cast<std::size_t>(random.uniform(0.0, 4.0)))],
            .frequency = random.uniform(0.6, 1.4),
            .duration_s = discrete ? random.uniform(2.0, 3.0) : random.uniform(3.0, 6.0),
            .discrete = discrete};
    for (std::size_t j = 0; j < 2; ++j) {
      leg.mean[j] = random.uniform(-0.3, 0.3);
      leg.size[j] = random.uniform(0.25, 0.7);
      leg.phase[j] = random.uniform(0.0, 2.0 * std::numbers::pi);
      leg.second[j] = random.uniform(0.0, 0.2);
      leg.third[j] = random.uniform(0.0, 0.08);
    }
    return leg;
  }

  /// Angle, velocity and acceleration.
  [[nodiscard]] std::array<double, 3> at_time(std::size_t j, double t) const {
    if (discrete) {
      // A minimum-jerk swing of 1 s or so in the middle, half a tenth of a second later at the knee.
      const double T = 1.0 / frequency, u = (t - 0.5 * (duration_s - T) - 0.05 * static_cast<double>(j)) / T;
      if (u <= 0.0) return {mean[j], 0.0, 0.0};
      if (u >= 1.0) return {mean[j] + 2.0 * size[j], 0.0, 0.0};
      const double a = 2.0 * size[j];
      return {mean[j] + a * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u),
              a / T * 30.0 * u * u * (1.0 - u) * (1.0 - u),
              a / (T * T) * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)};
    }
    const double w = 2.0 * std::numbers::pi * frequency;
    std::array<double, 3> out{mean[j], 0.0, 0.0};
    const std::array<double, 3> share{1.0, second[j], third[j]};
    for (std::size_t h = 0; h < 3; ++h) {
      const double n = static_cast<double>(h + 1), p = w * n * t + n * phase[j], a = size[j] * share[h];
      out[0] += a * std::cos(p);
      out[1] -= a * w * n * std::sin(p);
      out[2] -= a * w * w * n * n * std::cos(p);
    }
    return out;
  }
};

/// The double pendulum's torques (Lagrange), its mass centre, and its momentum about it; it stands beside a
/// foot that does not move.
Status mechanics(analysis::BodySeries& series) {
  const auto frames = series.q.rows();
  series.tau.resize(frames, 2);
  series.centre.setZero(frames, 3);
  series.centre_velocity.setZero(frames, 3);
  series.momentum.setZero(frames, 3);
  const double l1 = kRods[0], l2 = kRods[1], m1 = kMasses[0], m2 = kMasses[1], m = m1 + m2;
  for (Index f = 0; f < frames; ++f) {
    const double q1 = series.q(f, 0), q2 = q1 + series.q(f, 1), v1 = series.v(f, 0), v2 = v1 + series.v(f, 1),
                 a1 = series.a(f, 0), a2 = a1 + series.a(f, 1), c = std::cos(q1 - q2), s = std::sin(q1 - q2);
    // By the absolute angles, point masses at the ends; the knee's torque acts on the second alone.
    const double second =
        m2 * l2 * l2 * a2 + m2 * l1 * l2 * (a1 * c - v1 * v1 * s) + m2 * kGravity * l2 * std::sin(q2);
    const double first =
        m * l1 * l1 * a1 + m2 * l1 * l2 * (a2 * c + v2 * v2 * s) + m * kGravity * l1 * std::sin(q1);
    series.tau(f, 1) = second;
    series.tau(f, 0) = first + second;
    const Eigen::Vector3d x1(l1 * std::sin(q1), 1.0 - l1 * std::cos(q1), 0.0),
        w1(l1 * v1 * std::cos(q1), l1 * v1 * std::sin(q1), 0.0),
        x2 = x1 + Eigen::Vector3d(l2 * std::sin(q2), -l2 * std::cos(q2), 0.0),
        w2 = w1 + Eigen::Vector3d(l2 * v2 * std::cos(q2), l2 * v2 * std::sin(q2), 0.0);
    const Eigen::Vector3d x = (m1 * x1 + m2 * x2) / m, w = (m1 * w1 + m2 * w2) / m;
    series.centre.row(f) = x;
    series.centre_velocity.row(f) = w;
    series.momentum.row(f) = m1 * (x1 - x).cross(w1 - w) + m2 * (x2 - x).cross(w2 - w);
  }
  for (std::size_t side = 0; side < 2; ++side)
    for (const double along : {-0.2, 0.3})
      for (const double across : {0.05, 0.15}) {
        Eigen::MatrixX3d point = Eigen::MatrixX3d::Zero(frames, 3);
        point.col(0).setConstant(along);
        point.col(2).setConstant(side == 0 ? -across : across);
        series.outline[side].push_back(std::move(point));
      }
  return {};
}

struct Judged {
  std::string id;
  double truth, error, raw_error, sd;
  int inside;  // 1, 0; -1: no interval
  bool approximate;
};

/// Slow errors of skin: a share of both angles, and a drift of its own, together of the stated deviation.
Eigen::VectorXd skin(const MatrixXd& truth, std::size_t j, double sd, double rate_hz, Random& random) {
  const auto n = truth.rows();
  Eigen::VectorXd out = random.gaussian() * truth.col(static_cast<Index>(j)) +
                        random.gaussian() * truth.col(static_cast<Index>(1 - j));
  const double hz = random.uniform(0.3, 1.5), phase = random.uniform(0.0, 6.3);
  for (Index f = 0; f < n; ++f)
    out[f] += 0.3 * std::cos(6.283 * hz * static_cast<double>(f) / rate_hz + phase);
  out.array() -= out.mean();
  return out * (sd / std::sqrt(out.squaredNorm() / static_cast<double>(n)));
}

std::vector<Judged> judge(std::uint64_t seed, bool discrete, bool slow) {
  Random random(seed, discrete ? 21 : 22);
  const auto leg = Leg::draw(random, discrete);
  analysis::BodyRecord record;
  record.time = {.rate_hz = leg.rate_hz, .frames = static_cast<std::int64_t>(leg.duration_s * leg.rate_hz)};
  record.names = {"hip", "knee"};
  record.is_rotation = record.measured = record.driven = {true, true};
  record.is_root = {false, false};
  record.gravity = kGravity;
  record.mass_kg = kMasses[0] + kMasses[1];
  const auto frames = record.frames();
  record.determined = record.torque_known = Eigen::MatrixX<bool>::Constant(frames, 2, true);
  analysis::BodySeries truth;
  truth.q = truth.v = truth.a = MatrixXd(frames, 2);
  for (Index f = 0; f < frames; ++f)
    for (std::size_t j = 0; j < 2; ++j) {
      const auto x = leg.at_time(j, record.time.time_s(f));
      truth.q(f, static_cast<Index>(j)) = x[0];
      truth.v(f, static_cast<Index>(j)) = x[1];
      truth.a(f, static_cast<Index>(j)) = x[2];
    }
  (void)mechanics(truth);
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double white = kDegree * std::exp(random.uniform(std::log(0.1), std::log(1.0)));
  const double skin_sd = slow ? kDegree * random.uniform(1.0, 3.0) : 0.0;
  record.q = truth.q;
  for (std::size_t j = 0; j < 2; ++j) {
    const auto c = static_cast<Index>(j);
    if (slow) record.q.col(c) += skin(truth.q, j, skin_sd, leg.rate_hz, random);
    for (Index f = 0; f < frames; ++f) record.q(f, c) += white * random.gaussian();
  }
  if (slow) record.q_sd = MatrixXd::Constant(frames, 2, std::hypot(white, skin_sd));
  // The samples as they are, with the same differences.
  analysis::BodySeries raw;
  raw.q = record.q;
  raw.v = raw.a = MatrixXd::Zero(frames, 2);
  constexpr Index kMargin = analysis::kDerivativeMargin;
  for (Index c = 0; c < 2; ++c) {
    const auto inside = analysis::differentiate(record.q.col(c), kMargin, frames - 2 * kMargin, leg.rate_hz);
    raw.v.col(c).segment(kMargin, frames - 2 * kMargin) = inside.v.col(0);
    raw.a.col(c).segment(kMargin, frames - 2 * kMargin) = inside.a.col(0);
  }
  (void)mechanics(raw);
  const auto measured = analysis::measure_body(record, mechanics, {.pairs = {{0, 1}}, .seed = seed});
  std::vector<Judged> out;
  if (!measured) return out;
  const Eigen::MatrixX<bool> contact = Eigen::MatrixX<bool>::Constant(frames, 2, true);
  for (const auto& m : measured->measures) {
    const auto& definition = *analysis::find_body_definition(m.id);
    const auto first = record.time.nearest_frame(m.start_s), last = record.time.nearest_frame(m.end_s);
    const Index a = m.subject == "knee" ? 1 : 0;
    const double is =
        definition.value({truth, record, contact, first, last - first + 1, a, 1, data::Side::left, false});
    if (!std::isfinite(is) || !std::isfinite(m.value) || std::abs(is) < 1e-9) continue;
    const double as_it_is =
        definition.value({raw, record, contact, first, last - first + 1, a, 1, data::Side::left, false});
    const auto& i = m.interval;
    const auto apart = [&](double x) {
      return definition.turns ? std::remainder(x - is, 2.0 * std::numbers::pi) : x - is;
    };
    int inside = -1;
    const double at = definition.turns ? m.value - apart(m.value) : is;
    if (i.kind != data::IntervalKind::none) inside = !(at < i.low) && !(at > i.high);
    out.push_back({m.id, is, apart(m.value), apart(as_it_is), m.sd, inside, i.approximate});
  }
  return out;
}

void report(const std::string& family, const std::vector<std::vector<Judged>>& all, double least,
            double most) {
  std::map<std::string, std::vector<Judged>> by_id;
  for (const auto& one : all)
    for (const auto& judged : one) by_id[judged.id].push_back(judged);
  for (const auto& definition : analysis::body_definitions()) {
    const auto found = by_id.find(std::string(definition.what.id));
    if (found == by_id.end()) continue;
    double bias = 0.0, squares = 0.0, inside = 0.0, count = 0.0, known = 0.0, raw = 0.0;
    bool approximate = false;
    for (const auto& judged : found->second) {
      bias += judged.error, squares += judged.error * judged.error, raw += judged.raw_error, count += 1.0;
      approximate = approximate || judged.approximate;
      if (judged.inside >= 0) inside += judged.inside, known += 1.0;
    }
    bias /= count, raw /= count;
    const bool instant = definition.is_instant() && definition.scope == analysis::BodyScope::coordinate;
    if (instant && known < 10.0) continue;  // other instants are nearly as extreme
    const double sd = std::sqrt(std::max(1e-30, squares / count - bias * bias));
    if (sd < 1e-12) continue;  // nothing that errs is in it
    const double coverage = known > 0.0 ? 100.0 * inside / known : 0.0;
    const double from = approximate ? std::min(least, 80.0) : least, to = approximate ? 100.0 : most;
    const bool unbiased = instant || std::abs(bias) <= std::max(0.3 * sd, 0.1 * std::abs(raw)) + 1e-9;
    print_row(known > 0.0 && coverage >= from && coverage <= to && unbiased,
              fmt::format("{}: {}", family, definition.what.id),
              fmt::format("covers {:g} to {:g} %, bias <= 0.1 of the raw one or 0.3 SD", from, to),
              fmt::format("{:.1f} % of {:.0f} (given in {:.0f} %), bias {:.2f} SD, raw {:.2f} SD", coverage,
                          known, 100.0 * known / count, bias / sd, raw / sd));
  }
}

int run(int argc, char** argv) {
  const auto motions = argc > 1 ? std::atoll(argv[1]) : 40;
  const auto first = argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1;
  for (const auto& [name, discrete, slow] :
       {std::tuple{"swinging, white errors", false, false},
        std::tuple{"one swing, white errors", true, false}, std::tuple{"swinging, skin", false, true}}) {
    std::vector<std::vector<Judged>> all(at(motions));
    parallel_for(motions, 1, 0, [&, d = discrete, s = slow](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
        all[at(k)] = judge(first + static_cast<std::uint64_t>(k), d, s);
    });
    report(name, all, slow ? 85.0 : 91.0, slow ? 100.0 : 98.5);
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("motion_measures", run);

}  // namespace
