// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/input.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <algorithm>

#include "kinemark/core/number.h"
#include "kinemark/io/file.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMaxChildren = 100'000;
constexpr std::size_t kMaxTextBytes = 1UL << 20;
// Deflate compresses at most 1032 bytes to one, and a chunk that was never written has no bytes.
constexpr std::size_t kMaxExpansion = 1100;
constexpr std::size_t kFreeBytes = 256UL << 20;

herr_t refuse_link(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) { return -1; }

herr_t collect_name(hid_t, const char* name, const H5L_info_t* info, void* out) {
  auto& names = *static_cast<std::vector<std::string>*>(out);
  if (info->type == H5L_TYPE_HARD || info->type == H5L_TYPE_SOFT) names.emplace_back(name);
  return names.size() < kMaxChildren ? 0 : 1;
}

std::unexpected<Error> not_hdf5(const std::string& name) {
  return fail(Code::bad_input,
              fmt::format("{}: is not an NWB file: it is not HDF5, or a broken one. Nothing was "
                          "read.",
                          name));
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  return (kind == H5T_INTEGER || kind == H5T_FLOAT) && size >= 1 && size <= 16;
}

bool is_text(hid_t type) {
  return H5Tget_class(type) == H5T_STRING &&
         (H5Tis_variable_str(type) > 0 || H5Tget_size(type) <= kMaxTextBytes);
}

bool is_record(hid_t type) { return H5Tget_class(type) == H5T_COMPOUND; }

/// The memory type for texts like the file's.
Handle memory_text(hid_t file_type) {
  Handle out(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_cset(out.id(), H5Tget_cset(file_type));
  if (H5Tis_variable_str(file_type) > 0)
    H5Tset_size(out.id(), H5T_VARIABLE);
  else
    H5Tset_size(out.id(), H5Tget_size(file_type) + 1);  // room for the zero at the end
  return out;
}

/// `count` texts that `read(memory_type, buffer)` delivers.
template <class Read>
std::optional<std::vector<std::string>> read_texts(hid_t file_type, hid_t space, std::size_t count,
                                                   const Read& read) {
  const Handle type = memory_text(file_type);
  std::vector<std::string> out;
  if (count == 0) return out;
  out.reserve(count);
  if (H5Tis_variable_str(file_type) > 0) {
    std::vector<char*> pointers(count, nullptr);
    void* buffer = static_cast<void*>(pointers.data());
    const bool good = read(type.id(), buffer) >= 0;
    if (good)
      for (const char* p : pointers) out.emplace_back(p == nullptr ? "" : p);
    H5Dvlen_reclaim(type.id(), space, H5P_DEFAULT, buffer);
    return good ? std::optional(std::move(out)) : std::nullopt;
  }
  const std::size_t width = H5Tget_size(type.id());
  std::vector<char> bytes(count * width, '\0');
  if (read(type.id(), bytes.data()) < 0) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    std::string text(bytes.data() + i * width);
    while (!text.empty() && text.back() == ' ') text.pop_back();
    out.push_back(std::move(text));
  }
  return out;
}

template <class T>
hid_t native();
template <>
hid_t native<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

bool is_reference(hid_t type) { return H5Tequal(type, H5T_STD_REF_OBJ) > 0; }

/// The path of the object that a reference names.
std::optional<std::string> name_of(hid_t object, const hobj_ref_t& target) {
  const ssize_t length = H5Rget_name(object, H5R_OBJECT, &target, nullptr, 0);
  if (length <= 0 || static_cast<std::size_t>(length) > kMaxTextBytes) return std::nullopt;
  std::string out(static_cast<std::size_t>(length) + 1, '\0');
  if (H5Rget_name(object, H5R_OBJECT, &target, out.data(), out.size()) < 0) return std::nullopt;
  out.pop_back();
  return out;
}

std::string path_of(hid_t object) {
  std::string path(static_cast<std::size_t>(std::max<ssize_t>(0, H5Iget_name(object, nullptr, 0))) + 1, '\0');
  H5Iget_name(object, path.data(), path.size());
  path.pop_back();
  return path;
}

}  // namespace

Input::Input(Handle file, Handle link_access, std::string name, std::size_t size)
    : file_(std::move(file)),
      link_access_(std::move(link_access)),
      name_(std::move(name)),
      bytes_explained_(kFreeBytes + kMaxExpansion * size),
      bytes_left_(bytes_explained_) {
  H5Pset_elink_cb(link_access_.id(), refuse_link, nullptr);
}

Result<Input> Input::open(const std::filesystem::path& path) {
  // HDF5 does not distinguish a missing file from a damaged one.
  const auto there = InputFile::open(path);
  if (!there) return std::unexpected(there.error());
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) return not_hdf5(path.string());
  return Input(std::move(file), {H5Pcreate(H5P_LINK_ACCESS), H5Pclose}, path.string(), there->size());
}

Result<Input> Input::open(std::span<const std::byte> image, const std::string& name) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), 1UL << 16, false);
  if (!image.empty()) H5Pset_file_image(access.id(), const_cast<std::byte*>(image.data()), image.size());
  Handle file(image.empty() ? H5I_INVALID_HID : H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file) return not_hdf5(name);
  return Input(std::move(file), {H5Pcreate(H5P_LINK_ACCESS), H5Pclose}, name, image.size());
}

Input Input::of(hid_t file) {
  H5Iinc_ref(file);
  constexpr std::size_t kOurOwn = std::size_t{1} << 50;  // of no use: what we write is as large as it is
  return {Handle(file, H5Fclose), {H5Pcreate(H5P_LINK_ACCESS), H5Pclose}, "", kOurOwn};
}

Handle Input::object(hid_t from, const std::string& path) const {
  return {H5Oopen(from, path.c_str(), link_access_.id()), H5Oclose};
}

std::optional<std::vector<std::string>> Input::children(hid_t group) const {
  std::vector<std::string> out;
  hsize_t at = 0;
  if (H5Iget_type(group) != H5I_GROUP ||
      H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &at, collect_name, &out) < 0)
    return std::nullopt;
  return out;
}

bool Input::broken(hid_t from, const std::string& name) const {
  H5L_info_t info{};
  if (H5Lget_info(from, name.c_str(), &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_HARD ||
      object(from, name))
    return false;
  H5O_info_t what{};
  return H5Oget_info_by_name2(from, name.c_str(), &what, H5O_INFO_BASIC, H5P_DEFAULT) < 0 ||
         what.type != H5O_TYPE_DATASET;
}

std::optional<std::vector<std::int64_t>> Input::shape(hid_t dataset, bool (*fits)(hid_t type)) const {
  if (H5Iget_type(dataset) != H5I_DATASET) return std::nullopt;
  const Handle type(H5Dget_type(dataset), H5Tclose);
  if (!type || !fits(type.id())) return std::nullopt;
  // Samples in other files are not read, nor chunks larger than the file size allows.
  const Handle create(H5Dget_create_plist(dataset), H5Pclose);
  const H5D_layout_t layout = H5Pget_layout(create.id());
  if (layout == H5D_VIRTUAL || layout == H5D_LAYOUT_ERROR || H5Pget_external_count(create.id()) != 0)
    return std::nullopt;
  std::size_t chunk_bytes = H5Tget_size(type.id());
  if (layout == H5D_CHUNKED) {
    hsize_t chunk[H5S_MAX_RANK] = {};
    const int rank = H5Pget_chunk(create.id(), H5S_MAX_RANK, chunk);
    for (int d = 0; d < rank; ++d)
      if (__builtin_mul_overflow(chunk_bytes, chunk[d], &chunk_bytes)) return std::nullopt;
  }
  const Handle space(H5Dget_space(dataset), H5Sclose);
  hsize_t dims[H5S_MAX_RANK] = {};
  const int rank = H5Sget_simple_extent_dims(space.id(), dims, nullptr);
  if (rank < 0 || H5Sget_simple_extent_type(space.id()) == H5S_NULL || chunk_bytes > bytes_left_)
    return std::nullopt;
  std::vector<std::int64_t> out;
  hsize_t all = 1;
  for (int d = 0; d < rank; ++d) {
    if (__builtin_mul_overflow(all, dims[d], &all) || all > (hsize_t{1} << 40)) return std::nullopt;
    out.push_back(static_cast<std::int64_t>(dims[d]));
  }
  return out;
}

std::optional<std::vector<std::int64_t>> Input::number_shape(hid_t dataset) const {
  return shape(dataset, is_number);
}
std::optional<std::vector<std::int64_t>> Input::text_shape(hid_t dataset) const {
  return shape(dataset, is_text);
}

bool Input::afford(std::size_t count, std::size_t bytes_each) {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(count, bytes_each, &bytes) || bytes > bytes_left_) return false;
  bytes_left_ -= bytes;
  return true;
}

bool Input::read(hid_t dataset, hid_t memory_type, void* out) const {
  return H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out) >= 0;
}

std::optional<std::vector<std::string>> Input::texts(hid_t dataset) {
  const auto dims = text_shape(dataset);
  if (!dims) return std::nullopt;
  std::size_t count = 1;
  for (const std::int64_t d : *dims) count *= static_cast<std::size_t>(d);
  const Handle type(H5Dget_type(dataset), H5Tclose);
  if (!afford(count, sizeof(std::string) + H5Tget_size(type.id()))) return std::nullopt;
  const Handle space(H5Dget_space(dataset), H5Sclose);
  return read_texts(type.id(), space.id(), count,
                    [&](hid_t memory_type, void* out) { return read(dataset, memory_type, out) ? 0 : -1; });
}

template <class T>
std::optional<Array<T>> Input::numbers(hid_t dataset) {
  const auto dims = number_shape(dataset);
  if (!dims) return std::nullopt;
  std::size_t count = 1;
  for (const std::int64_t d : *dims) count *= static_cast<std::size_t>(d);
  if (!afford(count, sizeof(T))) return std::nullopt;
  Array<T> out(count, T{});
  if (count > 0 && !read(dataset, native<T>(), out.data())) return std::nullopt;
  if ((sizeof(T) == 1) == holds_bytes(dataset))
    digests_[path_of(dataset)] = XXH3_64bits(out.data(), out.size() * sizeof(T));
  return out;
}
template std::optional<Array<double>> Input::numbers(hid_t);
template std::optional<Array<std::uint8_t>> Input::numbers(hid_t);

std::optional<Array<double>> Input::member(hid_t table, const char* name) {
  const auto dims = shape(table, is_record);
  if (!dims || dims->size() != 1) return std::nullopt;
  const Handle type(H5Dget_type(table), H5Tclose);
  const int at = H5Tget_member_index(type.id(), name);
  if (at < 0) return std::nullopt;
  const Handle stored(H5Tget_member_type(type.id(), static_cast<unsigned>(at)), H5Tclose);
  Handle wanted(H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose);
  std::size_t width = 1;
  if (H5Tget_class(stored.id()) == H5T_ARRAY) {
    const Handle element(H5Tget_super(stored.id()), H5Tclose);
    hsize_t across = 0;
    if (!is_number(element.id()) || H5Tget_array_ndims(stored.id()) != 1 ||
        H5Tget_array_dims2(stored.id(), &across) != 1)
      return std::nullopt;
    width = across;
    wanted = Handle(H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &across), H5Tclose);
  } else if (!is_number(stored.id())) {
    return std::nullopt;
  }
  const Handle record(H5Tcreate(H5T_COMPOUND, H5Tget_size(wanted.id())), H5Tclose);
  const auto rows = static_cast<std::size_t>(dims->front());
  if (H5Tinsert(record.id(), name, 0, wanted.id()) < 0 || !afford(rows, width * sizeof(double)))
    return std::nullopt;
  Array<double> out(rows * width, 0.0);
  if (rows > 0 && !read(table, record.id(), out.data())) return std::nullopt;
  return out;
}

std::optional<std::uint64_t> Input::digest_of(hid_t dataset) const {
  const auto known = digests_.find(path_of(dataset));
  return known == digests_.end() ? std::nullopt : std::optional(known->second);
}

bool Input::holds_bytes(hid_t dataset) const {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  return H5Tget_class(type.id()) == H5T_INTEGER && H5Tget_size(type.id()) == 1;
}

bool Input::read_rows(hid_t dataset, const std::vector<std::int64_t>& shape, std::int64_t first,
                      std::int64_t count, void* out) const {
  const hid_t memory_type = holds_bytes(dataset) ? H5T_NATIVE_UINT8 : H5T_NATIVE_DOUBLE;
  if (shape.empty()) return read(dataset, memory_type, out);
  std::vector<hsize_t> start(shape.size(), 0), size(shape.begin(), shape.end());
  start[0] = static_cast<hsize_t>(first);
  size[0] = static_cast<hsize_t>(count);
  const Handle in_file(H5Dget_space(dataset), H5Sclose);
  const Handle in_memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
  return H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) >=
             0 &&
         H5Dread(dataset, memory_type, in_memory.id(), in_file.id(), H5P_DEFAULT, out) >= 0;
}

std::optional<std::vector<std::string>> Input::references(hid_t dataset) {
  const auto dims = shape(dataset, is_reference);
  if (!dims || dims->size() != 1) return std::nullopt;
  const auto count = static_cast<std::size_t>(dims->front());
  if (!afford(count, sizeof(hobj_ref_t) + sizeof(std::string))) return std::nullopt;
  std::vector<hobj_ref_t> targets(count);
  if (count > 0 && !read(dataset, H5T_STD_REF_OBJ, targets.data())) return std::nullopt;
  std::vector<std::string> out;
  for (const hobj_ref_t& target : targets) {
    auto path = name_of(dataset, target);
    if (!path) return std::nullopt;
    out.push_back(std::move(*path));
  }
  return out;
}

std::optional<std::string> Input::reference_attribute(hid_t object, const char* name) const {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute) return std::nullopt;
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  hobj_ref_t target{};
  if (!is_reference(type.id()) || H5Sget_simple_extent_npoints(space.id()) != 1 ||
      H5Aread(attribute.id(), H5T_STD_REF_OBJ, &target) < 0)
    return std::nullopt;
  return name_of(object, target);
}

std::optional<std::string> Input::soft_link(hid_t group, const std::string& name) const {
  H5L_info_t info{};
  if (H5Lget_info(group, name.c_str(), &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_SOFT ||
      info.u.val_size == 0 || info.u.val_size > kMaxTextBytes)
    return std::nullopt;
  std::string target(info.u.val_size, '\0');
  if (H5Lget_val(group, name.c_str(), target.data(), target.size(), H5P_DEFAULT) < 0) return std::nullopt;
  target.pop_back();  // its zero
  return target;
}

std::optional<std::vector<std::string>> Input::text_attributes(hid_t object, const char* name) const {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute) return std::nullopt;
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  if (!type || !is_text(type.id()) || count < 0 || static_cast<std::size_t>(count) > kMaxChildren)
    return std::nullopt;
  return read_texts(type.id(), space.id(), static_cast<std::size_t>(count),
                    [&](hid_t memory_type, void* out) { return H5Aread(attribute.id(), memory_type, out); });
}

std::optional<std::string> Input::text_attribute(hid_t object, const char* name) const {
  const auto texts = text_attributes(object, name);
  return texts && texts->size() == 1 ? std::optional(texts->front()) : std::nullopt;
}

std::optional<double> Input::number_attribute(hid_t object, const char* name) const {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute) return std::nullopt;
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  double value = 0.0;
  if (!type || !is_number(type.id()) || H5Sget_simple_extent_npoints(space.id()) != 1 ||
      H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0)
    return std::nullopt;
  if (H5Tget_class(type.id()) == H5T_FLOAT && H5Tget_size(type.id()) == sizeof(float))
    return parse_number(fmt::format("{}", static_cast<float>(value))).value_or(value);
  return value;
}

}  // namespace kinemark::io::internal
