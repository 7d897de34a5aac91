// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The whole-trajectory smoother beside least squares: simulated subjects with soft tissue and gaps, whose
// truth is known, and real recordings, of which a tenth is hidden.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "acceptance/ik_recordings.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/smoother/smoother.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

constexpr double kMostUnsettled = 0.5;     // % of the frames
constexpr double kLeastNoise_m = 0.01e-3;  // that the smoother assumes: computed markers have less

double percent(std::int64_t n, std::int64_t of) {
  return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, of));
}

/// Errors of an estimator, summed.
struct Errors {
  double squares = 0.0;
  std::int64_t count = 0;
  void add(double error) {
    squares += error * error;
    ++count;
  }
  void add(const Errors& other) {
    squares += other.squares;
    count += other.count;
  }
  [[nodiscard]] double rms() const {
    return std::sqrt(squares / static_cast<double>(std::max<std::int64_t>(1, count)));
  }
};

struct Tally {
  Errors least_squares, smoother;  ///< over angles that both determine, rad
  Errors alone;                    ///< of the smoother where least squares determines nothing
  std::int64_t frames = 0, unsettled = 0, determined = 0, one = 0, two = 0;

  void add(const Tally& t) {
    least_squares.add(t.least_squares);
    smoother.add(t.smoother);
    alone.add(t.alone);
    frames += t.frames;
    unsettled += t.unsettled;
    determined += t.determined;
    one += t.one;
    two += t.two;
  }
};

std::int64_t unsettled_frames(const data::JointMotion& motion) {
  return std::ranges::count(motion.status, data::FrameStatus::not_converged);
}

Tally compare(const data::JointMotion& ik, const data::JointMotion& smooth, const data::JointMotion& truth) {
  Tally t;
  t.frames = smooth.frames();
  t.unsettled = unsettled_frames(smooth);
  for (std::int64_t f = 0; f < t.frames; ++f)
    for (std::int64_t c = 0; c < smooth.size(); ++c) {
      const auto i = smooth.index(f, c);
      if (!smooth.determined[i]) continue;
      const double error = std::abs(smooth.q[i] - truth.q[i]);
      ++t.determined;
      t.one += error <= smooth.q_sd[i];
      t.two += error <= 2.0 * smooth.q_sd[i];
      if (!smooth.is_rotation[static_cast<std::size_t>(c)]) continue;
      if (!ik.determined[i]) {
        t.alone.add(error);
        continue;
      }
      t.smoother.add(error);
      t.least_squares.add(ik.q[i] - truth.q[i]);
    }
  return t;
}

/// Subjects of every kind of motion, with full soft tissue and a fifth of the samples missing.
void check_subjects(int subjects, std::uint64_t first_seed) {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  Tally all;
  int worse = 0;
  double worst = 0.0;
  for (int s = 0; s < subjects; ++s) {
    simulation::SubjectOptions options;
    options.motion = static_cast<simulation::MotionKind>(s % 4);
    options.duration_s = 8.0;
    options.rate_hz = 60.0;
    options.seed = first_seed + static_cast<std::uint64_t>(s);
    options.soft_tissue = 1.0;
    options.dropout_random = options.dropout_sight = 0.1;
    const auto subject = simulation::simulate_subject(model, options).value();
    const auto ik = motion::solve_ik(model, subject.markers).value();
    const auto smooth = motion::smooth_motion(model, subject.markers).value();
    const Tally t = compare(ik.motion, smooth.motion, subject.truth);
    const double ratio = t.smoother.rms() / t.least_squares.rms();
    worse += ratio > 1.0;
    worst = std::max(worst, ratio);
    print_note(fmt::format("smoother, subject {}, {}", options.seed, to_string(options.motion)),
               fmt::format("{:.3f} deg against {:.3f} deg; {:.3f} deg beyond; {:.1f} / {:.1f} %; {} of {} "
                           "frames not converged",
                           kDegPerRad * t.smoother.rms(), kDegPerRad * t.least_squares.rms(),
                           kDegPerRad * t.alone.rms(), percent(t.one, t.determined),
                           percent(t.two, t.determined), t.unsettled, t.frames));
    all.add(t);
  }
  const auto name = fmt::format("smoother, {} subjects with soft tissue and gaps", subjects);
  print_row(percent(all.unsettled, all.frames) <= kMostUnsettled, name + ": frames not converged",
            fmt::format("<= {} %", kMostUnsettled),
            fmt::format("{:.2f} %", percent(all.unsettled, all.frames)));
  print_row(all.smoother.rms() <= all.least_squares.rms(), name + ": RMS error of angles that both determine",
            "<= least squares'",
            fmt::format("{:.3f} deg against {:.3f} deg", kDegPerRad * all.smoother.rms(),
                        kDegPerRad * all.least_squares.rms()));
  print_row(worse == 0, name + ": subjects with a larger RMS error than least squares", "none",
            fmt::format("{}; the worst has {:.3f} times that of least squares", worse, worst));
  const double one = percent(all.one, all.determined), two = percent(all.two, all.determined);
  print_row(one >= 60.0 && one <= 75.0 && two >= 90.0 && two <= 98.0, name + ": coverage",
            "60-75 % within 1 SD, 90-98 % within 2 SD", fmt::format("{:.1f} % and {:.1f} %", one, two));
}

/// Hide stretches of 0.05 to 0.3 s, a tenth of all samples. Returns which ones (recording's frames x
/// markers).
std::vector<std::uint8_t> hide(data::Trajectories& t, std::uint64_t seed) {
  Random random(seed, 0x68696465);
  std::vector<std::uint8_t> hidden(t.state.size(), 0);
  const double rate = t.time.rate_hz;
  for (std::int64_t m = 0; m < t.markers(); ++m)
    for (auto f = static_cast<std::int64_t>(random.uniform(0.0, 3.0) * rate); f < t.frames();) {
      const auto length =
          std::max<std::int64_t>(1, static_cast<std::int64_t>(random.uniform(0.05, 0.3) * rate));
      for (const auto last = std::min(t.frames(), f + length); f < last; ++f) {
        if (!t.present(f, m)) continue;
        hidden[static_cast<std::size_t>(f * t.markers() + m)] = 1;
        t.set_missing(f, m);
      }
      f += static_cast<std::int64_t>(random.uniform(1.0, 2.2) * rate);
    }
  return hidden;
}

/// Coordinates that least squares determines in most frames; others (locked, or without markers) never count.
std::vector<int> usual_coordinates(const data::JointMotion& motion) {
  std::vector<int> usual;
  for (int c = 0; c < motion.size(); ++c) {
    std::int64_t determined = 0;
    for (std::int64_t f = 0; f < motion.frames(); ++f) determined += motion.determined[motion.index(f, c)];
    if (2 * determined > motion.frames()) usual.push_back(c);
  }
  return usual;
}

/// Distance of the hidden samples from where a motion has their markers, in frames in which least squares
/// determines every usual coordinate.
Errors hidden_errors(const testing_support::IkCase& c, const std::vector<std::uint8_t>& hidden,
                     const data::MarkerFit& fit, const data::JointMotion& motion,
                     const data::JointMotion& reference) {
  Errors errors;
  model::Workspace w(c.model);
  Eigen::VectorXd q(motion.size());
  const auto usual = usual_coordinates(reference);
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    if (!std::ranges::all_of(usual, [&](int k) { return reference.determined[reference.index(f, k)] != 0; }))
      continue;
    std::copy_n(motion.q.data() + motion.index(f, 0), q.size(), q.data());
    model::kinematics(c.model, w, model::state_from_coordinates(c.model, q));
    for (const auto& marker : fit.markers) {
      const auto column = c.markers.find(marker.name_in_data);
      if (!hidden[static_cast<std::size_t>((fit.first_frame + f) * c.markers.markers() + column)]) continue;
      const int m = c.model.description().find_marker(marker.name);
      errors.add((c.markers.x(fit.first_frame + f, column) - w.marker.col(m)).norm());
    }
  }
  return errors;
}

void check_recordings(const std::set<std::string>& named, std::uint64_t first_seed, int draws) {
  const auto data = testing_support::test_data_folder();
  if (!data) {
    (void)testing_support::skip_all("the smoother on recordings");
    return;
  }
  for (const auto& recording : testing_support::ik_recordings()) {
    if (!named.empty() && !named.contains(recording.name)) continue;
    auto c = testing_support::open_ik_recording(*data, recording);
    c.options.coordinate_tasks.clear();  // the smoother takes none
    motion::SmootherOptions options;
    options.ik = c.options;
    const auto whole = motion::smooth_motion(c.model, c.markers, options).value();
    const double ik_mm = 1e3 * motion::solve_ik(c.model, c.markers, c.options).value().fit.rms_error_m;
    const auto unsettled = unsettled_frames(whole.motion);
    print_row(percent(unsettled, whole.motion.frames()) <= kMostUnsettled,
              fmt::format("smoother, {}: frames not converged", recording.name),
              fmt::format("<= {} %", kMostUnsettled),
              fmt::format("{:.2f} %, {} steps; markers {:.3f} mm RMS from the model, least squares {:.3f} mm",
                          percent(unsettled, whole.motion.frames()), whole.iterations,
                          1e3 * whole.fit.rms_error_m, ik_mm));
    Errors least_squares, smoother;
    for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(draws); ++seed) {
      data::Trajectories partial = c.markers;
      const auto hidden = hide(partial, seed);
      const auto ik = motion::solve_ik(c.model, partial, c.options).value();
      const auto smooth = motion::smooth_motion(c.model, partial, options).value();
      least_squares.add(hidden_errors(c, hidden, ik.fit, ik.motion, ik.motion));
      smoother.add(hidden_errors(c, hidden, smooth.fit, smooth.motion, ik.motion));
    }
    const auto name = fmt::format("smoother, {}: RMS distance of hidden samples", recording.name);
    if (smoother.count == 0) {
      print_note(name, "without any one of its markers least squares determines nothing");
      continue;
    }
    print_row(smoother.rms() <= std::max(least_squares.rms(), kLeastNoise_m), name,
              "<= least squares', or <= 0.01 mm, the least noise that it assumes",
              fmt::format("{:.4f} mm against {:.4f} mm, {} samples", 1e3 * smoother.rms(),
                          1e3 * least_squares.rms(), smoother.count));
  }
}

/// accept_motion smoother subjects|recordings [RECORDING...] [seed=N] [draws=N]
int run_check(int argc, char** argv) {
  std::uint64_t seed = 1;
  int draws = 3;
  std::set<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("draws="))
      draws = std::stoi(word.substr(6));
    else if (word.starts_with("seed="))
      seed = std::stoull(word.substr(5));
    else
      words.insert(word);
  }
  if (words.erase("subjects") > 0)
    check_subjects(draws, seed);
  else if (words.erase("recordings") > 0)
    check_recordings(words, seed, draws);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("smoother", run_check);

}  // namespace
