// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/internal/plate_corners.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace kinemark::io::internal {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A plate of 0.4 x 0.6 m, its first corner at `at`, in the unit that has `scale` in a metre.
data::ForcePlate plate_at(int number, const Vector3d& at, double scale = 1.0) {
  data::ForcePlate plate{.number = number};
  const std::array<Vector3d, 4> edge{Vector3d(0.4, 0.6, 0.0), Vector3d(0.0, 0.6, 0.0), Vector3d::Zero(),
                                     Vector3d(0.4, 0.0, 0.0)};
  for (std::size_t c = 0; c < 4; ++c) plate.corners_in_world[c] = scale * (at + edge[c]);
  plate.origin_in_plate = Vector3d(0.0, 0.0, -0.04 * scale);
  return plate;
}

TEST(PlateCorners, AreReadByTheSizesThatTheFileStates) {
  C3dParameter corners{.name = "CORNERS", .type = C3dType::float32, .dims = {3, 4, 2}};
  for (int v = 0; v < 24; ++v) corners.numbers.push_back(v);
  EXPECT_EQ(plate_corner(&corners, 1, 2), Vector3d(18.0, 19.0, 20.0));
  corners.dims = {4, 3, 2};  // all x, then all y, then all z
  EXPECT_EQ(plate_corner(&corners, 1, 2), Vector3d(14.0, 18.0, 22.0));
  corners.dims = {24};  // no sizes: as the standard has them
  EXPECT_EQ(plate_corner(&corners, 0, 1), Vector3d(3.0, 4.0, 5.0));
  EXPECT_TRUE(plate_corner(&corners, 2, 0).hasNaN());
  EXPECT_TRUE(plate_corner(nullptr, 0, 0).hasNaN());
}

TEST(PlateCorners, InAnotherUnitThanThePointsAreBroughtToMetres) {
  std::vector<std::string> warnings;
  auto millimetres = plate_at(1, Vector3d::Zero(), 1000.0);  // called metres
  settle_plate_unit(millimetres, 1.0, warnings);
  EXPECT_LT((millimetres.corners_in_world[0] - Vector3d(0.4, 0.6, 0.0)).norm(), 1e-12);
  EXPECT_NEAR(millimetres.origin_in_plate.z(), -0.04, 1e-12);
  auto metres = plate_at(2, Vector3d::Zero(), 0.001);  // called millimetres
  settle_plate_unit(metres, 0.001, warnings);
  EXPECT_LT((metres.corners_in_world[0] - Vector3d(0.4, 0.6, 0.0)).norm(), 1e-12);
  EXPECT_THAT(
      warnings,
      ElementsAre(HasSubstr("plate 1 would have a side of 600 m in the unit of the points; its corners "
                            "are taken for mm, 0.6 m"),
                  HasSubstr("plate 2 would have a side of 0.0006 m")));
}

TEST(PlateCorners, InCentimetresBesideMillimetresAreBroughtToMetres) {
  std::vector<std::string> warnings;
  auto plate = plate_at(1, Vector3d::Zero(), 0.1);
  plate.origin_in_plate = Vector3d(0.0, 0.0, -0.04);
  settle_plate_unit(plate, 0.001, warnings);
  EXPECT_LT((plate.corners_in_world[0] - Vector3d(0.4, 0.6, 0.0)).norm(), 1e-12);
  EXPECT_EQ(plate.origin_in_plate.z(), -0.04);
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("its corners are taken for cm, 0.6 m")));
}

TEST(PlateCorners, AnOriginInTheUnitOfThePointsStays) {
  std::vector<std::string> warnings;
  auto plate = plate_at(1, Vector3d::Zero(), 0.001);
  plate.origin_in_plate = Vector3d(0.0, 0.0, -0.04);
  settle_plate_unit(plate, 0.001, warnings);
  EXPECT_LT((plate.corners_in_world[0] - Vector3d(0.4, 0.6, 0.0)).norm(), 1e-12);
  EXPECT_EQ(plate.origin_in_plate.z(), -0.04);
}

TEST(PlateCorners, OfAPlateOfUsualSizeOrOfNoneAreLeftAlone) {
  std::vector<std::string> warnings;
  for (const double scale : {1.0, 0.2, 5.0, 0.01, 0.0}) {
    auto plate = plate_at(1, Vector3d(1.0, 2.0, 0.0), scale);
    const auto before = plate.corners_in_world;
    settle_plate_unit(plate, scale < 1.0 ? 0.001 : 1.0, warnings);
    EXPECT_EQ(plate.corners_in_world, before) << scale;
  }
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(PlateCorners, ThatCrossOverGoAroundAsThoseOfTheOtherPlate) {
  const auto good = plate_at(1, Vector3d::Zero()), moved = plate_at(2, Vector3d(0.0, 1.0, 0.0));
  for (const auto& [a, b] : {std::pair{2U, 3U}, {0U, 1U}, {1U, 2U}, {0U, 3U}}) {
    std::vector<data::ForcePlate> plates{good, moved};
    std::swap(plates[1].corners_in_world[a], plates[1].corners_in_world[b]);
    std::vector<std::string> warnings;
    settle_corner_order(plates, warnings);
    EXPECT_EQ(plates[0].corners_in_world, good.corners_in_world);
    EXPECT_EQ(plates[1].corners_in_world, moved.corners_in_world) << a << " " << b;
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("force plate 2 has corners that cross over")));
  }
}

TEST(PlateCorners, OfAPlateAloneGoAroundSoThatItsZPointsDown) {
  auto good = plate_at(1, Vector3d(0.0, 0.0, 0.02));
  std::swap(good.corners_in_world[0], good.corners_in_world[3]);  // as the format has them: z into the plate
  std::swap(good.corners_in_world[1], good.corners_in_world[2]);
  // Corners 2 and 3, or 3 and 4 of the list are exchanged: each has one mend with z down, and one with z up.
  for (const auto& [a, b] : {std::pair{1U, 2U}, {2U, 3U}}) {
    std::vector<data::ForcePlate> alone{good};
    std::swap(alone[0].corners_in_world[a], alone[0].corners_in_world[b]);
    std::vector<std::string> warnings;
    settle_corner_order(alone, warnings);
    EXPECT_EQ(alone[0].corners_in_world, good.corners_in_world);
    EXPECT_THAT(warnings,
                ElementsAre(AllOf(HasSubstr(fmt::format("corners {} and {} are exchanged", a + 1, b + 1)),
                                  HasSubstr("its z points down (z of the laboratory is taken as up)"),
                                  HasSubstr("which nothing else in the file confirms"))));
  }
}

TEST(PlateCorners, OfAPlateThatNoAxisIsNearToStay) {
  std::vector<data::ForcePlate> slanted{plate_at(1, Vector3d::Zero())};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.955, Vector3d(1.0, -1.0, 0.0).normalized()).toRotationMatrix();
  for (auto& corner : slanted[0].corners_in_world) corner = turn * corner;
  std::swap(slanted[0].corners_in_world[2], slanted[0].corners_in_world[3]);
  const auto before = slanted[0].corners_in_world;
  std::vector<std::string> warnings;
  settle_corner_order(slanted, warnings);
  EXPECT_EQ(slanted[0].corners_in_world, before);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(PlateCorners, ThatGoAroundAreLeftAlone) {
  std::vector<data::ForcePlate> fine{plate_at(1, Vector3d::Zero()), plate_at(2, Vector3d(0.0, 1.0, 0.0))};
  std::vector<std::string> warnings;
  settle_corner_order(fine, warnings);
  settle_corner_order(std::span(fine).first(1), warnings);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(PlateCorners, AnOriginInAnotherUnitThanTheCornersIsBroughtToMetres) {
  std::vector<std::string> warnings;
  auto plate = plate_at(1, Vector3d::Zero());
  plate.origin_in_plate = Vector3d(0.0005e-3, 0.0, -0.04e-3);  // metres, called millimetres
  settle_plate_unit(plate, 0.001, warnings);
  EXPECT_LT((plate.origin_in_plate - Vector3d(0.0005, 0.0, -0.04)).norm(), 1e-12);
  plate.origin_in_plate = Vector3d(0.0, 0.0, -40.0);  // millimetres, called metres
  settle_plate_unit(plate, 1.0, warnings);
  EXPECT_NEAR(plate.origin_in_plate.z(), -0.04, 1e-12);
  EXPECT_THAT(
      warnings,
      ElementsAre(HasSubstr("force plate 1 would have its sensors 0.04 mm below its surface by ORIGIN "
                            "in the unit of the points; ORIGIN is taken for m, 40 mm"),
                  HasSubstr("4e+04 mm below its surface by ORIGIN in the unit of the points; ORIGIN "
                            "is taken for mm, 40 mm")));
}

TEST(PlateCorners, AnOriginThatAPlateHasOrThatIsNoneInAnyUnitStays) {
  std::vector<std::string> warnings;
  for (const Vector3d& origin :
       {Vector3d(0.0, 0.0, -0.04), Vector3d(0.0, 0.0, -0.001), Vector3d(0.21, 0.26, -0.03),
        Vector3d(0.0, 0.0, 0.0), Vector3d(2e-4, 1e-4, 0.0), Vector3d(0.0, 0.0, -5e-4)}) {
    auto plate = plate_at(1, Vector3d::Zero());
    plate.origin_in_plate = origin;
    settle_plate_unit(plate, 0.001, warnings);
    EXPECT_EQ(plate.origin_in_plate, origin);
  }
  EXPECT_THAT(warnings, IsEmpty());
}

}  // namespace
}  // namespace kinemark::io::internal
