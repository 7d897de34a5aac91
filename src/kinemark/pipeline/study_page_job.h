// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/poizner/study_poizner_job.h"

namespace kinemark::pipeline {

/// Write study_page(): the page appears whole or not at all, and replaces a file only with `force`.
[[nodiscard]] Status write_study_page(const PoiznerStudy& study, const std::filesystem::path& path,
                                      bool force);

}  // namespace kinemark::pipeline
