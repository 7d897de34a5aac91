// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/utf8.h"

#include "kinemark/io/mesh/internal/mesh_builder.h"
#include "kinemark/io/mesh/internal/mesh_formats.h"
#include "kinemark/io/mesh/internal/vtk_array.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMostNumbers = 3 * MeshBuilder::kMost;

/// A file whose appended bytes are set apart: raw ones are no XML.
struct Parts {
  std::string xml;
  std::string_view appended;  ///< behind the "_"
  bool raw = false;
};

Parts parts_of(std::string_view bytes) {
  const std::size_t begin = bytes.find("<AppendedData");
  if (begin == std::string_view::npos) return {.xml = std::string(bytes)};
  const std::string_view rest = bytes.substr(begin);
  const std::size_t close = std::min(rest.find('>'), rest.size());
  const std::size_t mark = rest.find('_', close);
  return {.xml = std::string(bytes.substr(0, begin)) + "</VTKFile>",
          .appended = mark == std::string_view::npos ? std::string_view() : rest.substr(mark + 1),
          .raw = rest.substr(0, close).find("\"raw\"") != std::string_view::npos};
}

pugi::xml_node array_named(pugi::xml_node node, const char* name) {
  return node.find_child_by_attribute("DataArray", "Name", name);
}

/// Reads the pieces of a file into one mesh.
class Reader {
 public:
  explicit Reader(VtkFile file) : file_(file) {}

  Status read_piece(pugi::xml_node piece) {
    const auto first = static_cast<std::int64_t>(mesh_.points());
    const auto x = read_vtk_array(file_, piece.child("Points").child("DataArray"), kMostNumbers);
    if (!x) return fail_at("<Points>", x.error());
    if (x->size() % 3 != 0)
      return fail(Code::bad_input, fmt::format("<Points> has {} numbers; need three a point", x->size()));
    for (std::size_t i = 0; i < x->size(); i += 3)
      mesh_.add_point({(*x)[i], (*x)[i + 1], (*x)[i + 2]}, "<Points>");
    for (const bool strips : {false, true})
      if (auto s = read_faces(piece.child(strips ? "Strips" : "Polys"), strips, first); !s) return s;
    return {};
  }

  Result<data::TriangleMesh> finish() { return mesh_.finish(); }

 private:
  Status read_faces(pugi::xml_node faces, bool strips, std::int64_t first) {
    const auto corners = array_named(faces, "connectivity"), ends = array_named(faces, "offsets");
    if (!corners || !ends) return {};
    const std::string place = fmt::format("<{}>", faces.name());
    const auto corner = read_vtk_array(file_, corners, kMostNumbers);
    if (!corner) return fail_at(place, corner.error());
    const auto end = read_vtk_array(file_, ends, kMostNumbers);
    if (!end) return fail_at(place, end.error());
    std::size_t from = 0;
    std::vector<std::int64_t> face;
    for (const double to : *end) {
      if (!(to >= static_cast<double>(from) && to <= static_cast<double>(corner->size())))
        return fail(Code::bad_input,
                    fmt::format("{}: an offset is {:g}; need one from {} to {}, the number of corners", place,
                                to, from, corner->size()));
      face.clear();
      for (; from < static_cast<std::size_t>(to); ++from) {
        // What is no place among the points is said by whoever adds the face.
        const double c = (*corner)[from];
        const bool known = c >= 0.0 && c < static_cast<double>(MeshBuilder::kMost);
        face.push_back(known ? first + std::llround(c) : -1);
      }
      if (strips)
        mesh_.add_strip(face, place);
      else
        mesh_.add_polygon(face, place);
    }
    return {};
  }

  VtkFile file_;
  MeshBuilder mesh_;
};

}  // namespace

Result<data::TriangleMesh> parse_vtp(std::string_view bytes) {
  const Parts parts = parts_of(bytes);
  pugi::xml_document document;
  const auto parsed = document.load_buffer(parts.xml.data(), parts.xml.size());
  if (!parsed)
    return fail(Code::bad_input,
                fmt::format("is not XML, from byte {} on: {}", parsed.offset, parsed.description()));
  const auto root = document.child("VTKFile");
  const auto data = root.child("PolyData");
  if (!data)
    return fail(Code::bad_input, fmt::format("is no VTK PolyData; its first element is <{}>",
                                             printable(document.document_element().name(), 40)));
  auto file = vtk_file_of(root);
  if (!file) return std::unexpected(file.error());
  file->appended = parts.appended;
  file->appended_raw = parts.raw;
  Reader reader(*file);
  for (const auto piece : data.children("Piece"))
    if (auto s = reader.read_piece(piece); !s) return std::unexpected(s.error());
  return reader.finish();
}

}  // namespace kinemark::io::internal
