// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/body/motion_cycles.h"

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/pipeline/gait/sheet_inputs.h"

namespace kinemark::pipeline {
namespace {

analysis::CycleSeries empty_series(const TimeBase& time, std::string id, data::Quantity quantity) {
  analysis::CycleSeries out{.id = std::move(id), .quantity = quantity};
  for (std::int64_t f = 0; f < time.frames; ++f) out.time_s.push_back(time.time_s(f));
  return out;
}

}  // namespace

void add_motion_cycles(const workflow::MotionMeasured& measured, std::span<const analysis::GaitCycle> cycles,
                       std::vector<SheetInput>& out) {
  const auto& motion = measured.motion;
  const auto& record = measured.record;
  for (std::int64_t c = 0; c < record.size(); ++c) {
    if (!record.measured[at(c)]) continue;
    auto one = empty_series(record.time, record.names[at(c)],
                            record.is_rotation[at(c)] ? data::Quantity::angle : data::Quantity::length);
    for (std::int64_t f = 0; f < record.frames(); ++f) {
      one.values.push_back(record.determined(f, c) ? record.q(f, c) : kNaN);
      if (record.q_sd.size() > 0) one.sd.push_back(record.q_sd(f, c));
    }
    add_series(one, cycles, "", out);
  }
  if (record.torque_known.size() == 0) return;
  for (std::int64_t c = 0; c < record.size(); ++c) {
    if (!record.driven[at(c)] || !record.is_rotation[at(c)]) continue;
    auto moment = empty_series(record.time, record.names[at(c)] + "_moment", data::Quantity::moment),
         power = empty_series(record.time, record.names[at(c)] + "_power", data::Quantity::power);
    for (std::int64_t f = 0; f < record.frames(); ++f) {
      const bool known = record.torque_known(f, c) && record.determined(f, c);
      const auto i = motion.index(f, c);
      moment.values.push_back(known ? motion.tau[i] : kNaN);
      power.values.push_back(known ? motion.tau[i] * motion.qd[i] : kNaN);
    }
    add_series(moment, cycles, "", out);
    add_series(power, cycles, "", out);
  }
}

}  // namespace kinemark::pipeline
