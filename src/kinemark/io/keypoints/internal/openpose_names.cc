// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/openpose_names.h"

#include <fmt/core.h>

#include <span>

namespace kinemark::io::internal {
namespace {

constexpr std::array kBody25 = {
    "Nose", "Neck",    "RShoulder", "RElbow", "RWrist",  "LShoulder", "LElbow", "LWrist", "MidHip",
    "RHip", "RKnee",   "RAnkle",    "LHip",   "LKnee",   "LAnkle",    "REye",   "LEye",   "REar",
    "LEar", "LBigToe", "LSmallToe", "LHeel",  "RBigToe", "RSmallToe", "RHeel"};
constexpr std::array kCoco18 = {"Nose",   "Neck",   "RShoulder", "RElbow", "RWrist", "LShoulder",
                                "LElbow", "LWrist", "RHip",      "RKnee",  "RAnkle", "LHip",
                                "LKnee",  "LAnkle", "REye",      "LEye",   "REar",   "LEar"};
constexpr std::array kMpi15 = {"Head",      "Neck",   "RShoulder", "RElbow", "RWrist",
                               "LShoulder", "LElbow", "LWrist",    "RHip",   "RKnee",
                               "RAnkle",    "LHip",   "LKnee",     "LAnkle", "Chest"};
constexpr std::size_t kHand = 21, kFace = 70;

std::span<const char* const> body_names(std::size_t points) {
  if (points == kBody25.size()) return kBody25;
  if (points == kCoco18.size()) return kCoco18;
  if (points == kMpi15.size()) return kMpi15;
  return {};
}

void number(std::vector<std::string>& names, const char* part, std::size_t points) {
  for (std::size_t i = 0; i < points; ++i) names.push_back(fmt::format("{}{}", part, i));
}

}  // namespace

std::string describe(const OpenPoseLayout& layout) {
  std::string out;
  for (std::size_t part = 0; part < layout.size(); ++part)
    if (layout[part] > 0)
      out += fmt::format("{}{} {}", out.empty() ? "" : ", ", kOpenPoseParts[part].name, layout[part]);
  return out;
}

Result<std::vector<std::string>> openpose_names(const OpenPoseLayout& layout) {
  const auto [body, left, right, face] = layout;
  const auto known = body_names(body);
  if ((body != 0 && known.empty()) || (left != 0 && left != kHand) || (right != 0 && right != kHand) ||
      (face != 0 && face != kFace))
    return fail(Code::not_supported,
                fmt::format("people have points of {}; known are body 25, 18 or 15, hand 21, face 70",
                            describe(layout)));
  std::vector<std::string> names(known.begin(), known.end());
  number(names, "LHand", left);
  number(names, "RHand", right);
  number(names, "Face", face);
  return names;
}

}  // namespace kinemark::io::internal
