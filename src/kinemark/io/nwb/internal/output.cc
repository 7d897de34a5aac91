// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/output.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "kinemark/core/random.h"

namespace kinemark::io::internal {
namespace {

constexpr hsize_t kChunkFrames = 4096;
constexpr hsize_t kMostChunkNumbers = 1 << 19;    // of rows of many numbers: 4 MB
constexpr std::size_t kMaxCompactBytes = 32'000;  // an object's header can hold 64 KB

std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0;
  for (const char c : text) hash = mix64(hash ^ static_cast<unsigned char>(c)) + 0x9E3779B97F4A7C15ULL;
  return hash;
}

std::vector<const char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<const char*> out;
  for (const std::string& text : texts) out.push_back(text.c_str());
  return out;
}

Handle simple_space(const std::vector<hsize_t>& dims) {
  return {H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose};
}

}  // namespace

std::size_t Column::rows() const {
  if (!ends.empty()) return ends.size();
  if (!references.empty()) return references.size();
  std::size_t one = 1;
  for (const hsize_t size : across) one *= std::max<hsize_t>(size, 1);
  return std::max({texts.size(), numbers.size() / one, integers.size() / one});
}

Output::Output(const std::string& path, std::string_view identity) : identity_(hash_of(identity)) {
  // The format of HDF5 1.10 checks its own structures with checksums; the older ones do not.
  const Handle access = keep(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  note(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110));
  // The file is locked already, by the one who made it.
  note(H5Pset_file_locking(access.id(), false, true));
  const Handle create = keep(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  note(H5Pset_obj_track_times(create.id(), false));
  note(H5Pset_link_phase_change(create.id(), 65535, 0));
  file_ = keep(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, create.id(), access.id()), H5Fclose);
  make_types();
}

Output::Output(Handle file, std::string_view identity)
    : file_(std::move(file)), identity_(hash_of(identity)), failed_(!file_) {
  make_types();
}

void Output::make_types() {
  text_type_ = keep(H5Tcopy(H5T_C_S1), H5Tclose);
  note(H5Tset_size(text_type_.id(), H5T_VARIABLE));
  note(H5Tset_cset(text_type_.id(), H5T_CSET_UTF8));
  create_group_ = keep(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  note(H5Pset_obj_track_times(create_group_.id(), false));
  // Links of large groups would go into a heap, which has no checksum; here they stay in the group's header.
  note(H5Pset_link_phase_change(create_group_.id(), 65535, 0));
}

Handle Output::keep(hid_t id, Handle::Closer close) {
  failed_ = failed_ || id < 0;
  return {id, close};
}

Handle Output::group(hid_t parent, const char* name, const char* type) {
  Handle out = keep(H5Gcreate2(parent, name, H5P_DEFAULT, create_group_.id(), H5P_DEFAULT), H5Gclose);
  if (*type != '\0') declare(out.id(), type);
  return out;
}

void Output::declare(hid_t object, const char* type, const char* type_namespace) {
  attribute(object, "neurodata_type", type);
  attribute(object, "namespace", type_namespace);
  // A UUID of version 8: 122 bits of our own.
  ++objects_;
  const std::uint64_t a = mix64(identity_ + objects_ * 0x9E3779B97F4A7C15ULL);
  const std::uint64_t b = mix64(a ^ 0x632BE59BD9B4E019ULL);
  attribute(object, "object_id",
            fmt::format("{:08x}-{:04x}-8{:03x}-{:04x}-{:012x}", a >> 32, (a >> 16) & 0xFFFF, a & 0xFFF,
                        0x8000 | (b >> 48 & 0x3FFF), b & 0xFFFFFFFFFFFFULL));
}

void Output::attribute(hid_t object, const char* name, std::string_view text) {
  const std::string copy(text);
  const char* pointer = copy.c_str();
  const Handle space = keep(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made =
      keep(H5Acreate2(object, name, text_type_.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  note(H5Awrite(made.id(), text_type_.id(), static_cast<const void*>(&pointer)));
}

void Output::attribute(hid_t object, const char* name, double number, hid_t file_type) {
  const Handle space = keep(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made =
      keep(H5Acreate2(object, name, file_type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  note(H5Awrite(made.id(), H5T_NATIVE_DOUBLE, &number));
}

void Output::attribute(hid_t object, const char* name, const std::vector<std::string>& texts) {
  const auto pointers = pointers_to(texts);
  const Handle space = simple_space({texts.size()});
  const Handle made =
      keep(H5Acreate2(object, name, text_type_.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  note(H5Awrite(made.id(), text_type_.id(), static_cast<const void*>(pointers.data())));
}

Handle Output::small_data(std::size_t bytes, const std::vector<hsize_t>& dims) {
  Handle create = keep(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  note(H5Pset_obj_track_times(create.id(), false));
  if (bytes <= kMaxCompactBytes) {
    note(H5Pset_layout(create.id(), H5D_COMPACT));
  } else {
    note(H5Pset_chunk(create.id(), static_cast<int>(dims.size()), dims.data()));
    note(H5Pset_fletcher32(create.id()));
  }
  return create;
}

Handle Output::text(hid_t parent, const char* name, std::string_view text) {
  const std::string copy(text);
  const char* pointer = copy.c_str();
  const Handle space = keep(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle create = small_data(0, {});
  Handle made = keep(
      H5Dcreate2(parent, name, text_type_.id(), space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT), H5Dclose);
  note(H5Dwrite(made.id(), text_type_.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                static_cast<const void*>(&pointer)));
  return made;
}

Handle Output::texts(hid_t parent, const char* name, const std::vector<std::string>& texts,
                     std::size_t columns) {
  const auto pointers = pointers_to(texts);
  std::vector<hsize_t> dims{texts.size() / columns};
  if (columns > 1) dims.push_back(columns);
  const Handle space = simple_space(dims);
  // Texts of any length cannot have a checksum of HDF5's in a chunk. That of the whole content holds them.
  const std::size_t bytes = texts.size() * H5Tget_size(text_type_.id());
  const Handle create =
      bytes <= kMaxCompactBytes ? small_data(bytes, dims) : keep(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  note(H5Pset_obj_track_times(create.id(), false));
  Handle made = keep(
      H5Dcreate2(parent, name, text_type_.id(), space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT), H5Dclose);
  if (!texts.empty())
    note(H5Dwrite(made.id(), text_type_.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                  static_cast<const void*>(pointers.data())));
  return made;
}

Handle Output::number(hid_t parent, const char* name, double value) {
  const Handle space = keep(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle create = keep(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  note(H5Pset_obj_track_times(create.id(), false));
  Handle made = keep(
      H5Dcreate2(parent, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT), H5Dclose);
  note(H5Dwrite(made.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value));
  return made;
}

Handle Output::integers(hid_t parent, const char* name, const std::vector<std::int64_t>& values) {
  return column(parent, {.name = name, .integers = values});
}

Handle Output::samples(hid_t parent, const char* name, hid_t file_type, std::int64_t frames, int width,
                       double fill, int compression) {
  std::vector<hsize_t> dims{static_cast<hsize_t>(frames)};
  const hsize_t most = std::max<hsize_t>(1, kMostChunkNumbers / static_cast<hsize_t>(width));
  std::vector<hsize_t> chunk{std::min({kChunkFrames, dims[0], most})};
  if (width > 1) {
    dims.push_back(static_cast<hsize_t>(width));
    chunk.push_back(static_cast<hsize_t>(width));
  }
  const Handle create = keep(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  note(H5Pset_obj_track_times(create.id(), false));
  note(H5Pset_chunk(create.id(), static_cast<int>(chunk.size()), chunk.data()));
  note(H5Pset_fill_value(create.id(), H5T_NATIVE_DOUBLE, &fill));
  if (H5Tget_size(file_type) > 1) note(H5Pset_shuffle(create.id()));
  if (compression > 0) note(H5Pset_deflate(create.id(), static_cast<unsigned>(compression)));
  note(H5Pset_fletcher32(create.id()));
  // One chunk of cache for each of many datasets: pieces come in order.
  const Handle access = keep(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  note(H5Pset_chunk_cache(access.id(), 3, kChunkFrames * static_cast<std::size_t>(width) * sizeof(double),
                          1.0));
  const Handle space = simple_space(dims);
  return keep(H5Dcreate2(parent, name, file_type, space.id(), H5P_DEFAULT, create.id(), access.id()),
              H5Dclose);
}

void Output::write(const Handle& samples, hid_t memory_type, std::int64_t first, std::int64_t count,
                   int width, const void* values) {
  const std::array<hsize_t, 2> start{static_cast<hsize_t>(first), 0};
  const std::array<hsize_t, 2> size{static_cast<hsize_t>(count), static_cast<hsize_t>(width)};
  const Handle in_file = keep(H5Dget_space(samples.id()), H5Sclose);
  note(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr));
  const Handle in_memory = simple_space({static_cast<hsize_t>(count * width)});
  note(H5Dwrite(samples.id(), memory_type, in_memory.id(), in_file.id(), H5P_DEFAULT, values));
}

Handle Output::column(hid_t table, const Column& column) {
  if (!column.texts.empty()) return texts(table, column.name.c_str(), column.texts);
  if (!column.references.empty()) return references(table, column);
  const bool whole = !column.integers.empty();
  const std::size_t count = whole ? column.integers.size() : column.numbers.size();
  std::vector<hsize_t> dims{column.ends.empty() ? column.rows() : count};
  dims.insert(dims.end(), column.across.begin(), column.across.end());
  const Handle space = simple_space(dims);
  const Handle create = small_data(count * sizeof(double), dims);
  Handle made = keep(H5Dcreate2(table, column.name.c_str(), whole ? H5T_STD_I64LE : H5T_IEEE_F64LE,
                                space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT),
                     H5Dclose);
  note(H5Dwrite(made.id(), whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                whole ? static_cast<const void*>(column.integers.data()) : column.numbers.data()));
  return made;
}

Handle Output::references(hid_t table, const Column& column) {
  std::vector<hobj_ref_t> targets(column.references.size());
  for (std::size_t i = 0; i < targets.size(); ++i)
    note(H5Rcreate(&targets[i], file_.id(), column.references[i].c_str(), H5R_OBJECT, -1));
  const std::vector<hsize_t> dims{targets.size()};
  const Handle space = simple_space(dims);
  const Handle create = small_data(targets.size() * sizeof(hobj_ref_t), dims);
  Handle made = keep(H5Dcreate2(table, column.name.c_str(), H5T_STD_REF_OBJ, space.id(), H5P_DEFAULT,
                                create.id(), H5P_DEFAULT),
                     H5Dclose);
  note(H5Dwrite(made.id(), H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, targets.data()));
  return made;
}

void Output::reference(hid_t object, const char* name, const std::string& target) {
  hobj_ref_t to{};
  note(H5Rcreate(&to, file_.id(), target.c_str(), H5R_OBJECT, -1));
  const Handle space = keep(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made =
      keep(H5Acreate2(object, name, H5T_STD_REF_OBJ, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  note(H5Awrite(made.id(), H5T_STD_REF_OBJ, &to));
}

/// The dataset that says where the rows of a column of any length end.
void Output::index_rows(hid_t table, const Column& column) {
  const std::vector<std::uint64_t> ends(column.ends.begin(), column.ends.end());
  const std::vector<hsize_t> dims{ends.size()};
  const Handle space = simple_space(dims);
  const Handle create = small_data(ends.size() * sizeof(std::uint64_t), dims);
  const std::string name = column.name + "_index";
  const Handle made =
      keep(H5Dcreate2(table, name.c_str(), H5T_STD_U64LE, space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT),
           H5Dclose);
  note(H5Dwrite(made.id(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, ends.data()));
  declare(made.id(), "VectorIndex", "hdmf-common");
  attribute(made.id(), "description", "where the rows of " + column.name + " end");
  std::string path(static_cast<std::size_t>(std::max<ssize_t>(0, H5Iget_name(table, nullptr, 0))) + 1, '\0');
  H5Iget_name(table, path.data(), path.size());
  path.pop_back();
  reference(made.id(), "target", path + "/" + column.name);
}

void Output::table(hid_t parent, const char* name, const char* description,
                   const std::vector<Column>& columns, const char* type) {
  const Handle made = group(parent, name);
  declare(made.id(), type, std::string_view(type) == "DynamicTable" ? "hdmf-common" : "core");
  attribute(made.id(), "description", description);
  std::vector<std::string> names;
  Column id{.name = "id", .integers = {}};
  for (const Column& c : columns) {
    names.push_back(c.name);
    const Handle data = column(made.id(), c);
    declare(data.id(), "VectorData", "hdmf-common");
    attribute(data.id(), "description", c.description);
    if (!c.ends.empty()) index_rows(made.id(), c);
    id.integers.resize(c.rows());
  }
  attribute(made.id(), "colnames", names);
  for (std::size_t i = 0; i < id.integers.size(); ++i) id.integers[i] = static_cast<std::int64_t>(i);
  const Handle ids = column(made.id(), id);
  declare(ids.id(), "ElementIdentifiers", "hdmf-common");
}

void Output::soft_link(hid_t parent, const char* name, const std::string& target) {
  note(H5Lcreate_soft(target.c_str(), parent, name, H5P_DEFAULT, H5P_DEFAULT));
}

bool Output::close() {
  if (!file_.close()) failed_ = true;
  return !failed_;
}

}  // namespace kinemark::io::internal
