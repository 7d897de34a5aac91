// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/plate_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kinemark/math/statistics.h"

namespace kinemark::testing_support {
namespace {

using analysis::GaitPaths;
using analysis::Steps;
using data::FootEvent;
using data::Side;
using Eigen::Vector2d;

constexpr double kContact_n = 20.0, kLeastBody_n = 200.0, kMostBody_n = 4000.0, kShareOfMost = 0.03;
constexpr double kLeast_s = 0.08, kBears = 0.35, kSeen = 0.3, kSmeared_s = 0.004, kSmearedTo = 2.5;
constexpr double kFrom = 0.08, kTo = 0.2, kEarly_s = 0.0003, kLateWalk_s = 0.003, kLateRun_s = 0.008;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

// The vertical force of a plate in every analog sample, N, without sign; empty where the type is not known.
std::vector<double> load_of(const data::Trial& trial, const data::ForcePlate& plate) {
  const auto k = static_cast<std::int64_t>(trial.analog.names.size());
  const auto value = [&](std::int64_t sample, int channel) {
    return trial.analog.values[index(sample * k + plate.channel_idx[static_cast<std::size_t>(channel)])];
  };
  std::vector<double> out;
  for (std::int64_t s = 0; s < trial.analog.samples; ++s) {
    double load = 0.0;
    if (plate.type == 3 && plate.channel_idx.size() >= 8)
      for (int c = 4; c < 8; ++c) load += value(s, c);
    else if (plate.type == 4 && plate.calibration.size() >= 36 && plate.channel_idx.size() >= 6)
      for (int c = 0; c < 6; ++c)
        load += plate.calibration[static_cast<std::size_t>(6 * c + 2)] * value(s, c);
    else if ((plate.type == 1 || plate.type == 2) && plate.channel_idx.size() >= 3)
      load = value(s, 2);
    else
      return {};
    out.push_back(load);
  }
  const double up = math::quantile(out, 0.98) > -math::quantile(out, 0.02) ? 1.0 : -1.0;
  for (double& load : out) load *= up;
  const double baseline = math::quantile(out, 0.1);
  // An offset of the amplifier, unless the plate is loaded nearly always.
  if (std::abs(baseline) < 0.15 * math::quantile(out, 0.98))
    for (double& load : out) load -= baseline;
  return out;
}

struct Load {
  std::vector<double> n;
  double rate_hz = 0.0, start_s = 0.0, most = 0.0;
  // Seconds at which the line from a sample to the next passes a level.
  [[nodiscard]] double passes(std::int64_t i, double level) const {
    return start_s +
           (static_cast<double>(i) + (level - n[index(i)]) / (n[index(i + 1)] - n[index(i)])) / rate_hz;
  }
  // Back to zero along the line through 8 and 20 % of the greatest load; `by` 1 from a strike on, -1 back
  // from a leaving.
  [[nodiscard]] std::optional<double> tangent(std::int64_t first, std::int64_t last, int by) const {
    std::int64_t i = by > 0 ? first : last;
    const auto within = [&](std::int64_t k) { return k > first - 1 && k < last + 1; };
    while (within(i) && n[index(i)] < kFrom * most) i += by;
    std::int64_t j = i;
    while (within(j) && n[index(j)] < kTo * most) j += by;
    if (!within(j) || i - by < 0 || i - by >= static_cast<std::int64_t>(n.size())) return std::nullopt;
    const double low = passes(std::min(i, i - by), kFrom * most),
                 high = passes(std::min(j, j - by), kTo * most);
    return low - kFrom * (high - low) / (kTo - kFrom);
  }
};

bool inside(const data::ForcePlate& plate, const Eigen::Matrix3d& upright, const Vector2d& point,
            double grown_m) {
  std::array<Vector2d, 4> c;
  Vector2d middle = Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    c[i] = (upright * plate.corners_in_world[i]).head<2>(), middle += 0.25 * c[i];
  int left = 0, right = 0;
  for (auto& corner : c) corner += grown_m * (corner - middle).normalized();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d edge = c[(i + 1) % 4] - c[i], to = point - c[i];
    (edge.x() * to.y() - edge.y() * to.x() >= 0.0 ? left : right) += 1;
  }
  return left == 0 || right == 0;
}

class Contacts {
 public:
  Contacts(const GaitPaths& paths, const Steps& steps, const Eigen::Matrix3d& upright, bool running)
      : paths_(paths), steps_(steps), upright_(upright), running_(running) {}

  void add(const data::ForcePlate& plate, const Load& load, double threshold,
           std::vector<data::GaitEvent>& out) const {
    const auto n = static_cast<std::int64_t>(load.n.size());
    for (std::int64_t i = 0; i < n; ++i) {
      if (!(load.n[index(i)] > threshold)) continue;
      std::int64_t last = i;
      double most = 0.0;
      while (last + 1 < n && load.n[index(last + 1)] > threshold)
        most = std::max(most, load.n[index(++last)]);
      if (static_cast<double>(last - i) > kLeast_s * load.rate_hz && most > kBears * load.most)
        add_contact(plate, load, threshold, i, last, out);
      i = last;
    }
  }

 private:
  [[nodiscard]] Vector2d heel(Side side, std::int64_t f) const {
    return paths_.foot(side).heel.row(f).leftCols<2>();
  }
  [[nodiscard]] Vector2d toe(Side side, std::int64_t f) const {
    return paths_.foot(side).toe.row(f).leftCols<2>();
  }

  void add_contact(const data::ForcePlate& plate, const Load& load, double threshold, std::int64_t first,
                   std::int64_t last, std::vector<data::GaitEvent>& out) const {
    const auto frame = [&](std::int64_t i) {
      return std::clamp<std::int64_t>(
          std::llround((load.start_s + static_cast<double>(i) / load.rate_hz - paths_.start_s) *
                       paths_.rate_hz),
          0, paths_.frames() - 1);
    };
    const auto from = frame(first), to = frame(last);
    if (to - from < 4) return;
    std::optional<Side> stands;
    std::array<double, 2> speed{1e9, 1e9};
    for (const Side side : data::kBothSides) {
      if (steps_.foot(side).speed.size() == 0) continue;
      const auto quarter = (to - from) / 4;
      speed[data::index_of(side)] =
          steps_.foot(side).speed.segment(from + quarter, to - from - 2 * quarter + 1).mean();
      if (!stands || speed[data::index_of(side)] < speed[data::index_of(*stands)]) stands = side;
    }
    if (!stands || std::max(speed[0], speed[1]) < 2.0 * std::min(speed[0], speed[1])) return;
    const auto third = from + (to - from) / 3;
    // One marker alone has to lie so far inside that the rest of its foot does too.
    const double grown = paths_.foot(*stands).points ? 0.03 : -0.25;
    if (!inside(plate, upright_, heel(*stands, third), grown) ||
        !inside(plate, upright_, toe(*stands, third), grown))
      return;
    std::array<bool, 2> clean{first > 0, last + 1 < static_cast<std::int64_t>(load.n.size())};
    const Side other = data::opposite(*stands);
    if (steps_.foot(other).speed.size() > 0)
      for (auto f = from; f < to; ++f)
        if (steps_.foot(other).speed[f] < 0.3 * steps_.usual[f] &&
            (inside(plate, upright_, heel(other, f), 0.05) || inside(plate, upright_, toe(other, f), 0.05)))
          clean[2 * f < from + to ? 0 : 1] = false;
    std::array<double, 2> at{kNaN, kNaN};
    if (first > 0) at[0] = load.passes(first - 1, threshold);
    if (clean[1]) at[1] = load.passes(last, threshold);
    auto rises = first;
    while (rises < last && load.n[index(rises)] < kSmearedTo * threshold) ++rises;
    if (first > 0 && load.passes(rises - 1, kSmearedTo * threshold) - at[0] > kSmeared_s) {
      if (const auto t = load.tangent(first, last, 1)) at[0] = *t - kEarly_s;
      if (const auto t = load.tangent(first, last, -1)) at[1] = *t + (running_ ? kLateRun_s : kLateWalk_s);
    }
    for (const FootEvent what : data::kFootEvents)
      if (clean[data::index_of(what)] && std::isfinite(at[data::index_of(what)]))
        out.push_back({.side = *stands,
                       .what = what,
                       .time_s = at[data::index_of(what)],
                       .sd_s = 0.003,
                       .source = data::EventSource::plate,
                       .method = "plate"});
  }

  const GaitPaths& paths_;
  const Steps& steps_;
  const Eigen::Matrix3d& upright_;
  bool running_;
};

}  // namespace

std::vector<data::GaitEvent> plate_truth(const data::Trial& trial, const GaitPaths& paths, const Steps& steps,
                                         const Eigen::Matrix3d& upright) {
  std::vector<data::GaitEvent> out;
  std::vector<Load> loads;
  double most = 0.0;
  for (const auto& plate : trial.force_plates) {
    Load load{.n = load_of(trial, plate), .rate_hz = trial.analog.rate_hz, .start_s = paths.start_s};
    for (const double n : load.n) load.most = std::max(load.most, n);
    most = std::max(most, load.most);
    loads.push_back(std::move(load));
  }
  const Contacts contacts(paths, steps, upright,
                          analysis::run_evidence(paths, steps, {0.0, 0.0}).stance_share < 0.45);
  const double threshold = most > kLeastBody_n && most < kMostBody_n ? kContact_n : kShareOfMost * most;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i].n.empty() || most == 0.0 || loads[i].most < kSeen * most) continue;
    loads[i].most = most;
    contacts.add(trial.force_plates[i], loads[i], threshold, out);
  }
  return out;
}

}  // namespace kinemark::testing_support
