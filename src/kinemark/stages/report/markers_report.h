// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page of a recording as it is: what there is of each marker, in space and over time.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kinemark/data/neural.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/report/cycle_overlay.h"
#include "kinemark/stages/report/report_parts.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report {

/// A recording and what is known of its laboratory.
struct MarkersReport {
  std::string trial;                       ///< name for the heading, usually the file's
  std::string version;                     ///< of the program
  std::string command_line;                ///< as typed; may be empty
  const data::Trial* recording = nullptr;  ///< must be set
  bool rate_known = true;                  ///< false: the file tells no rate, and frames are counted at 1 Hz
  const data::Wrenches* forces =
      nullptr;  ///< of the plates, on the markers' clock; nullptr: none or not known
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< as Scene::up
  std::string up_from;                            ///< as Scene::up_from
  std::vector<InputFile> inputs;                  ///< files that were read
  std::vector<std::string> warnings;              ///< one sentence each, besides those of the recording
  const data::Trajectories* before = nullptr;     ///< as it was recorded, on the same markers and frames;
                                                  ///< nullptr: as it is
  std::vector<CycleSpan> cycles;                  ///< that the recording's events mark; may be none
  const data::Neural* neural = nullptr;           ///< what lies beside the movement; nullptr: nothing
  nlohmann::ordered_json editing;  ///< state of the edits, where the page can change them; null
};

/// What stands out in a recording, the serious first: markers never seen, markers partly missing, samples
/// that were made or rejected, points that nobody named, remarks of the reader.
[[nodiscard]] std::vector<NoticeGroup> markers_notices(const MarkersReport& report);

/// MarkersPage of docs/formats/pages.md.
[[nodiscard]] nlohmann::ordered_json markers_report_json(const MarkersReport& report,
                                                         const SceneOptions& options = {});

/// One HTML page that needs nothing else. The same report gives the same bytes.
[[nodiscard]] std::string markers_report_html(const MarkersReport& report, const SceneOptions& options = {});

}  // namespace kinemark::report
