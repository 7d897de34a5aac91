// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Sentences that name a statistic or a defect: said where it was planted, and not said where it was not.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/finding.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/stages/skeleton/functional/slip.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using data::FindingKind;
using testing_support::print_row;

constexpr double kRateHz = 100.0;

/// How often a sentence was said.
struct Said {
  int planted = 0, cases = 0;          ///< said among cases in which it must be
  int elsewhere = 0, other_cases = 0;  ///< said among cases in which it must not be
};

void print(const std::string& sentence, const Said& said, double least, double most) {
  const double right = static_cast<double>(said.planted) / said.cases,
               wrong = static_cast<double>(said.elsewhere) / said.other_cases;
  print_row(right >= least && wrong <= most, "sentence \"" + sentence + "\"",
            fmt::format("in >= {:.0f} % where it must be said, <= {:.0f} % where it must not", 100.0 * least,
                        100.0 * most),
            fmt::format("{} of {}, {} of {}", said.planted, said.cases, said.elsewhere, said.other_cases));
}

/// A movement of 0.4 to 3 Hz with noise of 0.5 mm, each sample of it `keeps` times the one before plus news.
data::Trajectories coloured_marker(std::uint64_t seed, double keeps) {
  constexpr std::int64_t kFrames = 1000;
  Random random(seed, 0x73656e74);
  auto in = data::Trajectories::all_missing({"M"}, {.rate_hz = kRateHz, .frames = kFrames});
  const Eigen::Vector3d phase(random.uniform(), random.uniform(), random.uniform());
  const double base_hz = random.uniform(0.4, 1.0);
  const double news_m = 5e-4 * std::sqrt(1.0 - keeps * keeps);
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();
  for (std::int64_t f = 0; f < kFrames; ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      noise[axis] = keeps * noise[axis] + news_m * random.gaussian();
      for (int k = 1; k <= 3; ++k)
        in.x(f, 0)[axis] =
            (k == 1 ? noise[axis] : in.x(f, 0)[axis]) +
            0.1 / (k * k) *
                std::sin(2.0 * M_PI * (k * base_hz * static_cast<double>(f) / kRateHz + k * k * phase[axis]));
    }
    in.state[static_cast<std::size_t>(f)] = data::SampleState::measured;
  }
  return in;
}

data::MarkerAccount account_of(const data::Trajectories& in) {
  return trajectory::smooth(in).value().markers.front();
}

void whiteness(std::uint64_t seed, int draws) {
  Said white, coloured;
  for (int i = 0; i < draws; ++i) {
    const auto stream = seed + static_cast<std::uint64_t>(i);
    const double keeps = i % 4 == 0 ? 0.5 : i % 4 == 2 ? -0.85 : 0.0;
    const auto words = account_of(coloured_marker(stream, keeps)).description;
    Said& right = keeps == 0.0 ? white : coloured;
    Said& wrong = keeps == 0.0 ? coloured : white;
    ++right.cases;
    ++wrong.other_cases;
    (keeps == 0.0 ? white.planted : white.elsewhere) += words.contains("is consistent with white noise");
    (keeps == 0.0 ? coloured.elsewhere : coloured.planted) += words.contains("is not white");
  }
  print("the residual is consistent with white noise", white, 0.95, 0.05);
  print("the residual is not white", coloured, 0.95, 0.03);
}

/// A movement whose third derivative is white, in white noise: order 3 describes it best.
data::Trajectories rough_marker(std::uint64_t seed) {
  constexpr std::int64_t kFrames = 300;
  Random random(seed, 0x726f7567);
  auto in = data::Trajectories::all_missing({"M"}, {.rate_hz = kRateHz, .frames = kFrames});
  Eigen::Vector3d x = Eigen::Vector3d::Zero(), velocity = x, acceleration = x;
  for (std::int64_t f = 0; f < kFrames; ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      acceleration[axis] += 2.0 * random.gaussian();
      in.x(f, 0)[axis] = x[axis] + 1e-3 * random.gaussian();
    }
    velocity += acceleration / kRateHz;
    x += velocity / kRateHz;
    in.state[static_cast<std::size_t>(f)] = data::SampleState::measured;
  }
  return in;
}

/// "the least expected error (SURE)" is true of the order taken, or not, by the table of what was tried.
void least_sure(std::uint64_t seed, int draws) {
  Said least;
  for (int i = 0; i < draws; ++i) {
    const auto stream = seed + static_cast<std::uint64_t>(i);
    const auto account = account_of(i % 2 == 0 ? rough_marker(stream) : coloured_marker(stream, 0.0));
    const auto best = std::ranges::min_element(account.candidates, {}, &data::FilterCandidate::criterion);
    const bool said = account.description.contains("the least expected error (SURE)");
    if (best->order == account.used.order) {
      ++least.cases;
      least.planted += said;
    } else {
      ++least.other_cases;
      least.elsewhere += said;
    }
  }
  print("the least expected error (SURE)", least, 1.0, 0.0);
}

/// A simulated subject with skin motion, and its segments as screening and slip search know them.
struct Subject {
  data::Trajectories markers;
  data::SegmentLayout layout;  ///< bodies with four markers or more
};

Subject simulate(const model::Model& model, std::uint64_t seed) {
  simulation::SubjectOptions options;
  options.motion = static_cast<simulation::MotionKind>(seed % 4);
  options.duration_s = 6.0;
  options.rate_hz = kRateHz;
  options.seed = seed;
  options.soft_tissue = 0.3;
  Subject subject{.markers = simulation::simulate_subject(model, options).value().markers, .layout = {}};
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    data::SegmentLayout::Segment segment{.name = model.description().bodies[b].name, .markers = {}};
    for (int m = 0; m < model.marker_count(); ++m)
      if (model.markers()[static_cast<std::size_t>(m)].body == static_cast<int>(b))
        segment.markers.push_back(static_cast<int>(
            subject.markers.find(model.description().markers[static_cast<std::size_t>(m)].name)));
    if (segment.markers.size() >= 4) subject.layout.segments.push_back(std::move(segment));
  }
  return subject;
}

bool names_both(const std::string& words, const std::string& a, const std::string& b) {
  return words.contains("'" + a + "'") && words.contains("'" + b + "'");
}

/// True when a finding of the kind says the phrase and the names.
bool said(const std::vector<data::Finding>& findings, const TimeBase& time, FindingKind kind,
          const std::string& phrase, const std::string& a, const std::string& b) {
  return std::ranges::any_of(findings, [&](const data::Finding& f) {
    const auto words = describe(f, time);
    return f.kind == kind && words.contains(phrase) && names_both(words, a, b);
  });
}

bool said_at_all(const std::vector<data::Finding>& findings, FindingKind kind) {
  return std::ranges::any_of(findings, [&](const data::Finding& f) { return f.kind == kind; });
}

/// Two markers 60 mm apart or more, drawn at random.
std::pair<std::int64_t, std::int64_t> two_markers(const data::Trajectories& t, std::int64_t frame,
                                                  Random& random) {
  const auto draw = [&] {
    return std::min(t.markers() - 1,
                    static_cast<std::int64_t>(random.uniform() * static_cast<double>(t.markers())));
  };
  while (true) {
    const auto a = draw(), b = draw();
    if ((t.x(frame, a) - t.x(frame, b)).norm() > 0.06) return {a, b};
  }
}

void defects(std::uint64_t seed, int draws) {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  Said swap, visit, slip;
  for (int i = 0; i < draws; ++i) {
    const auto stream = seed + static_cast<std::uint64_t>(i);
    Random random(stream, 0x64656665);
    const Subject clean = simulate(model, stream);
    const auto& time = clean.markers.time;
    const auto none = trajectory::screen(clean.markers).value();
    const auto no_slip = skeleton::find_slips(clean.markers, clean.layout).value();
    for (Said* s : {&swap, &visit, &slip}) ++s->cases, ++s->other_cases;
    swap.elsewhere += said_at_all(none, FindingKind::label_swap);
    visit.elsewhere += said_at_all(none, FindingKind::swap_within);
    slip.elsewhere += said_at_all(no_slip, FindingKind::marker_slip);

    const auto first = static_cast<std::int64_t>(random.uniform(150.0, 300.0)),
               last = first + static_cast<std::int64_t>(random.uniform(20.0, 100.0));
    const auto [a, b] = two_markers(clean.markers, first, random);
    const auto name = [&](std::int64_t m) { return clean.markers.names[static_cast<std::size_t>(m)]; };

    auto t = clean.markers;
    for (auto f = first; f <= last; ++f) {
      const Eigen::Vector3d x = t.x(f, a);
      t.x(f, a) = t.x(f, b);
      t.x(f, b) = x;
    }
    const auto exchanged = trajectory::screen(t).value();
    swap.planted +=
        said(exchanged, time, FindingKind::label_swap, "exchanged back they continue", name(a), name(b));

    t = clean.markers;
    for (auto f = first; f < first + 10; ++f) {
      t.x(f, a) = t.x(f, b);
      t.set_missing(f, b);
    }
    const auto visited = trajectory::screen(t).value();
    visit.planted += said(visited, time, FindingKind::swap_within, "to the path of", name(a), name(b));

    // A marker slides by 25 mm on its segment.
    t = clean.markers;
    const auto& segments = clean.layout.segments;
    const auto& segment =
        segments[static_cast<std::size_t>(std::min(random.uniform() * static_cast<double>(segments.size()),
                                                   static_cast<double>(segments.size()) - 1.0))];
    const int m = segment.markers[static_cast<std::size_t>(random.uniform() * 3.99)];
    const int other = segment.markers[segment.markers[0] == m ? 1 : 0];
    for (auto f = first; f < t.frames(); ++f)
      t.x(f, m) += 0.025 * (clean.markers.x(f, other) - clean.markers.x(f, m)).normalized();
    slip.planted += said(skeleton::find_slips(t, clean.layout).value(), time, FindingKind::marker_slip,
                         "moved", name(m), segment.name);
  }
  print("are exchanged in ...: exchanged back they continue their paths ... times better", swap, 0.95, 0.0);
  print("jumps to the path of ... and back to its own", visit, 0.95, 0.0);
  print("moved on its segment", slip, 0.95, 0.0);
}

/// accept_motion sentences [DRAWS] [SEED]
int run_check(int argc, char** argv) {
  const int draws = argc > 1 ? std::stoi(argv[1]) : 20;
  const std::uint64_t seed = argc > 2 ? std::stoull(argv[2]) : 1;
  whiteness(seed, 20 * draws);
  least_sure(seed, 10 * draws);
  defects(seed, draws);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("sentences", run_check);

}  // namespace
