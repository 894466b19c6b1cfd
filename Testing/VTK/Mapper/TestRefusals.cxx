// SPDX-License-Identifier: BSD-3-Clause
// What the mapper cannot draw gives one message and no picture, and drawing goes on afterwards.
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkColorTransferFunction.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

class Refusals : public testing::Test
{
protected:
  Refusals()
      : mapper(test::InrMapper(test::Write(*test::MakeModel(), "Refusals.inr"))), messages(mapper)
  {
    this->renderer = this->scene.addRenderer();
    this->volume = this->scene.addVolume(this->renderer, this->mapper);
    this->property = this->volume->GetProperty();
    test::Scene::look(this->renderer);
  }

  bool draws()
  {
    const inr::Image image = this->scene.capture();
    return *std::max_element(image.pixels.begin(), image.pixels.end()) > 0;
  }

  /// Two frames of a scene that is refused: one message that contains `word`, nothing drawn.
  void expectRefused(const std::string& word)
  {
    EXPECT_FALSE(this->draws());
    EXPECT_FALSE(this->draws());
    EXPECT_FALSE(this->mapper->GetConverged());
    EXPECT_EQ(this->mapper->GetCacheHitRate(), 0);
    EXPECT_EQ(this->messages.errors, 1);
    EXPECT_NE(this->messages.last.find(word), std::string::npos) << this->messages.last;
  }

  void expectDrawn()
  {
    EXPECT_TRUE(this->draws());
    EXPECT_TRUE(this->mapper->GetConverged());
    EXPECT_EQ(this->messages.errors, 0) << this->messages.last;
  }

  test::Scene scene;
  vtkSmartPointer<vtkINRVolumeMapper> mapper;
  test::Messages messages;
  vtkRenderer* renderer = nullptr;
  vtkVolume* volume = nullptr;
  vtkVolumeProperty* property = nullptr;
};

vtkSmartPointer<vtkPiecewiseFunction> Ramp(double first, double last)
{
  auto ramp = vtkSmartPointer<vtkPiecewiseFunction>::New();
  ramp->AddPoint(0, first);
  ramp->AddPoint(100, last);
  return ramp;
}

TEST_F(Refusals, NothingIsWrongWithAnOrdinaryScene) { this->expectDrawn(); }

TEST_F(Refusals, ToleranceThatIsNoNumber)
{
  this->mapper->SetErrorTolerance(std::nan(""));
  this->expectRefused("tolerance");
  this->mapper->SetErrorTolerance(-1);
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, GradientOpacity)
{
  this->property->SetGradientOpacity(Ramp(0, 1));
  this->expectRefused("gradient opacity");
  this->property->SetDisableGradientOpacity(1);
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, NotOfAGradientOpacityThatIsOneEverywhere)
{
  this->property->SetGradientOpacity(Ramp(1, 1));
  this->expectDrawn();
}

TEST_F(Refusals, TransferFunctionsOfTwoDimensions)
{
  vtkNew<vtkImageData> table;
  table->SetDimensions(4, 4, 1);
  table->AllocateScalars(VTK_FLOAT, 4);
  std::fill_n(static_cast<float*>(table->GetScalarPointer()), 64, 0.5f);
  this->property->SetTransferFunctionMode(vtkVolumeProperty::TF_2D);
  this->property->SetTransferFunction2D(table);
  this->expectRefused("2D transfer function");
}

TEST_F(Refusals, LabelMasks)
{
  this->property->SetLabelScalarOpacity(1, Ramp(0, 1));
  this->expectRefused("mask");
}

TEST_F(Refusals, WhatIsHidden)
{
  this->mapper->Update();
  const auto show = [this](int type, int flag) {
    vtkNew<vtkImageData> image;
    image->ShallowCopy(this->mapper->GetDataSetInput());
    vtkUnsignedCharArray* flags = type == vtkDataObject::POINT ? image->AllocatePointGhostArray()
                                                               : image->AllocateCellGhostArray();
    flags->SetValue(7, static_cast<unsigned char>(flag));
    this->messages.errors = 0;
    this->mapper->SetInputData(image);
  };
  show(vtkDataObject::POINT, vtkDataSetAttributes::DUPLICATEPOINT);
  EXPECT_TRUE(this->draws());
  show(vtkDataObject::POINT, vtkDataSetAttributes::HIDDENPOINT);
  this->expectRefused("blanked");
  this->mapper->GetDataSetInput()->GetPointData()->RemoveArray("vtkGhostType");
  show(vtkDataObject::CELL, vtkDataSetAttributes::DUPLICATECELL);
  EXPECT_TRUE(this->draws());
  show(vtkDataObject::CELL, vtkDataSetAttributes::HIDDENCELL);
  this->expectRefused("blanked");
}

TEST_F(Refusals, OtherBlendModes)
{
  for (const int mode : {int{vtkVolumeMapper::SLICE_BLEND}, -1, 7}) {
    this->messages.errors = 0;
    this->mapper->SetBlendMode(mode);
    this->expectRefused("blend");
    this->mapper->SetBlendModeToComposite();
    EXPECT_TRUE(this->draws());
  }
}

TEST_F(Refusals, PathsThatAreProjected)
{
  this->mapper->SetBlendModeToMaximumIntensity();
  this->mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  this->expectRefused("Path tracing knows no blend mode but composite");
  this->mapper->SetRenderMode(vtkINRVolumeMapper::RAY_MARCHING);
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, ProjectionsOfAPiece)
{
  vtkNew<vtkImageData> piece;
  this->mapper->Update();
  piece->ShallowCopy(this->mapper->GetDataSetInput());
  int extent[6];
  piece->GetExtent(extent);
  extent[1] /= 2;
  piece->SetExtent(extent);
  this->mapper->SetInputData(piece);
  this->mapper->SetBlendModeToAdditive();
  this->expectRefused("needs the whole volume in one process");
  this->mapper->SetBlendModeToComposite();
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, PathsThatAreCroppedToWhatIsNoBox)
{
  this->mapper->CroppingOn();
  this->mapper->SetCroppingRegionPlanes(this->mapper->GetBounds());
  this->mapper->SetCroppingRegionFlagsToCross();
  this->mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  this->expectRefused("crop an INR to a box only");
  this->mapper->SetCroppingRegionFlagsToSubVolume();
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, CroppingAcrossAxesThatAreTurned)
{
  vtkNew<vtkImageData> turned;
  this->mapper->Update();
  turned->ShallowCopy(this->mapper->GetDataSetInput());
  const double direction[] = {0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1};
  turned->SetDirectionMatrix(direction);
  this->mapper->SetInputData(turned);
  EXPECT_TRUE(this->draws());
  this->mapper->CroppingOn();
  this->mapper->SetCroppingRegionPlanes(this->mapper->GetBounds());
  this->expectRefused("turns by other than right angles");
  this->mapper->CroppingOff();
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, OrdinaryVoxels)
{
  this->mapper->SetInputData(test::Decode(test::MakeModel()));
  this->expectRefused("'blobs' is not an INR");
}

TEST_F(Refusals, ImageDataWithoutScalars)
{
  vtkNew<vtkImageData> empty;
  empty->SetDimensions(5, 5, 5);
  this->mapper->SetInputData(empty);
  this->expectRefused("no point scalars");
}

TEST_F(Refusals, AnArrayThatIsNotThere)
{
  this->mapper->SetScalarModeToUsePointFieldData();
  this->mapper->SelectScalarArray("nothing");
  this->expectRefused("no point scalars");
}

TEST_F(Refusals, AnArrayOfTheWholeDataSet)
{
  this->mapper->SetScalarMode(VTK_SCALAR_MODE_USE_FIELD_DATA);
  this->mapper->SelectScalarArray("INRRatio"); // as a reader's image has one
  this->expectRefused("no point scalars");
}

TEST_F(Refusals, OtherDataSets)
{
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(2, 2, 2);
  this->mapper->SetInputData(grid);
  this->expectRefused("not image data");
}

TEST_F(Refusals, ACacheModeThatIsNone)
{
  for (const int mode : {-1, 3, 4}) {
    this->mapper->SetCacheMode(mode);
    EXPECT_EQ(this->mapper->GetCacheMode(), vtkINRVolumeMapper::CACHE_AND_NETWORK);
    EXPECT_NE(this->messages.last.find("CacheMode"), std::string::npos);
  }
  EXPECT_EQ(this->messages.errors, 3);
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, ATransformThatFlattens)
{
  this->volume->SetScale(1, 1, 0);
  this->expectRefused("the volume's matrix has no inverse");
  this->volume->SetScale(1, 1, 1);
  EXPECT_TRUE(this->draws());
}

TEST_F(Refusals, ComeAgainAfterTheSceneWasFine)
{
  this->mapper->SetBlendModeToSlice();
  this->expectRefused("slice");
  this->mapper->SetBlendModeToComposite();
  EXPECT_TRUE(this->draws());
  this->messages.errors = 0;
  this->mapper->SetBlendModeToSlice();
  this->expectRefused("slice");
}

} // namespace
