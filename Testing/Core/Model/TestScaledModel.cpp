// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/ScaledModel.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace test::scaled_model {

inr::VolumeInfo Volume(const glm::i64vec3& dims)
{
  inr::VolumeInfo volume;
  volume.dims = dims;
  volume.spacing = {0.5, -1.25, 3};
  volume.origin = {1, 2, 3};
  return volume;
}

/// Where `u` of the unit cube is in world space.
glm::dvec3 PlaceOf(const inr::VolumeInfo& volume, const glm::dvec3& u)
{
  const glm::dvec3 index = u * glm::dvec3(volume.dims) - 0.5;
  return volume.origin + volume.direction * (index * volume.spacing);
}

// What a network has at u stays where it is, whatever grid it is asked on.
TEST(ScaledModel, LeavesEverythingInItsPlace)
{
  inr::VolumeInfo native = Volume({301, 7, 2});
  native.direction = {{0, 1, 0}, {-0.8, 0, 0.6}, {0.6, 0, 0.8}};
  for (const double factor : {0.25, 0.3, 0.999, 1.0, 1.7, 4.0}) {
    const inr::VolumeInfo scaled = inr::ScaledVolume(native, factor);
    EXPECT_EQ(scaled.dims.x, std::llround(301 * factor));
    for (const glm::dvec3& u : {glm::dvec3(0), glm::dvec3(0.5), glm::dvec3(0.1, 0.9, 0.3)}) {
      EXPECT_LT(glm::length(PlaceOf(scaled, u) - PlaceOf(native, u)), 1e-10) << factor;
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(scaled.dims[axis], 2);
    }
  }
}

TEST(ScaledModel, KeepsSlabs)
{
  for (const double factor : {0.25, 4.0}) {
    const inr::VolumeInfo scaled = inr::ScaledVolume(Volume({20, 1, 20}), factor);
    EXPECT_EQ(scaled.dims.y, 1);
    EXPECT_EQ(scaled.spacing.y, -1.25);
    EXPECT_EQ(scaled.origin.y, 2);
  }
}

// Nobody has looked at what lies between native voxels, which those of a finer grid show.
TEST(ScaledModel, KnowsWhetherItsRangesHold)
{
  auto model = RandomModel(SmallDescription());
  model->volume = Volume({40, 40, 40});
  model->macroCells = inr::MakeMacroCells(model->volume.dims, 8);
  model->macroCells.provenance = inr::MacroCellProvenance::Decoded;
  EXPECT_TRUE(inr::ScaledModel(model, 1)->macroCells.rangesHold());
  EXPECT_TRUE(inr::ScaledModel(model, 0.5)->macroCells.rangesHold());
  EXPECT_FALSE(inr::ScaledModel(model, 1.25)->macroCells.rangesHold());
  EXPECT_TRUE(model->macroCells.rangesHold());
}

/// Of as many voxels, 16 * 2^(levels - 1) points of the finest lattice.
inr::ModelPointer ModelOf(const glm::i64vec3& dims, int levels)
{
  inr::Description description = SmallDescription();
  description.grid.baseResolution = 16;
  description.grid.perLevelScale = 2;
  description.grid.levels = levels;
  auto model = RandomModel(description);
  model->volume = Volume(dims);
  return model;
}

TEST(ScaledModel, TellsApartWhatTheModelAndItsVolumeDo)
{
  const glm::i64vec3 dims(100, 50, 3);
  EXPECT_EQ(inr::ResolutionOf(*ModelOf(dims, 3)), glm::i64vec3(64, 50, 3));
  const inr::ModelPointer fine = ModelOf(dims, 6);
  EXPECT_EQ(inr::ResolutionOf(*fine), dims);
  for (const double factor : {0.5, 1.0, 4.0}) {
    EXPECT_EQ(inr::ResolutionOf(*inr::ScaledModel(fine, factor)), dims) << factor;
  }
  EXPECT_EQ(inr::ResolutionOf(*inr::ScaledModel(inr::ScaledModel(fine, 0.5), 3)), dims);
}

TEST(ScaledModel, RefusesOtherFactorsAndTooManyVoxels)
{
  const auto told = [](const glm::i64vec3& dims, double factor) {
    try {
      inr::ScaledVolume(Volume(dims), factor);
    } catch (const inr::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const double factor : {0.0, -1.0, 0.2499, 4.001, std::nan(""), 1e300}) {
    EXPECT_NE(told(glm::i64vec3(9), factor).find("ScaleFactor"), std::string::npos) << factor;
  }
  EXPECT_NE(told(glm::i64vec3(131072), 4).find("524288"), std::string::npos);
  EXPECT_EQ(told(glm::i64vec3(131072), 1), "");
}

TEST(ScaledModel, BoundsWhatLiesBetweenCoarserVoxels)
{
  auto model = RandomModel(SmallDescription());
  model->volume = Volume({160, 160, 1});
  model->macroCells = inr::MakeMacroCells(model->volume.dims, 16);
  for (inr::ValueRange& range : model->macroCells.ranges) {
    range = {0.25f, 0.5f};
  }
  const auto special = static_cast<std::size_t>(model->macroCells.index(4, 4, 0));
  model->macroCells.ranges[special] = {0.0f, 1.0f};
  const auto wide = [&](double factor) {
    const inr::ModelPointer scaled = inr::ScaledModel(model, factor);
    EXPECT_EQ(scaled->volume.dims.x, std::llround(160 * factor));
    int count = 0;
    for (const inr::ValueRange& range : scaled->macroCells.ranges) {
      count += range.high == 1.0f ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(wide(0.25), 9);
  EXPECT_EQ(wide(1), 1);
  EXPECT_EQ(wide(4), 1);
  EXPECT_EQ(inr::ScaledModel(model, 1), model);
  EXPECT_EQ(inr::ScaledModel(model, 4)->parameters, model->parameters);
}

} // namespace test::scaled_model
