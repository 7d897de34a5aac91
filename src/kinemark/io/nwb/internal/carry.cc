// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/carry.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <ranges>
#include <set>
#include <string_view>
#include <utility>

#include "kinemark/io/nwb/internal/apart.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/transfer.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kCopyBlock = 1 << 20;

bool is_group_alone(const std::string& path) { return path.ends_with('/'); }

/// The processing module that a path of a content list is in or is; empty: none.
std::string_view module_in(std::string_view path) {
  constexpr std::string_view kProcessing = "/processing/";
  if (!path.starts_with(kProcessing)) return {};
  return path.substr(0, path.find('/', kProcessing.size()));
}

bool is_result(const std::string& path) {
  return !module_in(path).empty() || path.starts_with(std::string(kAcquisition) + "/") ||
         path.starts_with(std::string(kIntervals) + "/");
}

/// Results of a file of ours, and what of an older file they replace.
struct Results {
  std::vector<std::string> paths;
  std::set<std::string, std::less<>> modules;
  bool positions = false;

  explicit Results(const Input& fresh) : paths(listed_content(fresh).value_or(std::vector<std::string>{})) {
    std::erase_if(paths, [](const std::string& path) { return !is_result(path); });
    for (const auto& path : paths) {
      if (const auto module = module_in(path); !module.empty()) modules.emplace(module);
      positions = positions || path.ends_with(std::string("/") + kMarkersTable);
    }
  }
  /// @param module  with the positions of the older file
  [[nodiscard]] bool replaces(const std::string& path, std::string_view module) const {
    const auto own = module_in(path);
    if (own.empty()) return positions && is_result(path);
    return modules.contains(own) || (positions && own == module);
  }
};

/// Open a file of ours, whatever format of HDF5 it has.
Handle open_ours(const std::filesystem::path& path, unsigned flags) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V18, H5F_LIBVER_V110);
  H5Pset_file_locking(access.id(), false, true);  // who made it holds a lock
  return {H5Fopen(path.c_str(), flags, access.id()), H5Fclose};
}

class Carrier {
 public:
  Carrier(Handle copy, Input& fresh)
      : in_(Input::of(copy.id())),
        fresh_(fresh),
        results_(fresh),
        out_(std::move(copy), fresh.text_attribute(fresh.file(), kDigestAttribute).value_or("")) {}

  Result<Carried> put() {
    const auto module = results_.positions ? module_of(fresh_) : module_of(in_);
    auto content = remove_older();
    if (auto s = copy_results(); !s) return std::unexpected(s.error());
    content.insert(content.end(), results_.paths.begin(), results_.paths.end());
    std::ranges::sort(content);
    const auto [first, last] = std::ranges::unique(content);
    content.erase(first, last);
    for (const char* name : {kDigestAttribute, kContentAttribute, kModuleAttribute, kSetName}) remove(name);
    if (module != kModule) out_.attribute(out_.file(), kModuleAttribute, module);
    const auto mark = fresh_.text_attribute(fresh_.file(), kSetName).value_or("");
    seal(out_, mark.empty() ? mark : mark.substr(kSetKey.size() + 1), content);
    if (!close()) return fail(Code::io, "cannot be written (HDF5 failed)");
    return Carried{std::move(content)};
  }

 private:
  static constexpr const char* kSetName = "kinemark_set";

  /// What is ours and stays.
  std::vector<std::string> remove_older() {
    const auto module = module_of(in_);
    auto content = our_content(in_);
    const auto gone = [&](const std::string& path) { return results_.replaces(path, module); };
    for (const auto& path : content | std::views::filter(gone))
      if (!is_group_alone(path)) out_.require(H5Ldelete(out_.file(), path.c_str(), H5P_DEFAULT) >= 0);
    // A module that was ours alone and gets nothing new.
    for (auto path : content | std::views::filter(gone)) {
      if (!is_group_alone(path) || results_.modules.contains(module_in(path))) continue;
      path.pop_back();
      const Handle group = in_.object(in_.file(), path);
      if (const auto names = in_.children(group.id()); names && names->empty())
        out_.require(H5Ldelete(out_.file(), path.c_str(), H5P_DEFAULT) >= 0);
    }
    std::erase_if(content, gone);
    return content;
  }

  Status copy_results() {
    std::set<std::string, std::less<>> whole;  // modules that are copied with all that is in them
    for (const auto& path : results_.paths) {
      if (is_group_alone(path)) {
        const std::string module(module_in(path));
        if (is_there(module)) continue;
        whole.insert(module);
        if (auto s = copy_object(module); !s) return s;
      } else if (!whole.contains(module_in(path))) {
        if (auto s = copy_object(path); !s) return s;
      }
    }
    return {};
  }

  Status copy_object(const std::string& path) {
    const auto slash = path.rfind('/');
    const std::string parent = path.substr(0, slash);
    if (is_there(path))
      return fail(
          Code::bad_input,
          fmt::format("{} is there already and is not of kinemark; rename it. Nothing was written.", path));
    if (!is_there(parent)) out_.group(out_.file(), parent.c_str());
    out_.require(H5Ocopy(fresh_.file(), path.c_str(), out_.file(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT) >=
                 0);
    return {};
  }

  [[nodiscard]] bool is_there(const std::string& path) const {
    return H5Lexists(out_.file(), path.c_str(), H5P_DEFAULT) > 0;
  }
  void remove(const char* attribute) {
    if (H5Aexists(out_.file(), attribute) > 0) out_.require(H5Adelete(out_.file(), attribute) >= 0);
  }
  bool close() {
    in_ = Input::of(fresh_.file());  // lets go of the copy
    return out_.close();
  }

  Input in_;
  Input& fresh_;
  Results results_;
  Output out_;
};

/// Zeros in place of a text that HDF5 left where it is of no use any more: whoever looks for the mark of a
/// set among the bytes of a file must not find that of an older one.
Status blank(const std::filesystem::path& path, const std::string& text) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  std::string block(kCopyBlock + text.size(), '\0');
  const std::string zeros(text.size(), '\0');
  for (std::streamoff at = 0; file; at += kCopyBlock) {
    file.seekg(at);
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto found = std::string_view(block).substr(0, static_cast<std::size_t>(file.gcount()));
    file.clear();
    for (auto k = found.find(text); k != std::string_view::npos; k = found.find(text, k + 1)) {
      file.seekp(at + static_cast<std::streamoff>(k));
      file.write(zeros.data(), static_cast<std::streamsize>(zeros.size()));
    }
    if (found.size() < block.size()) break;
  }
  file.flush();
  return file ? Status() : fail(Code::io, "cannot be written");
}

/// Our mark, and nothing that somebody else called so.
bool is_mark(std::string_view text) {
  constexpr std::size_t kDigits = 16;
  if (text.size() != kSetKey.size() + 1 + kDigits || !text.starts_with(kSetKey) ||
      text[kSetKey.size()] != '=')
    return false;
  return text.find_first_not_of("0123456789abcdef", kSetKey.size() + 1) == std::string_view::npos;
}

Status copy_bytes(const std::filesystem::path& source, OutputFile& out) {
  const auto in = InputFile::open(source);
  if (!in) return std::unexpected(in.error());
  std::vector<std::byte> block(kCopyBlock);
  for (std::size_t at = 0; at < in->size(); at += block.size()) {
    const auto n = in->read_at(at, block);
    if (!n) return std::unexpected(n.error());
    if (auto s = out.write(std::span(block).first(*n)); !s) return s;
  }
  return {};
}

}  // namespace

Result<Carried> carry_here(const std::filesystem::path& copy, const std::filesystem::path& fresh) {
  const Quiet quiet;
  const auto made = open_ours(fresh, H5F_ACC_RDONLY);
  if (!made) return fail(Code::io, "what was to be put into the copy cannot be read");
  auto results = Input::of(made.id());
  auto file = open_ours(copy, H5F_ACC_RDWR);
  if (!file)
    return fail(
        Code::bad_input,
        "the file cannot be opened for writing: it is damaged, or a program that wrote it did not close "
        "it. Nothing was written.");
  const auto before = Input::of(file.id()).text_attribute(file.id(), std::string(kSetKey).c_str());
  const auto now = results.text_attribute(results.file(), std::string(kSetKey).c_str());
  auto carried = Carrier(std::move(file), results).put();
  if (carried && before && is_mark(*before) && before != now)
    if (auto s = blank(copy, *before); !s) return std::unexpected(s.error());
  return carried;
}

Status carry(const std::filesystem::path& source, const std::filesystem::path& fresh, OutputFile& out,
             const std::string& name) {
  if (auto s = copy_bytes(source, out); !s) return s;
  const auto done = run_apart<Carried>({.file = out.temporary(),
                                        .name = name,
                                        .what = {"carry", fresh.string(), name},
                                        .undone = "Nothing was written."},
                                       receive_carried);
  return done ? Status() : std::unexpected(done.error());
}

}  // namespace kinemark::io::internal
