// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/defect.h"

namespace kinemark::data {

std::string_view to_string(DefectKind kind) {
  switch (kind) {
    case DefectKind::zero:
      return "zero";
    case DefectKind::stuck:
      return "stuck";
    case DefectKind::duplicated_frame:
      return "duplicated frame";
    case DefectKind::clock_jump:
      return "clock jump";
    case DefectKind::unit_slip:
      return "unit slip";
    case DefectKind::spike:
      return "spike";
    case DefectKind::swap_within:
      return "swap within";
    case DefectKind::label_swap:
      return "label swap";
  }
  return "unknown";
}

}  // namespace kinemark::data
