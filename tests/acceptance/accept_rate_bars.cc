// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Deviations of rates that are estimated from angles alone, along real movements with white noise on each
// angle.
#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "acceptance/real_movements.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/stages/motion/smoother/coordinate_smoother.h"
#include "kinemark/stages/motion/smoother/rates.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_row;

constexpr double kMargin_s = 0.1;  // left out at both ends

/// Errors of one kind of number: angle, rate, acceleration.
struct Tally {
  std::int64_t all = 0, one = 0, two = 0;
  double squares = 0.0;
  void add(double error, double variance) {
    ++all;
    one += error * error <= variance;
    two += error * error <= 1.96 * 1.96 * variance;
    squares += error * error;
  }
  [[nodiscard]] double share(std::int64_t n) const {
    return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, all));
  }
  [[nodiscard]] std::string words() const {
    return fmt::format("{:.1f} / {:.1f} %, {:.3g} deg RMS", share(one), share(two),
                       kDegPerRad * std::sqrt(squares / static_cast<double>(std::max<std::int64_t>(1, all))));
  }
};

/// accept_motion rate_bars [RECORDING...] [seed=N] [draws=N] [rate=HZ] [noise=DEG]
int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("deviations of rates along real movements");
  std::uint64_t seed = 1;
  int draws = 2;
  double rate_hz = 0.0;
  std::vector<double> noises_deg = {0.2, 1.0};
  std::set<std::string> named;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("draws="))
      draws = std::stoi(word.substr(6));
    else if (word.starts_with("seed="))
      seed = std::stoull(word.substr(5));
    else if (word.starts_with("rate="))
      rate_hz = std::stod(word.substr(5));
    else if (word.starts_with("noise="))
      noises_deg = {std::stod(word.substr(6))};
    else
      named.insert(word);
  }
  Tally all;
  for (const auto& recording : testing_support::ik_recordings()) {
    if (!named.contains(recording.name)) continue;
    const auto c = testing_support::open_ik_recording(*data, recording);
    const auto truth = testing_support::real_movement(c, rate_hz > 0.0 ? rate_hz : c.markers.time.rate_hz);
    const auto& time = truth.markers.time;
    const auto margin = static_cast<Eigen::Index>(kMargin_s * time.rate_hz);
    for (const double noise_deg : noises_deg) {
      Tally rate, acceleration;
      for (int d = 0; d < draws; ++d) {
        Random random(seed + static_cast<std::uint64_t>(d), 0x72617465);
        data::JointMotion motion;
        data::set_coordinates(c.model.description(), motion);
        motion.time = time;
        for (Eigen::Index f = 0; f < truth.q.cols(); ++f)
          for (Eigen::Index k = 0; k < truth.q.rows(); ++k)
            motion.q.push_back(truth.q(k, f) + noise_deg * kRadPerDeg * random.gaussian());
        motion.q_sd.assign(motion.q.size(), 2.0 * noise_deg * kRadPerDeg);  // skin and all
        const auto errors = motion::estimate_rates(c.model, motion).value();
        Eigen::VectorXd v, a;
        for (Eigen::Index k = 0; k < truth.q.rows(); ++k) {
          motion::five_point_rates(truth.q.row(k), time.rate_hz, v, a);
          if (motion.is_rotation[static_cast<std::size_t>(k)] == 0 || v.cwiseAbs().maxCoeff() < 1e-6)
            continue;
          for (Eigen::Index f = margin; f + margin < truth.q.cols(); ++f) {
            const auto i = motion.index(f, k);
            if (!(errors.covariance[6 * i + 3] > 0.0)) continue;
            rate.add(motion.qd[i] - v[f], errors.covariance[6 * i + 3]);
            acceleration.add(motion.qdd[i] - a[f], errors.covariance[6 * i + 5]);
          }
        }
      }
      all.all += rate.all, all.one += rate.one, all.two += rate.two;
      print_row(
          rate.share(rate.one) >= 60.0 && rate.share(rate.two) >= 90.0,
          fmt::format("rates along {}, {:g} Hz, {:g} deg of noise", recording.name, time.rate_hz, noise_deg),
          "60 % within 1 SD and 90 % within 1.96, or more",
          fmt::format("{}/s; accelerations {}/s^2", rate.words(), acceleration.words()));
    }
  }
  const double one = all.share(all.one), two = all.share(all.two);
  print_row(one >= 60.0 && one <= 75.0 && two >= 90.0 && two <= 98.0, "rates along all of these",
            "60-75 % within 1 SD, 90-98 % within 1.96", fmt::format("{:.1f} and {:.1f} %", one, two));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("rate_bars", run_check);

}  // namespace
