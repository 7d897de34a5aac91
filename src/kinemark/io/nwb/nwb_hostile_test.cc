// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Broken and malicious files: one sentence or a valid recording, nothing on stderr, bounded memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/internal/reader.h"
#include "kinemark/io/nwb/testing/sample.h"
#include "support/scratch.h"

// HDF5 1.10 does not free everything when a damaged file makes it give up in the middle; that is not ours to
// mend, and would hide leaks that are.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace kinemark::io {
namespace {

using internal::Handle;
using ::testing::HasSubstr;

/// A result that a caller can live with.
void expect_sane(const Result<NwbFile>& file) {
  if (file) {
    EXPECT_TRUE(file->trial.markers.validate());
    EXPECT_TRUE(!file->derivatives || file->derivatives->validate(file->trial.markers));
  } else {
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    // A unit that damage made unreadable is one that is not supported.
    EXPECT_TRUE(file.error().code == Code::bad_input || file.error().code == Code::not_supported)
        << file.error().message;
  }
}

std::string small_file(const testing_support::ScratchFolder& scratch) {
  const auto t = testing::sample_trajectories(12);
  const auto d = testing::sample_derivatives(t);
  EXPECT_TRUE(write_nwb(scratch / "small.nwb", t, &d, testing::sample_metadata(), {.force = true}));
  return read_text(scratch / "small.nwb").value();
}

Result<NwbFile> read_image(const std::string& bytes) {
  const internal::Quiet quiet;
  auto in = internal::Input::open(std::as_bytes(std::span(bytes)), "image.nwb");
  if (!in) return std::unexpected(in.error());
  return internal::read_nwb(*in);
}

TEST(HostileNwb, NotAnNwbFileAtAll) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "text.nwb", "Frame,Time\n", false));
  ASSERT_TRUE(write_text(scratch / "empty.nwb", "", false));
  {
    internal::Output other((scratch / "plain.h5").string(), "");
    ASSERT_TRUE(other.close());
  }
  for (const char* name : {"text.nwb", "empty.nwb"}) {
    const auto file = read_nwb(scratch / name);
    EXPECT_EQ(file.error().code, Code::bad_input);
    EXPECT_THAT(file.error().message, HasSubstr("is not an NWB file: it is not HDF5"));
  }
  EXPECT_THAT(read_nwb(scratch / "plain.h5").error().message, HasSubstr("is HDF5 but not an NWB file"));
  EXPECT_EQ(read_nwb(scratch / "absent.nwb").error().code, Code::io);
  EXPECT_EQ(read_nwb(scratch.path()).error().code, Code::bad_input);
}

TEST(HostileNwb, HDF5IsSilentAndStaysAsItWas) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "text.nwb", "no", false));
  H5E_auto2_t before = nullptr;
  H5E_auto2_t after = nullptr;
  void* data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(internal::read_nwb_here(scratch / "text.nwb"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  H5Eget_auto2(H5E_DEFAULT, &after, &data);
  EXPECT_EQ(before, after);
}

TEST(HostileNwb, FilesCutShort) {
  const testing_support::ScratchFolder scratch;
  const std::string whole = small_file(scratch);
  for (std::size_t k = 0; k < 40; ++k) {
    const auto file = read_image(whole.substr(0, whole.size() * k / 40));
    EXPECT_FALSE(file) << k;
    expect_sane(file);
  }
}

/// True where HDF5 keeps texts: the one structure of our files that has no checksum.
std::vector<bool> text_heaps(const std::string& bytes) {
  std::vector<bool> out(bytes.size(), false);
  for (std::size_t at = bytes.find("GCOL"); at != std::string::npos; at = bytes.find("GCOL", at + 1)) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at + 8, sizeof size);
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(at), std::min<std::size_t>(size, bytes.size() - at),
                true);
  }
  return out;
}

TEST(HostileNwb, BytesChangedAtRandomAreFoundByChecksums) {
  const testing_support::ScratchFolder scratch;
  const std::string whole = small_file(scratch);
  const auto intact = read_image(whole);
  ASSERT_TRUE(intact);
  const std::vector<bool> unguarded = text_heaps(whole);
  Random random(11, 0);
  int refused = 0;
  for (int k = 0; k < 60;) {
    std::string broken = whole;
    const double where = random.uniform();
    const auto at = static_cast<std::size_t>(where * static_cast<double>(whole.size()));
    if (unguarded[at]) continue;
    ++k;
    broken[at] = static_cast<char>(broken[at] ^ 0x55);
    const auto file = read_image(broken);
    expect_sane(file);
    refused += file ? 0 : 1;
    // What is not found must not matter: free space, or metadata that can be done without.
    if (file) {
      EXPECT_TRUE(testing::same_bits(file->trial.markers.x_in_world, intact->trial.markers.x_in_world));
      EXPECT_EQ(file->trial.markers.names, intact->trial.markers.names);
    }
  }
  EXPECT_GT(refused, 20);
}

/// Open the small file, let `spoil` change it, and read it.
template <class Spoil>
Result<NwbFile> spoilt(const testing_support::ScratchFolder& scratch, const Spoil& spoil) {
  small_file(scratch);
  const internal::Quiet quiet;
  {
    const Handle file(H5Fopen((scratch / "small.nwb").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    // As files of older versions, so that it is not the digest that sees what was done.
    H5Adelete(file.id(), internal::kDigestAttribute);
    const Handle module(H5Gopen2(file.id(), internal::kModule, H5P_DEFAULT), H5Gclose);
    spoil(module.id());
  }
  return internal::read_nwb_here(scratch / "small.nwb");
}

/// Put a dataset of `dims` in place of what was at `path`; nothing is written into it.
void replace(hid_t module, const char* path, std::vector<hsize_t> dims, hid_t type = H5T_IEEE_F64LE) {
  H5Ldelete(module, path, H5P_DEFAULT);
  const Handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  std::vector<hsize_t> chunk(dims.size(), 1);
  H5Pset_chunk(create.id(), static_cast<int>(chunk.size()), chunk.data());
  const Handle made(H5Dcreate2(module, path, type, space.id(), H5P_DEFAULT, create.id(), H5P_DEFAULT),
                    H5Dclose);
  ASSERT_TRUE(made) << path;
}

TEST(HostileNwb, ClaimsThatTheSizeOfTheFileDoesNotExplain) {
  const testing_support::ScratchFolder scratch;
  for (const hsize_t frames : {hsize_t{1} << 30, hsize_t{1} << 50}) {
    const auto file = spoilt(scratch, [&](hid_t m) {
      for (const char* name : {"Subject_LASI", "a_b", "a_b_2", "_.", "C7 \xC3\xA9"})
        replace(m, (std::string("Position/") + name + "/data").c_str(), {frames, 3});
    });
    ASSERT_FALSE(file);
    expect_sane(file);
  }
  expect_sane(spoilt(scratch, [](hid_t m) { replace(m, "markers/marker", {hsize_t{1} << 33}, H5T_C_S1); }));
}

TEST(HostileNwb, ShapesAndTypesThatDoNotFit) {
  const testing_support::ScratchFolder scratch;
  const auto message = [&](const auto& spoil) {
    const auto file = spoilt(scratch, spoil);
    expect_sane(file);
    return file ? "was read" : file.error().message;
  };
  EXPECT_THAT(
      message([](hid_t m) { replace(m, "Position/a_b/data", {12, 4}); }),
      HasSubstr("small.nwb: /processing/behavior/Position/a_b: data are not numbers of shape frames x 3"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "Position/a_b/data", {11, 3}); }),
              HasSubstr("marker 'a/b' has 11 samples, the first one 12"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "Position/a_b/data", {12, 3}, H5T_C_S1); }),
              HasSubstr("data are not numbers"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "Velocity/a_b/data", {12}); }),
              HasSubstr("Velocity/a_b: does not hold 12 samples of 3 numbers"));
  EXPECT_THAT(message([](hid_t m) { H5Ldelete(m, "Covariance/_.", H5P_DEFAULT); }),
              HasSubstr("Covariance/_.: does not hold 12 samples"));
  EXPECT_THAT(message([](hid_t m) { H5Ldelete(m, "Position/_.", H5P_DEFAULT); }),
              HasSubstr("Position/_.: data"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "markers/t0_s", {4}); }),
              HasSubstr("columns of different lengths"));
  EXPECT_THAT(message([](hid_t m) { H5Ldelete(m, "markers", H5P_DEFAULT); }),
              HasSubstr("table of markers is missing"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "markers/rate_hz", {5}); }), HasSubstr("rate of 0 Hz"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "markers/filter_order", {2}); }),
              HasSubstr("a filter for each"));
  EXPECT_THAT(message([](hid_t m) { H5Ldelete(m, "methods", H5P_DEFAULT); }),
              HasSubstr("a sample was made by method"));
  EXPECT_THAT(message([](hid_t m) { replace(m, "markers/offset_s", {3}); }), HasSubstr("was read"))
      << "the offsets of samples go before those of markers";
}

TEST(HostileNwb, LostProvenanceDoesNotCostTheSamples) {
  const testing_support::ScratchFolder scratch;
  const auto file = spoilt(scratch, [](hid_t m) {
    H5Ldelete(m, "provenance", H5P_DEFAULT);
    H5Ldelete(m, "sources/bytes", H5P_DEFAULT);
    H5Ldelete(m, "Position/a_b/control", H5P_DEFAULT);
  });
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->metadata.software, "kinemark") << "general/was_generated_by says so, too";
  EXPECT_EQ(file->metadata.sources.size(), 2U);
  EXPECT_TRUE(file->trial.markers.validate());
}

}  // namespace
}  // namespace kinemark::io
