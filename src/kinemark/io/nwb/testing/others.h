// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What other programs put into an NWB file: spikes, voltages, trials, references, links. For the tests of
// this folder.
#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/io/nwb/internal/output.h"

namespace kinemark::io::testing {

using internal::Handle;

/// A row of a table that points at a stretch of a series, as NWB stores them.
struct Stretch {
  std::int32_t first, count;
  hobj_ref_t series;
};

inline Handle stretch_type() {
  Handle type(H5Tcreate(H5T_COMPOUND, sizeof(Stretch)), H5Tclose);
  H5Tinsert(type.id(), "idx_start", offsetof(Stretch, first), H5T_NATIVE_INT32);
  H5Tinsert(type.id(), "count", offsetof(Stretch, count), H5T_NATIVE_INT32);
  H5Tinsert(type.id(), "timeseries", offsetof(Stretch, series), H5T_STD_REF_OBJ);
  return type;
}

inline Handle open_for_writing(const std::filesystem::path& path) {
  return {H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
}

/// Adds /units, /acquisition/lfp (chunked, compressed), /intervals/trials (compound with references),
/// /general/lab, a device, a soft link, a link to another file, and (`loop`) a group that links to itself.
inline void add_others(const std::filesystem::path& path, bool loop = true) {
  const internal::Quiet quiet;
  internal::Output out(open_for_writing(path), "others");
  const hid_t file = out.file();
  const auto ensure = [&](const char* group) {
    if (H5Lexists(file, group, H5P_DEFAULT) <= 0) out.group(file, group);
  };
  for (const char* group : {"/acquisition", "/general", "/general/devices", "/intervals"}) ensure(group);
  std::vector<double> spikes(40);
  std::iota(spikes.begin(), spikes.end(), 0.25);
  out.table(file, "units", "sorted", {{.name = "spike_times", .description = "s", .numbers = spikes}});
  const Handle units(H5Gopen2(file, "/units", H5P_DEFAULT), H5Gclose);
  const Handle lfp = out.group(file, "/acquisition/lfp", "ElectricalSeries");
  const Handle data = out.samples(lfp.id(), "data", H5T_IEEE_F32LE, 6000, 4, 0.0, 6);
  std::vector<double> volts(24000);
  for (std::size_t i = 0; i < volts.size(); ++i) volts[i] = 1e-6 * static_cast<double>(i % 977);
  out.write(data, H5T_NATIVE_DOUBLE, 0, 6000, 4, volts.data());
  out.attribute(data.id(), "unit", "volts");
  const Handle start = out.number(lfp.id(), "starting_time", 0.5);
  out.attribute(start.id(), "rate", 1000.0, H5T_IEEE_F64LE);
  const Handle trials = out.group(file, "/intervals/trials", "TimeIntervals");
  out.attribute(trials.id(), "colnames", std::vector<std::string>{"timeseries"});
  std::array<Stretch, 2> rows{{{0, 100, 0}, {100, 50, 0}}};
  for (auto& row : rows) H5Rcreate(&row.series, file, "/acquisition/lfp", H5R_OBJECT, -1);
  const hsize_t two = 2;
  const Handle space(H5Screate_simple(1, &two, nullptr), H5Sclose);
  const Handle type = stretch_type();
  const Handle column(
      H5Dcreate2(trials.id(), "timeseries", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  H5Dwrite(column.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  out.text(file, "/general/lab", "motor lab");
  out.group(file, "/general/devices/probe", "Device");
  out.soft_link(file, "/acquisition/same", "/acquisition/lfp");
  H5Lcreate_external("elsewhere.h5", "/raw", file, "/acquisition/raw", H5P_DEFAULT, H5P_DEFAULT);
  out.group(file, "/odd");
  if (loop) H5Lcreate_hard(file, "/odd", file, "/odd/again", H5P_DEFAULT, H5P_DEFAULT);
  if (!out.close()) std::abort();
}

/// The bytes of a dataset as they are in memory; references as the paths that they lead to.
inline std::string content(const std::filesystem::path& path, const char* dataset) {
  const internal::Quiet quiet;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Handle data(H5Dopen2(file.id(), dataset, H5P_DEFAULT), H5Dclose);
  if (!data) return "absent";
  const Handle type(H5Dget_type(data.id()), H5Tclose);
  const Handle space(H5Dget_space(data.id()), H5Sclose);
  std::string bytes(
      static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())) * H5Tget_size(type.id()), '\0');
  if (H5Tget_class(type.id()) == H5T_COMPOUND) {
    std::vector<Stretch> rows(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    const Handle memory = stretch_type();
    if (H5Dread(data.id(), memory.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) return "unreadable";
    std::string out;
    for (const auto& row : rows) {
      std::array<char, 64> name{};
      H5Rget_name(file.id(), H5R_OBJECT, &row.series, name.data(), name.size());
      out += std::to_string(row.first) + " " + std::to_string(row.count) + " " + name.data() + "\n";
    }
    return out;
  }
  if (H5Dread(data.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) return "unreadable";
  return bytes;
}

}  // namespace kinemark::io::testing
