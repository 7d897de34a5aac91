// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/content_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/metadata.h"

namespace kinemark::io::internal {
namespace {

// Groups of NWB itself: what is in them is listed, not they.
constexpr std::array kFrames = {"/acquisition",        "/analysis",  "/general",
                                "/intervals",          "/stimulus",  "/stimulus/presentation",
                                "/stimulus/templates", "/processing"};

// What a file of ours has at its root and below /general.
constexpr std::array kOwnHead = {"/file_create_date",        "/identifier",      "/session_description",
                                 "/session_start_time",      "/general/subject", "/timestamps_reference_time",
                                 "/general/was_generated_by"};

constexpr std::array kContainers = {kPosition, kPose,       kSkeletons, kMethod,  kCovariance,
                                    kOffset,   kUnfiltered, kResidual,  kCameras, kChannels};
constexpr std::array kTables = {kMarkersTable,    kChannelsTable,    kAnalogTable,
                                kEventsTable,     kPlatesTable,      kMethodsTable,
                                kProvenanceTable, kCalibrationTable, kSourcesTable};
constexpr std::array kMeasureTables = {"measures", "measures_tidy", "measure_definitions"};

template <class Names>
bool among(const Names& names, std::string_view name) {
  return std::ranges::find(names, name) != std::end(names);
}

/// A name within a processing module that the writer of positions gives.
bool is_our_name(std::string_view name) {
  return among(kContainers, name) || among(kTables, name) ||
         std::ranges::any_of(kRates, [name](const Rate& rate) { return rate.container == name; });
}

void add_children(const Input& in, const std::string& path, std::vector<std::string>& out) {
  const Handle group = in.object(in.file(), path.empty() ? "/" : path);
  const auto names = in.children(group.id());
  if (!names) return;
  for (const auto& name : *names) {
    const std::string child = path + "/" + name;
    if (among(kFrames, child)) {
      add_children(in, child, out);
    } else if (path == "/processing") {
      out.push_back(child + "/");
      add_children(in, child, out);
    } else {
      out.push_back(child);
    }
  }
}

/// Of a file of ours that lists nothing.
bool is_known(const std::string& path) {
  const std::string module = std::string(kModule) + "/";
  if (path == module || among(kOwnHead, path)) return true;
  if (path.starts_with(module)) {
    const auto name = std::string_view(path).substr(module.size());
    return is_our_name(name) || among(kMeasureTables, name);
  }
  return path.starts_with(std::string(kAcquisition) + "/analog") ||
         path == std::string(kIntervals) + "/" + kUnloaded;
}

/// What write_neural() puts beside a movement: no result replaces it, and what is made from the file keeps
/// it, as that of others.
bool is_beside(const std::string& path) {
  const std::string unloaded = std::string(kIntervals) + "/" + kUnloaded;
  return path == "/units" || path == "/general/devices" || path == "/general/extracellular_ephys" ||
         path.starts_with("/processing/ecephys/") ||
         (path.starts_with(std::string(kIntervals) + "/") && path != unloaded);
}

}  // namespace

std::string module_of(const Input& in) {
  const auto named = in.text_attribute(in.file(), kModuleAttribute);
  return named && named->starts_with("/processing/") ? *named : kModule;
}

std::vector<std::string> all_content(const Input& in) {
  std::vector<std::string> out;
  add_children(in, "", out);
  std::erase_if(out, is_beside);
  return out;
}

std::optional<std::vector<std::string>> listed_content(const Input& in) {
  return in.text_attributes(in.file(), kContentAttribute);
}

std::vector<std::string> our_content(Input& in) {
  if (auto listed = listed_content(in)) return std::move(*listed);
  const Handle generated = in.object(in.file(), "/general/was_generated_by");
  const auto software = in.texts(generated.id());
  if (!software || software->empty() || software->front() != NwbMetadata{}.software) return {};
  auto out = all_content(in);
  std::erase_if(out, [](const std::string& path) { return !is_known(path); });
  return out;
}

bool covers(const std::vector<std::string>& content, std::string_view path) {
  return std::ranges::any_of(content, [path](const std::string& ours) {
    return path == ours || (!ours.ends_with('/') && path.size() > ours.size() && path.starts_with(ours) &&
                            path[ours.size()] == '/');
  });
}

std::string room_for_positions(Input& in) {
  const auto ours = our_content(in);
  const auto taken = [&](const std::string& module) {
    const Handle group = in.object(in.file(), module);
    if (!group) return false;
    const auto names = in.children(group.id());
    return !names || std::ranges::any_of(*names, [&](const std::string& name) {
      return is_our_name(name) && !covers(ours, module + "/" + name);
    });
  };
  if (const auto before = module_of(in); !taken(before)) return before;
  std::string out = "/processing/kinemark";
  for (int number = 2; taken(out); ++number) out = fmt::format("/processing/kinemark_{}", number);
  return out;
}

}  // namespace kinemark::io::internal
