// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A macaque's arm in a sleeve of LEDs, whose frames come one after the other.
#pragma once

#include <memory>

#include "kinemark/core/result.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stream/stream.h"

namespace kinemark::simulation {

/// The markers of simulate_sleeve() with the same options, to the bit, made as they are asked for: memory
/// does not grow with the recording. The shoulder is the origin, z is up; the extent is that of the first
/// minute.
class SleeveSource final : public stream::Source {
 public:
  /// @param facts  its name; all else is of the simulation
  /// Fails as SleeveOptions::check(); Code::usage too with skin, which needs the whole recording at once.
  [[nodiscard]] static Result<std::unique_ptr<SleeveSource>> create(const SleeveOptions& options,
                                                                    stream::SourceFacts facts);
  ~SleeveSource() override;
  /// Never fails. O(M): some microseconds.
  [[nodiscard]] Result<bool> next(stream::Frame& frame) override;

 private:
  struct Impl;
  SleeveSource(std::unique_ptr<Impl> impl, stream::SourceFacts facts);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinemark::simulation
