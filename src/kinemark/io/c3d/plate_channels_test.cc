// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/internal/plate_channels.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

C3dParameter channel(int rows, std::vector<double> numbers) {
  const int plates = static_cast<int>(numbers.size()) / rows;
  return {.name = "CHANNEL", .type = C3dType::int16, .dims = {rows, plates}, .numbers = std::move(numbers)};
}

/// `before` channels of muscles, six of each of `plates` plates, one more muscle.
AnalogLabels labelled(int before, int plates) {
  AnalogLabels out;
  for (int k = 0; k < before; ++k) out.labels.push_back(fmt::format("EMG{}", k + 1));
  for (int p = 1; p <= plates; ++p)
    for (const char* part : {"Fx", "Fy", "Fz", "Mx", "My", "Mz"})
      out.labels.push_back(fmt::format("Force.{}{}", part, p));
  out.labels.emplace_back("EMG9");
  out.count = std::ssize(out.labels);
  return out;
}

struct Found {
  int first;
  std::vector<std::string> warnings;
};

Found first_of(const C3dParameter& channels, const std::vector<double>& types, const AnalogLabels& analog) {
  Found out{.first = -1, .warnings = {}};
  out.first = first_channel_number(&channels, types, analog, out.warnings);
  return out;
}

TEST(PlateChannels, CountedFromZeroAreSeenByTheLabels) {
  const auto two = channel(6, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  const auto found = first_of(two, {2, 2}, labelled(0, 2));
  EXPECT_EQ(found.first, 0);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr(
                                  "FORCE_PLATFORM:CHANNEL counts from 0, not from 1 as the format has it (so "
                                  "the labels of the channels say); 1 is added to each number, 'Force.Fx1' "
                                  "is the first channel of plate 1")));
  EXPECT_THAT(channels_of_plate(&two, 1, 2, 13, 0), ElementsAre(6, 7, 8, 9, 10, 11));
  // No number is 0 where other channels come first: every label is one off all the same.
  const auto behind = channel(6, {4, 5, 6, 7, 8, 9});
  EXPECT_EQ(first_of(behind, {2}, labelled(4, 1)).first, 0);
  // Rows that the type has not are of no plate, whatever they hold.
  EXPECT_EQ(first_of(channel(8, {0, 1, 2, 3, 4, 5, 0, 0}), {4}, labelled(0, 1)).first, 0);
}

TEST(PlateChannels, CountedFromOneAreLeftAlone) {
  const auto found = first_of(channel(6, {5, 6, 7, 8, 9, 10}), {2}, labelled(4, 1));
  EXPECT_EQ(found.first, 1);
  EXPECT_THAT(found.warnings, IsEmpty());
  AnalogLabels bare{.labels = {}, .count = 12};
  EXPECT_EQ(first_of(channel(6, {1, 2, 3, 4, 5, 6}), {2}, bare).first, 1);
  EXPECT_EQ(first_of(channel(6, {5, 6, 7, 8, 9, 10}), {2}, bare).first, 1);
}

TEST(PlateChannels, WithoutLabelsTheyCountFromZeroWithoutAGap) {
  const AnalogLabels bare{.labels = {"1", "2", "3"}, .count = 12};
  const auto found = first_of(channel(6, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), {2, 2}, bare);
  EXPECT_EQ(found.first, 0);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("(0, 1, 2 and so on)")));
  EXPECT_EQ(first_of(channel(6, {0, 1, 2, 4, 5, 6}), {2}, bare).first, 1) << "a gap";
  EXPECT_EQ(first_of(channel(6, {0, 1, 2, 3, 4, 5}), {2}, {.labels = {}, .count = 5}).first, 1)
      << "a channel that the file has not";
}

TEST(PlateChannels, AZeroOfAChannelThatIsNotThereStays) {
  // Fx was never connected: Fy is the first channel of the file.
  AnalogLabels without{.labels = {"Fy1", "Fz1", "Mx1", "My1", "Mz1", "EMG1"}, .count = 6};
  const auto unused = channel(6, {0, 1, 2, 3, 4, 5});
  const auto found = first_of(unused, {2}, without);
  EXPECT_EQ(found.first, 1);
  EXPECT_THAT(found.warnings, IsEmpty());
  EXPECT_THAT(channels_of_plate(&unused, 0, 2, 6, 1), IsEmpty());
  // The second plate was not in use.
  const auto empty = channel(6, {1, 2, 3, 4, 5, 6, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(first_of(empty, {2, 2}, labelled(0, 2)).first, 1);
  EXPECT_EQ(first_of(empty, {2, 2}, {.labels = {}, .count = 12}).first, 1);
  // Only the vertical force.
  EXPECT_EQ(first_of(channel(6, {0, 0, 1, 0, 0, 0}), {2}, {.labels = {}, .count = 12}).first, 1);
}

TEST(PlateChannels, LabelsOfOtherComponentsAreSaid) {
  const auto said = [](std::vector<double> numbers, int type, const AnalogLabels& analog) {
    std::vector<std::string> warnings;
    const int rows = static_cast<int>(numbers.size());
    const auto channels = channel(rows, std::move(numbers));
    note_other_labels(&channels, std::vector<double>{static_cast<double>(type)}, analog, 1, warnings);
    return warnings;
  };
  EXPECT_THAT(said({6, 5, 7, 8, 9, 10}, 2, labelled(4, 1)),
              ElementsAre(HasSubstr(
                  "force plate 1: by FORCE_PLATFORM:CHANNEL its Fx is 'Force.Fy1', Fy is 'Force.Fx1'; if the "
                  "labels are right, its forces lie along other axes")));
  EXPECT_THAT(said({5, 6, 7, 8, 9, 10}, 2, labelled(4, 1)), IsEmpty());
  EXPECT_THAT(said({4, 5, 6, 7, 8, 9}, 2, labelled(4, 1)), IsEmpty()) << "one of them names no component";
  EXPECT_THAT(said({1, 2, 3, 4, 5, 6}, 2, {.labels = {"a", "b", "c", "d", "e", "f"}, .count = 6}), IsEmpty());
  EXPECT_THAT(said({1, 2, 3, 4, 5, 6}, 1, {.labels = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"}, .count = 6}),
              IsEmpty())
      << "the point has no label of its own";
}

TEST(PlateChannels, OfTypesThatAreNotKnownAreThoseBeforeTheFirstZero) {
  const auto other = channel(8, {3, 1, 2, 0, 0, 0, 0, 0});
  EXPECT_EQ(first_of(other, {21}, labelled(0, 1)).first, 1);
  EXPECT_THAT(channels_of_plate(&other, 0, 21, 7, 1), ElementsAre(2, 0, 1));
  EXPECT_THAT(channels_of_plate(&other, 0, 2, 7, 1), IsEmpty());
  EXPECT_THAT(channels_of_plate(nullptr, 0, 2, 7, 1), IsEmpty());
}

}  // namespace
}  // namespace kinemark::io::internal
