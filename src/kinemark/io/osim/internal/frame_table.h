// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "kinemark/data/model_description.h"
#include "kinemark/io/osim/internal/xml_file.h"
#include "kinemark/math/se3.h"

namespace kinemark::io::osim {

/// A frame fixed on a body or the ground.
struct Attachment {
  int body_idx = data::kGround;
  math::SE3 body_from_frame;
};

/// The frames of a model, found by the paths that OpenSim writes: "/bodyset/tibia_r", "../../ground",
/// "tibia_r_offset" (a frame of the component that asks), or just a body's name in documents before 4.0. A
/// PhysicalOffsetFrame anywhere in the model is known; it may hang on another one.
class FrameTable {
 public:
  /// `file`, `model` and `description` (its bodies) must outlive the table.
  FrameTable(XmlFile& file, pugi::xml_node model, const data::ModelDescription& description);

  /// The frame `path` as seen from the component `owner`. Failures are noted in the file at `owner`; then the
  /// ground.
  [[nodiscard]] Attachment resolve(std::string_view path, pugi::xml_node owner);

  /// Frame named by the socket `name` of `owner` in any spelling: <socket_name>, <connectors>, <name>. No
  /// value if the component has no such socket.
  [[nodiscard]] std::optional<Attachment> socket(pugi::xml_node owner, const std::string& name);

  /// The PhysicalOffsetFrame of that name, wherever it stands; no value without one, or where several have
  /// it.
  [[nodiscard]] std::optional<Attachment> offset_frame(std::string_view name);

 private:
  [[nodiscard]] std::optional<Attachment> lookup(const std::string& absolute_path);
  [[nodiscard]] std::optional<Attachment> by_last_name(std::string_view path);
  [[nodiscard]] Attachment offset_frame(pugi::xml_node node);

  XmlFile& file_;
  pugi::xml_node model_;
  std::map<std::string, int, std::less<>> bodies_;                   // name -> index
  std::map<std::string, pugi::xml_node, std::less<>> frames_;        // absolute path -> PhysicalOffsetFrame
  std::multimap<std::string, pugi::xml_node, std::less<>> by_name_;  // name -> PhysicalOffsetFrame
  std::map<pugi::xml_node, Attachment> resolved_;
  int depth_ = 0;  // of offset frames on offset frames being resolved
};

/// Rotation (body-fixed X-Y-Z angles) and translation in two child elements of `node`.
[[nodiscard]] math::SE3 read_transform(XmlFile& file, pugi::xml_node node, const char* translation,
                                       const char* orientation);

}  // namespace kinemark::io::osim
