// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A simulated moving person whose frames come one after the other.
#pragma once

#include <memory>

#include "kinemark/core/result.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/simulation/subject_options.h"
#include "kinemark/stream/stream.h"

namespace kinemark::simulation {

/// The markers of a simulated subject, made as they are asked for: memory does not grow with the recording.
///
/// Without gaps these are the markers of simulate_subject() with the same options, to the bit. Gaps are drawn
/// as time goes, with the lengths of simulate_subject()'s: each marker begins one at random, so that
/// dropout_random of the samples are lost in the mean (Random(seed, 7 * 2^32 + 1 + marker)). Extents are
/// those of 200 instants in the first minute.
class SubjectSource final : public stream::Source {
 public:
  /// @param facts  name and vertical; markers, rate, times, count of frames and extent are of the simulation
  /// Fails as simulate_subject(); Code::usage too where soft_tissue or dropout_sight, which need the whole
  /// recording at once, are not 0.
  [[nodiscard]] static Result<std::unique_ptr<SubjectSource>> create(
      std::shared_ptr<const model::Model> model, const SubjectOptions& options, stream::SourceFacts facts);
  ~SubjectSource() override;
  /// Never fails. O(M): about 0.05 ms for a whole body.
  [[nodiscard]] Result<bool> next(stream::Frame& frame) override;

 private:
  struct Impl;
  SubjectSource(std::unique_ptr<Impl> impl, stream::SourceFacts facts);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinemark::simulation
