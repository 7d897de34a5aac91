// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page of a source that is running: what is known before its first frame. Frames come to it later.
#pragma once

#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace kinemark::report {

/// A coordinate of the model that follows the source.
struct LiveCoordinate {
  std::string name;         ///< as in the model
  bool is_rotation = true;  ///< shown in degrees; else in mm
};

/// A body of the model.
struct LiveBody {
  std::string name;                                       ///< as in the model
  int parent = -1;                                        ///< that carries it; -1: the ground
  double mass_kg = 0.0;                                   ///< as in the model
  Eigen::Vector3d com_in_body = Eigen::Vector3d::Zero();  ///< m
};

/// A marker of the model that follows one of the source.
struct LiveTarget {
  int marker = 0;                                       ///< of the source
  int body = 0;                                         ///< that carries it
  Eigen::Vector3d x_in_body = Eigen::Vector3d::Zero();  ///< m
  int level = 0;                                        ///< of its goal
};

/// A source and what is known of its laboratory.
struct LiveReport {
  std::string title;                              ///< for the heading
  std::string source;                             ///< as given
  std::string version;                            ///< of the program
  std::string recording;                          ///< name of the file that keeps the frames; empty: none
  double rate_hz = 0.0;                           ///< nominal
  std::vector<std::string> markers;               ///< names, in the order in which they come
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< as Scene::up
  std::string up_from;                            ///< as Scene::up_from
  std::optional<std::array<Eigen::Vector3d, 2>> extent_m;  ///< smallest and largest coordinates; or not known
  std::vector<LiveCoordinate> coordinates;                 ///< none without a model
  std::vector<LiveBody> bodies;                            ///< none without a model
  std::vector<LiveTarget> targets;                         ///< none without a model
  std::vector<std::string> levels;                         ///< markers of each, in words
  bool strict = false;                                     ///< levels are priorities
};

/// LivePage of docs/formats/pages.md.
[[nodiscard]] nlohmann::ordered_json live_report_json(const LiveReport& report);

/// One HTML page, which asks its own server for frames. The same report gives the same bytes.
[[nodiscard]] std::string live_report_html(const LiveReport& report);

}  // namespace kinemark::report
