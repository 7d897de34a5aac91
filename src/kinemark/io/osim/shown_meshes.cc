// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/shown_meshes.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/legacy.h"
#include "kinemark/io/osim/internal/xml_file.h"
#include "kinemark/math/euler.h"

namespace kinemark::io {
namespace {

using data::ShownMesh;
using Eigen::Vector3d;
using osim::XmlFile;

constexpr std::size_t kMostMeshes = 2000;
constexpr double kHidden = 0.0;

class Reader {
 public:
  Reader(XmlFile& file, pugi::xml_node model, const data::ModelDescription& description)
      : file_(file), description_(description), frames_(file, model, description) {}

  /// Element by element, in the order of the file.
  void read(pugi::xml_node node) {
    struct Walker : pugi::xml_tree_walker {
      Reader* reader = nullptr;
      bool for_each(pugi::xml_node& at) override {
        const std::string_view tag = at.name();
        if (tag == "Mesh")
          reader->read_mesh(at);
        else if (tag == "VisibleObject" && std::string_view(at.parent().name()) == "Body")
          reader->read_visible(at);
        return reader->meshes_.size() <= kMostMeshes && !reader->file_.error();
      }
    } walker;
    walker.reader = this;
    node.traverse(walker);
    if (meshes_.size() > kMostMeshes) file_.note(node, fmt::format("shows more than {} meshes", kMostMeshes));
  }

  std::vector<ShownMesh> take() { return std::move(meshes_); }

 private:
  void add(std::string body, std::string name, const Vector3d& scale, const math::SE3& body_from_mesh) {
    if (name.empty() || body == "ground") return;
    meshes_.push_back(
        {.body = std::move(body), .file = std::move(name), .scale = scale, .body_from_mesh = body_from_mesh});
  }

  /// From 4.0 on: a component that names its frame.
  void read_mesh(pugi::xml_node mesh) {
    const auto appearance = mesh.child("Appearance");
    const auto shown = appearance.child("SurfaceProperties");
    if (shown && file_.number(shown, "representation", 3.0) == kHidden) return;
    const auto visible = appearance ? file_.flag(appearance, "visible", true) : true;
    if (!visible) return;
    // One without a name adds no step to its path, and one without a socket hangs on what it stands in.
    const bool is_named = !osim::name_of(mesh).empty();
    auto frame = is_named ? frames_.socket(mesh, "frame") : std::nullopt;
    if (!frame) frame = frames_.resolve(is_named ? ".." : ".", mesh);
    if (frame->body_idx == data::kGround) return;
    add(description_.bodies[static_cast<std::size_t>(frame->body_idx)].name, osim::text_of(mesh, "mesh_file"),
        file_.vector3(mesh, "scale_factors", Vector3d::Ones()), frame->body_from_frame);
  }

  /// Six numbers: body-fixed x, y, z rotations in rad, then m.
  math::SE3 pose(pugi::xml_node node) {
    const auto v = file_.numbers(node, "transform");
    if (v.size() != 6) return {};
    return {.rotation = math::from_body_xyz({v[0], v[1], v[2]}), .translation = {v[3], v[4], v[5]}};
  }

  /// Before 4.0: shapes of a body, each with a scale and a pose within those of the whole. The preference of
  /// the whole does not hide them: OpenSim 4 shows such bodies too.
  void read_visible(pugi::xml_node visible) {
    const std::string body = osim::name_of(visible.parent());
    const Vector3d scale = file_.vector3(visible, "scale_factors", Vector3d::Ones());
    const math::SE3 whole = pose(visible);
    for (const auto shape : osim::objects_of(visible, "GeometrySet")) {
      if (file_.number(shape, "display_preference", 4.0) == kHidden) continue;
      add(body, osim::text_of(shape, "geometry_file"),
          scale.cwiseProduct(file_.vector3(shape, "scale_factors", Vector3d::Ones())), whole * pose(shape));
    }
    for (auto& name : osim::words_of(osim::text_of(visible, "geometry_files"))) add(body, name, scale, whole);
  }

  XmlFile& file_;
  const data::ModelDescription& description_;
  osim::FrameTable frames_;
  std::vector<ShownMesh> meshes_;
};

Result<std::vector<ShownMesh>> read(XmlFile file, const std::filesystem::path* folder,
                                    const data::ModelDescription& description) {
  file.inline_files(folder);
  const pugi::xml_node model = file.find_object({"Model"});
  if (file.error()) return std::unexpected(*file.error());
  osim::modernise(model);
  Reader reader(file, model, description);
  reader.read(model);
  if (file.error()) return std::unexpected(*file.error());
  return reader.take();
}

}  // namespace

Result<std::vector<ShownMesh>> read_shown_meshes(const std::filesystem::path& path,
                                                 const data::ModelDescription& model) {
  auto file = XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  const std::filesystem::path folder = path.parent_path();
  return read(std::move(*file), &folder, model);
}

Result<std::vector<ShownMesh>> parse_shown_meshes(std::string_view xml, std::string_view name,
                                                  const data::ModelDescription& model) {
  auto file = XmlFile::parse(xml, std::string(name));
  if (!file) return std::unexpected(file.error());
  return read(std::move(*file), nullptr, model);
}

}  // namespace kinemark::io
