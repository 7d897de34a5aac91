// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Any bytes as each of OpenSim's files that say what to do (IK setup and tasks, setups of scaling and of
// analyses, factors, marker set): an answer or one sentence.
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "kinemark/io/osim/analysis_setup.h"
#include "kinemark/io/osim/ik_setup.h"
#include "kinemark/io/osim/scale_setup.h"
#include "support/scratch.h"

namespace {

template <class T>
bool sane(const kinemark::Result<T>& read) {
  if (!read && read.error().message.empty()) std::abort();
  return read.has_value();
}

/// Weights are said to be at least 0, so no caller asks again.
void check_tasks(const kinemark::io::IkTasks& tasks) {
  for (const auto& task : tasks.markers)
    if (!(task.weight >= 0.0)) std::abort();
  for (const auto& task : tasks.coordinates)
    if (!(task.weight >= 0.0)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinemark;
  // A folder of its own: a setup may name files beside it.
  static const testing_support::ScratchFolder scratch;
  const auto path = scratch / "fuzz.xml";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (const auto tasks = io::read_ik_tasks(path); sane(tasks)) check_tasks(*tasks);
  if (const auto setup = io::read_ik_setup(path); sane(setup)) check_tasks(setup->tasks);
  if (const auto setup = io::read_scale_setup(path); sane(setup)) check_tasks(setup->tasks);
  sane(io::read_analysis_setup(path));
  sane(io::read_scale_set(path));
  sane(io::read_marker_set(path));
  return 0;
}
