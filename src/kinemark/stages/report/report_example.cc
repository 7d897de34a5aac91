// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// report_example PAGE.html [FRAMES] [ik|clean]: the report of a made-up trial, for looking at the page and
// testing it in a browser.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/report/ik_report.h"
#include "kinemark/stages/report/internal/example_clean.h"
#include "kinemark/stages/report/internal/example_trial.h"

namespace {

using namespace kinemark;

Result<std::string> ik_page(std::int64_t frames) {
  const report::internal::ExampleTrial trial = report::internal::example_trial(frames);
  auto summary = report::summarize(trial.run, trial.motion, &trial.markers);
  if (!summary) return std::unexpected(summary.error());
  return report::report_html(
      {.summary = *std::move(summary), .motion = &trial.motion, .markers = &trial.markers});
}

Result<std::string> clean_page(std::int64_t frames) {
  return report::clean_report_html(report::internal::example_clean(frames).finished());
}

}  // namespace

int main(int argc, char** argv) {
  const std::int64_t frames = argc > 2 ? std::strtoll(argv[2], nullptr, 10) : 600;
  const std::string_view kind = argc > 3 ? argv[3] : "ik";
  if (argc < 2 || frames < 100 || (kind != "ik" && kind != "clean")) {
    std::cerr << "usage: report_example PAGE.html [FRAMES, at least 100] [ik|clean]\n";
    return 2;
  }
  const Result<std::string> page = kind == "ik" ? ik_page(frames) : clean_page(frames);
  if (!page) {
    std::cerr << page.error().message << '\n';
    return exit_status(page.error().code);
  }
  std::ofstream out(argv[1], std::ios::binary);
  out << *page;
  return out.flush() ? 0 : 4;
}
