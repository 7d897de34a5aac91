// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinemark/stages/analysis/segments/segment_definition.h"

namespace kinemark::workflow {

/// A definition of nothing but measures of a subject: a length with a second name, an angle, a mass.
inline analysis::SegmentDefinition subject_measures() {
  using analysis::SubjectQuantity;
  analysis::SegmentDefinition d;
  d.parameters.push_back(
      {.name = "LLegLength", .also = {"LeftLegLength"}, .quantity = SubjectQuantity::length});
  d.parameters.push_back({.name = "LThighRotation", .quantity = SubjectQuantity::angle});
  d.parameters.push_back({.name = "Bodymass", .quantity = SubjectQuantity::mass});
  return d;
}

}  // namespace kinemark::workflow
