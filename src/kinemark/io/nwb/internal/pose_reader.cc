// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/pose_reader.h"

#include <fmt/core.h>

namespace kinemark::io {

Status PoseTable::validate() const {
  std::size_t need = 3;
  if (frames < 0 || __builtin_mul_overflow(need, static_cast<std::size_t>(frames), &need) ||
      __builtin_mul_overflow(need, people.size(), &need) ||
      __builtin_mul_overflow(need, points.size(), &need) || need != values.size())
    return fail(Code::bad_input, fmt::format("{} frames of {} people with {} points do not fit {} values",
                                             frames, people.size(), points.size(), values.size()));
  return {};
}

namespace internal {
namespace {

/// The group that pandas wrote a table into: DeepLabCut's own name for it, else the first.
Handle table_group(Input& in) {
  const auto is_table = [&](hid_t group) { return in.text_attribute(group, "pandas_type").has_value(); };
  if (Handle usual = in.object(in.file(), "df_with_missing"); usual && is_table(usual.id())) return usual;
  if (const auto names = in.children(in.file()))
    for (const auto& name : *names)
      if (Handle group = in.object(in.file(), name); group && is_table(group.id())) return group;
  return {};
}

bool is_sleap(Input& in) {
  return static_cast<bool>(in.object(in.file(), "tracks")) &&
         static_cast<bool>(in.object(in.file(), "node_names"));
}

/// A project of SLEAP keeps records of instances.
bool is_sleap_project(Input& in) {
  return static_cast<bool>(in.object(in.file(), "instances")) &&
         static_cast<bool>(in.object(in.file(), "metadata"));
}

Result<PoseTable> read_any(Input& in) {
  if (is_sleap(in)) return read_sleap(in);
  if (is_sleap_project(in))
    return fail(Code::not_supported,
                "is a project of SLEAP; export its points with 'Export Analysis HDF5' and give that file");
  if (const Handle group = table_group(in)) return read_deeplabcut(in, group.id());
  return fail(
      Code::bad_input,
      "is HDF5, but no points in images: it has neither tracks and node_names (an analysis file of SLEAP) "
      "nor a table of pandas (DeepLabCut). Nothing was read.");
}

}  // namespace

bool holds_poses(Input& in) {
  return is_sleap(in) || is_sleap_project(in) || static_cast<bool>(table_group(in));
}

Result<PoseTable> read_pose_table(Input& in) {
  auto out = read_any(in);
  if (!out) return fail_at(in.name(), out.error());
  if (auto status = out->validate(); !status) return fail_at(in.name(), status.error());
  return out;
}

Result<PoseTable> read_pose_table_here(const std::filesystem::path& path) {
  const Quiet quiet;
  auto in = Input::open(path);
  if (!in) return std::unexpected(in.error());
  return read_pose_table(*in);
}

}  // namespace internal
}  // namespace kinemark::io
