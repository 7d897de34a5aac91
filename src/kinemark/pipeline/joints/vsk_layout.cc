// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/vsk_layout.h"

#include <fmt/core.h>

#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/name_index.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kMarkersListed = 8;

bool turns_about_a_point(io::VskJointKind kind) {
  using enum io::VskJointKind;
  return kind == ball || kind == hardy_spicer || kind == hinge;
}

/// Of each segment the one that it is one body with: itself, or what it is fixed to.
std::vector<int> bodies_of(const io::Vsk& vsk) {
  std::vector<int> body;
  for (const io::VskSegment& segment : vsk.segments) {
    const bool fixed = segment.kind == io::VskJointKind::fixed && segment.parent >= 0;
    body.push_back(fixed ? body[at(segment.parent)] : static_cast<int>(body.size()));
  }
  return body;
}

}  // namespace

Result<data::SegmentLayout> layout_of(const io::Vsk& vsk, const std::vector<std::string>& markers,
                                      std::vector<std::string>& warnings) {
  const data::NameIndex index(markers);
  const std::vector<int> body = bodies_of(vsk);
  std::vector<std::vector<int>> on_body(vsk.segments.size());
  std::vector<std::string> lacking;
  for (const io::VskMarker& marker : vsk.markers) {
    const auto m = index.find(marker.name);
    if (m < 0 && index.ambiguous(marker.name))
      return fail(Code::bad_input,
                  fmt::format("more than one marker in the recording is called '{}'; it has {}", marker.name,
                              index.instead_of(marker.name)));
    if (m < 0)
      lacking.push_back(marker.name);
    else
      on_body[at(body[at(marker.segment)])].push_back(static_cast<int>(m));
  }
  if (!lacking.empty())
    warnings.push_back(fmt::format("Not in the recording: {} of the {} markers of the subject: {}.",
                                   lacking.size(), vsk.markers.size(), join_some(lacking, kMarkersListed)));

  data::SegmentLayout layout;
  std::vector<int> number(vsk.segments.size(), -1);
  for (std::size_t s = 0; s < vsk.segments.size(); ++s) {
    if (on_body[s].empty()) continue;
    number[s] = static_cast<int>(layout.segments.size());
    layout.segments.push_back({vsk.segments[s].name, std::move(on_body[s])});
  }
  for (std::size_t s = 0; s < vsk.segments.size(); ++s) {
    const io::VskSegment& segment = vsk.segments[s];
    if (number[s] < 0 || segment.parent < 0 || !turns_about_a_point(segment.kind)) continue;
    const int parent = number[at(body[at(segment.parent)])];
    if (parent < 0) continue;
    const std::string name = vsk.segments[at(body[at(segment.parent)])].name + "-" + segment.name;
    layout.joints.push_back({segment.joint.empty() ? name : segment.joint, parent, number[s]});
  }
  if (layout.joints.empty())
    return fail(Code::bad_input,
                fmt::format("no joint lies between two segments of which the recording has markers; it has "
                            "{} of the {} markers of the subject",
                            vsk.markers.size() - lacking.size(), vsk.markers.size()));
  if (auto s = layout.validate(static_cast<std::int64_t>(markers.size())); !s)
    return std::unexpected(s.error());
  return layout;
}

}  // namespace kinemark::pipeline
