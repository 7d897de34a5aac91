// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What lies beside a movement, as pages hold it: spikes, trials, field potentials.
#pragma once

#include <nlohmann/json.hpp>

#include "kinemark/data/neural.h"

namespace kinemark::report {

/// NeuralLanes of docs/formats/pages.md, over [start_s, end_s]: what lies outside is not drawn. Spikes are
/// counted in 3,000 bins at most, envelopes have a byte a value: the size of a page does not grow with the
/// length. null where nothing lies there.
[[nodiscard]] nlohmann::ordered_json neural_json(const data::Neural& neural, double start_s, double end_s);

}  // namespace kinemark::report
