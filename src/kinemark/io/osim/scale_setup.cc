// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/scale_setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "kinemark/io/osim/internal/ik_tasks_xml.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

using osim::in_quotes;
using osim::name_of;
using osim::objects_of;
using osim::path_of;
using osim::text_of;
using osim::words_of;
using osim::XmlFile;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// "X Y Z", "x", "XY": 1 where an axis is named.
Eigen::Vector3d read_axes(XmlFile& file, pugi::xml_node node) {
  const std::string text = text_of(node, "axes");
  Eigen::Vector3d axes = Eigen::Vector3d::Zero();
  for (const char c : lower(text)) {
    if (c >= 'x' && c <= 'z')
      axes[c - 'x'] = 1.0;
    else if (std::isspace(static_cast<unsigned char>(c)) == 0)
      file.note(node.child("axes"), fmt::format("is {}; need some of X Y Z", in_quotes(text)));
  }
  return axes;
}

/// Nothing when it is switched off or scales no body.
std::optional<data::ScaleMeasurement> read_measurement(XmlFile& file, pugi::xml_node node) {
  data::ScaleMeasurement measurement{.name = name_of(node)};
  const bool apply = file.flag(node, "apply", true);
  for (const pugi::xml_node pair : objects_of(node, "MarkerPairSet")) {
    const auto words = words_of(text_of(pair, "markers"));
    if (words.size() != 2) {
      file.note(pair, fmt::format("<markers> is {}; need two names", in_quotes(text_of(pair, "markers"))));
      continue;
    }
    measurement.pairs.push_back({words[0], words[1]});
  }
  for (const pugi::xml_node body : objects_of(node, "BodyScaleSet")) {
    if (name_of(body).empty()) file.note(body, "has no name; need that of a body");
    measurement.bodies.push_back({.body = name_of(body), .axes = read_axes(file, body)});
  }
  if (!apply || measurement.bodies.empty()) return std::nullopt;
  return measurement;
}

/// Nothing when it is switched off.
std::optional<data::BodyFactors> read_scale(XmlFile& file, pugi::xml_node node) {
  // The body stands in <segment>; files edited by hand name the scale after it instead.
  std::string body = text_of(node, "segment");
  if (body.empty() || body == "Unassigned") body = name_of(node);
  if (body.empty()) file.note(node, "names no <segment>");
  if (body.starts_with("/bodyset/")) body.erase(0, std::string("/bodyset/").size());
  data::BodyFactors scale{.body = std::move(body),
                          .factors = file.vector3(node, "scales", Eigen::Vector3d::Ones())};
  const bool apply = file.flag(node, "apply", true);
  if (!(scale.factors.minCoeff() > 0.0)) file.note(node.child("scales"), "must be above 0");
  if (!apply) return std::nullopt;
  return scale;
}

std::vector<data::BodyFactors> read_scales(XmlFile& file, pugi::xml_node owner) {
  std::vector<data::BodyFactors> scales;
  for (const pugi::xml_node node : objects_of(owner, "ScaleSet"))
    if (auto scale = read_scale(file, node)) scales.push_back(std::move(*scale));
  return scales;
}

std::vector<data::ScaleStep> read_order(XmlFile& file, pugi::xml_node scaler) {
  std::vector<data::ScaleStep> order;
  for (const auto& word : words_of(text_of(scaler, "scaling_order"))) {
    const std::string step = lower(word);
    if (step == "measurements")
      order.push_back(data::ScaleStep::measurements);
    else if (step == "manualscale")
      order.push_back(data::ScaleStep::manual);
    else if (step != "unassigned")
      file.note(scaler.child("scaling_order"),
                fmt::format("holds {}; need measurements, manualScale or both", in_quotes(word)));
  }
  return order;
}

void read_scaler(XmlFile& file, pugi::xml_node scaler, const std::filesystem::path& folder,
                 ScaleSetup& setup) {
  setup.scale = scaler && file.flag(scaler, "apply", true);
  data::ScaleRecipe recipe;
  recipe.order = read_order(file, scaler);
  for (const pugi::xml_node node : objects_of(scaler, "MeasurementSet"))
    if (auto measurement = read_measurement(file, node))
      recipe.measurements.push_back(std::move(*measurement));
  recipe.manual = read_scales(file, scaler);
  setup.scale_marker_file = osim::input_path_of(file, scaler, "marker_file", folder, setup.notes);
  if (const auto range = osim::read_time_range(file, scaler)) {
    recipe.first_time_s = range->first;
    recipe.last_time_s = range->second;
  }
  recipe.preserve_mass_distribution = file.flag(scaler, "preserve_mass_distribution", false);
  setup.scaled_model_file = path_of(scaler, "output_model_file", folder);
  setup.scale_set_file = path_of(scaler, "output_scale_file", folder);
  if (setup.scale)
    setup.recipe = std::move(recipe);
  else
    setup.recipe.order.clear();
}

void read_placer(XmlFile& file, pugi::xml_node placer, const std::filesystem::path& folder,
                 ScaleSetup& setup) {
  setup.place = placer && file.flag(placer, "apply", true);
  setup.tasks = osim::read_ik_tasks(file, placer, "IKTaskSet");
  setup.place_marker_file = osim::input_path_of(file, placer, "marker_file", folder, setup.notes);
  setup.coordinate_file = osim::input_path_of(file, placer, "coordinate_file", folder, setup.notes);
  if (const auto range = osim::read_time_range(file, placer)) {
    setup.place_begin_s = range->first;
    setup.place_end_s = range->second;
  }
  setup.max_marker_movement_mm = file.number(placer, "max_marker_movement", -1.0);
  setup.output_model_file = path_of(placer, "output_model_file", folder);
  setup.output_motion_file = path_of(placer, "output_motion_file", folder);
}

std::string body_of_marker(pugi::xml_node node) {
  std::string body = text_of(node, "socket_parent_frame");
  if (body.empty()) body = text_of(node, "body");
  const auto slash = body.rfind('/');
  return slash == std::string::npos ? body : body.substr(slash + 1);
}

}  // namespace

Result<ScaleSetup> read_scale_setup(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const std::filesystem::path folder = path.parent_path();
  file->inline_files(&folder);
  const pugi::xml_node tool = file->find_object({"ScaleTool"});
  if (!tool)
    return fail(Code::bad_input, fmt::format("{}: has no <ScaleTool>; its first element is <{}>",
                                             path.string(), file->document().name()));
  ScaleSetup setup{.name = name_of(tool), .parts = file->inlined()};
  const double mass = file->number(tool, "mass", -1.0), height = file->number(tool, "height", -1.0);
  if (!std::isfinite(mass)) file->note(tool.child("mass"), "must be finite");
  setup.height_mm = std::isfinite(height) ? std::max(0.0, height) : 0.0;
  const pugi::xml_node maker = tool.child("GenericModelMaker");
  setup.model_file = osim::input_path_of(*file, maker, "model_file", folder, setup.notes);
  setup.marker_set_file = osim::input_path_of(*file, maker, "marker_set_file", folder, setup.notes);
  read_scaler(*file, tool.child("ModelScaler"), folder, setup);
  setup.recipe.mass_kg = std::max(0.0, mass);
  read_placer(*file, tool.child("MarkerPlacer"), folder, setup);
  if (file->error()) return std::unexpected(*file->error());
  return setup;
}

Result<std::vector<data::BodyFactors>> read_scale_set(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const pugi::xml_node set = file->find_object({"ScaleSet"});
  if (!set)
    return fail(Code::bad_input, fmt::format("{}: has no <ScaleSet>; its first element is <{}>",
                                             path.string(), file->document().name()));
  auto scales = read_scales(*file, set.parent());
  if (file->error()) return std::unexpected(*file->error());
  return scales;
}

Result<std::vector<MarkerOfSet>> read_marker_set(const std::filesystem::path& path) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const pugi::xml_node set = file->find_object({"MarkerSet"});
  if (!set)
    return fail(Code::bad_input, fmt::format("{}: has no <MarkerSet>; its first element is <{}>",
                                             path.string(), file->document().name()));
  std::vector<MarkerOfSet> markers;
  std::set<std::string> seen;
  for (const pugi::xml_node node : objects_of(set.parent(), "MarkerSet")) {
    MarkerOfSet marker{.name = name_of(node), .body = body_of_marker(node)};
    if (marker.name.empty()) file->note(node, "a Marker has no name");
    if (marker.body.empty()) file->note(node, "names no <body>");
    if (!seen.insert(marker.name).second) file->note(node, "occurs twice");
    marker.x_in_body = file->vector3(node, "location");
    marker.fixed = file->flag(node, "fixed", false);
    markers.push_back(std::move(marker));
  }
  if (file->error()) return std::unexpected(*file->error());
  return markers;
}

Status merge_markers(data::ModelDescription& model, const std::vector<MarkerOfSet>& markers) {
  for (const auto& marker : markers) {
    const int body = model.find_body(marker.body);
    if (body < data::kGround)
      return fail(Code::bad_input, fmt::format("marker '{}' sits on body '{}', which the model does not have",
                                               marker.name, marker.body));
    const int known = model.find_marker(marker.name);
    data::MarkerDescription described{.name = marker.name, .body_idx = body, .x_in_body = marker.x_in_body};
    if (known >= 0)
      model.markers[static_cast<std::size_t>(known)] = std::move(described);
    else
      model.markers.push_back(std::move(described));
  }
  return {};
}

}  // namespace kinemark::io
