// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The tai chi recording: how far least squares comes when the model's geometry is adapted to it.
#include <fmt/core.h>

#include "acceptance/taichi_recording.h"
#include "kinemark/stages/motion/scaling/clavicles.h"
#include "studies/taichi/geometry_fit.h"
#include "studies/taichi/subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using acceptance::kMillimetres;
using studies::Freedom;
using testing_support::print_row;

void check_fit(const data::ModelDescription& model, const data::Trajectories& landmarks, Freedom freedom,
               const std::string& what, double most_mm, double most_held_mm) {
  const auto frames = landmarks.frames();
  const auto fit = studies::fit_geometry(model, landmarks, freedom, 0, frames).value();
  print_row(kMillimetres * fit.rms_m <= most_mm, "tai chi, least squares, " + what,
            fmt::format("RMS <= {} mm", most_mm),
            fmt::format("{:.2f} mm, at most {:.1f} mm; {} numbers adapted", kMillimetres * fit.rms_m,
                        kMillimetres * fit.max_m, fit.parameters));
  const auto held = studies::fit_geometry(model, landmarks, freedom, 0, frames / 2).value();
  print_row(
      kMillimetres * held.rms_second_m <= most_held_mm, "tai chi, held out, " + what,
      fmt::format("second half: RMS <= {} mm", most_held_mm),
      fmt::format("adapted on the first half: first {:.2f} mm, second {:.2f} mm (adapted on all: second "
                  "{:.2f} mm)",
                  kMillimetres * held.rms_first_m, kMillimetres * held.rms_second_m,
                  kMillimetres * fit.rms_second_m));
}

int run_check(int /*argc*/, char** /*argv*/) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("geometry adapted to the tai chi recording");
  const auto landmarks = acceptance::tai_chi_landmarks(*data);
  auto model = studies::scale_by_medians(acceptance::human(), landmarks).value();
  check_fit(model, landmarks, Freedom::centres, "joints adapted", 9.0, 10.0);
  check_fit(model, landmarks, Freedom::positions, "joints and positions adapted", 7.5, 9.5);
  motion::add_clavicles(model).value();
  check_fit(model, landmarks, Freedom::centres, "clavicles, joints adapted", 4.5, 5.0);
  check_fit(model, landmarks, Freedom::positions, "clavicles, joints and positions adapted", 3.0, 3.5);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("taichi_geometry", run_check);

}  // namespace
