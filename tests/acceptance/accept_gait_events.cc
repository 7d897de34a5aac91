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
#include <map>
#include <string>
#include <vector>

#include "acceptance/gait_recordings.h"
#include "acceptance/plate_truth.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using namespace kinemark::acceptance;
using data::FootEvent;
using data::GaitEvent;
using data::Side;
using testing_support::print_note;
using testing_support::print_row;

constexpr std::array kGaits{
    GaitRecording{"bmc-rajagopal-run/ExpData/motion_capture_run.trc", "bmc", "run ground forward"},
    GaitRecording{"btk-others/ADemo1_rewrite_c3d_pc_float.c3d", "ADemo1", "walk ground forward"},
    GaitRecording{"btk-others/FunctionalWalk.c3d", "functional", "walk ground forward"},
    GaitRecording{"btk-others/Gait.c3d", "gait", "walk ground forward"},
    GaitRecording{"btk-others/PiG_Motion3_FF.c3d", "pig", "walk ground forward"},
    GaitRecording{"c3d-org/sample01/Eb015pi.c3d", "Eb015", "walk ground ?"},
    GaitRecording{"c3d-org/sample06/MACsample.c3d", "MAC", "walk ground forward"},
    GaitRecording{"c3d-org/sample10/TYPE-2.C3D", "type2", "walk ground forward"},
    GaitRecording{"c3d-org/sample28/dynamic.C3D", "sample28", "walk ground forward"},
    GaitRecording{"c3d-parser-clinics/MH0222_BP15.c3d", "MH", "walk ground forward"},
    GaitRecording{"c3d-parser-clinics/QCMAS.dynamic.c3d", "QCMAS", "walk ground forward"},
    GaitRecording{"c3d-parser-clinics/RBWH_bfnd_w1.c3d", "RBWH", "walk ground forward"},
    GaitRecording{"c3d-parser-clinics/S4-AMGait03.c3d", "S4", "walk ground forward"},
    GaitRecording{"ezc3d-testFiles/Qualisys.c3d", "Qualisys", "walk ground forward"},
    GaitRecording{"nimble-arnold-synthetic/subject01/trials/walk2/markers.trc", "arnold",
                  "walk ground forward"},
    GaitRecording{"opensim-core-formats/dataWithNaNsWithSpaces.trc", "OpenSim run", "run treadmill forward"},
    GaitRecording{"opensim-core-formats/walking2.c3d", "walking2", "walk ground forward"},
    GaitRecording{"opensim-gait2354/subject01_walk1.trc", "gait2354", "walk treadmill forward"},
    GaitRecording{"opensim-hamner-fullbody/subject02_running.trc", "hamner", "run treadmill forward"},
};
constexpr std::array kNoGaits{"biobuddy/static.c3d",
                              "biobuddy/right_knee.c3d",
                              "btk-others/FunctionalLHip.c3d",
                              "btk-others/PiG_Calibration3_FF.c3d",
                              "c3d-org/sample13/Dance.c3d",
                              "c3d-parser-clinics/MH0222_BP08.c3d",
                              "c3d-parser-clinics/MH_Cal_01.c3d",
                              "c3d-parser-clinics/S4_AM_Cal_01.c3d",
                              "cmu-mocap/85_02.c3d",
                              "cmu-mocap/cmu_02_05.c3d",
                              "opensim-gait2354/subject01_static.trc",
                              "pycgm-rom/Sample_Static.c3d"};
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

struct Compared {
  std::string laboratory;
  double error_s, sd_s;
};
// Errors and losses beside plates, and events that the file has not within what it labels.
class BesidePlates {
 public:
  void add(const GaitFound& one) {
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

int run(int argc, char** argv) {
  const auto folder = testing_support::test_data_folder();
  if (!folder) return testing_support::skip_all("gait_events");
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  std::vector<GaitFound> recordings;
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
