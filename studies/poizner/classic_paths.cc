// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/classic_paths.h"

#include <array>

#include "kinemark/stages/reconstruction/grid_lookup.h"
#include "kinemark/stages/trajectory/from_counts/classic_chain.h"

namespace kinemark::studies {
namespace {

using Series = std::vector<double>;

Eigen::Matrix3Xd differences(const Eigen::Matrix3Xd& x, double rate_hz) {
  Eigen::Matrix3Xd out(3, x.cols());
  for (int a = 0; a < 3; ++a) {
    const Eigen::VectorXd row = x.row(a);
    const auto d =
        trajectory::two_point_difference({row.data(), static_cast<std::size_t>(row.size())}, rate_hz);
    out.row(a) = Eigen::Map<const Eigen::RowVectorXd>(d.data(), row.size());
  }
  return out;
}

Eigen::Matrix3Xd meet(const data::Rig& classic, const std::array<std::array<Series, 2>, 2>& plane) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(plane[0][0].size()));
  for (Eigen::Index f = 0; f < out.cols(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    const std::array<Eigen::Vector2d, 2> at{Eigen::Vector2d(plane[0][0][i], plane[0][1][i]),
                                            Eigen::Vector2d(plane[1][0][i], plane[1][1][i])};
    out.col(f) = reconstruction::meet_midway(classic.cameras, at);
  }
  return out;
}

}  // namespace

std::vector<ClassicPath> classic_paths(const data::Counts& counts, const data::Rig& classic,
                                       const std::vector<std::uint8_t>& usable) {
  std::vector<ClassicPath> out;
  const auto frames = static_cast<std::size_t>(counts.frames());
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    std::array<std::array<Series, 2>, 2> raw, filtered;  // camera, axis
    for (std::size_t c = 0; c < 2; ++c) {
      std::vector<char> valid(frames);
      for (auto& axis : raw[c]) axis.resize(frames);
      for (std::size_t f = 0; f < frames; ++f) {
        const auto frame = static_cast<std::int64_t>(f), camera = static_cast<std::int64_t>(c);
        const auto at = reconstruction::look_up(
            classic.cameras[c].table, reconstruction::detector_ratios(counts.at(frame, led, camera)));
        valid[f] = usable[counts.index(frame, led, camera)] != 0 && at.allFinite();
        for (std::size_t a = 0; a < 2; ++a) raw[c][a][f] = at[static_cast<Eigen::Index>(a)];
      }
      for (std::size_t a = 0; a < 2; ++a) {
        raw[c][a] = trajectory::bridge_by_spline(raw[c][a], valid);
        filtered[c][a] = trajectory::butterworth_both_ways(raw[c][a], counts.time.rate_hz);
      }
    }
    ClassicPath path;
    path.raw = meet(classic, raw);
    path.filtered = meet(classic, filtered);
    path.velocity = differences(path.filtered, counts.time.rate_hz);
    path.acceleration = differences(path.velocity, counts.time.rate_hz);
    out.push_back(std::move(path));
  }
  return out;
}

}  // namespace kinemark::studies
