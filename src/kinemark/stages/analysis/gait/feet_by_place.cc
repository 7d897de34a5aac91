// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/feet_by_place.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/gait_names.h"

namespace kinemark::analysis {
namespace {

using data::Side;

constexpr double kLeastSeen = 0.1, kSeenInGroups = 0.5;
constexpr double kLowShare = 0.13, kLow_m = 0.03;                            // of the body's height, and more
constexpr double kLowInGroups = 0.18, kLowInGroups_m = 0.02;                 // where no names pair
constexpr double kShortest_m = 0.07, kLongest_m = 0.35, kMostChange = 0.25;  // of a foot's two markers
constexpr double kEnds = 0.2;  // of the height: the ends of the body
constexpr std::int64_t kFramesLooked = 2000;

struct Marker {
  std::int64_t index = 0;
  std::string name;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // median, against the middle of all, m
  double travel_m = 0.0;                            // how much it moves against the middle of all
};

bool seen(const data::Trajectories& markers, std::int64_t f, std::int64_t m) {
  return markers.state[markers.index(f, m)] == data::SampleState::measured;
}

double deviation(const std::vector<double>& x) {
  double sum = 0.0, squares = 0.0;
  for (const double v : x) sum += v, squares += v * v;
  const auto n = static_cast<double>(x.size());
  return n > 0.0 ? std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n))) : INFINITY;
}

class Search {
 public:
  Search(const data::Trajectories& markers, std::span<const std::int64_t> among) : markers_(markers) {
    const std::int64_t step = std::max<std::int64_t>(1, markers.frames() / kFramesLooked);
    for (std::int64_t f = 0; f < markers.frames(); f += step) frames_.push_back(f);
    std::set<std::string> names;
    for (const auto m : among) names.insert(plain_name(markers.names[at(m)]));
    for (const auto m : among)
      if (const auto name = plain_name(markers.names[at(m)]); share(m) > kLeastSeen && !is_axis(name, names))
        all_.push_back({.index = m, .name = name});
    place();
  }

  [[nodiscard]] std::optional<FeetByPlace> by_pairs() {
    if (all_.size() < 6) return std::nullopt;
    find_height(all_);
    std::map<std::string, std::array<const Marker*, 2>> pairs;
    for (const auto& marker : all_)
      for (const auto& [side, word] : sided_words(marker.name)) pairs[word][data::index_of(side)] = &marker;
    std::vector<std::array<const Marker*, 2>> low;
    for (const auto& [word, pair] : pairs)
      if (pair[0] != nullptr && pair[1] != nullptr && pair[0] != pair[1] &&
          std::max(height(*pair[0]), height(*pair[1])) < kLowShare * tall_m_ + kLow_m)
        low.push_back(pair);
    if (low.empty()) return std::nullopt;
    FeetByPlace out{.feet = {{{low[0][0]->index, low[0][0]->index}, {low[0][1]->index, low[0][1]->index}}},
                    .sides_known = true};
    double best = -INFINITY;
    for (std::size_t i = 0; i < low.size(); ++i)
      for (std::size_t j = i + 1; j < low.size(); ++j) {
        double apart = INFINITY, change = 0.0;
        for (std::size_t side = 0; side < 2; ++side) {
          const auto d = distances(low[i][side]->index, low[j][side]->index);
          apart = std::min(apart, d.empty() ? kNaN : math::median(d));
          change = std::max(change, deviation(d));
        }
        if (!(apart >= kShortest_m && apart <= kLongest_m && change <= kMostChange * apart)) continue;
        if (apart - 2.0 * change <= best) continue;
        best = apart - 2.0 * change;
        const bool first_rises = rise(low[i]) >= rise(low[j]);
        const auto &rear = first_rises ? low[i] : low[j], &front = first_rises ? low[j] : low[i];
        for (std::size_t side = 0; side < 2; ++side) out.feet[side] = {rear[side]->index, front[side]->index};
      }
    return out;
  }

  [[nodiscard]] std::optional<FeetByPlace> by_groups() {
    std::erase_if(all_, [&](const Marker& marker) { return share(marker.index) <= kSeenInGroups; });
    if (all_.size() < 4) return std::nullopt;
    find_height(all_);
    std::vector<const Marker*> low;
    for (const auto& marker : all_)
      if (height(marker) < kLowInGroups * tall_m_ + kLowInGroups_m) low.push_back(&marker);
    if (low.size() < 2) return std::nullopt;
    std::array<std::size_t, 2> poles{0, 1};
    double most = -1.0;
    for (std::size_t i = 0; i < low.size(); ++i)
      for (std::size_t j = i + 1; j < low.size(); ++j)
        if (const auto d = distances(low[i]->index, low[j]->index); d.size() > 4 && deviation(d) > most)
          most = deviation(d), poles = {i, j};
    if (!(most > kShortest_m)) return std::nullopt;
    FeetByPlace out;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto* const pole = low[poles[side]];
      out.feet[side] = {pole->index, pole->index};
      double farthest = 0.0;
      for (const auto* const marker : low) {
        if (marker == pole || marker == low[poles[1 - side]]) continue;
        const auto own = distances(marker->index, pole->index),
                   other = distances(marker->index, low[poles[1 - side]]->index);
        if (own.empty() || other.empty() || deviation(own) > deviation(other)) continue;
        const double apart = math::median(own);
        if (apart <= kLongest_m && apart > farthest && deviation(own) <= kMostChange * apart)
          farthest = apart, out.feet[side][1] = marker->index;
      }
    }
    return out;
  }

 private:
  // Plug-in Gait's bones are points with the same stem and O, A, L, P: no markers.
  static bool is_axis(const std::string& name, const std::set<std::string>& names) {
    if (name.size() < 2 || std::string_view("oalp").find(name.back()) == std::string_view::npos) return false;
    const auto stem = name.substr(0, name.size() - 1);
    return std::ranges::all_of(std::string_view("oalp"),
                               [&](char c) { return names.contains(stem + std::string(1, c)); });
  }

  [[nodiscard]] double share(std::int64_t m) const {
    const auto count = std::ranges::count_if(frames_, [&](auto f) { return seen(markers_, f, m); });
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, frames_.size()));
  }

  void place() {
    std::vector<Eigen::Vector3d> middle;
    for (const auto f : frames_) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double count = 0.0;
      for (const auto& marker : all_)
        if (seen(markers_, f, marker.index)) sum += markers_.x(f, marker.index), count += 1.0;
      middle.emplace_back(sum / count);
    }
    for (auto& marker : all_)
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> x;
        for (std::size_t i = 0; i < frames_.size(); ++i)
          if (seen(markers_, frames_[i], marker.index))
            x.push_back(markers_.x(frames_[i], marker.index)[axis] - middle[i][axis]);
        marker.place[axis] = math::median(x);
        marker.travel_m += deviation(x);
      }
  }

  // The axis along which the body is longest, and which of its ends moves more: there are the feet.
  void find_height(const std::vector<Marker>& markers) {
    double most = -1.0;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> x;
      for (const auto& marker : markers) x.push_back(marker.place[axis]);
      if (const double range = math::quantile(x, 0.95) - math::quantile(x, 0.05); range > most)
        most = range, axis_ = axis;
    }
    std::vector<double> x, at_low, at_high;
    for (const auto& marker : markers) x.push_back(marker.place[axis_]);
    const double low = std::ranges::min(x), high = std::ranges::max(x);
    tall_m_ = high - low;
    for (const auto& marker : markers) {
      if (marker.place[axis_] < low + kEnds * tall_m_) at_low.push_back(marker.travel_m);
      if (marker.place[axis_] > high - kEnds * tall_m_) at_high.push_back(marker.travel_m);
    }
    up_ = math::median(at_low) > math::median(at_high) ? 1.0 : -1.0;
    floor_ = up_ > 0.0 ? low : -high;
  }

  [[nodiscard]] double height(const Marker& marker) const { return up_ * marker.place[axis_] - floor_; }

  [[nodiscard]] std::vector<double> distances(std::int64_t a, std::int64_t b) const {
    std::vector<double> out;
    for (const auto f : frames_)
      if (seen(markers_, f, a) && seen(markers_, f, b))
        out.push_back((markers_.x(f, a) - markers_.x(f, b)).norm());
    return out;
  }

  // How far a pair goes up and down, m, in the mean.
  [[nodiscard]] double rise(const std::array<const Marker*, 2>& pair) const {
    double sum = 0.0;
    for (const auto* const marker : pair) {
      std::vector<double> x;
      for (const auto f : frames_)
        if (seen(markers_, f, marker->index)) x.push_back(markers_.x(f, marker->index)[axis_]);
      sum += 0.5 * (math::quantile(x, 0.95) - math::quantile(x, 0.05));
    }
    return sum;
  }

  const data::Trajectories& markers_;
  std::vector<std::int64_t> frames_;
  std::vector<Marker> all_;
  int axis_ = 2;
  double up_ = 1.0, floor_ = 0.0, tall_m_ = 0.0;
};

}  // namespace

std::optional<FeetByPlace> find_feet_by_place(const data::Trajectories& markers,
                                              std::span<const std::int64_t> among) {
  Search search(markers, among);
  if (auto pairs = search.by_pairs()) return pairs;
  return search.by_groups();
}

}  // namespace kinemark::analysis
