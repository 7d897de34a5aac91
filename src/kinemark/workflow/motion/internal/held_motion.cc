// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/internal/held_motion.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "kinemark/stages/analysis/consistency/model_facts.h"
#include "kinemark/stages/analysis/consistency/motion_facts.h"
#include "kinemark/stages/motion/dynamics/masses.h"
#include "kinemark/workflow/prepare/contradictions.h"

namespace kinemark::workflow::internal {
namespace {

void contradict(const std::vector<std::string>& sentences, Remarks& remarks) {
  std::ranges::copy(sentences, std::back_inserter(remarks.warnings));
  add_contradictions(sentences, remarks.gates);
}

}  // namespace

void hold_model(const model::Model& model, const data::JointMotion& motion, Remarks& remarks) {
  contradict(analysis::contradicted_joints(model.description()), remarks);
  std::ranges::move(analysis::coordinates_out_of_range(model.description(), motion),
                    std::back_inserter(remarks.warnings));
}

void hold_motion(const model::Model& model, const GivenMotion& given, bool mass_centre, Remarks& remarks) {
  contradict(given.contradicted, remarks);
  hold_model(model, given.motion, remarks);
  if (!mass_centre) return;
  for (const auto& fault : motion::find_mass_faults(model))
    if (fault.kind == motion::MassFault::Kind::centre && fault.matters)
      contradict({fault.sentence()}, remarks);
}

}  // namespace kinemark::workflow::internal
