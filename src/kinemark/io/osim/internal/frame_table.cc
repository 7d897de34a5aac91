// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/frame_table.h"

#include <fmt/core.h>

#include <cctype>
#include <vector>

#include "kinemark/math/euler.h"

namespace kinemark::io::osim {
namespace {

constexpr int kMaxFrameDepth = 50;
constexpr std::size_t kMaxFrames = 100'000,
                      kMaxPath = 1000;  // bounds on the memory that a hostile file can claim

/// The part that a component adds to the paths of those below it: its name, or for a set without one the
/// lower-case tag
/// ("jointset"). Elements that are neither ("objects", "frames") add nothing.
std::string path_step(pugi::xml_node node) {
  if (std::string name = name_of(node); !name.empty()) return name;
  std::string tag = node.name();
  if (!tag.ends_with("Set")) return "";
  for (char& c : tag) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return tag;
}

/// "/jointset/knee_r/tibia_offset"; the model itself is "".
std::string absolute_path(pugi::xml_node node, pugi::xml_node model) {
  std::string path;
  for (; node && node != model; node = node.parent())
    if (const std::string step = path_step(node); !step.empty()) path = "/" + step + path;
  return path;
}

/// Without "." and "..".
std::string normalised(std::string_view path) {
  std::vector<std::string_view> steps;
  while (!path.empty()) {
    const std::size_t n = std::min(path.find('/'), path.size());
    const std::string_view step = path.substr(0, n);
    path.remove_prefix(std::min(n + 1, path.size()));
    if (step.empty() || step == ".") continue;
    if (step != "..") {
      steps.push_back(step);
    } else if (!steps.empty()) {
      steps.pop_back();
    }
  }
  std::string result;
  for (const auto step : steps) result.append("/").append(step);
  return result;
}

}  // namespace

math::SE3 read_transform(XmlFile& file, pugi::xml_node node, const char* translation,
                         const char* orientation) {
  return {.rotation = math::from_body_xyz(file.vector3(node, orientation)),
          .translation = file.vector3(node, translation)};
}

FrameTable::FrameTable(XmlFile& file, pugi::xml_node model, const data::ModelDescription& description)
    : file_(file), model_(model) {
  for (std::size_t i = 0; i < description.bodies.size(); ++i)
    bodies_.try_emplace(description.bodies[i].name, static_cast<int>(i));
  bodies_.insert_or_assign("ground", data::kGround);
  struct Finder : pugi::xml_tree_walker {
    FrameTable* table = nullptr;
    bool for_each(pugi::xml_node& node) override {
      if (std::string_view(node.name()) == "PhysicalOffsetFrame") {
        std::string path = absolute_path(node, table->model_);
        if (path.size() > kMaxPath || table->frames_.size() >= kMaxFrames) {
          table->file_.note(node, fmt::format("has a path of {} characters, or is one of more than {} frames",
                                              path.size(), kMaxFrames));
          return false;
        }
        table->frames_.try_emplace(std::move(path), node);
        table->by_name_.emplace(name_of(node), node);
      }
      return true;
    }
  } finder;
  finder.table = this;
  model.traverse(finder);
}

std::optional<Attachment> FrameTable::lookup(const std::string& path) {
  if (const auto frame = frames_.find(path); frame != frames_.end()) return offset_frame(frame->second);
  std::string_view body = path;
  if (body.starts_with("/bodyset/"))
    body.remove_prefix(9);
  else if (body == "/ground")
    body.remove_prefix(1);
  else
    return std::nullopt;
  const auto it = bodies_.find(body);
  return it == bodies_.end() ? std::nullopt : std::optional(Attachment{.body_idx = it->second});
}

std::optional<Attachment> FrameTable::by_last_name(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  if (const auto body = bodies_.find(name); body != bodies_.end())
    return Attachment{.body_idx = body->second};
  return offset_frame(name);
}

std::optional<Attachment> FrameTable::offset_frame(std::string_view name) {
  if (by_name_.count(name) != 1) return std::nullopt;
  return offset_frame(by_name_.find(name)->second);
}

Attachment FrameTable::offset_frame(pugi::xml_node node) {
  if (const auto known = resolved_.find(node); known != resolved_.end()) return known->second;
  if (depth_ >= kMaxFrameDepth) {
    file_.note(node, "hangs on a chain of offset frames that is a circle or too long");
    return {};
  }
  ++depth_;
  Attachment frame;
  if (const auto parent = socket(node, "parent"))
    frame = *parent;
  else
    file_.note(node, "does not name its frame");
  --depth_;
  frame.body_from_frame = frame.body_from_frame * read_transform(file_, node, "translation", "orientation");
  return resolved_.insert_or_assign(node, frame).first->second;
}

Attachment FrameTable::resolve(std::string_view path, pugi::xml_node owner) {
  if (path.starts_with('/')) {
    if (const auto found = lookup(normalised(path))) return *found;
  } else {
    // Relative to the component itself; interim versions wrote paths relative to its owner.
    for (pugi::xml_node from = owner; from; from = from == model_ ? pugi::xml_node() : from.parent())
      if (const auto found = lookup(normalised(absolute_path(from, model_) + "/" + std::string(path))))
        return *found;
  }
  if (const auto found = by_last_name(path)) return *found;
  file_.note(owner,
             fmt::format("refers to the body or frame {}, which the model does not have", in_quotes(path)));
  return {};
}

std::optional<Attachment> FrameTable::socket(pugi::xml_node owner, const std::string& name) {
  std::string path = text_of(owner, ("socket_" + name).c_str());
  if (path.empty())
    for (const pugi::xml_node connector : owner.child("connectors").children())
      if (name_of(connector) == name) path = text_of(connector, "connectee_name");
  if (path.empty()) path = text_of(owner, name.c_str());
  return path.empty() ? std::nullopt : std::optional(resolve(path, owner));
}

}  // namespace kinemark::io::osim
