// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io::osim {

/// An OpenSim file as a tree of elements, with the first error found in its content.
///
/// Files in the field are not always well-formed: bytes that are not UTF-8 are taken as Latin-1, element
/// names may hold "::", unmatched closing tags at the end are ignored. A truncated or unreasonably deeply
/// nested document is refused.
///
/// The getters never stop: a bad value is noted (the first one wins) and the fallback returned, so that a
/// reader goes straight on and looks at error() once.
class XmlFile {
 public:
  /// Whether comments of the file are part of the tree.
  enum class Comments { left_out, kept };

  static Result<XmlFile> parse(std::string_view xml, std::string name,
                               Comments comments = Comments::left_out);
  static Result<XmlFile> read(const std::filesystem::path& path, Comments comments = Comments::left_out);

  /// A tree of its own with the same content.
  [[nodiscard]] XmlFile copy() const;
  /// The whole document as UTF-8, with a declaration that says so.
  [[nodiscard]] std::string text() const;

  /// Replace every element `<SomethingSet file="x"/>` by that element as file x, relative to `folder`,
  /// defines it. Without a folder such an element is an error.
  void inline_files(const std::filesystem::path* folder);
  /// The files that inline_files() took elements from.
  [[nodiscard]] const std::vector<std::filesystem::path>& inlined() const { return inlined_; }

  /// Of the first of `tags` that there is: the document element itself, or the first element below it.
  [[nodiscard]] pugi::xml_node find_object(std::initializer_list<const char*> tags) const;
  [[nodiscard]] pugi::xml_node document() const { return tree_.document_element(); }
  /// Version of the document, 10500 for the oldest ones, which do not state it.
  [[nodiscard]] int version() const;
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Note that something is wrong with `node`: "file: CustomJoint 'knee_r', <axis>: what".
  void note(pugi::xml_node node, std::string_view what, Code code = Code::bad_input);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  // Content of a child element; the fallback when it is absent or empty.
  [[nodiscard]] double number(pugi::xml_node node, const char* child, double fallback);
  [[nodiscard]] bool flag(pugi::xml_node node, const char* child, bool fallback);
  [[nodiscard]] Eigen::Vector3d vector3(pugi::xml_node node, const char* child,
                                        const Eigen::Vector3d& fallback = Eigen::Vector3d::Zero());
  /// All numbers of a child element, none if it is absent. Each must be finite.
  [[nodiscard]] std::vector<double> numbers(pugi::xml_node node, const char* child);

 private:
  std::string name_;
  pugi::xml_document tree_;
  std::optional<Error> error_;
  std::vector<std::filesystem::path> inlined_;
};

/// The text of an element, without blanks at both ends. Comments inside it do not count.
[[nodiscard]] std::string text_of(pugi::xml_node node);
[[nodiscard]] std::string text_of(pugi::xml_node node, const char* child);
/// The words of a text.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text);
/// The attribute "name".
[[nodiscard]] std::string name_of(pugi::xml_node node);
/// The first child that is an element, whatever its tag.
[[nodiscard]] pugi::xml_node first_element(pugi::xml_node node);
/// Objects of a set: children of node/<set>/<objects>.
[[nodiscard]] std::vector<pugi::xml_node> objects_of(pugi::xml_node node, const char* set);

/// A value from the file for a sentence: in quotes, cut when long.
[[nodiscard]] std::string in_quotes(std::string_view value);

}  // namespace kinemark::io::osim
