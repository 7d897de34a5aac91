// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a reader of angles must know of them.
#pragma once

#include <string>
#include <vector>

#include "kinemark/workflow/segments/segments.h"

namespace kinemark::workflow {

/// Angles of a static trial jump against those of walks where the tibia is turned.
void note_static_angles(const analysis::SegmentMotion& motion, std::vector<std::string>& warnings);

/// Choices about the static trial that nobody stated.
void note_choices(const analysis::SegmentDefinition& definition, const analysis::SegmentMotion& motion,
                  std::vector<std::string>& warnings);

/// Cross-talk of angles for which the definition asks, with a warning where it is suspicious.
void find_cross_talk(const analysis::SegmentDefinition& definition, SegmentsFound& found);

}  // namespace kinemark::workflow
