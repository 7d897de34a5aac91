// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/simulate/human_model.h"

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/pipeline/simulate/internal/human_model_text.h"

namespace kinemark::pipeline {

Result<data::ModelDescription> human_model() {
  return io::parse_osim(internal::human_model_text(), "human.osim");
}

}  // namespace kinemark::pipeline
