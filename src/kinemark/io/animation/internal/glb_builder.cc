// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/animation/internal/glb_builder.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"

namespace kinemark::io::animation {
namespace {

constexpr int kFloat = 5126, kVertices = 34962;  // numbers of the glTF 2.0 specification
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
static_assert(std::endian::native == std::endian::little, "a GLB is little-endian");

std::string bytes_of(std::initializer_list<std::uint32_t> words) {
  std::string out(4 * words.size(), '\0');
  std::memcpy(out.data(), std::data(words), out.size());
  return out;
}

void pad_to_words(std::string& text, char with) { text.resize((text.size() + 3) / 4 * 4, with); }

}  // namespace

GlbBuilder::GlbBuilder() {
  root_["asset"] = {{"version", "2.0"}, {"generator", "kinemark"}};
  root_["scene"] = 0;
  root_["scenes"] = {{{"nodes", Json::array()}}};
}

int GlbBuilder::add_node(Json node, int parent) {
  auto& nodes = root_["nodes"];
  const int index = static_cast<int>(nodes.size());
  node["name"] = to_utf8(node["name"].get<std::string>());
  nodes.push_back(std::move(node));
  (parent < 0 ? root_["scenes"][0]["nodes"] : nodes[static_cast<std::size_t>(parent)]["children"])
      .push_back(index);
  return index;
}

int GlbBuilder::add_floats(std::span<const float> values, std::size_t components, bool bounds, int target) {
  Json view = {{"buffer", 0}, {"byteOffset", numbers_.size()}, {"byteLength", values.size_bytes()}};
  if (target != 0) view["target"] = target;
  numbers_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  constexpr std::array<const char*, 5> kTypes{"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  Json accessor = {{"bufferView", root_["bufferViews"].size()},
                   {"componentType", kFloat},
                   {"count", values.size() / components},
                   {"type", kTypes.at(components)}};
  if (bounds) {
    std::vector<float> low(components, std::numeric_limits<float>::infinity()),
        high(components, -low.front());
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % components] = std::min(low[i % components], values[i]);
      high[i % components] = std::max(high[i % components], values[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }
  root_["bufferViews"].push_back(std::move(view));
  root_["accessors"].push_back(std::move(accessor));
  return static_cast<int>(root_["accessors"].size()) - 1;
}

int GlbBuilder::add_mesh(std::string_view name, std::span<const Triangle> triangles,
                         const std::array<double, 3>& colour) {
  std::vector<float> positions, normals;
  for (const Triangle& t : triangles) {
    const Eigen::Vector3f normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    for (const auto& corner : t) {
      positions.insert(positions.end(), corner.begin(), corner.end());
      normals.insert(normals.end(), normal.begin(), normal.end());
    }
  }
  root_["materials"].push_back({{"pbrMetallicRoughness",
                                 {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0}},
                                  {"metallicFactor", 0.0},
                                  {"roughnessFactor", 0.8}}}});
  const int position = add_floats(positions, 3, true, kVertices),
            normal = add_floats(normals, 3, false, kVertices);
  root_["meshes"].push_back({{"name", name},
                             {"primitives",
                              {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                                {"material", root_["materials"].size() - 1}}}}});
  return static_cast<int>(root_["meshes"].size()) - 1;
}

int GlbBuilder::add_times(std::span<const float> times_s) { return add_floats(times_s, 1, true); }

void GlbBuilder::animate(int node, std::string_view path, int times, std::span<const float> values,
                         bool steps) {
  const int output = add_floats(values, path == "rotation" ? 4 : 3, false);
  if (!root_.contains("animations"))
    root_["animations"] = {{{"name", "motion"}, {"samplers", Json::array()}, {"channels", Json::array()}}};
  Json& animation = root_["animations"][0];
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back(
      {{"input", times}, {"interpolation", steps ? "STEP" : "LINEAR"}, {"output", output}});
}

Status GlbBuilder::write(const std::filesystem::path& path, bool force) {
  root_["buffers"] = {{{"byteLength", numbers_.size()}}};
  std::string json = root_.dump();
  pad_to_words(json, ' ');
  pad_to_words(numbers_, '\0');
  const std::size_t bytes = 12 + 8 + json.size() + 8 + numbers_.size();
  if (bytes > std::numeric_limits<std::uint32_t>::max())
    return fail(
        Code::not_supported,
        fmt::format("{}: would have {} bytes; a GLB has at most 4 GiB, so take a part of the recording",
                    path.string(), bytes));
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  const auto words = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  const std::string header = bytes_of({kMagic, kVersion, words(bytes), words(json.size()), kJsonChunk});
  if (auto s = file->write(header); !s) return s;
  if (auto s = file->write(json); !s) return s;
  if (auto s = file->write(bytes_of({words(numbers_.size()), kBinaryChunk})); !s) return s;
  if (auto s = file->write(numbers_); !s) return s;
  return file->commit();
}

}  // namespace kinemark::io::animation
