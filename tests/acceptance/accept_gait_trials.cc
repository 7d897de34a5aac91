// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Events of real walks: by markers alone, beside those of the plates and the file's own. `first` judges the
// recordings that were used while the methods were chosen, `unseen` those that were not.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/measures/gait_request.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

constexpr std::array kFirst{"btk-others/PiG_Motion3_FF.c3d", "btk-others/Gait.c3d",
                            "btk-others/ADemo1_rewrite_c3d_pc_float.c3d"};
constexpr std::array kUnseen{"btk-others/FunctionalWalk.c3d", "ezc3d-testFiles/Qualisys.c3d",
                             "c3d-org/sample28/dynamic.C3D", "opensim-core-formats/walking2.c3d"};

struct Score {
  int found = 0, near = 0, one_sd = 0, two_sd = 0, missed = 0;
};

// One source's events beside another's.
void compare(const std::vector<data::GaitEvent>& ours, const std::vector<data::GaitEvent>& theirs,
             double their_sd_s, const std::string& file, const char* whose, Score& score) {
  std::string differences;
  for (const auto& event : theirs) {
    const data::GaitEvent* best = nullptr;
    for (const auto& one : ours)
      if (one.side == event.side && one.what == event.what && std::abs(one.time_s - event.time_s) < 0.15 &&
          (best == nullptr || std::abs(one.time_s - event.time_s) < std::abs(best->time_s - event.time_s)))
        best = &one;
    const auto name = fmt::format("{}{}", event.side == data::Side::left ? "L" : "R",
                                  event.what == data::FootEvent::strike ? "S" : "O");
    if (best == nullptr) {
      ++score.missed;
      differences += fmt::format(" {}-", name);
      continue;
    }
    const double d = best->time_s - event.time_s, sd = std::hypot(best->sd_s, their_sd_s);
    ++score.found;
    score.near += std::abs(d) <= 0.02;
    score.one_sd += std::abs(d) <= sd;
    score.two_sd += std::abs(d) <= 2.0 * sd;
    differences += fmt::format(" {}{:+.0f}", name, 1e3 * d);
  }
  if (!theirs.empty())
    print_note(fmt::format("gait_trials, {}, markers less {}", file, whose), differences + " ms");
}

void judge(const std::string& name, const Score& score, bool with_sd = true) {
  const auto share = [&](int of, int all) { return 100.0 * of / std::max(1, all); };
  const int all = score.found + score.missed;
  print_row(share(score.near, all) >= 95.0, name + " within 20 ms", ">= 95 %",
            fmt::format("{:.1f} % of {}, {} not found", share(score.near, all), all, score.missed));
  if (!with_sd) return;  // a file says nothing of its events' errors
  print_row(share(score.one_sd, score.found) >= 62.0, name + " within one SD", ">= 62 %",
            fmt::format("{:.1f} % of {}", share(score.one_sd, score.found), score.found));
  print_row(share(score.two_sd, score.found) >= 90.0, name + " within two SD", ">= 90 %",
            fmt::format("{:.1f} % of {}", share(score.two_sd, score.found), score.found));
}

int run(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("gait_trials");
  const bool unseen = argc > 1 && std::string_view(argv[1]) == "unseen";
  const std::vector<std::string> files = unseen ? std::vector<std::string>(kUnseen.begin(), kUnseen.end())
                                                : std::vector<std::string>(kFirst.begin(), kFirst.end());
  Score to_plates, to_file, best_to_file;
  for (const auto& file : files) {
    const auto path = *data / file;
    const auto input = pipeline::read_marker_input({.path = path});
    if (!input) {
      print_row(false, "gait_trials, " + file, "read", input.error().message);
      continue;
    }
    auto trial = input->trial;
    const auto own = analysis::events_of_file(trial.events, trial.markers.time).events;
    const auto best = pipeline::measure_gait(path, trial, {});
    const auto plates =
        pipeline::measure_gait(path, trial, {.choice = analysis::EventChoice::plates, .refits = 0});
    trial.force_plates.clear();
    const auto markers = pipeline::measure_gait(path, trial, {});
    if (!markers || !best) {
      print_row(false, "gait_trials, " + file, "measured",
                markers ? best.error().message : markers.error().message);
      continue;
    }
    for (const auto& note : best->notes) print_note("gait_trials, " + file, note);
    if (plates) compare(markers->events, plates->events, 0.003, file, "plates", to_plates);
    const double half_frame = 0.3 / trial.markers.time.rate_hz;
    compare(markers->events, own, half_frame, file, "the file's", to_file);
    compare(best->events, own, half_frame, file, "the file's (best)", best_to_file);
  }
  judge("gait_trials, markers alone beside plates, events", to_plates);
  judge("gait_trials, markers alone beside the file's, events", to_file);
  judge("gait_trials, best beside the file's, events", best_to_file, false);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("gait_trials", run);

}  // namespace
