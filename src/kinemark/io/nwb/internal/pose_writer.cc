// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/pose_writer.h"

#include <fmt/core.h>

#include <set>

#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

constexpr const char* kNamespace = "ndx-pose";
constexpr const char* kSkeleton = "skeleton";

Handle typed_group(Output& out, hid_t parent, const char* name, const char* type) {
  Handle group = out.group(parent, name);
  out.declare(group.id(), type, kNamespace);
  return group;
}

/// Names for the series among what else a PoseEstimation holds.
std::vector<std::string> pose_names(const std::vector<std::string>& series_names) {
  std::set<std::string> used(series_names.begin(), series_names.end());
  const std::set<std::string> taken{"description", "source_software", kSkeleton,
                                    "scorer",      "dimensions",      "device"};
  std::vector<std::string> out = series_names;
  for (std::string& name : out)
    if (taken.contains(name))
      while (!used.insert(name).second || taken.contains(name)) name.insert(0, "_");
  return out;
}

}  // namespace

std::vector<PoseSeries> write_pose(Output& out, hid_t module, const std::string& room,
                                   const NwbMetadata& metadata, const std::vector<std::string>& series_names,
                                   std::int64_t frames, int compression) {
  const Handle skeletons = typed_group(out, module, kSkeletons, "Skeletons");
  const Handle skeleton = typed_group(out, skeletons.id(), kSkeleton, "Skeleton");
  const std::vector<std::string> names = pose_names(series_names);
  out.texts(skeleton.id(), "nodes", names);

  const Handle pose = typed_group(out, module, kPose, "PoseEstimation");
  out.text(pose.id(), "description", "positions of markers; their data are those of Position");
  const Handle software = out.text(pose.id(), "source_software", metadata.software);
  out.attribute(software.id(), "version", metadata.version.empty() ? "unknown" : metadata.version);
  out.soft_link(pose.id(), kSkeleton, fmt::format("{}/{}/{}", room, kSkeletons, kSkeleton));
  std::vector<PoseSeries> made;
  for (std::size_t m = 0; m < names.size(); ++m) {
    Handle series = typed_group(out, pose.id(), names[m].c_str(), "PoseEstimationSeries");
    out.attribute(series.id(), "description", fmt::format("position (x, y, z) of marker {}", names[m]));
    out.attribute(series.id(), "comments", "no comments");
    out.text(series.id(), "reference_frame", metadata.reference_frame);
    out.soft_link(series.id(), "data", fmt::format("{}/{}/{}/data", room, kPosition, series_names[m]));
    Handle confidence = out.samples(series.id(), "confidence", H5T_IEEE_F32LE, frames, 1, 0.0, compression);
    out.attribute(confidence.id(), "definition",
                  "1: measured; 0.5: made from measured samples (interpolated, model_filled or upsampled, as "
                  "control of the series in Position says); 0: missing or rejected");
    made.push_back({std::move(series), std::move(confidence)});
  }
  return made;
}

float confidence_of(data::SampleState state) {
  switch (state) {
    case data::SampleState::measured:
      return 1.0F;
    case data::SampleState::interpolated:
    case data::SampleState::model_filled:
    case data::SampleState::upsampled:
      return 0.5F;
    case data::SampleState::missing:
    case data::SampleState::rejected:
      break;
  }
  return 0.0F;
}

}  // namespace kinemark::io::internal
