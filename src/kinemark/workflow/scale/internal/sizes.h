// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Are the sizes those of a person?
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/scale_recipe.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/motion/scaling/scale.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// A recording that sizes came from, and what sentences call it.
struct SizeSource {
  std::string name;                             ///< within a sentence, "cal.c3d"
  const data::Trajectories* markers = nullptr;  ///< never null
};

/// What a recipe measured.
struct RecipeSizes {
  const data::ScaleRecipe* recipe = nullptr;    ///< never null
  const motion::ScaleResult* scaled = nullptr;  ///< by it; never null
  std::string trial;                            ///< where it measured
};

/// The gate `sizes`: missed where a body's factor is more than 1.5 times that of the bodies' median or less
/// than 1 / 1.5 of it, or that median is below 0.25 or above 1.6. A warning names three bodies at most, with
/// the distances that a recipe measured of them, else with those between markers of the body, or of it and
/// its neighbours, that differ most from the model's. No gate without a source. Fails for a model that cannot
/// be compiled.
[[nodiscard]] Status judge_sizes(const data::ModelDescription& given,
                                 const std::vector<data::BodyFactors>& factors,
                                 std::span<const SizeSource> sources,
                                 const std::optional<RecipeSizes>& recipe, Remarks& remarks);

}  // namespace kinemark::workflow
