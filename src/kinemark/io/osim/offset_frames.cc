// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/offset_frames.h"

#include <utility>

#include "kinemark/io/osim/internal/frame_table.h"
#include "kinemark/io/osim/internal/legacy.h"
#include "kinemark/io/osim/internal/xml_file.h"

namespace kinemark::io {
namespace {

Result<std::vector<OffsetFrame>> read(osim::XmlFile file, const data::ModelDescription& description,
                                      const std::vector<std::string>& names) {
  const pugi::xml_node model = file.find_object({"Model"});
  std::vector<OffsetFrame> out;
  if (model && !file.error()) {
    osim::modernise(model);
    osim::FrameTable frames(file, model, description);
    for (const auto& name : names)
      if (const auto frame = frames.offset_frame(name); frame && frame->body_idx != data::kGround)
        out.push_back({.name = name, .body_idx = frame->body_idx, .body_from_frame = frame->body_from_frame});
  }
  if (file.error()) return std::unexpected(*file.error());
  return out;
}

}  // namespace

Result<std::vector<OffsetFrame>> read_offset_frames(const std::filesystem::path& path,
                                                    const data::ModelDescription& model,
                                                    const std::vector<std::string>& names) {
  auto file = osim::XmlFile::read(path);
  if (!file) return std::unexpected(file.error());
  return read(std::move(*file), model, names);
}

Result<std::vector<OffsetFrame>> parse_offset_frames(std::string_view xml, std::string_view name,
                                                     const data::ModelDescription& model,
                                                     const std::vector<std::string>& names) {
  auto file = osim::XmlFile::parse(xml, std::string(name));
  if (!file) return std::unexpected(file.error());
  return read(std::move(*file), model, names);
}

}  // namespace kinemark::io
