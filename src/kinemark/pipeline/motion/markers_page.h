// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::pipeline {

/// What a page of a recording has to know besides its file.
struct MarkersPageOptions {
  RecordingOptions recording = {};      ///< doubtful samples are kept unless they are to be dropped
  std::filesystem::path skeleton = {};  ///< .asf of an .amc; empty: the one beside it
  std::string command_line;             ///< as typed, for the record
  std::vector<std::filesystem::path> geometry = {};  ///< of joint angles: folders of the model's meshes
  nlohmann::ordered_json editing;                    ///< as report::MarkersReport::editing
};

/// Which way is up in a recording without a model: its plates, POINT:Y_SCREEN of a C3D file, else the axis
/// along which the markers reach farthest in most frames, when they reach over 0.8 m there and 1.2 times as
/// far as along the others; else z, and `from` is empty.
[[nodiscard]] workflow::Vertical vertical_without_model(const data::Trial& trial);

/// HTML of a marker file as it is: any that io::read_marker_input() reads, decided by its content. Forces of
/// plates that cannot be read are a remark on the page. Fails as the reader.
[[nodiscard]] Result<std::string> markers_page(const std::filesystem::path& path,
                                               const MarkersPageOptions& options = {});

}  // namespace kinemark::pipeline
