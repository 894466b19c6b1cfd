// SPDX-License-Identifier: BSD-3-Clause
//
// Saving what is never in memory as a whole.
#include "MessageCapture.h"
#include "PieceSource.h"
#include "TestModels.h"
#include "vtkINRReader.h"
#include "vtkINRWriter.h"

#include <vtkCallbackCommand.h>
#include <vtkDataArray.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkImageShiftScale.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <filesystem>

namespace {

constexpr vtkIdType MiB = 1 << 20;

class Streaming : public testing::Test
{
protected:
  Streaming()
  {
    this->Writer->SetFileName(this->path().c_str());
    this->Writer->SetInputConnection(this->Source->GetOutputPort());
    this->Writer->SetModelConfig(
        R"({"encoding": {"otype": "HashGrid", "n_levels": 4, "n_features_per_level": 4,
                         "log2_hashmap_size": 12, "base_resolution": 4, "per_level_scale": 1.6},
            "network": {"otype": "FullyFusedMLP", "n_neurons": 16, "n_hidden_layers": 2,
                        "activation": "ReLU", "output_activation": "None"}})");
    this->Writer->SetMaximumSteps(150);
    this->Writer->SetTimeLimit(0);
    this->Writer->SetMemoryLimit(120); // the field takes 62.5 MiB
  }

  std::string path() const { return this->Folder / "saved.inr"; }

  TemporaryFolder Folder;
  vtkNew<PieceSource> Source;
  vtkNew<vtkINRWriter> Writer;
};

} // namespace

TEST_F(Streaming, NeverAsksForMoreThanTheLimit)
{
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  EXPECT_TRUE(messages.warnings().empty()) << messages.text();
  EXPECT_GT(this->Source->Requests, 20);
  EXPECT_LE(8 * this->Source->LargestRequest, 8 * MiB);
  EXPECT_GT(this->Writer->GetPSNR(), 30);

  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  reader->Update();
  vtkIdType dims[3];
  reader->GetNativeDimensions(dims);
  EXPECT_EQ(dims[0], 320);
  EXPECT_EQ(dims[1], 160);
  EXPECT_EQ(dims[2], 160);
  const double bounds[] = {6, 165.5, -5.5, 233, 3, 400.5};
  for (int k = 0; k < 6; ++k) {
    EXPECT_DOUBLE_EQ(reader->GetOutput()->GetBounds()[k], bounds[k]) << k;
  }
}

TEST_F(Streaming, GoesThroughFilters)
{
  vtkNew<vtkImageShiftScale> scale;
  scale->SetInputConnection(this->Source->GetOutputPort());
  scale->SetShift(-100);
  scale->SetOutputScalarTypeToDouble();
  this->Writer->SetInputConnection(scale->GetOutputPort());
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  EXPECT_LE(8 * this->Source->LargestRequest, 8 * MiB);
  EXPECT_GT(this->Writer->GetPSNR(), 30);
}

namespace {

constexpr double Unknown = 1000;

/// Passes an image of doubles on, with Unknown next to what is, and where a neighbour was not asked
/// for; asks for no more than it is asked for, as many filters do.
class NeighbourFilter : public vtkImageAlgorithm
{
public:
  static NeighbourFilter* New() { VTK_STANDARD_NEW_BODY(NeighbourFilter); }
  vtkTypeMacro(NeighbourFilter, vtkImageAlgorithm);

protected:
  int RequestData(vtkInformation*, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override
  {
    int whole[6];
    inputs[0]->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(),
                                            whole);
    auto* input = vtkImageData::GetData(inputs[0]);
    auto* output = vtkImageData::GetData(outputs);
    output->DeepCopy(input);
    const auto* from = static_cast<double*>(input->GetPointData()->GetScalars()->GetVoidPointer(0));
    auto* to = static_cast<double*>(output->GetPointData()->GetScalars()->GetVoidPointer(0));
    const int* extent = input->GetExtent();
    vtkIdType steps[3] = {1, 0, 0};
    for (int axis = 1; axis < 3; ++axis) {
      steps[axis] = steps[axis - 1] * (extent[2 * axis - 1] - extent[2 * axis - 2] + 1);
    }
    for (vtkIdType k = 0; k < input->GetNumberOfPoints(); ++k) {
      for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const vtkIdType count = extent[2 * axis + 1] - extent[2 * axis] + 1;
        const bool atFace = k / steps[axis] % count == (face % 2 == 0 ? 0 : count - 1);
        const vtkIdType step = face % 2 == 0 ? -steps[axis] : steps[axis];
        if (atFace ? extent[face] != whole[face] : from[k + step] == Unknown) {
          to[k] = Unknown;
        }
      }
    }
    return 1;
  }
};

} // namespace

TEST_F(Streaming, AsksForTheNeighboursThatFiltersLookAt)
{
  vtkNew<NeighbourFilter> first;
  vtkNew<NeighbourFilter> second;
  first->SetInputConnection(this->Source->GetOutputPort());
  second->SetInputConnection(first->GetOutputPort());
  this->Writer->SetInputConnection(second->GetOutputPort());
  this->Writer->SetMaximumSteps(2);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  EXPECT_LT(inr::ReadModelHeader(this->path()).volume.high, 200);
  EXPECT_GT(this->Source->Requests, 20);
  EXPECT_LE(8 * this->Source->LargestRequest, 8 * MiB);
}

TEST_F(Streaming, RefusesASourceThatGivesAnotherArray)
{
  this->Source->RenamedFrom = 12;
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.onlyError("'another' where it had given 'field'")) << messages.text();
  EXPECT_FALSE(std::filesystem::exists(this->path()));
}

// The upper half, of most pieces nothing or all.
TEST_F(Streaming, LeavesOutWhatIsHidden)
{
  this->Source->HiddenFrom = 80;
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u) << messages.text();
  EXPECT_NE(messages.warnings()[0].find("has 4096000 NaN or infinite values, or hidden points"),
            std::string::npos)
      << messages.text();
  EXPECT_GT(this->Source->Requests, 20);
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  reader->Update();
  EXPECT_GE(reader->GetOutput()->GetScalarRange()[0], 59.0);
}

TEST_F(Streaming, WarnsOfHiddenIntegers)
{
  this->Source->HiddenFrom = 80;
  this->Source->Type = VTK_SHORT;
  this->Writer->SetMaximumSteps(5);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u) << messages.text();
  EXPECT_NE(messages.warnings()[0].find("are hidden, but a model has no mask"), std::string::npos);
}

TEST_F(Streaming, OfEveryTimeStep)
{
  this->Writer->WriteTimeStepsOn();
  this->Writer->SetMaximumSteps(5);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  EXPECT_EQ(this->Folder.entries(), 2);
  EXPECT_EQ(this->Source->Time, 1.5);
  EXPECT_LE(8 * this->Source->LargestRequest, 8 * MiB);
}

// What is in memory already, or fits, is not read in pieces.
TEST_F(Streaming, OnlyWhereItIsNeeded)
{
  this->Writer->SetMaximumSteps(2);
  this->Writer->SetMemoryLimit(126);
  this->Writer->Write();
  EXPECT_EQ(this->Source->Requests, 2); // a voxel, which shows that all fits, and all
  EXPECT_EQ(this->Source->LargestRequest, vtkIdType{320} * 160 * 160);
  this->Writer->SetMemoryLimit(64);
  this->Writer->Write();
  EXPECT_EQ(this->Source->Requests, 2);
  EXPECT_EQ(this->Writer->GetErrorCode(), 0u);
}

TEST_F(Streaming, TellsOfASourceThatFails)
{
  for (const int failing : {1, 2, 14, 40}) { // at once, while reading, training, measuring
    this->Source->Requests = 0;
    this->Source->FailingRequest = failing;
    this->Source->Modified();
    const MessageCapture messages;
    this->Writer->Write();
    EXPECT_NE(messages.text().find("the tape is torn"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(this->path()));
    std::filesystem::remove(this->path() + ".checkpoint");
    EXPECT_NE(messages.text().find("Cannot save"), std::string::npos) << messages.text();
    EXPECT_NE(this->Writer->GetErrorCode(), 0u);
    if (failing > 1) { // else VTK comes no further
      EXPECT_NE(messages.text().find("could not be read: "), std::string::npos);
    }
  }
}

TEST_F(Streaming, TellsOfAStepThatFails)
{
  this->Writer->WriteTimeStepsOn();
  this->Writer->SetMaximumSteps(2);
  this->Writer->SetMemoryLimit(4096); // for each step there is one request
  this->Source->FailingRequest = 2;
  this->Source->FailsFromThere = true;
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_NE(messages.text().find("Cannot save"), std::string::npos) << messages.text();
  EXPECT_NE(this->Writer->GetErrorCode(), 0u);
  EXPECT_EQ(this->Folder.entries(), 1);
}

// As many readers do: they complain, and hand on memory that nobody has written to.
TEST_F(Streaming, BelievesASourceThatComplainsAndSucceeds)
{
  this->Source->OnlyComplains = true;
  for (const int limit : {120, 0}) {    // in pieces, and as a whole
    for (const int failing : {1, 14}) { // at once, and while reading
      if (limit == 0 && failing > 1) {
        continue; // there is one request
      }
      this->Source->Requests = 0;
      this->Source->FailingRequest = failing;
      this->Source->Modified();
      this->Writer->SetMemoryLimit(limit);
      const MessageCapture messages;
      this->Writer->Write();
      EXPECT_NE(messages.text().find("could not be read: "), std::string::npos) << limit;
      EXPECT_NE(this->Writer->GetErrorCode(), 0u);
      EXPECT_FALSE(std::filesystem::exists(this->path()));
    }
  }
}

TEST_F(Streaming, CountsAllArraysOfTheSource)
{
  this->Source->MoreArrays = 7;
  this->Writer->SetMaximumSteps(2);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  EXPECT_LE(8 * 8 * this->Source->LargestRequest, 8 * MiB);
}

// The one that it always tells of would fit, in 62.5 MiB.
TEST_F(Streaming, CountsArraysThatItIsToldOfOrNot)
{
  this->Source->MoreArrays = 7;
  this->Writer->SetMaximumSteps(2);
  this->Writer->SetMemoryLimit(200);
  for (const bool tells : {true, false}) {
    SCOPED_TRACE(tells);
    this->Source->TellsOfArrays = tells;
    this->Source->Modified();
    const MessageCapture messages;
    this->Writer->Write();
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    EXPECT_GT(this->Source->Requests, 20);
    EXPECT_LE(8 * 8 * this->Source->LargestRequest, 100 * MiB);
    this->Source->Requests = 0;
  }
}

TEST_F(Streaming, WarnsWhereTheLimitMakesTheModelSmaller)
{
  this->Source->Extent[5] = 19;
  this->Source->MoreArrays = 15;
  this->Source->TellsOfArrays = true;
  this->Writer->SetModelConfig(nullptr);
  this->Writer->SetMaximumSteps(2);
  for (const int limit : {140, 116}) { // both too small for all that the source gives
    SCOPED_TRACE(limit);
    this->Writer->SetMemoryLimit(limit);
    const MessageCapture messages;
    this->Writer->Write();
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    ASSERT_EQ(messages.warnings().size(), limit == 140 ? 0u : 1u);
    if (limit == 116) {
      EXPECT_NE(messages.warnings()[0].find("The MemoryLimit of 116 MiB left"), std::string::npos);
    }
  }
}

TEST_F(Streaming, WarnsOfASourceThatGivesNoParts)
{
  this->Source->GivesParts = false;
  this->Writer->SetMaximumSteps(2);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u);
  EXPECT_NE(messages.warnings()[0].find("cannot give parts"), std::string::npos);
  EXPECT_EQ(this->Folder.entries(), 1);
}

// As filters that pass the request on and give all that they make of it.
TEST_F(Streaming, IsNotOfWhatWasMadeOfAVoxel)
{
  this->Source->GivesParts = false;
  this->Source->IsMadeOfRequest = true;
  for (const int limit : {120, 200}) { // too large, or not
    SCOPED_TRACE(limit);
    this->Writer->SetMemoryLimit(limit);
    this->Source->Modified();
    const MessageCapture messages;
    this->Writer->Write();
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    EXPECT_EQ(messages.warnings().size(), limit == 120 ? 1u : 0u);
    EXPECT_GT(this->Writer->GetPSNR(), 30);
    EXPECT_LT(this->Writer->GetPSNR(), 100); // it is not constant
  }
}

TEST_F(Streaming, IsReadAsAWholeWhereAVoxelCannotBeGiven)
{
  this->Source->FailingRequest = 1;
  this->Writer->SetMaximumSteps(2);
  this->Writer->SetMemoryLimit(200);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  EXPECT_EQ(this->Writer->GetErrorCode(), 0u);
  EXPECT_EQ(this->Source->Requests, 2);
  EXPECT_TRUE(std::filesystem::exists(this->path()));

  this->Source->FailingRequest = 3; // for all, which was there a moment ago
  this->Source->Modified();
  std::filesystem::remove(this->path());
  this->Writer->Write();
  EXPECT_NE(this->Writer->GetErrorCode(), 0u);
  EXPECT_NE(messages.text().find("the tape is torn"), std::string::npos) << messages.text();
  EXPECT_FALSE(std::filesystem::exists(this->path()));
}

TEST_F(Streaming, SaysWhyThereIsNothingWhereTheFirstAttemptWasToldWhy)
{
  this->Source->FailingRequest = 1;
  this->Source->FailsFromThere = this->Source->SaysSoOnce = true;
  this->Writer->SetMemoryLimit(200);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_NE(this->Writer->GetErrorCode(), 0u);
  EXPECT_NE(messages.text().find("the tape is torn"), std::string::npos) << messages.text();
  EXPECT_EQ(this->Folder.entries(), 0);
}

TEST_F(Streaming, CanBeAborted)
{
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    auto* writer = vtkINRWriter::SafeDownCast(caller);
    if (writer->GetProgress() > 0.101) {
      writer->SetAbortExecute(1);
    }
  });
  this->Writer->AddObserver(vtkCommand::ProgressEvent, abort);
  this->Writer->SetMaximumSteps(100000);
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_NE(messages.text().find("stopped"), std::string::npos) << messages.text();
  EXPECT_FALSE(std::filesystem::exists(this->path()));
}
