// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/recover_job.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/io/recording/recover.h"
#include "kinemark/pipeline/files/output_check.h"

namespace kinemark::pipeline {

Result<RecoverOutcome> run_recover(const RecoverJob& job) {
  if (auto s = check_apart(job, {job.out}, {job.in}); !s) return std::unexpected(s.error());
  auto report = io::recover_recording(job.in, job.out, job.force);
  if (!report) return std::unexpected(report.error());
  RecoverOutcome out;
  out.original = job.in;
  out.messages = report->messages;
  out.end = report->end;
  out.bytes_left_out = report->bytes_left_out;
  out.damage = std::move(report->damage);
  out.warnings = std::move(report->warnings);
  out.written = {job.out};
  out.gates.push_back({.name = "bytes_left_out",
                       .passed = out.bytes_left_out == 0,
                       .value = static_cast<double>(out.bytes_left_out),
                       .bound = 0.0,
                       .unit = "bytes",
                       .sentence = fmt::format("{} bytes could not be recovered.", out.bytes_left_out)});
  return out;
}

}  // namespace kinemark::pipeline
