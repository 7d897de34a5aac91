// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/skeleton.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/simulation/neurons.h"
#include "kinemark/stages/simulation/upsample.h"

namespace kinemark::pipeline {

/// Which limb is simulated.
enum class LimbScene : std::uint8_t { arm, macaque };

/// What `kinemark simulate arm` and `kinemark simulate macaque` are asked to do.
struct SimulateLimbJob : JobSettings {
  std::filesystem::path folder;                       ///< made when absent
  LimbScene scene = LimbScene::arm;                   ///< which limb
  simulation::ChainOptions arm;                       ///< for LimbScene::arm
  simulation::SleeveOptions macaque;                  ///< for LimbScene::macaque
  simulation::NeuronOptions neurons;                  ///< of the macaque; none by default
  simulation::UpsampleOptions upsample{.factor = 1};  ///< what the recorder makes of it
};

/// Warnings: frames, markers, and how much of them is seen.
struct SimulateLimbOutcome : JobOutcome {};

/// Write markers.c3d and markers.trc (what the recorder hands on), truth.csv (joint centres and then all
/// markers without noise, every frame of the cameras) and segments.toml (segment_layout_toml()); with neurons
/// also session.nwb, the markers with units, trials and field potentials on their clock. Either all files
/// appear or none, nor the folder. Progress counts files.
[[nodiscard]] Result<SimulateLimbOutcome> run_simulate_limb(const SimulateLimbJob& job);

/// The layout as `kinemark joints --segments` reads it: [[segment]] with name and markers, [[joint]] with
/// name, parent and child. markers: names of the recording's.
[[nodiscard]] std::string segment_layout_toml(const data::SegmentLayout& layout,
                                              const std::vector<std::string>& markers);

}  // namespace kinemark::pipeline
