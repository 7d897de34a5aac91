// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/model_meshes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/mesh/mesh_file.h"
#include "kinemark/io/mesh/mesh_reduction.h"
#include "kinemark/io/osim/shown_meshes.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using data::TriangleMesh;

constexpr std::size_t kMostTriangles = 12'000;  // of a page
constexpr std::size_t kMostNamed = 3;           // files in a sentence
constexpr std::size_t kMostPoints = 65'535;     // of a body

/// Where OpenSim looks, one folder after the other.
std::vector<fs::path> folders_of(const fs::path& osim, std::span<const fs::path> given) {
  const fs::path beside = osim.parent_path().empty() ? fs::path(".") : osim.parent_path();
  std::vector<fs::path> folders{beside, beside / "Geometry"};
  folders.insert(folders.end(), given.begin(), given.end());
  return folders;
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Files are found once however often they are shown.
class Finder {
 public:
  Finder(const fs::path& osim, std::span<const fs::path> given) : folders_(folders_of(osim, given)) {}

  /// Names with the separators of another system are understood.
  std::optional<fs::path> find(std::string name) {
    std::ranges::replace(name, '\\', '/');
    const fs::path wanted(name);
    if (wanted.is_absolute()) return is_file(wanted) ? std::optional(wanted) : std::nullopt;
    for (const auto& folder : folders_)
      if (is_file(folder / wanted)) return folder / wanted;
    for (const auto& folder : folders_)
      if (auto found = in_any_case((folder / wanted).parent_path(), wanted.filename().string())) return found;
    return std::nullopt;
  }

 private:
  std::optional<fs::path> in_any_case(const fs::path& folder, const std::string& name) {
    const auto [at, is_new] = listed_.try_emplace(folder);
    if (is_new) {
      std::error_code error;
      for (fs::directory_iterator one(folder, error), end; !error && one != end; one.increment(error))
        at->second.try_emplace(lower_case(one->path().filename().string()), one->path());
    }
    const auto found = at->second.find(lower_case(name));
    return found != at->second.end() && is_file(found->second) ? std::optional(found->second) : std::nullopt;
  }

  std::vector<fs::path> folders_;
  std::map<fs::path, std::map<std::string, fs::path>> listed_;
};

/// A mesh in the axes of its body. Factors below zero turn it inside out, which is taken back.
TriangleMesh placed(TriangleMesh mesh, const data::ShownMesh& shown) {
  for (auto& x : mesh.points) x = shown.body_from_mesh * shown.scale.cwiseProduct(x);
  if (shown.scale.prod() < 0.0)
    for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  return mesh;
}

void append(TriangleMesh& all, const TriangleMesh& more) {
  const auto first = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  for (const auto& [a, b, c] : more.triangles) all.triangles.push_back({first + a, first + b, first + c});
}

/// What happened to the files that a model names.
struct Account {
  std::vector<std::string> missing;  ///< files that are nowhere
  std::vector<std::string> refused;  ///< one sentence each
  std::size_t files = 0;             ///< that the model names
  std::size_t before = 0;            ///< triangles that were read
};

/// Which of the files are nowhere, and where they were looked for.
std::string missing_words(const Account& account) {
  const std::size_t missing = account.missing.size();
  const bool all = missing == account.files;
  const std::string which = all && missing == 1 ? std::string("the mesh file")
                            : all               ? fmt::format("none of the {} mesh files", missing)
                                  : fmt::format("{} of the {} mesh files", missing, account.files);
  const char* verb = missing == 1 ? "was not" : all ? "was" : "were not";
  return fmt::format(
      "{} that the model names {} found beside it, in Geometry/ there, or with --geometry FOLDER: {}", which,
      verb, join_names(account.missing, kMostNamed));
}

/// What a reader says of a file, which is named as the model names it.
std::string refusal(const std::string& said, const fs::path& path, const std::string& name) {
  const std::string shown = path.string();
  return printable_sentence(said.starts_with(shown) ? printable(name, 60) + said.substr(shown.size()) : said);
}

std::string sentence_of(const Account& account, const ModelMeshes& meshes, std::size_t after) {
  std::string text;
  if (!meshes.of_body.empty())
    text = fmt::format("{} drawn from the model's meshes",
                       counted(std::ssize(meshes.of_body), "body", "bodies"));
  if (account.before > after && !meshes.of_body.empty())
    text += fmt::format(", with {} of their {} triangles", after, account.before);
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (!account.missing.empty()) add(missing_words(account));
  if (!account.refused.empty())
    add(account.refused.front() + (account.refused.size() > 1 ? fmt::format(" ({} more files cannot be read)",
                                                                            account.refused.size() - 1)
                                                              : ""));
  return text;
}

}  // namespace

Status check_geometry(std::span<const fs::path> folders) {
  for (const auto& folder : folders) {
    std::error_code error;
    if (!fs::is_directory(folder, error))
      return fail(Code::io, fmt::format("--geometry: there is no folder {}", folder.string()));
  }
  return {};
}

ModelMeshes read_model_meshes(const fs::path& osim, const data::ModelDescription& model,
                              std::span<const fs::path> folders, std::size_t most_read) {
  const auto shown = io::read_shown_meshes(osim, model);
  if (!shown) return {.of_body = {}, .note = printable_sentence(shown.error().message)};
  ModelMeshes out;
  Account account;
  Finder finder(osim, folders);
  std::map<std::string, std::optional<TriangleMesh>> files;
  std::vector<TriangleMesh> meshes;
  std::vector<std::string> bodies;
  for (const auto& one : *shown) {
    const auto [file, is_new] = files.try_emplace(one.file);
    if (is_new) {
      const auto path = finder.find(one.file);
      if (!path) {
        account.missing.push_back(printable(one.file, 60));
      } else if (account.before > most_read) {
        account.refused.push_back(
            fmt::format("{}: the meshes before it have {} triangles together, more than are read",
                        printable(one.file, 60), account.before));
      } else if (auto mesh = io::read_mesh(*path); mesh) {
        file->second = std::move(*mesh);
      } else {
        account.refused.push_back(refusal(mesh.error().message, *path, one.file));
      }
    }
    if (!file->second) continue;
    account.before += file->second->triangles.size();
    meshes.push_back(placed(*file->second, one));
    bodies.push_back(one.body);
  }
  account.files = files.size();
  io::reduce_meshes(meshes, kMostTriangles);
  std::size_t after = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].empty()) continue;
    auto& body = out.of_body[bodies[i]];
    if (body.points.size() + meshes[i].points.size() > kMostPoints) continue;
    append(body, meshes[i]);
    after += meshes[i].triangles.size();
  }
  out.note = sentence_of(account, out, after);
  return out;
}

}  // namespace kinemark::pipeline
