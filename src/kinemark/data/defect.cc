// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/defect.h"

#include "kinemark/core/enum_names.h"

namespace kinemark::data {

std::string_view to_string(DefectKind kind) {
  static constexpr EnumNames<DefectKind::label_swap> kNames{
      "zero", "stuck", "duplicated frame", "clock jump", "unit slip", "spike", "swap within", "label swap"};
  return kNames[kind];
}

}  // namespace kinemark::data
