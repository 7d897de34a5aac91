// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/beside.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

constexpr int kMostGroupsBelow = 32;
constexpr std::size_t kMostObjects = 20'000;

// What every file has and nobody asks for.
constexpr std::array kNotNamed = {"/identifier",
                                  "/session_description",
                                  "/file_create_date",
                                  "/acquisition",
                                  "/analysis",
                                  "/general",
                                  "/stimulus",
                                  "/stimulus/presentation",
                                  "/stimulus/templates",
                                  "/processing",
                                  "/timestamps_reference_time",
                                  "/general/was_generated_by"};

struct Link {
  std::string name;
  H5L_type_t type;
};

herr_t collect_link(hid_t, const char* name, const H5L_info_t* info, void* out) {
  auto& links = *static_cast<std::vector<Link>*>(out);
  links.push_back({name, info->type});
  return links.size() < kMostObjects ? 0 : 1;
}

/// The file that a link to another one names.
std::string target_file(hid_t group, const std::string& name) {
  H5L_info_t info{};
  if (H5Lget_info(group, name.c_str(), &info, H5P_DEFAULT) < 0 || info.u.val_size == 0 ||
      info.u.val_size > (1U << 16))
    return "?";
  std::string value(info.u.val_size, '\0');
  const char* file = nullptr;
  const char* object = nullptr;
  if (H5Lget_val(group, name.c_str(), value.data(), value.size(), H5P_DEFAULT) < 0 ||
      H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) < 0)
    return "?";
  return file;
}

class Survey {
 public:
  Survey(Input& in, const std::set<std::string>& movement)
      : in_(in), movement_(movement), ours_(our_content(in)) {}

  void all() {
    const Handle root = in_.object(in_.file(), "/");
    H5O_info_t info{};
    if (!root || H5Oget_info2(root.id(), &info, H5O_INFO_BASIC) < 0) return closed("/");
    seen_.insert(info.addr);
    group(root.id(), "", 0);
  }
  [[nodiscard]] std::vector<data::BesideObject> objects() { return std::move(out_); }
  [[nodiscard]] bool of_others() const { return ours_.empty(); }

 private:
  void group(hid_t group, const std::string& path, int depth) {
    std::vector<Link> links;
    hsize_t at = 0;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &at, collect_link, &links) < 0) return closed(path);
    for (const auto& link : links) {
      const std::string child = path + "/" + link.name;
      if (is_movement(child) || out_.size() >= kMostObjects) continue;
      if (link.type == H5L_TYPE_HARD)
        object(group, link.name, child, depth);
      else
        note_link(group, link, child);
    }
  }
  /// Ours, or read as a marker. A person and a date that somebody named are more than that.
  [[nodiscard]] bool is_movement(const std::string& path) {
    if (movement_.contains(path)) return true;
    if (path == "/session_start_time" || !covers(ours_, path)) return false;
    if (path != "/general/subject") return true;
    const Handle id = in_.object(in_.file(), "/general/subject/subject_id");
    const auto name = in_.texts(id.id());
    return name && name->size() == 1 && name->front() == kUnknownSubject;
  }

  /// Damaged, or of a type that only a newer HDF5 knows.
  void closed(const std::string& path) {
    out_.push_back({.path = path, .type = "cannot be opened", .shape = {}, .unit = {}, .lost = {}});
  }

  void note_link(hid_t group, const Link& link, const std::string& path) {
    if (link.type == H5L_TYPE_SOFT) {
      out_.push_back({.path = path,
                      .type = fmt::format("link to {}", in_.soft_link(group, link.name).value_or("?")),
                      .shape = {},
                      .unit = {},
                      .lost = {}});
      return;
    }
    out_.push_back({.path = path,
                    .type = fmt::format("link to another file, {}", target_file(group, link.name)),
                    .shape = {},
                    .unit = {},
                    .lost = "the link goes along, what it leads to does not"});
  }

  void object(hid_t parent, const std::string& name, const std::string& path, int depth) {
    const Handle object = in_.object(parent, name);
    H5O_info_t info{};
    if (!object || H5Oget_info2(object.id(), &info, H5O_INFO_BASIC) < 0) return closed(path);
    if (!seen_.insert(info.addr).second) {
      out_.push_back(
          {.path = path, .type = "another name of an object", .shape = {}, .unit = {}, .lost = {}});
    } else if (H5Iget_type(object.id()) == H5I_DATASET) {
      dataset(object.id(), path);
    } else if (H5Iget_type(object.id()) == H5I_GROUP) {
      typed(object.id(), path, depth);
    } else {
      out_.push_back({.path = path, .type = "type of values", .shape = {}, .unit = {}, .lost = {}});
    }
  }

  void dataset(hid_t dataset, const std::string& path) {
    if (std::ranges::find(kNotNamed, path) != kNotNamed.end()) return;
    data::BesideObject one{
        .path = path, .type = type_of(dataset, "dataset"), .shape = {}, .unit = {}, .lost = {}};
    if (path == "/session_start_time") {
      const auto date = in_.texts(dataset);
      if (!date || date->size() != 1 || date->front() == kUnknownDate) return;
      one.type = "date " + date->front();
    }
    describe(dataset, one);
    out_.push_back(std::move(one));
  }

  void typed(hid_t group, const std::string& path, int depth) {
    const std::string type = type_of(group, "");
    data::BesideObject one{
        .path = path, .type = type.empty() ? "group" : type, .shape = {}, .unit = {}, .lost = {}};
    if (path == "/specifications") {
      one.type = "specifications";
    } else if (H5Aexists(group, "colnames") > 0) {
      const Handle id = in_.object(group, "id");
      describe(id.id(), one);
    } else if (type.ends_with("Series") && type != "BehavioralTimeSeries") {
      const Handle data = in_.object(group, "data");
      describe(data.id(), one);
      const Handle start = in_.object(group, "starting_time");
      if (start) one.rate_hz = in_.number_attribute(start.id(), "rate").value_or(0.0);
    } else if (type.empty() || has_groups(group)) {
      const auto names = in_.children(group);
      const bool empty = names && names->empty();
      if (empty && std::ranges::find(kNotNamed, path) != kNotNamed.end()) return;
      if (!empty && depth < kMostGroupsBelow) return this->group(group, path, depth + 1);
    }
    if (!std::isfinite(one.rate_hz)) one.rate_hz = 0.0;
    out_.push_back(std::move(one));
  }

  [[nodiscard]] std::string type_of(hid_t object, const char* otherwise) const {
    return in_.text_attribute(object, "neurodata_type").value_or(otherwise);
  }

  [[nodiscard]] bool has_groups(hid_t group) const {
    std::vector<Link> links;
    hsize_t at = 0;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &at, collect_link, &links) < 0) return true;
    return std::ranges::any_of(links, [&](const Link& link) {
      if (link.type != H5L_TYPE_HARD) return link.type != H5L_TYPE_SOFT;
      const Handle child = in_.object(group, link.name);
      return H5Iget_type(child.id()) != H5I_DATASET;
    });
  }

  /// Shape and unit of a dataset, and whether its values are in the file.
  void describe(hid_t dataset, data::BesideObject& out) const {
    if (H5Iget_type(dataset) != H5I_DATASET) return;
    const Handle space(H5Dget_space(dataset), H5Sclose);
    hsize_t dims[H5S_MAX_RANK] = {};
    const int rank = H5Sget_simple_extent_dims(space.id(), dims, nullptr);
    for (int d = 0; d < rank; ++d) out.shape.push_back(static_cast<std::int64_t>(dims[d]));
    out.unit = in_.text_attribute(dataset, "unit").value_or("");
    const Handle create(H5Dget_create_plist(dataset), H5Pclose);
    if (H5Pget_layout(create.id()) == H5D_VIRTUAL || H5Pget_external_count(create.id()) > 0)
      out.lost = "its values lie in other files and stay there";
  }

  Input& in_;
  const std::set<std::string>& movement_;
  std::vector<std::string> ours_;
  std::set<haddr_t> seen_;
  std::vector<data::BesideObject> out_;
};

}  // namespace

data::Beside find_beside(Input& in, const std::set<std::string>& movement) {
  Survey survey(in, movement);
  survey.all();
  data::Beside out{.file = in.name(), .room = {}, .objects = survey.objects()};
  if (out.objects.empty() && !survey.of_others()) return {};
  out.room = room_for_positions(in);
  return out;
}

}  // namespace kinemark::io::internal
