// SPDX-License-Identifier: BSD-3-Clause
//
// Time steps: a reader that goes from file to file, and a writer that makes a file of each step.
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDataArray.h"
#include "vtkINRReader.h"
#include "vtkINRWriter.h"

#include <vtkCallbackCommand.h>
#include <vtkDoubleArray.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <cmath>
#include <csignal>
#include <filesystem>

namespace {

using Pipeline = vtkStreamingDemandDrivenPipeline;

class ReaderOfSteps : public testing::Test
{
protected:
  std::string write(const char* name, const glm::i64vec3& dims, std::optional<double> time = {})
  {
    const auto model = MakeModel(dims);
    model->volume.time = time;
    const std::string path = this->Folder / name;
    inr::WriteModel(*model, path);
    return path;
  }
  vtkINRDataArray* show(const std::string& path)
  {
    this->Algorithm->SetFileName(path.c_str());
    this->Algorithm->Update();
    return vtkINRDataArray::SafeDownCast(
        this->Algorithm->GetOutput()->GetPointData()->GetScalars());
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRReader> Algorithm;
};

TEST_F(ReaderOfSteps, FindsAStepAgainWithWhatWasKeptOfIt)
{
  const std::string first = this->write("a.inr", {20, 13, 7});
  const std::string second = this->write("b.inr", {9, 9, 9});
  const inr::ModelPointer model = this->show(first)->GetModel();
  const auto kept = std::make_shared<const int>(3);
  this->show(first)->GetKeepsake()->Content = kept;
  const inr::ModelPointer other = this->show(second)->GetModel();
  EXPECT_NE(other, model);
  EXPECT_EQ(this->show(second)->GetKeepsake()->Content, nullptr);
  EXPECT_EQ(this->show(first)->GetModel(), model);
  EXPECT_EQ(this->show(first)->GetKeepsake()->Content, kept);
  EXPECT_EQ(this->show(second)->GetModel(), other);
}

TEST_F(ReaderOfSteps, ReadsAChangedFileAnew)
{
  const std::string first = this->write("a.inr", {20, 13, 7});
  const std::string second = this->write("b.inr", {9, 9, 9});
  const inr::ModelPointer model = this->show(first)->GetModel();
  this->show(first)->GetKeepsake()->Content = std::make_shared<const int>(3);
  this->show(second);
  this->write("a.inr", {5, 6, 7});
  EXPECT_NE(this->show(first)->GetModel(), model);
  EXPECT_EQ(this->show(first)->GetModel()->volume.dims.x, 5);
  EXPECT_EQ(this->show(first)->GetKeepsake()->Content, nullptr);
}

TEST_F(ReaderOfSteps, ForgetsWhatWasKeptOfAnotherScale)
{
  const std::string path = this->write("a.inr", {20, 13, 7});
  this->show(path)->GetKeepsake()->Content = std::make_shared<const int>(3);
  this->Algorithm->SetScaleFactor(2);
  EXPECT_EQ(this->show(path)->GetKeepsake()->Content, nullptr);
}

TEST_F(ReaderOfSteps, TellsTheTimeOfAFileWithoutOpeningIt)
{
  const MessageCapture messages;
  double time = 0;
  EXPECT_TRUE(this->Algorithm->FindTime(this->write("a.inr", {5, 6, 7}, -2.5).c_str(), time));
  EXPECT_EQ(time, -2.5);
  EXPECT_TRUE(this->Algorithm->FindTime(this->write("b.inr", {5, 6, 7}).c_str(), time));
  EXPECT_TRUE(std::isnan(time));
  EXPECT_FALSE(this->Algorithm->FindTime((this->Folder / "none.inr").c_str(), time));
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
}

/// Waves of 12^3 points that move by a voxel in 0.25 of time.
class MovingWaves : public vtkImageAlgorithm
{
public:
  static MovingWaves* New() { VTK_STANDARD_NEW_BODY(MovingWaves); }
  vtkTypeMacro(MovingWaves, vtkImageAlgorithm);

  std::vector<double> Times = {0.25, 0.5, 1.5, 2};
  double BadTime = -1;    ///< when there is no array
  double FlatTime = -1;   ///< when all values are the same
  double SignalTime = -1; ///< when the user presses Ctrl-C

protected:
  MovingWaves() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**,
                         vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    const int extent[6] = {0, 11, 0, 11, 0, 11};
    const double range[2] = {this->Times.front(), this->Times.back()};
    info->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
    info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    vtkImageData* image = vtkImageData::GetData(info);
    const bool asked = info->Has(Pipeline::UPDATE_TIME_STEP());
    const double time = asked ? info->Get(Pipeline::UPDATE_TIME_STEP()) : this->Times[0];
    image->Initialize();
    image->SetDimensions(12, 12, 12);
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    if (time == this->BadTime) {
      return 1;
    }
    if (time == this->SignalTime) {
      std::raise(SIGINT);
    }
    vtkNew<vtkDoubleArray> array;
    array->SetName("waves");
    for (int k = 0; k < 12 * 12 * 12; ++k) {
      array->InsertNextValue(time == this->FlatTime ? 0.5
                                                    : std::sin(0.5 * (k % 12 - time)) *
                                                              std::cos(0.3 * (k / 12 % 12)) +
                                                          0.02 * (k / 144));
    }
    image->GetPointData()->SetScalars(array);
    return 1;
  }
};

class WriterOfSteps : public testing::Test
{
protected:
  WriterOfSteps()
  {
    this->Algorithm->SetInputConnection(this->Source->GetOutputPort());
    this->Algorithm->SetFileName((this->Folder / "waves.inr").c_str());
    this->Algorithm->SetMaximumSteps(60);
    this->Algorithm->SetWriteTimeSteps(true);
  }
  inr::Model header(const char* name) { return inr::ReadModelHeader(this->Folder / name); }

  TemporaryFolder Folder;
  vtkNew<MovingWaves> Source;
  vtkNew<vtkINRWriter> Algorithm;
};

TEST_F(WriterOfSteps, MakesAFileOfEachWithItsTimeFromTheOneBefore)
{
  std::vector<double> progress;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&progress);
  watch->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    static_cast<std::vector<double>*>(data)->push_back(
        vtkAlgorithm::SafeDownCast(caller)->GetProgress());
  });
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, watch);
  EXPECT_EQ(this->Algorithm->Write(), 1);
  EXPECT_EQ(this->Folder.entries(), 4);
  for (int k = 0; k < 4; ++k) {
    const inr::Model step = this->header(("waves_" + std::to_string(k) + ".inr").c_str());
    EXPECT_EQ(step.volume.time, this->Source->Times[static_cast<std::size_t>(k)]);
    EXPECT_EQ(step.training->steps, 60u);
    EXPECT_EQ(step.training->earlierSteps.value_or(0), 60u * static_cast<unsigned>(k));
  }
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1);
  // Again the same, whatever was written before.
  const inr::ModelPointer last = inr::ReadModel(this->Folder / "waves_3.inr");
  this->Algorithm->Write();
  EXPECT_EQ(inr::ReadModel(this->Folder / "waves_3.inr")->parameters, last->parameters);
  EXPECT_FALSE(this->header("waves_0.inr").training->earlierSteps.has_value());
}

TEST_F(WriterOfSteps, StartsFromTheLatestThatWasTrained)
{
  const auto earlierSteps = [&](int step) {
    const auto name = "waves_" + std::to_string(step) + ".inr";
    return this->header(name.c_str()).training->earlierSteps.value_or(0);
  };
  this->Source->FlatTime = this->Source->Times[1];
  EXPECT_EQ(this->Algorithm->Write(), 1);
  EXPECT_EQ(earlierSteps(2), 60u);
  EXPECT_EQ(earlierSteps(3), 120u);
  this->Source->FlatTime = this->Source->Times[0];
  this->Source->Modified();
  EXPECT_EQ(this->Algorithm->Write(), 1);
  EXPECT_EQ(earlierSteps(1), 0u);
  EXPECT_EQ(earlierSteps(2), 60u);
}

TEST_F(WriterOfSteps, StartsEachFromRandomNumbersWhenToldTo)
{
  this->Algorithm->SetStartFromPrevious(false);
  this->Algorithm->Write();
  for (const char* name : {"waves_0.inr", "waves_3.inr"}) {
    EXPECT_FALSE(this->header(name).training->earlierSteps.has_value()) << name;
  }
}

TEST_F(WriterOfSteps, WritesTheChosenOnesUnderTheChosenNames)
{
  this->Algorithm->SetMinTimeStep(1);
  this->Algorithm->SetMaxTimeStep(3);
  this->Algorithm->SetTimeStepStride(2);
  this->Algorithm->SetFileNameSuffix("-t%.3d");
  EXPECT_EQ(this->Algorithm->Write(), 1);
  EXPECT_EQ(this->Folder.entries(), 2);
  EXPECT_EQ(this->header("waves-t001.inr").volume.time, 0.5);
  EXPECT_EQ(this->header("waves-t003.inr").volume.time, 2);
  EXPECT_EQ(this->header("waves-t003.inr").training->earlierSteps, 60u);
}

TEST_F(WriterOfSteps, WritesOneFileOfTheirTimeWhenTheyComeOneByOne)
{
  this->Algorithm->SetWriteTimeSteps(false);
  for (const double time : {0.5, 1.5, 1.5}) {
    this->Source->UpdateTimeStep(time);
    this->Algorithm->Write();
    EXPECT_EQ(this->header("waves.inr").volume.time, time);
  }
  EXPECT_EQ(this->Folder.entries(), 1);
  EXPECT_FALSE(this->header("waves.inr").training->earlierSteps.has_value()) << "the same step";
  this->Source->UpdateTimeStep(2);
  this->Algorithm->Write();
  EXPECT_EQ(this->header("waves.inr").training->earlierSteps, 60u);
}

TEST_F(WriterOfSteps, EndsAtAStepThatCannotBeWrittenAndKeepsTheOthers)
{
  this->Source->BadTime = 1.5;
  {
    const MessageCapture messages;
    EXPECT_EQ(this->Algorithm->Write(), 0);
    EXPECT_TRUE(messages.onlyError("waves_2.inr")) << messages.text();
    EXPECT_NE(messages.text().find("point array"), std::string::npos);
  }
  EXPECT_EQ(this->Folder.entries(), 2);
  this->Source->BadTime = -1;
  this->Source->Modified();
  EXPECT_EQ(this->Algorithm->Write(), 1); // from the first on
  EXPECT_EQ(this->Folder.entries(), 4);
}

TEST_F(WriterOfSteps, EndWithOneThatIsStoppedWhileItIsRead)
{
  static volatile std::sig_atomic_t received;
  received = 0;
  const auto before = std::signal(SIGINT, [](int) { received = 1; });
  this->Source->SignalTime = 0.5;
  {
    const MessageCapture messages;
    EXPECT_EQ(this->Algorithm->Write(), 0);
    EXPECT_TRUE(messages.onlyError("stopped")) << messages.text();
  }
  EXPECT_EQ(received, 1);
  std::signal(SIGINT, before);
  EXPECT_TRUE(std::filesystem::exists(this->Folder / "waves_0.inr"));
  EXPECT_FALSE(std::filesystem::exists(this->Folder / "waves_1.inr"));
}

TEST_F(WriterOfSteps, GoOnFromTheStepBeforeWhereOneWasStopped)
{
  this->Algorithm->SetWriteTimeSteps(false);
  const auto write = [&](double time) {
    this->Source->UpdateTimeStep(time);
    return this->Algorithm->Write();
  };
  ASSERT_EQ(write(0.5), 1);
  {
    const MessageCapture messages;
    vtkNew<vtkCallbackCommand> abort;
    abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
      vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
    });
    const unsigned long tag = this->Algorithm->AddObserver(vtkCommand::ProgressEvent, abort);
    EXPECT_EQ(write(1.5), 0);
    this->Algorithm->RemoveObserver(tag);
    this->Algorithm->SetAbortExecute(0);
  }
  const MessageCapture messages;
  ASSERT_EQ(write(1.5), 1);
  EXPECT_TRUE(messages.warnings().empty()) << messages.text();
  EXPECT_EQ(this->header("waves.inr").training->earlierSteps, 60u);
}

TEST_F(WriterOfSteps, RefusesStepsAndSuffixesThatMakeNoSense)
{
  for (const char* suffix : {"", "_", "%s", "%d%d", "_%x", "/%d", "%d/", "%99d"}) {
    const MessageCapture messages;
    this->Algorithm->SetFileNameSuffix(suffix);
    EXPECT_EQ(this->Algorithm->Write(), 0);
    EXPECT_TRUE(messages.onlyError("must have one %d")) << suffix << messages.text();
  }
  this->Algorithm->SetFileNameSuffix("%3d");
  this->Algorithm->SetMinTimeStep(4);
  {
    const MessageCapture messages;
    EXPECT_EQ(this->Algorithm->Write(), 0);
    EXPECT_TRUE(messages.onlyError("number 3")) << messages.text();
  }
  EXPECT_EQ(this->Folder.entries(), 0);
  this->Algorithm->SetMinTimeStep(3);
  EXPECT_EQ(this->Algorithm->Write(), 1);
  EXPECT_EQ(this->header("waves  3.inr").volume.time, 2);
}

} // namespace
