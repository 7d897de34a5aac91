// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/live_report.h"

#include "kinemark/stages/report/internal/page.h"

namespace kinemark::report {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

Json live_report_json(const LiveReport& report) {
  Json coordinates = Json::array();
  for (const auto& [name, is_rotation] : report.coordinates)
    coordinates.push_back({{"name", name}, {"unit", is_rotation ? "deg" : "mm"}});
  Json bodies = Json::array(), targets = Json::array();
  for (const auto& body : report.bodies)
    bodies.push_back({{"name", body.name},
                      {"parent", body.parent},
                      {"mass_kg", body.mass_kg},
                      {"com_m", vector_json(body.com_in_body)}});
  for (const auto& target : report.targets)
    targets.push_back({{"marker", target.marker},
                       {"body", target.body},
                       {"point_m", vector_json(target.x_in_body)},
                       {"level", target.level}});
  Json extent = nullptr;
  if (report.extent_m) {
    extent = Json::array();
    for (const auto& corner : *report.extent_m) extent.push_back(vector_json(corner));
  }
  return {{"summary",
           {{"schema", "kinemark.live"},
            {"schema_version", 1},
            {"trial", report.title},
            {"source", report.source},
            {"version", report.version},
            {"recording", report.recording.empty() ? Json() : Json(report.recording)},
            {"rate_hz", report.rate_hz},
            {"markers", report.markers},
            {"up", vector_json(report.up)},
            {"up_from", report.up_from},
            {"extent_m", extent},
            {"coordinates", coordinates},
            {"bodies", bodies},
            {"targets", targets},
            {"levels", report.levels},
            {"strict", report.strict}}}};
}

std::string live_report_html(const LiveReport& report) {
  return internal::fill_page(live_report_json(report));
}

}  // namespace kinemark::report
