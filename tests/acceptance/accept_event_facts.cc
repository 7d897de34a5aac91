// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Labelled events of simulated and real walks, some of them removed, doubled or given to the other side at
// random: what is measured by them is right, or it is said what is wrong with them. Arguments: walkers
// (default 200), first seed (default 1), draws of each real walk (default 6).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/gait/spatiotemporal.h"
#include "kinemark/stages/analysis/gait/testing/known_walk.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using data::GaitEvent;
using testing_support::print_note;
using testing_support::print_row;

constexpr std::array kWalks{"bmc-rajagopal-run/ExpData/motion_capture_run.trc",
                            "btk-others/ADemo1_rewrite_c3d_pc_float.c3d",
                            "btk-others/FunctionalWalk.c3d",
                            "btk-others/Gait.c3d",
                            "btk-others/PiG_Motion3_FF.c3d",
                            "c3d-org/sample01/Eb015pi.c3d",
                            "c3d-org/sample06/MACsample.c3d",
                            "c3d-org/sample10/TYPE-2.C3D",
                            "c3d-org/sample28/dynamic.C3D",
                            "c3d-parser-clinics/MH0222_BP15.c3d",
                            "c3d-parser-clinics/QCMAS.dynamic.c3d",
                            "c3d-parser-clinics/RBWH_bfnd_w1.c3d",
                            "c3d-parser-clinics/S4-AMGait03.c3d",
                            "ezc3d-testFiles/Qualisys.c3d",
                            "nimble-arnold-synthetic/subject01/trials/walk2/markers.trc",
                            "opensim-core-formats/dataWithNaNsWithSpaces.trc",
                            "opensim-core-formats/walking2.c3d",
                            "opensim-gait2354/subject01_walk1.trc",
                            "opensim-hamner-fullbody/subject02_running.trc"};
constexpr double kOwnLabel_s = 0.008, kOfKind_s = 0.012;  // of labels by hand, of all of a kind
constexpr double kWrong = 0.05, kWrongSds = 2.0, kSame_s = 0.05;

// Kinds of what is said of events that contradict something.
constexpr std::array kSaid{"follows another of its kind",
                           "is labelled between",
                           "are exchanged",
                           "is no stride",
                           "run on another clock",
                           "that of the markers",
                           "show of the other foot",
                           "lies outside",
                           "is so short"};

enum class Damage : std::uint8_t { none, removed, doubled, sides, all_sides, kinds };
constexpr std::array kDamages{Damage::none,  Damage::removed,   Damage::doubled,
                              Damage::sides, Damage::all_sides, Damage::kinds};
std::string_view name_of(Damage damage) {
  constexpr std::array<std::string_view, 6> kNames{"as they are",           "some removed",
                                                   "some doubled",          "some of the other side",
                                                   "all of the other side", "strikes and offs exchanged"};
  return kNames[static_cast<std::size_t>(damage)];
}

struct Labelled {
  std::string name;
  data::Trajectories markers;
  std::vector<GaitEvent> events;
};

data::Event label_of(const GaitEvent& event) {
  return {.label = std::string(data::to_string(event.what)),
          .context = std::string(data::to_string(event.side)),
          .time_s = event.time_s};
}

// Events as somebody labels them.
std::vector<GaitEvent> by_hand(std::vector<GaitEvent> events, const TimeBase& time, Random& random) {
  const std::array<double, 2> of_kind{kOfKind_s * random.gaussian(), kOfKind_s * random.gaussian()};
  const double first = time.time_s(0), last = time.time_s(time.frames - 1);
  for (auto& event : events) {
    event.time_s += of_kind[data::index_of(event.what)] + kOwnLabel_s * random.gaussian();
    event.time_s = std::clamp(event.time_s, first, last);
    event.time_s = time.time_s(time.nearest_frame(event.time_s));
  }
  return events;
}

std::vector<GaitEvent> damaged(std::vector<GaitEvent> events, Damage damage, Random& random) {
  const auto any = [&] {
    return static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(events.size()) - 1e-9));
  };
  const int count = 1 + static_cast<int>(random.uniform(0.0, 3.0));
  const auto other_side = [](GaitEvent& event) { event.side = data::opposite(event.side); };
  switch (damage) {
    case Damage::none:
      break;
    case Damage::removed:
      for (int i = 0; i < count && events.size() > 4; ++i)
        events.erase(events.begin() + static_cast<std::ptrdiff_t>(any()));
      break;
    case Damage::doubled:
      for (int i = 0; i < count; ++i) {
        auto again = events[any()];
        again.time_s += (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(0.02, 0.4);
        events.push_back(again);
      }
      break;
    case Damage::sides:
      for (int i = 0; i < count; ++i) other_side(events[any()]);
      break;
    case Damage::all_sides:
      for (auto& event : events) other_side(event);
      break;
    case Damage::kinds:
      for (auto& event : events)
        event.what = event.what == data::FootEvent::strike ? data::FootEvent::off : data::FootEvent::strike;
      break;
  }
  return events;
}

std::optional<analysis::Gait> measured(const Labelled& walk, const std::vector<GaitEvent>& events,
                                       std::uint64_t seed, std::vector<data::Region> regions = {}) {
  std::vector<data::Event> labels;
  for (const auto& event : events) labels.push_back(label_of(event));
  auto gait = analysis::analyze_gait(
      walk.markers, {.plates = nullptr, .events = labels},
      {.choice = analysis::EventChoice::file, .regions = std::move(regions), .refits = 39, .seed = seed});
  return gait ? std::optional(std::move(*gait)) : std::nullopt;
}

// What is said that could be about damage to events.
std::vector<std::string> findings(const analysis::Gait& gait) {
  std::vector<std::string> out;
  for (const auto& note : gait.notes)
    if (std::ranges::any_of(kSaid, [&](const char* part) { return note.find(part) != note.npos; }))
      out.push_back(note);
  return out;
}

struct Score {
  int recordings = 0, measured = 0, said = 0, wrong = 0, unsaid = 0;
  std::vector<std::string> examples;
};

// The time that whole strides cover, in frames.
std::array<std::int64_t, 2> span_of(const Labelled& walk, const analysis::Gait& gait) {
  const auto& time = walk.markers.time;
  double first = gait.cycles.front().start_s, last = gait.cycles.front().end_s;
  for (const auto& cycle : gait.cycles)
    first = std::min(first, cycle.start_s), last = std::max(last, cycle.end_s);
  return {time.nearest_frame(first), time.nearest_frame(last)};
}

// The labels as they are, over the time that whole strides of damaged ones cover: who labels less measures
// less.
std::optional<analysis::Gait> whole_of(const Labelled& walk, const std::vector<GaitEvent>& labels,
                                       const analysis::Gait& whole, const analysis::Gait& gait,
                                       std::uint64_t seed) {
  if (gait.cycles.empty() || whole.cycles.empty()) return std::nullopt;
  const auto span = span_of(walk, gait);
  if (span == span_of(walk, whole)) return whole;
  const auto& time = walk.markers.time;
  return measured(walk, labels, seed,
                  {{.name = "", .first_frame = time.number(span[0]), .last_frame = time.number(span[1])}});
}

// A measure of the labels as they are over the strides that damaged ones show it of; NaN where these are
// others.
double over_the_same(const analysis::Gait& whole, const analysis::Gait& gait, const data::Measure& measure) {
  const auto& definition = *analysis::find_gait_definition(measure.id);
  const auto side_of = [&](const analysis::GaitCycle& cycle) {
    return definition.of_other ? data::opposite(cycle.side) : cycle.side;
  };
  std::vector<analysis::GaitCycle> cycles;
  for (const auto& cycle : gait.cycles) {
    if (definition.scope == analysis::GaitScope::each_side &&
        data::to_string(side_of(cycle)) != measure.context)
      continue;
    const auto same = std::ranges::find_if(whole.cycles, [&](const auto& one) {
      return one.side == cycle.side && std::abs(one.start_s - cycle.start_s) < kSame_s &&
             std::abs(one.end_s - cycle.end_s) < kSame_s;
    });
    if (same == whole.cycles.end()) return kNaN;
    auto one = *same;
    if (!std::isfinite(cycle.off_s)) one.off_s = kNaN;
    if (!std::isfinite(cycle.other_off_s)) one.other_off_s = kNaN;
    if (!std::isfinite(cycle.other_strike_s)) one.other_strike_s = kNaN;
    if (!std::isfinite(cycle.print.x.x())) one.print = cycle.print;
    if (!std::isfinite(cycle.other_print.x.x())) one.other_print = cycle.other_print;
    if (!std::isfinite(cycle.next_print.x.x())) one.next_print = cycle.next_print;
    cycles.push_back(one);
  }
  return definition.value(cycles);
}

// The measures of damaged labels beside those of the labels as they are.
void compare(const Labelled& walk, const analysis::Gait& whole, const analysis::Gait& gait, Score& out) {
  const auto said = findings(gait);
  out.said += !said.empty();
  for (const auto& measure : gait.measures) {
    if (!std::isfinite(measure.value)) continue;
    const auto same = std::ranges::find_if(whole.measures, [&](const data::Measure& one) {
      return one.id == measure.id && one.context == measure.context;
    });
    if (same == whole.measures.end() || !std::isfinite(same->value)) continue;
    ++out.measured;
    const double off = std::abs(measure.value - same->value),
                 sd = std::isfinite(measure.sd) ? measure.sd : 0.0;
    if (off <= kWrong * std::abs(same->value) || off <= kWrongSds * sd) continue;
    // What cannot be distinguished from 0 states an upper end in place of an SD.
    if (measure.interval.kind == data::IntervalKind::at_most && same->value <= measure.interval.high)
      continue;
    // Who labels fewer offs shows double support in fewer strides: right of these.
    if (const double these = over_the_same(whole, gait, measure);
        std::abs(measure.uncorrected - these) <= kWrong * std::abs(these))
      continue;
    ++out.wrong;
    if (!said.empty()) continue;
    ++out.unsaid;
    if (out.examples.size() < 6)
      out.examples.push_back(fmt::format("{}: {} {} {:.4g} for {:.4g}", walk.name, measure.id,
                                         measure.context, measure.value, same->value));
  }
}

class Table {
 public:
  void add(const Labelled& walk, std::uint64_t seed, int draws) {
    Random random(seed, 0x6576);
    for (int draw = 0; draw < draws; ++draw) {
      const auto labels = by_hand(walk.events, walk.markers.time, random);
      const auto whole = measured(walk, labels, seed);
      if (!whole) continue;
      for (const auto damage : kDamages) {
        auto& score = scores_[damage];
        ++score.recordings;
        if (damage == Damage::none) {
          const auto said = findings(*whole);
          score.said += !said.empty();
          if (!said.empty() && score.examples.size() < 6)
            score.examples.push_back(walk.name + ": " + said.front());
        } else if (const auto gait = measured(walk, damaged(labels, damage, random), seed)) {
          if (const auto same = whole_of(walk, labels, *whole, *gait, seed))
            compare(walk, *same, *gait, score);
        } else {
          ++score.said;  // refused
        }
      }
    }
  }

  void join(const Table& other) {
    for (const auto& [damage, score] : other.scores_) {
      auto& to = scores_[damage];
      to.recordings += score.recordings, to.measured += score.measured, to.said += score.said;
      to.wrong += score.wrong, to.unsaid += score.unsaid;
      std::ranges::copy(score.examples, std::back_inserter(to.examples));
    }
  }

  void judge(const std::string& of) const {
    for (const auto& [damage, score] : scores_) {
      const auto name = fmt::format("event_facts, {}, labels {}", of, name_of(damage));
      for (std::size_t i = 0; i < std::min<std::size_t>(6, score.examples.size()); ++i)
        print_note(name, score.examples[i]);
      if (damage == Damage::none)
        print_row(100 * score.said <= score.recordings, name + ", said", "<= 1 %",
                  fmt::format("{} of {}", score.said, score.recordings));
      else
        print_row(score.unsaid == 0, name + ", measures off by 5 % and 2 SD, nothing said", "0",
                  fmt::format("{} of {} ({} of {} measures off; said in {} of {})", score.unsaid, score.wrong,
                              score.wrong, score.measured, score.said, score.recordings));
    }
  }

 private:
  std::map<Damage, Score> scores_;
};

Labelled simulated(std::uint64_t seed) {
  Random random(seed, 11);
  auto walk = analysis::testing::KnownWalk::draw(random);
  walk.treadmill = seed % 2 == 0;
  walk.duration_s = walk.treadmill ? 12.0 : random.uniform(3.5, 6.0);
  return {.name = fmt::format("walker {}", seed),
          .markers = walk.body_markers(1e-3 * random.uniform(0.1, 1.0), seed),
          .events = walk.events()};
}

template <class Of>
Table all_of(int count, Of add) {
  std::vector<Table> tables(static_cast<std::size_t>(count));
  parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
      add(static_cast<std::size_t>(i), tables[static_cast<std::size_t>(i)]);
  });
  Table out;
  for (const auto& table : tables) out.join(table);
  return out;
}

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const int draws = argc > 3 ? std::atoi(argv[3]) : 6;
  all_of(count, [&](std::size_t i, Table& table) {
    table.add(simulated(seed + i), seed + i, 1);
  }).judge("simulated");
  const auto folder = testing_support::test_data_folder();
  if (!folder) return testing_support::skip_all("event_facts");
  all_of(static_cast<int>(kWalks.size()), [&](std::size_t i, Table& table) {
    auto trial = io::read_markers(*folder / kWalks[i]);
    if (!trial) return;
    auto gait = analysis::analyze_gait(trial->markers, {},
                                       {.choice = analysis::EventChoice::kinematics, .refits = 0});
    if (!gait) return;
    table.add({.name = kWalks[i], .markers = std::move(trial->markers), .events = std::move(gait->events)},
              seed + 1000 * (i + 1), draws);
  }).judge("real");
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("event_facts", run);

}  // namespace
