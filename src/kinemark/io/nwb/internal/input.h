// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Reading HDF5 objects of unknown content: an object that is not of the requested kind reads as empty.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/io/nwb/internal/handle.h"

namespace kinemark::io::internal {

/// A file open for reading, and how much memory its size can explain. Callers hold a Quiet.
class Input {
 public:
  static Result<Input> open(const std::filesystem::path& path);
  /// A file as bytes in memory; HDF5 copies them.
  static Result<Input> open(std::span<const std::byte> image, const std::string& name);
  /// A file of ours that is open for writing; it stays open.
  static Input of(hid_t file);

  /// A group or dataset by its path from `from` (file or group), or an empty handle. Links to other files are
  /// not followed.
  [[nodiscard]] Handle object(hid_t from, const std::string& path) const;
  /// Names of the links in a group in alphabetical order, 100,000 at most; nothing when they cannot be read.
  [[nodiscard]] std::optional<std::vector<std::string>> children(hid_t group) const;

  /// True when a link leads to a group of this file, or what may be one, that cannot be opened: damage, not a
  /// dangling link. Datasets can be of types that only a newer HDF5 knows.
  [[nodiscard]] bool broken(hid_t from, const std::string& name) const;

  /// Dimensions of a dataset of numbers, or of texts, whose bytes lie in this file; nothing for others.
  [[nodiscard]] std::optional<std::vector<std::int64_t>> number_shape(hid_t dataset) const;
  [[nodiscard]] std::optional<std::vector<std::int64_t>> text_shape(hid_t dataset) const;

  [[nodiscard]] std::optional<std::string> text_attribute(hid_t object, const char* name) const;
  /// A single number; one stored in single precision as the shortest decimal that it stands for.
  [[nodiscard]] std::optional<double> number_attribute(hid_t object, const char* name) const;

  /// Everything in a dataset of texts or numbers, row by row; nothing when it is none or too large to be
  /// true.
  [[nodiscard]] std::optional<std::vector<std::string>> texts(hid_t dataset);
  template <class T>
  [[nodiscard]] std::optional<Array<T>> numbers(hid_t dataset);
  /// The numbers of one member of a table of records, row by row: one for each record, or as many as its
  /// array has. Nothing where there is no such table or member.
  [[nodiscard]] std::optional<Array<double>> member(hid_t table, const char* name);

  /// All texts of an attribute; nothing where it holds none.
  [[nodiscard]] std::optional<std::vector<std::string>> text_attributes(hid_t object, const char* name) const;
  /// Paths of the objects that a dataset of references names; nothing for other datasets.
  [[nodiscard]] std::optional<std::vector<std::string>> references(hid_t dataset);
  /// The path of the object that an attribute refers to; nothing where it does not.
  [[nodiscard]] std::optional<std::string> reference_attribute(hid_t object, const char* name) const;
  /// Where a soft link of a group leads; nothing for other links.
  [[nodiscard]] std::optional<std::string> soft_link(hid_t group, const std::string& name) const;
  /// XXH3 of all numbers of a dataset, as they lie in memory, where numbers() has read them; else nothing.
  [[nodiscard]] std::optional<std::uint64_t> digest_of(hid_t dataset) const;
  /// Whether numbers of a dataset are read as bytes: those that are stored as bytes. Others are doubles.
  [[nodiscard]] bool holds_bytes(hid_t dataset) const;
  /// Rows [first, first + count) of numbers of that shape into `out`, bytes or doubles.
  [[nodiscard]] bool read_rows(hid_t dataset, const std::vector<std::int64_t>& shape, std::int64_t first,
                               std::int64_t count, void* out) const;

  /// Reserve `bytes` of the memory that the file's size justifies; false when they exceed it.
  [[nodiscard]] bool afford(std::size_t count, std::size_t bytes_each);
  /// How many bytes of content the file's size can explain, whatever was reserved.
  [[nodiscard]] std::size_t bytes_explained() const { return bytes_explained_; }

  [[nodiscard]] hid_t file() const { return file_.id(); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  Input(Handle file, Handle link_access, std::string name, std::size_t size);
  [[nodiscard]] std::optional<std::vector<std::int64_t>> shape(hid_t dataset, bool (*fits)(hid_t type)) const;
  [[nodiscard]] bool read(hid_t dataset, hid_t memory_type, void* out) const;

  Handle file_, link_access_;
  std::string name_;
  std::size_t bytes_explained_ = 0, bytes_left_ = 0;
  std::map<std::string, std::uint64_t> digests_;  ///< of what was read, by its path
};

}  // namespace kinemark::io::internal
