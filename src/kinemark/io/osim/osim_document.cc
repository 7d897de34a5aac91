// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/osim_document.h"

#include <fmt/core.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/io/osim/internal/attachment_scaler.h"
#include "kinemark/io/osim/internal/model_difference.h"
#include "kinemark/io/osim/internal/model_editor.h"
#include "kinemark/io/osim/internal/path_xml.h"
#include "kinemark/io/osim/internal/xml_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io {
namespace {

using osim::XmlFile;

constexpr int kOwnStructure = 20000;  // documents from here on have bodies and joints of their own

/// Sets of a model that a description has no place for.
bool is_understood(std::string_view set) {
  constexpr std::string_view kUnderstood[] = {"BodySet",       "JointSet", "ConstraintSet", "MarkerSet",
                                              "CoordinateSet", "Ground",   "SimbodyEngine", "DynamicsEngine"};
  return std::ranges::find(kUnderstood, set) != std::end(kUnderstood);
}

/// "54 Thelen2003Muscle, 2 Mesh".
std::string list_of(const std::map<std::string, int>& kinds) {
  std::vector<std::string> words;
  for (const auto& [kind, count] : kinds) words.push_back(fmt::format("{} {}", count, kind));
  return join(words);
}

/// Objects of a model that its description leaves out, by kind.
std::map<std::string, int> left_out(pugi::xml_node model) {
  std::map<std::string, int> kinds;
  for (const pugi::xml_node set : model.children())
    if (!is_understood(set.name()))
      for (const pugi::xml_node object : set.child("objects").children())
        if (object.type() == pugi::node_element) ++kinds[object.name()];
  for (const char* tag : {"Mesh", "DisplayGeometry"})
    if (const auto shapes = osim::descendants(model, tag); !shapes.empty())
      kinds[tag] += static_cast<int>(shapes.size());
  for (const pugi::xml_node set : osim::descendants(model, "WrapObjectSet"))
    for (const pugi::xml_node surface : set.child("objects").children())
      if (surface.type() == pugi::node_element) ++kinds[surface.name()];
  return kinds;
}

/// Marks of earlier sets of files: what is written now belongs to another one, or to none.
void remove_marks(pugi::xml_node root) {
  for (pugi::xml_node node = root.first_child(); node;) {
    const pugi::xml_node next = node.next_sibling();
    if (node.type() == pugi::node_comment &&
        std::string_view(node.value()).find(kSetKey) != std::string_view::npos)
      root.remove_child(node);
    node = next;
  }
}

}  // namespace

struct OsimDocument::Parts {
  XmlFile file;
  data::ModelDescription model;
  std::vector<data::MusclePath> paths;
  std::string paths_error;
};

Result<OsimDocument> OsimDocument::make(Parts parts, const std::filesystem::path* folder) {
  parts.file.inline_files(folder);
  remove_marks(parts.file.document().root());
  XmlFile file = parts.file.copy();  // errors of the paths are apart
  const pugi::xml_node model = file.find_object({"Model"});
  osim::FrameTable frames(file, model, parts.model);
  parts.paths = osim::read_paths(file, frames, model, parts.model);
  if (file.error()) {
    parts.paths.clear();
    parts.paths_error = file.error()->message;
  }
  return OsimDocument(std::make_shared<const Parts>(std::move(parts)));
}

Result<OsimDocument> OsimDocument::read(const std::filesystem::path& path) {
  auto model = read_osim(path);
  if (!model) return std::unexpected(model.error());
  auto file = XmlFile::read(path, XmlFile::Comments::kept);
  if (!file) return std::unexpected(file.error());
  const std::filesystem::path folder = path.parent_path();
  return make({.file = std::move(*file), .model = std::move(*model), .paths = {}, .paths_error = {}},
              &folder);
}

Result<OsimDocument> OsimDocument::parse(std::string_view xml, std::string_view name) {
  auto model = parse_osim(xml, name);
  if (!model) return std::unexpected(model.error());
  auto file = XmlFile::parse(xml, std::string(name), XmlFile::Comments::kept);
  if (!file) return std::unexpected(file.error());
  return make({.file = std::move(*file), .model = std::move(*model), .paths = {}, .paths_error = {}},
              nullptr);
}

const data::ModelDescription& OsimDocument::model() const { return parts_->model; }
const std::vector<data::MusclePath>& OsimDocument::paths() const { return parts_->paths; }
const std::string& OsimDocument::paths_error() const { return parts_->paths_error; }

Result<OsimText> OsimDocument::format(const OsimChange& change) const {
  const XmlFile& original = parts_->file;
  std::string why = fmt::format("its version, {}, has no place for the changes", original.version());
  if (original.version() >= kOwnStructure) {
    XmlFile file = original.copy();
    const pugi::xml_node model = file.find_object({"Model"});
    if (!change.factors.empty()) osim::scale_attachments(file, model, parts_->model, change.factors);
    osim::scale_rest_lengths(file, model, change.paths);
    if (auto s = osim::edit_model(file, model, parts_->model, change.model); !s)
      return std::unexpected(s.error());
    std::string text = file.text();
    const auto found = parse_osim(text, original.name());
    const std::string difference = found ? osim::difference_of(change.model, *found) : found.error().message;
    if (difference.empty()) return OsimText{.text = std::move(text), .lost = {}};
    why = fmt::format("{} cannot be changed where it stands", difference);
  }
  auto text = format_osim(change.model);
  if (!text) return std::unexpected(text.error());
  OsimText out{.text = std::move(*text), .lost = {}};
  if (const auto kinds = left_out(original.find_object({"Model"})); !kinds.empty())
    out.lost.push_back(
        fmt::format("The model was written anew, because {}; not in it: {}", why, list_of(kinds)));
  return out;
}

}  // namespace kinemark::io
