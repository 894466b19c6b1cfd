// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDecode.h"
#include "vtkINRReader.h"
#include "vtkINRWriter.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <chrono>

// Small enough to learn a smooth field in a second.
inline constexpr const char* SmallModel = R"({
  "encoding": {"otype": "HashGrid", "n_levels": 4, "n_features_per_level": 2,
               "log2_hashmap_size": 12, "base_resolution": 4, "per_level_scale": 1.6},
  "network": {"otype": "FullyFusedMLP", "n_neurons": 16, "n_hidden_layers": 2,
              "activation": "ReLU", "output_activation": "None"}})";

/// Between 0 and 1, different along every axis.
inline double Field(double x, double y, double z) { return 0.5 * x * x + 0.3 * y + 0.2 * (1 - z); }

/// An image whose array `name` is low + (high - low) * Field over its extent.
inline vtkSmartPointer<vtkImageData> MakeImage(const glm::ivec3& dims, int type, double low,
                                               double high)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(dims.x, dims.y, dims.z);
  image->SetSpacing(0.5, 1.5, 2.5);
  image->SetOrigin(-3.0, 7.0, 0.25);
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetName("field");
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  const glm::dvec3 last = glm::max(glm::dvec3(dims) - 1.0, 1.0);
  for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
    const double y = Field(static_cast<double>(index % dims.x) / last.x,
                           static_cast<double>(index / dims.x % dims.y) / last.y,
                           static_cast<double>(index / (dims.x * dims.y)) / last.z);
    array->SetTuple1(index, low + (high - low) * y);
  }
  image->GetPointData()->SetScalars(array);
  return image;
}

class Writer : public testing::Test
{
protected:
  Writer()
  {
    this->Algorithm->SetFileName(this->path().c_str());
    this->Algorithm->SetModelConfig(SmallModel);
    this->Algorithm->SetMaximumSteps(80);
  }

  std::string path() const { return this->Folder / "saved.inr"; }

  void write(vtkDataObject* data)
  {
    this->Algorithm->SetInputData(data);
    this->Algorithm->Write();
  }

  /// The voxels as the file has them.
  vtkSmartPointer<vtkImageData> decode()
  {
    vtkNew<vtkINRReader> reader;
    reader->SetFileName(this->path().c_str());
    vtkNew<vtkINRDecode> decode;
    decode->SetInputConnection(reader->GetOutputPort());
    decode->Update();
    return decode->GetOutput();
  }

  void expectRefusal(vtkDataObject* data, const std::string& words)
  {
    const MessageCapture messages;
    const auto start = std::chrono::steady_clock::now();
    this->write(data);
    EXPECT_TRUE(messages.onlyError(words)) << messages.text();
    EXPECT_NE(this->Algorithm->GetErrorCode(), 0u);
    EXPECT_EQ(this->Folder.entries(), 0);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRWriter> Algorithm;
};

/// Largest difference of two images' scalars.
inline double LargestError(vtkImageData* first, vtkImageData* second)
{
  vtkDataArray* a = first->GetPointData()->GetScalars();
  vtkDataArray* b = second->GetPointData()->GetScalars();
  double largest = 0;
  for (vtkIdType index = 0; index < a->GetNumberOfTuples(); ++index) {
    largest = std::fmax(largest, std::fabs(a->GetTuple1(index) - b->GetTuple1(index)));
  }
  return largest;
}
