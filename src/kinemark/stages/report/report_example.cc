// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// report_example PAGE.html [FRAMES]: the report of a made-up trial, for looking at the page and testing it in
// a browser.
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "kinemark/stages/report/ik_report.h"
#include "kinemark/stages/report/internal/example_trial.h"

int main(int argc, char** argv) {
  using namespace kinemark;
  const std::int64_t frames = argc > 2 ? std::strtoll(argv[2], nullptr, 10) : 600;
  if (argc < 2 || frames < 100) {
    std::cerr << "usage: report_example PAGE.html [FRAMES, at least 100]\n";
    return 2;
  }
  const report::internal::ExampleTrial trial = report::internal::example_trial(frames);
  auto summary = report::summarize(trial.run, trial.motion, &trial.markers);
  if (!summary) {
    std::cerr << summary.error().message << '\n';
    return exit_status(summary.error().code);
  }
  std::ofstream out(argv[1], std::ios::binary);
  out << report::report_html(
      {.summary = *std::move(summary), .motion = &trial.motion, .markers = &trial.markers});
  return out.flush() ? 0 : 4;
}
