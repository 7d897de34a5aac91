// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Numbers of a recording or a model that contradict each other, and the gate that they make a verb miss.
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/recording.h"
#include "kinemark/data/run_record.h"
#include "kinemark/workflow/prepare/prepare.h"

namespace kinemark::workflow {

/// A sentence on each contradiction of the kinds that are asked for, in the order of HeldFacts; none where
/// too few markers are known by their names, or no feet are found for plates and events. About 0.1 s whatever
/// the recording's length, a second where a pair is exchanged; plates and events need the paths of the feet,
/// O(F). Fails as motion::judge_movement().
[[nodiscard]] Result<std::vector<std::string>> find_contradictions(const data::Recording& recording,
                                                                   const HeldFacts& facts);

/// What no body has, of a model that is written or described: joints that turn about one axis twice, masses
/// that matter. A sentence each. Of a model that cannot be compiled only the first.
/// @param small  gets masses that no torque shows; may be null
[[nodiscard]] std::vector<std::string> contradicted_model(const data::ModelDescription& model,
                                                          std::vector<std::string>* small = nullptr);

/// The gate `contradictions`, missed, where there are any. One that is there takes further sentences, each
/// once.
void add_contradictions(const std::vector<std::string>& contradicted, std::vector<data::Gate>& gates);

}  // namespace kinemark::workflow
