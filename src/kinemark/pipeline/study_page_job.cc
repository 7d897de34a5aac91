// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/study_page_job.h"

#include "kinemark/io/file.h"
#include "kinemark/pipeline/poizner/study_figures.h"

namespace kinemark::pipeline {

Status write_study_page(const PoiznerStudy& study, const std::filesystem::path& path, bool force) {
  auto file = io::OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  if (auto s = file->write(study_page(study)); !s) return s;
  return file->commit();
}

}  // namespace kinemark::pipeline
