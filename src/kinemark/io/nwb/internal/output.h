// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/io/nwb/internal/handle.h"

namespace kinemark::io::internal {

/// A column of a table: texts, numbers or integers.
struct Column {
  std::string name;
  std::string description;
  std::vector<std::string> texts;
  std::vector<double> numbers;
  std::vector<std::int64_t> integers;
  std::vector<hsize_t> across =
      {};  ///< sizes of what one row holds, of numbers and integers; empty: one value
  std::vector<std::string> references = {};  ///< paths of objects, one a row, in place of values
  /// Where the numbers of each row end, for rows of any length; empty: they are of one length.
  std::vector<std::int64_t> ends = {};

  [[nodiscard]] std::size_t rows() const;
};

/// Writes the parts of an NWB file. A failure is recorded, not returned: what follows one does
/// nothing of use, and failed() is asked once at the end. Callers hold a Quiet.
class Output {
 public:
  /// A new file in place of an empty one. Names of objects are made from `identity`, so that the same input
  /// gives the same bytes.
  Output(const std::string& path, std::string_view identity);
  /// A file that is open for writing. What is in it stays.
  Output(Handle file, std::string_view identity);

  /// A group of a neurodata type, or a plain one when `type` is empty.
  Handle group(hid_t parent, const char* name, const char* type = "");
  /// neurodata_type, namespace and object_id.
  void declare(hid_t object, const char* type, const char* type_namespace = "core");
  void attribute(hid_t object, const char* name, std::string_view text);
  void attribute(hid_t object, const char* name, double number, hid_t file_type);
  void attribute(hid_t object, const char* name, const std::vector<std::string>& texts);
  Handle text(hid_t parent, const char* name, std::string_view text);
  /// Texts in `columns` columns, row by row; one column is a plain list.
  Handle texts(hid_t parent, const char* name, const std::vector<std::string>& texts,
               std::size_t columns = 1);
  Handle number(hid_t parent, const char* name, double value);
  Handle integers(hid_t parent, const char* name, const std::vector<std::int64_t>& values);
  /// Numbers, frames x width (1: a plain list), in checksummed chunks; `fill` where nothing is written.
  Handle samples(hid_t parent, const char* name, hid_t file_type, std::int64_t frames, int width, double fill,
                 int compression);
  /// Rows [first, first + count) of samples().
  void write(const Handle& samples, hid_t memory_type, std::int64_t first, std::int64_t count, int width,
             const void* values);
  /// A DynamicTable, or another table of NWB (TimeIntervals, Units, ElectrodesTable); columns are of equal
  /// length.
  void table(hid_t parent, const char* name, const char* description, const std::vector<Column>& columns,
             const char* type = "DynamicTable");
  /// An attribute that refers to an object by its path.
  void reference(hid_t object, const char* name, const std::string& target);
  void soft_link(hid_t parent, const char* name, const std::string& target);

  [[nodiscard]] hid_t file() const { return file_.id(); }
  [[nodiscard]] bool failed() const { return failed_; }
  /// A failure of the caller's when false.
  void require(bool good) { failed_ = failed_ || !good; }
  /// Flush and close the file; false when that or anything before failed.
  bool close();

 private:
  Handle keep(hid_t id, Handle::Closer close);
  void make_types();
  void note(herr_t status) { failed_ = failed_ || status < 0; }
  /// How to store numbers, or a few texts, so that they have a checksum: in the header of their object, or in
  /// a chunk.
  Handle small_data(std::size_t bytes, const std::vector<hsize_t>& dims);
  Handle column(hid_t table, const Column& column);
  Handle references(hid_t table, const Column& column);
  void index_rows(hid_t table, const Column& column);

  Handle file_, text_type_, create_group_;
  std::uint64_t identity_ = 0;
  std::uint64_t objects_ = 0;
  bool failed_ = false;
};

}  // namespace kinemark::io::internal
