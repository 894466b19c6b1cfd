// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/ChannelGrid.h"
#include "vtkTurbulentChannelSource.h"

#include <vtkDataArray.h>
#include <vtkExtractVOI.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace {

vtkSmartPointer<vtkTurbulentChannelSource> MakeSource(int type = VTK_DOUBLE)
{
  auto source = vtkSmartPointer<vtkTurbulentChannelSource>::New();
  source->SetDimensions(90, 14, 11);
  source->SetSeed(5);
  source->SetOutputScalarType(type);
  return source;
}

vtkDataArray* Values(vtkImageData* image) { return image->GetPointData()->GetScalars(); }

} // namespace

TEST(TurbulentChannelSource, GivesTheFieldAtItsPoints)
{
  const auto source = MakeSource();
  source->Update();
  vtkImageData* const image = source->GetOutput();
  ASSERT_STREQ(Values(image)->GetName(), "velocity");
  inr::TurbulentChannel::Parameters parameters;
  parameters.seed = 5;
  const inr::TurbulentChannel field(parameters);
  for (vtkIdType id = 0; id < image->GetNumberOfPoints(); id += 97) {
    glm::dvec3 point;
    image->GetPoint(id, &point.x);
    EXPECT_NEAR(Values(image)->GetTuple1(id), field.at(point / inr::TurbulentChannel::Size), 1e-12);
  }
}

TEST(TurbulentChannelSource, PiecesHaveTheBitsOfTheWhole)
{
  for (const int type : {VTK_FLOAT, VTK_DOUBLE}) {
    const auto whole = MakeSource(type);
    whole->Update();
    const auto source = MakeSource(type);
    source->SetNumberOfThreads(1);
    for (std::array<int, 6> extent :
         {std::array<int, 6>{0, 89, 0, 13, 3, 3}, std::array<int, 6>{61, 70, 2, 5, 0, 10},
          std::array<int, 6>{89, 89, 13, 13, 10, 10}}) {
      source->UpdateInformation();
      source->UpdateExtent(extent.data());
      vtkImageData* const piece = source->GetOutput();
      std::array<int, 6> got{};
      piece->GetExtent(got.data());
      ASSERT_EQ(got, extent); // nothing else was computed
      for (vtkIdType id = 0; id < piece->GetNumberOfPoints(); ++id) {
        double point[3];
        piece->GetPoint(id, point);
        const vtkIdType there = whole->GetOutput()->FindPoint(point);
        ASSERT_EQ(Values(piece)->GetTuple1(id), Values(whole->GetOutput())->GetTuple1(there));
      }
    }
  }
}

TEST(TurbulentChannelSource, AVolumeThatFitsNoMemoryIsReadInPieces)
{
  vtkNew<vtkTurbulentChannelSource> source;
  source->SetDimensions(10240, 7680, 1536);
  source->SetOutputScalarType(VTK_DOUBLE);
  vtkNew<vtkExtractVOI> extract;
  extract->SetInputConnection(source->GetOutputPort());
  extract->SetVOI(5000, 5063, 7600, 7679, 700, 701);
  extract->Update();
  EXPECT_EQ(source->GetNumberOfRequests(), 1);
  EXPECT_EQ(source->GetLargestRequest(), 64 * 80 * 2 * 8);
  EXPECT_EQ(source->GetBytesRequested(), 64 * 80 * 2 * 8);
  EXPECT_EQ(extract->GetOutput()->GetNumberOfPoints(), 64 * 80 * 2);
}

TEST(TurbulentChannelSource, StepsInTime)
{
  const auto source = MakeSource();
  source->UpdateInformation();
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  EXPECT_FALSE(source->GetOutputInformation(0)->Has(Pipeline::TIME_STEPS()));
  source->SetNumberOfTimeSteps(4);
  source->SetTimeStepSize(0.25);
  source->UpdateInformation();
  ASSERT_EQ(source->GetOutputInformation(0)->Length(Pipeline::TIME_STEPS()), 4);
  source->UpdateTimeStep(0.25);
  source->UpdateTimeStep(0.5);
  vtkImageData* const image = source->GetOutput();
  EXPECT_EQ(image->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), 0.5);
  inr::TurbulentChannel::Parameters parameters;
  parameters.seed = 5;
  parameters.time = 0.5;
  glm::dvec3 point;
  image->GetPoint(4321, &point.x);
  const glm::dvec3 u = point / inr::TurbulentChannel::Size;
  EXPECT_NEAR(Values(image)->GetTuple1(4321), inr::TurbulentChannel(parameters).at(u), 1e-12);
  source->UpdateTimeStep(0.6); // between two steps: the one before
  EXPECT_NEAR(Values(image)->GetTuple1(4321), inr::TurbulentChannel(parameters).at(u), 1e-12);
}

TEST(TurbulentChannelSource, FollowsItsProperties)
{
  const auto source = MakeSource();
  source->Update();
  const double before = Values(source->GetOutput())->GetTuple1(4321);
  source->SetSeed(6);
  source->Update();
  const double other = Values(source->GetOutput())->GetTuple1(4321);
  EXPECT_NE(other, before);
  source->SetOctaves(2);
  source->Update();
  EXPECT_NE(Values(source->GetOutput())->GetTuple1(4321), other);
}
