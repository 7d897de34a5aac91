// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/recording_room.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <system_error>

namespace kinemark::pipeline {
namespace {

constexpr double kLeastRoom_s = 60.0;  // of a trial without a length
constexpr double kFrameBytes = 90.0;   // of a frame beside its counts: message, check and index

double bytes_per_second(const stream::GrantedPlan& plan) {
  const auto observations = static_cast<double>(plan.layout.led_count() * plan.layout.camera_count());
  const double dark =
      plan.layout.has_dark_slot() ? 8.0 * static_cast<double>(plan.layout.camera_count()) : 0.0;
  return (9.0 * observations + dark + kFrameBytes) * plan.plan.rate_hz;
}

std::string length_of(double seconds) {
  return seconds < 120.0 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} minutes", seconds / 60.0);
}

}  // namespace

Status check_room(const std::filesystem::path& file, bool force, const stream::GrantedPlan& plan,
                  double duration_s) {
  std::error_code none;
  if (!force && std::filesystem::exists(std::filesystem::symlink_status(file, none)))
    return fail(Code::io,
                fmt::format("{}: exists already; use --force to replace it, or another name", file.string()));
  const auto folder = file.parent_path().empty() ? std::filesystem::path(".") : file.parent_path();
  const auto space = std::filesystem::space(folder, none);
  if (none) return {};
  const double seconds = static_cast<double>(space.available) / bytes_per_second(plan);
  if (seconds >= std::max(duration_s, kLeastRoom_s)) return {};
  return fail(Code::io,
              fmt::format("{}: the disk has room for {} of this trial; make room, or record elsewhere",
                          file.string(), length_of(seconds)));
}

}  // namespace kinemark::pipeline
