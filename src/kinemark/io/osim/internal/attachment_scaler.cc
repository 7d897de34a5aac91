// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/attachment_scaler.h"

#include <map>
#include <string>
#include <string_view>

#include "kinemark/io/osim/internal/format_xml.h"
#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/function_edit.h"
#include "kinemark/io/osim/internal/path_xml.h"
#include "kinemark/math/euler.h"

namespace kinemark::io::osim {
namespace {

using Eigen::Vector3d;

void multiply(XmlFile& file, pugi::xml_node node, const char* child, double factor) {
  if (!text_of(node, child).empty()) set_numbers(node, child, {file.number(node, child, 1.0) * factor});
}

void multiply(XmlFile& file, pugi::xml_node node, const char* child, const Vector3d& factors) {
  if (!text_of(node, child).empty())
    set_vector3(node, child, file.vector3(node, child).cwiseProduct(factors));
}

/// Finds the bodies of attachments and stretches one kind of attachment after the other.
class AttachmentScaler {
 public:
  AttachmentScaler(XmlFile& file, pugi::xml_node model, const data::ModelDescription& description,
                   std::span<const Vector3d> factors)
      : file_(file),
        model_(model),
        frames_(file, model, description),
        description_(description),
        factors_(factors) {}

  void scale_points() {
    for (const char* tag : {"PathPoint", "ConditionalPathPoint", "MovingPathPoint", "Station"})
      for (const pugi::xml_node point : descendants(model_, tag)) {
        const auto frame = frame_of_point(frames_, point);
        if (!frame) continue;
        const Vector3d factors = of(frame->body_idx);
        multiply(file_, point, "location", factors);
        for (std::size_t i = 0; i < kPositions.size(); ++i)
          if (const pugi::xml_node function = first_element(point.child(kPositions[i])))
            multiply_function(file_, function, factors[static_cast<Eigen::Index>(i)]);
      }
  }

  /// Each axis of a surface grows by the length that its unit vector gets.
  void scale_surfaces() {
    for (const pugi::xml_node set : descendants(model_, "WrapObjectSet"))
      for (const pugi::xml_node surface : set.child("objects").children()) {
        const Vector3d factors = of(body_of(set.parent()));
        const Eigen::Matrix3d axes = math::from_body_xyz(file_.vector3(surface, "xyz_body_rotation"));
        const Vector3d growth = (factors.asDiagonal() * axes).colwise().norm();
        const double across = 0.5 * (growth.x() + growth.y());
        const bool is_sphere = std::string_view(surface.name()) == "WrapSphere";
        multiply(file_, surface, "translation", factors);
        multiply(file_, surface, "radius", is_sphere ? growth.mean() : across);
        multiply(file_, surface, "length", growth.z());
        multiply(file_, surface, "inner_radius", across);
        multiply(file_, surface, "outer_radius", across);
        multiply(file_, surface, "dimensions", growth);
      }
  }

  void scale_geometry() {
    for (const pugi::xml_node list : descendants(model_, "attached_geometry"))
      for (const pugi::xml_node geometry : list.children()) {
        if (geometry.type() != pugi::node_element) continue;
        const Vector3d shape = file_.vector3(geometry, "scale_factors", Vector3d::Ones());
        set_vector3(geometry, "scale_factors", shape.cwiseProduct(of(body_of(list.parent()))));
      }
    for (const pugi::xml_node shown : descendants(model_, "VisibleObject"))  // before 4.0
      if (std::string_view(shown.parent().name()) == "Body") scale_old_geometry(shown);
  }

  void scale_frames() {
    for (const pugi::xml_node frame : descendants(model_, "PhysicalOffsetFrame"))
      multiply(file_, frame, "translation", of(body_of(frame)));
  }

 private:
  [[nodiscard]] Vector3d of(int body_idx) const {
    if (body_idx < 0 || static_cast<std::size_t>(body_idx) >= factors_.size()) return Vector3d::Ones();
    return factors_[static_cast<std::size_t>(body_idx)];
  }

  /// Body of an element that is a body, the ground or an offset frame.
  [[nodiscard]] int body_of(pugi::xml_node node) {
    if (std::string_view(node.name()) == "Body") return description_.find_body(name_of(node));
    const auto frame = frames_.socket(node, "parent");
    return frame ? frame->body_idx : data::kGround;
  }

  void scale_old_geometry(pugi::xml_node shown) {
    const Vector3d factors = of(body_of(shown.parent()));
    const Vector3d shape = file_.vector3(shown, "scale_factors", Vector3d::Ones());
    set_vector3(shown, "scale_factors", shape.cwiseProduct(factors));
    for (const pugi::xml_node geometry : objects_of(shown, "GeometrySet")) {
      auto pose = file_.numbers(geometry, "transform");  // three angles, then the place
      if (pose.size() != 6) continue;
      for (std::size_t i = 0; i < 3; ++i) pose[i + 3] *= factors[static_cast<Eigen::Index>(i)];
      set_numbers(geometry, "transform", pose);
    }
  }

  XmlFile& file_;
  pugi::xml_node model_;
  FrameTable frames_;
  const data::ModelDescription& description_;
  std::span<const Vector3d> factors_;
};

}  // namespace

void scale_attachments(XmlFile& file, pugi::xml_node model, const data::ModelDescription& description,
                       std::span<const Vector3d> factors) {
  AttachmentScaler scaler(file, model, description, factors);
  scaler.scale_points();
  scaler.scale_surfaces();
  scaler.scale_geometry();
  scaler.scale_frames();
}

void scale_rest_lengths(XmlFile& file, pugi::xml_node model, std::span<const data::PathScale> paths) {
  std::map<std::string, double, std::less<>> ratios;
  for (const auto& path : paths) ratios.emplace(path.name, path.ratio);
  for (const pugi::xml_node path : descendants(model, "GeometryPath")) {
    const pugi::xml_node owner = owner_of_path(path);
    const auto found = ratios.find(name_of(owner));
    if (found == ratios.end()) continue;
    for (const char* length :
         {"optimal_fiber_length", "tendon_slack_length", "resting_length", "slack_length"})
      multiply(file, owner, length, found->second);
  }
}

}  // namespace kinemark::io::osim
