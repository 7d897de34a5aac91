// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/data/run_record.h"
#include "kinemark/model/model.h"

namespace kinemark::pipeline {

/// A body model, ready to be moved.
struct ModelInput {
  model::Model model;    ///< compiled
  data::InputFile file;  ///< role "model"
};

/// Read, check and compile an .osim, and record it. A model without markers, which no recording can move, is
/// Code::bad_input; else fails as io::read_osim() and model::Model::compile().
[[nodiscard]] Result<ModelInput> read_model_input(const std::filesystem::path& path);

}  // namespace kinemark::pipeline
