// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Compiled in place of everything else where HDF5 is absent or not wanted.
#include <fmt/core.h>

#include "kinemark/io/nwb/neural_file.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/nwb/nwb_tables.h"
#include "kinemark/io/nwb/pose_table.h"

namespace kinemark::io {
namespace {

std::unexpected<Error> absent(const std::filesystem::path& path) {
  return fail(Code::not_supported,
              fmt::format("{}: this program was built without HDF5, which NWB and points in .h5 need; "
                          "install libhdf5-dev and build it again with "
                          "KINEMARK_NWB=ON",
                          path.string()));
}

}  // namespace

struct NwbWriter::Open {};

NwbOutline NwbOutline::of(const data::Trajectories& trajectories, const data::Derivatives* /*derivatives*/) {
  return {.names = trajectories.names, .time = trajectories.time};
}

Result<NwbFile> read_nwb(const std::filesystem::path& path) { return absent(path); }

Result<data::Neural> read_neural(const std::filesystem::path& path) { return absent(path); }

Result<data::Neural> read_neural_lanes(const std::filesystem::path& path) { return absent(path); }

Result<PoseTable> read_pose_table(const std::filesystem::path& path) { return absent(path); }

Status write_nwb(const std::filesystem::path& path, const data::Trajectories& /*trajectories*/,
                 const data::Derivatives* /*derivatives*/, const NwbMetadata& /*metadata*/,
                 const NwbWriteOptions& /*options*/) {
  return absent(path);
}

Status write_nwb(const std::filesystem::path& path, const data::Trial& /*trial*/,
                 const data::Derivatives* /*derivatives*/, const NwbMetadata& /*metadata*/,
                 const NwbWriteOptions& /*options*/) {
  return absent(path);
}

Status write_nwb_tables(const std::filesystem::path& path, std::span<const NwbTable> /*tables*/,
                        const NwbMetadata& /*metadata*/, bool /*force*/, const data::Beside* /*beside*/,
                        const std::string& /*module*/) {
  return absent(path);
}

NwbWriter::NwbWriter(std::unique_ptr<Open> open) : open_(std::move(open)) {}
NwbWriter::NwbWriter(NwbWriter&& other) noexcept = default;
NwbWriter& NwbWriter::operator=(NwbWriter&& other) noexcept = default;
NwbWriter::~NwbWriter() = default;

Result<NwbWriter> NwbWriter::create(const std::filesystem::path& path, const NwbOutline& /*outline*/,
                                    const NwbMetadata& /*metadata*/, const NwbWriteOptions& /*options*/) {
  return absent(path);
}

Status NwbWriter::write(const data::Trajectories& /*piece*/, const data::Derivatives* /*derivatives*/,
                        std::int64_t /*first_frame*/) {
  return absent("NWB");
}

Status NwbWriter::write_signals(const data::Trial& /*trial*/) { return absent("NWB"); }

Status NwbWriter::write_neural(const data::Neural& /*neural*/,
                               const std::vector<data::FieldSamples>& /*fields*/) {
  return absent("NWB");
}

Status NwbWriter::commit(const std::string& /*set*/) { return absent("NWB"); }

}  // namespace kinemark::io
