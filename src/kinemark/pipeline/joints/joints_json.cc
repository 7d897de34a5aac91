// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_json.h"

#include <fmt/core.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/core/version.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

using report::Notice;
using report::Verdict;

/// Joints that some frames do not place.
std::vector<Notice> partly_placed(const data::Skeleton& skeleton) {
  std::vector<Notice> out;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    std::int64_t open = 0;
    for (std::int64_t f = 0; f < skeleton.frames(); ++f)
      if (skeleton.state[skeleton.index(f, static_cast<std::int64_t>(j))] == data::CentreState::undetermined)
        ++open;
    if (open > 0 && open < skeleton.frames())
      out.push_back({.subject = skeleton.joints[j].name,
                     .text = fmt::format("{}: not placed in {} of {} frames.", skeleton.joints[j].name, open,
                                         skeleton.frames())});
  }
  return out;
}

std::vector<report::NoticeGroup> groups_of(const JointsOutcome& outcome) {
  std::vector<report::NoticeGroup> groups;
  std::vector<Notice> left_out, open, slips, doubts;
  for (const auto& bad : outcome.left_out) left_out.push_back({.subject = bad.name, .text = bad.sentence()});
  std::vector<data::Gate> others;
  for (const auto& gate : outcome.gates)
    if (gate.name == "determined")
      open.push_back({.text = gate.sentence});
    else if (gate.name != "plausible")
      others.push_back(gate);
  for (const auto& slip : outcome.slips)
    slips.push_back({.text = sentence_of(slip, outcome.skeleton.time),
                     .time_s = outcome.skeleton.time.time_s(slip.first_frame)});
  for (const auto& warning : outcome.skeleton.warnings) doubts.push_back({.text = warning});
  report::add_gates(groups, others);
  report::add_group(groups, Verdict::attention, "joint", "joint not determined", "joints not determined",
                    std::move(open));
  report::add_group(groups, Verdict::attention, "joint", "segment or joint left out as no body's",
                    "segments and joints left out as no body's", std::move(left_out));
  report::add_group(groups, Verdict::attention, "joint", "doubt about the fit", "doubts about the fit",
                    std::move(doubts));
  report::add_group(groups, Verdict::good, "marker", "marker that moved on its segment",
                    "markers that moved on their segments", std::move(slips));
  report::add_group(groups, Verdict::good, "joint", "joint not placed in some frames",
                    "joints not placed in some frames", partly_placed(outcome.skeleton));
  report::add_remarks(groups, outcome.warnings);
  return groups;
}

using Json = nlohmann::ordered_json;

constexpr int kSkeletonSchemaVersion = 2;  // 2: first_frame, and frames are the recording's numbers

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class Vector>
Json numbers(const Vector& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(number(v));
  return out;
}

Json matrix(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(numbers(Eigen::Vector3d(m.row(row).transpose())));
  return rows;
}

/// How many frames have each state, and the RMS of the centre's SD (root of the trace) where there is one;
/// the same without the direction known worst, which is a hinge's axis.
struct Frames {
  std::array<std::int64_t, 4> count{};
  double sd_m = 0.0, across_sd_m = 0.0;
};

Frames count_frames(const data::Skeleton& skeleton, std::int64_t joint) {
  Frames frames;
  double squares = 0.0, across = 0.0, n = 0.0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    const auto state = skeleton.state[skeleton.index(f, joint)];
    ++frames.count[static_cast<std::size_t>(state)];
    if (state == data::CentreState::undetermined) continue;
    const Eigen::Matrix3d C = skeleton.centre_covariance(f, joint);
    if (!C.allFinite()) continue;
    squares += C.trace();
    across += C.trace() -
              Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C, Eigen::EigenvaluesOnly).eigenvalues()[2];
    n += 1.0;
  }
  frames.sd_m = n > 0.0 ? std::sqrt(squares / n) : std::nan("");
  frames.across_sd_m = n > 0.0 ? std::sqrt(across / n) : std::nan("");
  return frames;
}

/// Root of the trace of a covariance in the parent's axes (in the child's, where that alone is known), across
/// the axis of a hinge.
double sd_of(const data::SkeletonJoint& joint, const Eigen::Matrix3d& in_parent,
             const Eigen::Matrix3d& in_child) {
  const bool parent = in_parent.allFinite();
  const Eigen::Vector3d& axis = parent ? joint.axis_in_parent : joint.axis_in_child;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  return std::sqrt((across * (parent ? in_parent : in_child) * across).trace());
}

Json skin_json(const data::SkinAccount& skin) {
  return {{"verdict", data::to_string(skin.verdict)},
          {"words", skin.description},
          {"movements", skin.movements},
          {"alike", skin.alike},
          {"p_value", number(skin.p_value)},
          {"explained", number(skin.explained)},
          {"own_slide_m_per_rad", number(skin.own_slide_m)},
          {"own_slide_limit_m_per_rad", number(skin.own_limit_m)},
          {"gap_with_posture_m", number(skin.gap_m)}};
}

/// Three numbers, never one: what another part of the trial would repeat, how far the bone's joint may be,
/// and whether the recording or prior knowledge says so. And what was seen of skin.
void add_skin(const data::SkeletonJoint& joint, Json& out) {
  out["accuracy_sd_m"] = number(sd_of(joint, joint.covariance_in_parent, joint.covariance_in_child));
  out["repeatability_sd_m"] =
      number(sd_of(joint, joint.repeatability_in_parent, joint.repeatability_in_child));
  out["prior_share"] = number(joint.prior_share);
  out["source"] =
      std::isnan(joint.prior_share) ? Json(nullptr) : Json(joint.prior_dominated() ? "prior" : "recording");
  out["skin"] = skin_json(joint.skin);
}

Json joint_json(const data::Skeleton& skeleton, std::size_t j) {
  const auto& joint = skeleton.joints[j];
  const auto name = [&](int s) { return skeleton.segments[static_cast<std::size_t>(s)].name; };
  const Frames frames = count_frames(skeleton, static_cast<std::int64_t>(j));
  const bool hinge = joint.kind == data::JointKind::hinge;
  Json out;
  out["name"] = joint.name;
  out["kind"] = data::to_string(joint.kind);
  out["parent"] = name(joint.parent_segment);
  out["child"] = name(joint.child_segment);
  out["method"] = joint.method;
  out["words"] = joint.description;
  out["range_of_motion_deg"] = number(joint.range_of_motion_rad * kDegPerRad);
  const bool in_parent = joint.covariance_in_parent.allFinite(),
             in_child = joint.covariance_in_child.allFinite();
  out["centre_in_parent_m"] = in_parent ? numbers(joint.centre_in_parent) : Json(nullptr);
  out["centre_in_child_m"] = in_child ? numbers(joint.centre_in_child) : Json(nullptr);
  out["covariance_in_parent_m2"] = in_parent ? matrix(joint.covariance_in_parent) : Json(nullptr);
  out["covariance_in_child_m2"] = in_child ? matrix(joint.covariance_in_child) : Json(nullptr);
  const auto known = [](const Eigen::Matrix3d& m) { return m.allFinite() ? matrix(m) : Json(nullptr); };
  out["repeatability_in_parent_m2"] = known(joint.repeatability_in_parent);
  out["repeatability_in_child_m2"] = known(joint.repeatability_in_child);
  if (hinge) {
    out["axis_repeatability_in_parent"] = known(joint.axis_repeatability_in_parent);
    out["axis_in_parent"] = numbers(joint.axis_in_parent);
    out["axis_in_child"] = numbers(joint.axis_in_child);
    out["axis_sd_deg"] = number(joint.axis_sd_rad * kDegPerRad);
    out["axis_covariance_in_parent"] = matrix(joint.axis_covariance_in_parent);
  }
  add_skin(joint, out);
  out["centre_sd_m"] = number(frames.sd_m);
  if (hinge) out["centre_sd_across_axis_m"] = number(frames.across_sd_m);
  for (const auto state : {data::CentreState::determined, data::CentreState::bridged,
                           data::CentreState::ambiguous, data::CentreState::undetermined})
    out["frames"][std::string(data::to_string(state))] = frames.count[static_cast<std::size_t>(state)];
  return out;
}

/// A fixed joint or an end of a segment.
Json end_json(const data::Skeleton& skeleton, const data::SkeletonEnd& end) {
  Json out;
  out["name"] = end.name;
  out["kind"] = end.stays() ? "fixed" : "marker";
  out["segment"] = skeleton.segments[at(end.segment)].name;
  if (!end.stays()) out["marker"] = skeleton.markers[at(end.marker)];
  out["words"] = end.description;
  out["x_in_segment_m"] = numbers(end.x_in_segment);
  out["covariance_m2"] = matrix(end.covariance);
  if (end.stays()) {
    out["gap_m"] = number(end.gap_m);
    out["skin"] = skin_json(end.skin);
  }
  if (end.joint >= 0) {
    out["from"] = skeleton.joints[at(end.joint)].name;
    out["length_m"] = number(end.length_m);
    out["length_sd_m"] = number(end.length_sd_m);
  }
  for (const auto state :
       {data::CentreState::determined, data::CentreState::bridged, data::CentreState::undetermined})
    out["frames"][std::string(data::to_string(state))] = std::ranges::count(end.state, state);
  return out;
}

std::vector<std::string> names_of(const std::vector<int>& which, const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const int m : which) out.push_back(names[at(m)]);
  return out;
}

Json judged_json(const skeleton::JudgedJoint& joint, const std::vector<std::string>& names) {
  const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  Json out;
  out["name"] = joint.name;
  out["known"] = joint.known;
  out["parent_markers"] = names_of(joint.parent, names);
  out["child_markers"] = names_of(joint.child, names);
  out["turn_sd_deg"] = number(joint.turn_rad * kDegPerRad);
  out["gap_m"] = number(joint.gap_m);
  out["between_rivals_m"] = number(joint.spread_m);
  out["weight"] = joint.weight;
  out["rival_weight"] = joint.rival_weight;
  out["rivals"] = Json::array();
  for (const auto& rival : joint.rivals)
    out["rivals"].push_back({{"parent_markers", names_of(rival.parent, names)},
                             {"child_markers", names_of(rival.child, names)},
                             {"weight", rival.weight},
                             {"distance_m", number(rival.distance_m)}});
  if (!joint.known) out["words"] = joint.sentence(names);
  return out;
}

/// Where the segmentation comes from, the joints that are not determined, rivals.
Json segmentation_json(const JointsOutcome& outcome) {
  const auto& found = *outcome.segmentation;
  const auto& names = outcome.markers;
  Json out;
  out["from"] = found.from_names ? "names" : "data";
  out["sets"] = found.sets;
  out["segmentations_compared"] = found.rivals;
  out["words"] = workflow::describe_origin(found);
  out["put_aside"] = Json::array();
  for (const auto& aside : found.aside)
    out["put_aside"].push_back({{"marker", names[at(aside.marker)]},
                                {"segment", aside.segment},
                                {"median_distance_sd_m", aside.distance_sd_m}});
  out["model_outputs"] = names_of(found.model_outputs, names);
  out["on_neither_side"] = names_of(found.over_joints, names);
  out["on_no_segment"] = names_of(found.unplaced, names);
  out["known"] = Json::array();
  out["not_determined"] = Json::array();
  for (const auto& joint : found.joints)
    out[joint.known ? "known" : "not_determined"].push_back(judged_json(joint, names));
  return out;
}

/// How well the data tell the segments and the joints between them.
Json topology_json(const JointsOutcome& outcome) {
  const auto& topology = *outcome.topology;
  Json out;
  const auto outputs = outcome.segmentation ? outcome.segmentation->model_outputs : std::vector<int>();
  for (std::size_t m = 0; m < topology.markers.size(); ++m)
    if (std::ranges::find(outputs, static_cast<int>(m)) == outputs.end())
      out["markers"].push_back({{"name", outcome.skeleton.markers[m]},
                                {"nats", topology.markers[m].nats},
                                {"doubtful", topology.markers[m].doubtful}});
  for (std::size_t j = 0; j < topology.joints.size(); ++j) {
    const auto& joint = topology.joints[j];
    out["joints"].push_back({{"name", topology.layout.joints[j].name},
                             {"residual_m", joint.residual_m},
                             {"margin", number(joint.margin)},
                             {"doubtful", joint.doubtful}});
  }
  return out;
}

/// Segments and joints that are no body's, and what to do.
void add_left_out(const JointsOutcome& outcome, Json& json) {
  json["left_out"] = Json::array();
  for (const auto& bad : outcome.left_out)
    json["left_out"].push_back({{"kind", bad.is_segment ? "segment" : "joint"},
                                {"name", bad.name},
                                {"figure", skeleton::to_string(bad.figure)},
                                {"value_m", number(bad.value_m)},
                                {"least_m", bad.least_m},
                                {"most_m", bad.most_m},
                                {"markers", bad.markers},
                                {"words", bad.sentence()}});
  if (!outcome.next_step.empty()) json["next_step"] = outcome.next_step;
}

}  // namespace

std::string joints_page(const JointsJob& job, const JointsOutcome& outcome, std::int64_t first_frame) {
  return report::result_report_html(
      {.kind = "joints",
       .trial = job.input.filename().string(),
       .version = std::string(kVersion),
       .command_line = job.command_line,
       .groups = groups_of(outcome),
       .inputs = {outcome.input},
       .result = joints_json(job, outcome),
       .scene = report::Scene{.markers = &outcome.used,
                              .skeleton = outcome.skeleton.joints.empty() ? nullptr : &outcome.skeleton},
       .first_frame = first_frame});
}

Json joints_json(const JointsJob& job, const JointsOutcome& outcome) {
  Json json = skeleton_json(outcome.skeleton);
  json["version"] = kVersion;
  json["command"] = job.command_line;
  json["input"] = {{"path", outcome.input.path}, {"xxh3_64", outcome.input.hash}};
  json["method"] = job.method;
  json["notes"] = outcome.warnings;
  add_left_out(outcome, json);
  json["slips"] = Json::array();
  for (const auto& slip : outcome.slips)
    json["slips"].push_back({{"words", sentence_of(slip, outcome.skeleton.time)},
                             {"shift_m", slip.size},
                             {"sd_m", slip.size_sd},
                             {"frame", outcome.skeleton.time.number(slip.first_frame)}});
  for (std::size_t m = 0; m < outcome.marker_noise_sd_m.size(); ++m)
    if (std::isfinite(outcome.marker_noise_sd_m[m]))
      json["marker_noise"].push_back(
          {{"name", outcome.skeleton.markers[m]}, {"sd_m", outcome.marker_noise_sd_m[m]}});
  if (outcome.segmentation) json["segmentation"] = segmentation_json(outcome);
  if (outcome.topology) json["topology"] = topology_json(outcome);
  return json;
}

Json skeleton_json(const data::Skeleton& skeleton) {
  Json out;
  out["schema"] = "kinemark.skeleton";
  out["schema_version"] = kSkeletonSchemaVersion;
  out["frames"] = skeleton.frames();
  out["first_frame"] = skeleton.time.first_number;
  out["rate_hz"] = skeleton.time.rate_hz;
  out["noise_sd_m"] = number(skeleton.noise_sd_m);
  out["segments"] = Json::array();
  for (const auto& segment : skeleton.segments) {
    Json s;
    s["name"] = segment.name;
    s["kind"] = data::to_string(segment.kind);
    s["markers"] = Json::array();
    for (std::size_t k = 0; k < segment.markers.size(); ++k)
      s["markers"].push_back(
          {{"name", skeleton.markers[static_cast<std::size_t>(segment.markers[k])]},
           {"x_in_segment_m",
            numbers(Eigen::Vector3d(segment.x_in_segment.col(static_cast<Eigen::Index>(k))))}});
    out["segments"].push_back(std::move(s));
  }
  out["joints"] = Json::array();
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) out["joints"].push_back(joint_json(skeleton, j));
  out["lengths"] = Json::array();
  for (const auto& length : skeleton.lengths)
    out["lengths"].push_back({{"name", length.name},
                              {"from", skeleton.joints[static_cast<std::size_t>(length.joint_a)].name},
                              {"to", skeleton.joints[static_cast<std::size_t>(length.joint_b)].name},
                              {"length_m", number(length.length_m)},
                              {"sd_m", number(length.sd_m)}});
  if (!skeleton.ends.empty()) {
    out["ends"] = Json::array();
    for (const auto& end : skeleton.ends) out["ends"].push_back(end_json(skeleton, end));
  }
  out["warnings"] = skeleton.warnings;
  return out;
}

std::vector<std::string> skeleton_description(const data::Skeleton& skeleton) {
  std::vector<std::string> lines;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const auto& joint = skeleton.joints[j];
    const Frames frames = count_frames(skeleton, static_cast<std::int64_t>(j));
    const auto placed =
        skeleton.frames() - frames.count[static_cast<std::size_t>(data::CentreState::undetermined)];
    std::string line = fmt::format("{} ({}, {}): {}", joint.name, data::to_string(joint.kind),
                                   joint.method.empty() ? "not found" : joint.method, joint.description);
    line += fmt::format("; placed in {} of {} frames", placed, skeleton.frames());
    const bool hinge = joint.kind == data::JointKind::hinge;
    if (std::isfinite(frames.sd_m))
      line += hinge ? fmt::format(", SD {:.1f} mm across the axis", 1e3 * frames.across_sd_m)
                    : fmt::format(", SD {:.1f} mm", 1e3 * frames.sd_m);
    const auto ambiguous = frames.count[static_cast<std::size_t>(data::CentreState::ambiguous)];
    if (ambiguous > 0) line += fmt::format(", {} ambiguous", ambiguous);
    lines.push_back(std::move(line));
    if (!joint.skin.description.empty()) lines.push_back(joint.name + ": " + joint.skin.description);
  }
  for (const auto& end : skeleton.ends) {
    lines.push_back(end.name + (end.stays() ? " (fixed): " : " (end): ") + end.description);
    if (!end.skin.description.empty()) lines.push_back(end.name + ": " + end.skin.description);
  }
  for (const auto& length : skeleton.lengths)
    lines.push_back(
        fmt::format("{}: {:.1f} mm (SD {:.1f})", length.name, 1e3 * length.length_m, 1e3 * length.sd_m));
  return lines;
}

}  // namespace kinemark::pipeline
