// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events of real walks and runs by markers alone: beside force plates, spoiled on purpose, and the kind of
// gait. Biases and SDs were learnt on recordings that most of these are among, each laboratory left out in
// turn. Arguments: first seed of what is spoiled (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "acceptance/plate_truth.h"
#include "kinemark/core/random.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using analysis::Gait;
using data::FootEvent;
using data::GaitEvent;
using data::Side;
using testing_support::print_note;
using testing_support::print_row;

struct Recording {
  const char *file, *laboratory, *kind;
};
// "walk ground forward": manner, surface, direction ("?": no front of foot or pelvis is named).
constexpr std::array kGaits{
    Recording{"bmc-rajagopal-run/ExpData/motion_capture_run.trc", "bmc", "run ground forward"},
    Recording{"btk-others/ADemo1_rewrite_c3d_pc_float.c3d", "ADemo1", "walk ground forward"},
    Recording{"btk-others/FunctionalWalk.c3d", "functional", "walk ground forward"},
    Recording{"btk-others/Gait.c3d", "gait", "walk ground forward"},
    Recording{"btk-others/PiG_Motion3_FF.c3d", "pig", "walk ground forward"},
    Recording{"c3d-org/sample01/Eb015pi.c3d", "Eb015", "walk ground ?"},
    Recording{"c3d-org/sample06/MACsample.c3d", "MAC", "walk ground forward"},
    Recording{"c3d-org/sample10/TYPE-2.C3D", "type2", "walk ground forward"},
    Recording{"c3d-org/sample28/dynamic.C3D", "sample28", "walk ground forward"},
    Recording{"c3d-parser-clinics/MH0222_BP15.c3d", "MH", "walk ground forward"},
    Recording{"c3d-parser-clinics/QCMAS.dynamic.c3d", "QCMAS", "walk ground forward"},
    Recording{"c3d-parser-clinics/RBWH_bfnd_w1.c3d", "RBWH", "walk ground forward"},
    Recording{"c3d-parser-clinics/S4-AMGait03.c3d", "S4", "walk ground forward"},
    Recording{"ezc3d-testFiles/Qualisys.c3d", "Qualisys", "walk ground forward"},
    Recording{"nimble-arnold-synthetic/subject01/trials/walk2/markers.trc", "arnold", "walk ground forward"},
    Recording{"opensim-core-formats/dataWithNaNsWithSpaces.trc", "OpenSim run", "run treadmill forward"},
    Recording{"opensim-core-formats/walking2.c3d", "walking2", "walk ground forward"},
    Recording{"opensim-gait2354/subject01_walk1.trc", "gait2354", "walk treadmill forward"},
    Recording{"opensim-hamner-fullbody/subject02_running.trc", "hamner", "run treadmill forward"},
};
constexpr std::array kNoGaits{"biobuddy/static.c3d",
                              "biobuddy/right_knee.c3d",
                              "btk-others/FunctionalLHip.c3d",
                              "btk-others/PiG_Calibration3_FF.c3d",
                              "c3d-org/sample13/Dance.c3d",
                              "c3d-parser-clinics/MH0222_BP08.c3d",
                              "c3d-parser-clinics/MH_Cal_01.c3d",
                              "c3d-parser-clinics/RBWH_Max_Cal_01.c3d",
                              "c3d-parser-clinics/S4_AM_Cal_01.c3d",
                              "cmu-mocap/85_02.c3d",
                              "cmu-mocap/cmu_02_05.c3d",
                              "opensim-gait2354/subject01_static.trc",
                              "pycgm-rom/Sample_Static.c3d"};
constexpr double kNear_s = 0.15, kEnd_s = 0.1;

Result<Gait> by_markers(const data::Trajectories& markers, std::int64_t refits = 0) {
  return analysis::analyze_gait(
      markers, {}, {.choice = analysis::EventChoice::kinematics, .refits = refits, .threads = 0});
}

const GaitEvent* nearest(const std::vector<GaitEvent>& events, const GaitEvent& to) {
  const GaitEvent* best = nullptr;
  for (const auto& event : events)
    if (event.side == to.side && event.what == to.what && std::abs(event.time_s - to.time_s) < kNear_s &&
        (best == nullptr || std::abs(event.time_s - to.time_s) < std::abs(best->time_s - to.time_s)))
      best = &event;
  return best;
}

std::string kind_of(const Gait& gait) {
  return fmt::format(
      "{} {} {}", to_string(gait.kind.manner), gait.kind.belt ? "treadmill" : "ground",
      gait.kind.direction == analysis::GaitDirection::unknown ? "?" : to_string(gait.kind.direction));
}

/// Two labels of a foot in a row that are of one kind miss one of the other between them: no foot strikes
/// twice without leaving. The first of ours there is that one.
bool fills_a_gap(const std::vector<GaitEvent>& labels, const std::vector<GaitEvent>& ours,
                 const GaitEvent& event) {
  const GaitEvent *before = nullptr, *after = nullptr;
  for (const auto& label : labels) {
    if (label.side != event.side) continue;
    if (label.time_s <= event.time_s) before = &label;
    if (label.time_s > event.time_s && after == nullptr) after = &label;
  }
  if (before == nullptr || after == nullptr || before->what == event.what || after->what == event.what)
    return false;
  return std::ranges::none_of(ours, [&](const GaitEvent& other) {
    return other.side == event.side && other.what == event.what && other.time_s > before->time_s &&
           other.time_s < event.time_s;
  });
}

double share(double of, double all) { return 100.0 * of / std::max(1.0, all); }

struct Compared {
  std::string laboratory;
  double error_s, sd_s;
};
struct Found {
  data::Trial trial;
  Gait gait;
  Recording recording;
};

// Errors and losses beside plates, and events that the file has not within what it labels.
class BesidePlates {
 public:
  void add(const Found& one) {
    const auto which = analysis::find_gait_markers(one.trial.markers).value();
    auto smoother = analysis::GaitSmoother::create(one.trial.markers, which, 0.0).value();
    const auto found = analysis::find_marker_events(smoother, which).value();
    const auto& time = one.trial.markers.time;
    std::string errors;
    const auto plates =
        testing_support::plate_truth(one.trial, smoother.paths(), found.steps, smoother.upright());
    for (const auto& plate : plates) {
      const auto& known = smoother.paths().foot(plate.side).known;
      const auto frame = time.nearest_frame(plate.time_s);
      const auto reach = static_cast<std::int64_t>(kEnd_s * time.rate_hz);
      if (frame < reach || frame + reach >= time.frames) continue;
      bool seen = true;
      for (auto f = frame - reach; f <= frame + reach; ++f) seen = seen && known[static_cast<std::size_t>(f)];
      if (!seen) continue;
      ++all_;
      const auto* const ours = nearest(one.gait.events, plate);
      const auto name = fmt::format("{}{}", plate.side == Side::left ? "L" : "R",
                                    plate.what == FootEvent::strike ? "S" : "O");
      if (ours == nullptr) {
        ++lost_;
        errors += fmt::format(" {} lost at {:.2f} s", name, plate.time_s);
        continue;
      }
      errors += fmt::format(" {}{:+.0f}", name, 1e3 * (ours->time_s - plate.time_s));
      compared_[data::index_of(plate.what)].push_back(
          {one.recording.laboratory, ours->time_s - plate.time_s, ours->sd_s});
    }
    if (!errors.empty())
      print_note(fmt::format("gait_events, {}, markers less plates", one.recording.file), errors + " ms");
    const auto labels = analysis::events_of_file(one.trial.events, time).events;
    if (labels.size() < 2) return;
    for (const auto& event : one.gait.events) {
      if (event.time_s < labels.front().time_s - 0.05 || event.time_s > labels.back().time_s + 0.05) continue;
      ++within_labels_;
      const bool labelled = std::ranges::any_of(labels, [&](const GaitEvent& label) {
        return label.what == event.what && label.side == event.side;
      });
      if (!labelled || nearest(labels, event) != nullptr || nearest(plates, event) != nullptr) continue;
      if (fills_a_gap(labels, one.gait.events, event)) continue;
      ++extra_;
      print_note(fmt::format("gait_events, {}, not among its labels", one.recording.file),
                 fmt::format("{} {} at {:.3f} s", data::to_string(event.side), data::to_string(event.what),
                             event.time_s));
    }
    for (const auto& label : labels)
      if (label.time_s > time.time_s(0) + kEnd_s && label.time_s < time.time_s(time.frames - 1) - kEnd_s) {
        ++labels_;
        labels_found_ += nearest(one.gait.events, label) != nullptr;
      }
  }

  void judge() const {
    print_row(share(all_ - lost_, all_) >= 99.0 && all_ >= 40, "gait_events, events of plates found",
              ">= 99 % of 40 or more", fmt::format("{} of {}", all_ - lost_, all_));
    print_row(share(extra_, within_labels_) <= 1.0 || extra_ <= 1,
              "gait_events, events that neither labels nor plates have", "<= 1 %",
              fmt::format("{} of {}", extra_, within_labels_));
    print_row(share(labels_found_, labels_) >= 98.0, "gait_events, the files' own events found", ">= 98 %",
              fmt::format("{} of {}", labels_found_, labels_));
    for (const FootEvent what : data::kFootEvents) judge_errors(what);
  }

 private:
  void judge_errors(FootEvent what) const {
    const auto& all = compared_[data::index_of(what)];
    const auto name = fmt::format("gait_events, {}", to_string(what));
    std::map<std::string, std::vector<double>> by_laboratory;
    for (const auto& one : all) by_laboratory[one.laboratory].push_back(one.error_s);
    double one_sd = 0.0, two_sd = 0.0, squares = 0.0, worst = 0.0, within = 0.0, freedom = 0.0;
    std::vector<double> sds;
    for (const auto& one : all) {
      const double weight = 1.0 / static_cast<double>(by_laboratory[one.laboratory].size()),
                   z = std::abs(one.error_s) / one.sd_s;
      one_sd += weight * (z <= 1.0), two_sd += weight * (z <= 2.0), squares += weight * z * z;
      worst = std::max(worst, z);
      sds.push_back(one.sd_s);
    }
    for (const auto& [laboratory, errors] : by_laboratory) {
      double mean = 0.0;
      for (const double e : errors) mean += e / static_cast<double>(errors.size());
      for (const double e : errors) within += (e - mean) * (e - mean);
      freedom += static_cast<double>(errors.size()) - 1.0;
    }
    const auto n = static_cast<double>(by_laboratory.size());
    const double rms = std::sqrt(squares / n), inside = 1e3 * std::sqrt(within / std::max(1.0, freedom));
    print_row(share(one_sd, n) >= 55.0 && share(one_sd, n) <= 82.0,
              name + " within one SD, each laboratory once", "55-82 %",
              fmt::format("{:.0f} % of {} laboratories, {} events", share(one_sd, n), n, all.size()));
    print_row(share(two_sd, n) >= 88.0, name + " within two SD", "88-100 %",
              fmt::format("{:.0f} %", share(two_sd, n)));
    print_row(rms >= 0.8 && rms <= 1.25, name + ", RMS of error / SD", "0.8-1.25",
              fmt::format("{:.2f}", rms));
    print_row(worst <= 4.0, name + ", largest error", "<= 4 SD", fmt::format("{:.1f} SD", worst));
    print_row(math::median(sds) <= 0.02, name + ", median SD", "<= 20 ms",
              fmt::format("{:.1f} ms", 1e3 * math::median(sds)));
    print_row(inside <= 10.0, name + ", within a recording", "<= 10 ms", fmt::format("{:.1f} ms", inside));
  }

  std::array<std::vector<Compared>, 2> compared_;
  int all_ = 0, lost_ = 0, extra_ = 0, within_labels_ = 0, labels_ = 0, labels_found_ = 0;
};

// ---- recordings spoiled on purpose

using Spoil = std::function<data::Trajectories(data::Trajectories, const analysis::GaitMarkers&, Random&)>;

data::Trajectories every(const data::Trajectories& in, double rate_hz) {
  const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(in.time.rate_hz / rate_hz));
  auto out =
      data::Trajectories::all_missing(in.names, {.rate_hz = in.time.rate_hz / static_cast<double>(step),
                                                 .t0_s = in.time.t0_s,
                                                 .frames = in.frames() / step});
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m)
      if (in.present(f * step, m)) {
        out.x(f, m) = in.x(f * step, m);
        out.state[out.index(f, m)] = in.state[in.index(f * step, m)];
      }
  return out;
}

void each(data::Trajectories& markers, const std::function<void(std::int64_t, std::int64_t)>& change) {
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m)) change(f, m);
}

Spoil noise(double sd_m) {
  return [sd_m](data::Trajectories x, const analysis::GaitMarkers&, Random& random) {
    each(x, [&](auto f, auto m) {
      for (int axis = 0; axis < 3; ++axis) x.x(f, m)[axis] += sd_m * random.gaussian();
    });
    return x;
  };
}

data::Trajectories gaps(data::Trajectories x, const analysis::GaitMarkers& which, Random& random) {
  const double rate = x.time.rate_hz;
  for (const auto& foot : which.feet)
    for (const auto m : {foot.heel, foot.toe})
      for (double t = random.uniform(0.2, 1.0); m >= 0 && t * rate < static_cast<double>(x.frames());
           t += 1.0)
        for (double s = 0.0; s < 0.15 && (t + s) * rate < static_cast<double>(x.frames()) - 1.0;
             s += 1.0 / rate)
          x.set_missing(static_cast<std::int64_t>((t + s) * rate), m);
  return x;
}

data::Trajectories spikes(data::Trajectories x, const analysis::GaitMarkers& which, Random& random) {
  for (const auto& foot : which.feet)
    for (const auto m : {foot.heel, foot.toe})
      for (std::int64_t f = 0; m >= 0 && f < x.frames(); ++f)
        if (random.uniform() < 1.0 / 150.0 && x.present(f, m))
          x.x(f, m)[static_cast<int>(random.uniform(0.0, 3.0))] += 0.3;
  return x;
}

// Turned about the vertical, which then points along -x.
data::Trajectories turned(data::Trajectories x, const analysis::GaitMarkers& which, Random& random) {
  const auto upright = analysis::GaitSmoother::create(x, which, 0.0).value().upright();
  const double a = random.uniform(-3.0, 3.0);
  Eigen::Matrix3d turn, down;
  turn << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  down << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  const Eigen::Matrix3d all = down * turn * upright;
  each(x, [&](auto f, auto m) { x.x(f, m) = (all * x.x(f, m)).eval(); });
  return x;
}

struct Scores {
  int found = 0, all = 0, extra = 0, ours = 0, same_kind = 0, runs = 0;
  std::string changed;
};

// Events of the spoiled recording beside those of the whole one, away from the ends.
void compare(const Found& whole, const data::Trajectories& spoiled, Scores& out) {
  ++out.runs;
  const auto gait = by_markers(spoiled);
  const double from = spoiled.time.time_s(0) + kEnd_s,
               to = spoiled.time.time_s(spoiled.frames() - 1) - kEnd_s;
  const std::vector<GaitEvent> none;
  const auto& events = gait ? gait->events : none;
  for (const auto& event : whole.gait.events)
    if (event.time_s > from && event.time_s < to) {
      ++out.all;
      out.found += nearest(events, event) != nullptr;
    }
  for (const auto& event : events)
    if (event.time_s > from && event.time_s < to) {
      ++out.ours;
      out.extra += nearest(whole.gait.events, event) == nullptr;
    }
  const bool same =
      gait && gait->kind.manner == whole.gait.kind.manner && gait->kind.belt == whole.gait.kind.belt;
  out.same_kind += same;
  if (!same)
    out.changed +=
        fmt::format("; {}: {}", whole.recording.file, gait ? kind_of(*gait) : gait.error().message);
}

void judge_spoils(const std::vector<Found>& recordings, std::uint64_t seed) {
  const std::vector<std::pair<std::string, Spoil>> spoils{
      {"33 Hz", [](const auto& x, const auto&, auto&) { return every(x, 33.0); }},
      {"25 Hz", [](const auto& x, const auto&, auto&) { return every(x, 25.0); }},
      {"noise 5 mm", noise(0.005)},
      {"noise 10 mm", noise(0.01)},
      {"gaps of 0.15 s each second", gaps},
      {"leaps of 300 mm", spikes},
      {"axes exchanged and turned", turned}};
  for (const auto& [name, spoil] : spoils) {
    Scores scores;
    Random random(seed, 100 + name.size());
    for (const auto& one : recordings) {
      const auto which = analysis::find_gait_markers(one.trial.markers).value();
      compare(one, spoil(one.trial.markers, which, random), scores);
    }
    print_row(share(scores.found, scores.all) >= 98.0 && share(scores.extra, scores.ours) <= 2.0,
              "gait_events, " + name, ">= 98 % found, <= 2 % more",
              fmt::format("{} of {}, {} more; walk or run and surface kept in {} of {}{}", scores.found,
                          scores.all, scores.extra, scores.same_kind, scores.runs, scores.changed));
  }
}

// Whether a foot that is hidden or held for 40 % of the recording is said, and the other one keeps its
// events.
void judge_hidden(const std::vector<Found>& recordings, std::uint64_t seed) {
  for (const bool held : {false, true}) {
    Random random(seed, held ? 71 : 72);
    int said = 0, all = 0, kept = 0, others = 0;
    for (const auto& one : recordings)
      for (const Side side : data::kBothSides) {
        auto markers = one.trial.markers;
        const auto which = analysis::find_gait_markers(markers).value();
        const auto n = markers.frames();
        const auto from = static_cast<std::int64_t>(random.uniform(0.05, 0.55) * static_cast<double>(n)),
                   to = from + static_cast<std::int64_t>(0.4 * static_cast<double>(n));
        for (const auto m : {which.foot(side).heel, which.foot(side).toe})
          for (auto f = from + 1; f < to; ++f)
            if (!held)
              markers.set_missing(f, m);
            else if (markers.present(from, m) && markers.present(f, m))
              markers.x(f, m) = Eigen::Vector3d(markers.x(from, m));
        const auto gait = by_markers(markers);
        ++all;
        const std::string foot = side == Side::left ? "left" : "right";
        said += !gait || std::ranges::any_of(gait->notes, [&](const auto& note) {
          return (note.find(foot + " foot") != note.npos && note.find("hidden") != note.npos) ||
                 note.find("no marker of the " + foot + " foot that is seen") != note.npos;
        });
        for (const auto& event : one.gait.events)
          if (event.side != side) {
            ++others;
            kept += gait && nearest(gait->events, event) != nullptr;
          }
      }
    const std::string name = held ? "gait_events, a foot held still" : "gait_events, a foot hidden";
    print_row(said == all, name + ", said", "always", fmt::format("{} of {}", said, all));
    print_row(share(kept, others) >= 95.0, name + ", the other foot's events", ">= 95 %",
              fmt::format("{} of {}", kept, others));
  }
}

int run(int argc, char** argv) {
  const auto folder = testing_support::test_data_folder();
  if (!folder) return testing_support::skip_all("gait_events");
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  std::vector<Found> recordings;
  BesidePlates beside;
  std::string wrong;
  int right = 0;
  for (const auto& recording : kGaits) {
    auto trial = io::read_markers(*folder / recording.file);
    auto gait = trial ? by_markers(trial->markers, 39) : std::unexpected(trial.error());
    const auto kind = gait ? kind_of(*gait) : gait.error().message;
    right += kind == recording.kind;
    if (kind != recording.kind) wrong += fmt::format("; {}: {}", recording.file, kind);
    if (!gait) continue;
    recordings.push_back({std::move(*trial), std::move(*gait), recording});
    beside.add(recordings.back());
  }
  print_row(wrong.empty(), "gait_events, kind of gait", "all",
            fmt::format("{} of {}{}", right, kGaits.size(), wrong));
  beside.judge();
  int refused = 0;
  std::string believed;
  for (const auto* const file : kNoGaits) {
    const auto trial = io::read_markers(*folder / file);
    const auto gait = trial ? by_markers(trial->markers) : std::unexpected(trial.error());
    const bool with_reason = !gait && gait.error().message.starts_with("not locomotion: ");
    refused += with_reason;
    if (!with_reason) believed += fmt::format("; {}: {}", file, gait ? kind_of(*gait) : gait.error().message);
  }
  print_row(believed.empty(), "gait_events, recordings of no gait refused", "all, with the reason",
            fmt::format("{} of {}{}", refused, kNoGaits.size(), believed));
  judge_spoils(recordings, seed);
  judge_hidden(recordings, seed);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("gait_events", run);

}  // namespace
