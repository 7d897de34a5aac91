// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// An OpenSim model with all that stands in its file, so that changes are written into it and the rest passes
// through unharmed: muscles, geometry, contact, controllers, probes, comments.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/model_description.h"
#include "kinemark/data/muscle_path.h"

namespace kinemark::io {

/// What becomes of a model.
struct OsimChange {
  data::ModelDescription model;          ///< all that a description holds, as it shall be
  std::vector<Eigen::Vector3d> factors;  ///< of the sizes of the document's bodies; empty: unchanged
  std::vector<data::PathScale> paths;    ///< ratios for lengths at rest
};

/// A document that is ready to be written.
struct OsimText {
  std::string text;               ///< XML, UTF-8
  std::vector<std::string> lost;  ///< what the source holds and the text does not, one sentence each
};

/// An .osim as it stands in its file.
class OsimDocument {
 public:
  /// Fails as read_osim().
  static Result<OsimDocument> read(const std::filesystem::path& path);
  /// Fails as parse_osim().
  static Result<OsimDocument> parse(std::string_view xml, std::string_view name);

  /// What read_osim() makes of the file.
  [[nodiscard]] const data::ModelDescription& model() const;
  /// Paths of muscles, ligaments and springs, in the order of the file. They cannot be read where they use
  /// what is not supported; then none and paths_error().
  [[nodiscard]] const std::vector<data::MusclePath>& paths() const;
  /// Why there are no paths; empty when they were read.
  [[nodiscard]] const std::string& paths_error() const;

  /// The document with the changes in it, in its own version and order.
  ///
  /// Documents before 2.0, and changes that an old structure has no place for, become a document of version
  /// 40000 made from the description alone (format_osim()); what that leaves behind is listed.
  [[nodiscard]] Result<OsimText> format(const OsimChange& change) const;

 private:
  struct Parts;
  explicit OsimDocument(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
  static Result<OsimDocument> make(Parts parts, const std::filesystem::path* folder);

  std::shared_ptr<const Parts> parts_;
};

}  // namespace kinemark::io
