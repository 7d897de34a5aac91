// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Edits of an HDF5 file that the bytes of a fuzzer ask for: groups and datasets gone, linked elsewhere, of
// other shapes and types, other samples and attributes. The structures that HDF5 keeps for itself are left
// whole: HDF5 1.10 can crash on damaged ones.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/io/nwb/internal/input.h"

namespace kinemark::io::testing {

using internal::Handle;

/// The file that every input begins with, and where things are in it.
struct Start {
  std::string bytes;
  std::vector<std::string> paths;       // of groups and datasets
  std::vector<std::string> attributes;  // their names
};

inline void walk(const internal::Input& in, const std::string& path, Start& out) {
  const Handle object = in.object(in.file(), path.empty() ? "/" : path);
  if (!path.empty()) out.paths.push_back(path);
  for (hsize_t i = 0;; ++i) {
    const Handle attribute(
        H5Aopen_by_idx(object.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (!attribute) break;
    std::array<char, 64> name{};
    H5Aget_name(attribute.id(), name.size(), name.data());
    if (std::ranges::find(out.attributes, name.data()) == out.attributes.end())
      out.attributes.emplace_back(name.data());
  }
  if (const auto below = in.children(object.id()))
    for (const std::string& name : *below) walk(in, path + "/" + name, out);
}

/// A file as bytes, and all that is in it.
inline Start start_of(std::string bytes) {
  Start out{.bytes = std::move(bytes), .paths = {}, .attributes = {}};
  const auto in = internal::Input::open(std::as_bytes(std::span(out.bytes)), "start");
  walk(in.value(), "", out);
  return out;
}

class Editor {
 public:
  Editor(hid_t file, const Start& start, FuzzedDataProvider& bytes)
      : file_(file), start_(start), bytes_(bytes) {}

  void edit() {
    const std::string at = path();
    switch (bytes_.ConsumeIntegralInRange(0, 6)) {
      case 0:
        H5Ldelete(file_, at.c_str(), H5P_DEFAULT);
        break;
      case 1:
        set_attribute(at, true);
        break;
      case 2:
        set_attribute(at, false);
        break;
      case 3:
        replace(at);
        break;
      case 4:
        set_samples(at);
        break;
      case 5:
        H5Ldelete(file_, at.c_str(), H5P_DEFAULT);
        H5Lcreate_soft(path().c_str(), file_, at.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        break;
      default:
        H5Ldelete(file_, at.c_str(), H5P_DEFAULT);
        H5Lcreate_hard(file_, path().c_str(), file_, at.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
  }

 private:
  const std::string& path() { return start_.paths[index(start_.paths.size())]; }

  void set_attribute(const std::string& at, bool text) {
    const Handle object(H5Oopen(file_, at.c_str(), H5P_DEFAULT), H5Oclose);
    const std::string name = start_.attributes[index(start_.attributes.size())];
    H5Adelete(object.id(), name.c_str());
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const std::string value = bytes_.ConsumeRandomLengthString(32) + '\0';
    const Handle string_type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(string_type.id(), value.size());
    const Handle made(H5Acreate2(object.id(), name.c_str(), text ? string_type.id() : H5T_IEEE_F64LE,
                                 space.id(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose);
    const double number = real();
    if (text)
      H5Awrite(made.id(), string_type.id(), value.data());
    else
      H5Awrite(made.id(), H5T_NATIVE_DOUBLE, &number);
  }

  /// A dataset of another shape and type; samples are written into small ones.
  void replace(const std::string& at) {
    constexpr std::array<hsize_t, 9> kSizes = {0, 1, 2, 3, 4, 5, 6, 20, hsize_t{1} << 40};
    std::vector<hsize_t> dims(static_cast<std::size_t>(bytes_.ConsumeIntegralInRange(0, 3)));
    std::size_t count = 1;
    for (hsize_t& size : dims) {
      size = kSizes[index(kSizes.size())];
      count = size > 20 ? std::size_t{1} << 40 : count * size;
    }
    const Handle string_type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(string_type.id(), 12);
    const std::array types = {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_U8LE, H5T_STD_I64LE, string_type.id()};
    const hid_t type = types[index(types.size())];
    H5Ldelete(file_, at.c_str(), H5P_DEFAULT);
    const Handle space(dims.empty() ? H5Screate(H5S_SCALAR)
                                    : H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
                       H5Sclose);
    const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const std::vector<hsize_t> chunk(dims.size(), 1);
    if (!dims.empty()) H5Pset_chunk(create.id(), static_cast<int>(chunk.size()), chunk.data());
    const Handle made(H5Dcreate2(file_, at.c_str(), type, space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT),
                      H5Dclose);
    if (!made || count > 1000) return;
    if (type == string_type.id()) {
      std::vector<char> text(12 * std::max<std::size_t>(count, 1), '\0');
      bytes_.ConsumeData(text.data(), text.size());
      H5Dwrite(made.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data());
    } else {
      write_numbers(made.id(), count);
    }
  }

  void set_samples(const std::string& at) {
    const Handle dataset(H5Dopen2(file_, at.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    const H5T_class_t kind = H5Tget_class(type.id());
    if ((kind == H5T_FLOAT || kind == H5T_INTEGER) && count > 0 && count <= 1000)
      write_numbers(dataset.id(), static_cast<std::size_t>(count));
  }

  void write_numbers(hid_t dataset, std::size_t count) {
    std::vector<double> numbers(std::max<std::size_t>(count, 1));
    for (double& x : numbers) x = bytes_.remaining_bytes() > 0 ? real() : 1.0;
    H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  }

  double real() {
    constexpr std::array kOdd = {0.0, -1.0, 1.0, 4.0, 1e-310, 1e300, HUGE_VAL, -HUGE_VAL, double(NAN)};
    const std::size_t which = index(kOdd.size() + 1);
    return which < kOdd.size() ? kOdd[which] : bytes_.ConsumeFloatingPoint<double>();
  }

  std::size_t index(std::size_t size) { return bytes_.ConsumeIntegralInRange<std::size_t>(0, size - 1); }

  hid_t file_;
  const Start& start_;
  FuzzedDataProvider& bytes_;
};

/// The start with up to eight edits, in the file `path`.
inline void write_edited(const std::filesystem::path& path, const Start& start, FuzzedDataProvider& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(start.bytes.data(), static_cast<std::streamsize>(start.bytes.size()));
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  if (!file) std::abort();
  Editor editor(file.id(), start, bytes);
  for (int edits = 0; edits < 8 && bytes.remaining_bytes() > 0; ++edits) editor.edit();
}

}  // namespace kinemark::io::testing
