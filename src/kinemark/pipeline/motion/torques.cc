// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/torques.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/pipeline/files/external_forces.h"
#include "kinemark/workflow/prepare/turn.h"

namespace kinemark::pipeline {
namespace {

/// Forces of a file on the frames of a motion, in the axes of its model.
Result<ExternalForces> read_forces(const model::Model& model, const data::JointMotion& motion,
                                   const std::filesystem::path& path, double contact_force_n,
                                   const workflow::Axes& axes) {
  auto read = read_external_forces(path, motion.time, contact_force_n);
  if (!read) return read;
  for (auto& warning : read->warnings) warning = fmt::format("{}: {}", path.filename().string(), warning);
  workflow::turn(read->wrenches, axes.model_from_recording);
  const auto off = workflow::check_forces(read->wrenches, axes, model);
  if (!off) return fail_at(path.string(), off.error());
  if (!off->empty()) read->warnings.push_back(*off);
  return read;
}

}  // namespace

Result<TorqueAccount> add_torques(const model::Model& model, data::JointMotion& motion,
                                  const std::filesystem::path& forces, const motion::DynamicsOptions& options,
                                  const motion::RateErrors* errors, const workflow::Axes& axes) {
  TorqueAccount account;
  if (forces.empty()) {
    auto without = workflow::add_torques(model, motion, nullptr, options, errors);
    if (!without) return std::unexpected(without.error());
    static_cast<workflow::TorqueAccount&>(account) = std::move(*without);
    return account;
  }
  auto external = read_forces(model, motion, forces, options.contact_force_n, axes);
  if (!external) return std::unexpected(external.error());
  auto found = workflow::add_torques(model, motion, &external->wrenches, options, errors);
  if (!found) return fail_at(forces.string(), found.error());
  account.files = std::move(external->files);
  account.warnings = std::move(external->warnings);
  account.facts = std::move(found->facts);
  std::ranges::move(found->warnings, std::back_inserter(account.warnings));
  return account;
}

}  // namespace kinemark::pipeline
