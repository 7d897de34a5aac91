// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/edited_page.h"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "kinemark/core/version.h"
#include "kinemark/data/resample_forces.h"
#include "kinemark/io/input/external_forces.h"
#include "kinemark/io/plates/plate_forces.h"
#include "kinemark/pipeline/motion/markers_page.h"
#include "kinemark/stages/report/markers_report.h"

#include "kinemark/pipeline/motion/internal/cycle_overlays.h"
#include "kinemark/pipeline/motion/internal/page_forces.h"

namespace kinemark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3;

Json changes_json(const std::vector<trajectory::MarkerChange>& changes) {
  Json out = Json::array();
  for (const auto& change : changes)
    out.push_back({{"marker", change.marker},
                   {"moved", change.moved},
                   {"came", change.came},
                   {"went", change.went},
                   {"restated", change.restated},
                   {"largest_mm", kMillimetres * change.largest_m},
                   {"first", change.first_frame},
                   {"last", change.last_frame}});
  return out;
}

/// Forces of the plates as they were recorded, on the clock of what edits left; what is wrong is a remark.
data::Wrenches forces_of(const EditSession& session, std::vector<std::string>& remarks) {
  const auto& recorded = session.recorded().trial;
  if (recorded.force_plates.empty()) return {};
  const auto forces = io::plate_forces(recorded, {.contact_force_n = internal::kContact_n});
  if (forces) return data::resample(forces->wrenches, session.now().markers.time);
  remarks.push_back(internal::no_forces(forces.error().message));
  return {};
}

/// What a report of the session holds, and what it refers to.
struct EditedReport {
  explicit EditedReport(const EditSession& session) {
    std::vector<std::string> remarks;
    forces = forces_of(session, remarks);
    const auto vertical = vertical_without_model(session.recorded().trial);
    report = {.trial = std::filesystem::path(session.recorded().file.path).filename().string(),
              .version = std::string(kVersion),
              .recording = &session.now(),
              .up = vertical.up,
              .up_from = vertical.from,
              .inputs = {session.recorded().file},
              .warnings = std::move(remarks),
              .cycles = internal::cycle_spans(session.now().events, session.now().markers.time),
              .editing = editing_json(session)};
    if (!forces.items.empty()) report.forces = &forces;
    if (session.outcome().in_force.empty()) return;
    before = trajectory::aligned_to(session.recorded().trial, session.now());
    report.before = &before;
  }
  EditedReport(const EditedReport&) = delete;
  EditedReport& operator=(const EditedReport&) = delete;

  data::Wrenches forces;
  data::Trajectories before;
  report::MarkersReport report;
};

}  // namespace

Json editing_json(const EditSession& session) {
  const auto outcome = session.outcome();
  Json json = edit_json(outcome);
  json["journal"] = outcome.journal.filename().string();
  json["changes"] = {{"last", changes_json(session.last_changes())},
                     {"all", changes_json(session.all_changes())}};
  return json;
}

Json edited_page_json(const EditSession& session) {
  return report::markers_report_json(EditedReport(session).report);
}

Result<std::string> edited_page(const std::filesystem::path& recording) {
  const auto session = EditSession::open(recording);
  if (session) return report::markers_report_html(EditedReport(*session).report);
  return markers_page(
      recording, {.recording = {.edits = io::kEditsNone}, .editing = {{"refused", session.error().message}}});
}

}  // namespace kinemark::pipeline
