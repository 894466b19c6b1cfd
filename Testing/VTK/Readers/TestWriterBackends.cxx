// SPDX-License-Identifier: BSD-3-Clause
// What trains: the choice, what is said of it, and a device that is not there, or lost.
#include "Testing/Core/Training/FakeTrainer.h"
#include "WriterFixture.h"

#include <vtkCallbackCommand.h>
#include <vtkObjectFactory.h>

#include <sstream>

namespace {

/// A writer on a machine with such a device, or none.
class BackendWriter : public vtkINRWriter
{
public:
  static BackendWriter* New();
  vtkTypeMacro(BackendWriter, vtkINRWriter);

  FakeTrainingDevice* device = nullptr;
  int searches = 0;

protected:
  std::shared_ptr<const inr::TrainingAccelerator>
  FindTrainingAccelerator(std::string& reason) override
  {
    ++this->searches;
    if (this->device) {
      return std::make_shared<FakeTrainer>(*this->device);
    }
    reason = "no device in this test";
    return nullptr;
  }
};
vtkStandardNewMacro(BackendWriter);

class WriterBackends : public testing::Test
{
protected:
  WriterBackends()
  {
    this->Device.planned = Steps;
    this->Algorithm->SetFileName(std::string(this->Folder / "saved.inr").c_str());
    this->Algorithm->SetModelConfig(SmallModel);
    this->Algorithm->SetMaximumSteps(Steps);
    this->Algorithm->SetInputData(MakeImage({12, 11, 10}, VTK_FLOAT, 0, 1));
  }

  /// What it said of it.
  std::vector<std::string> write()
  {
    const MessageCapture messages;
    EXPECT_EQ(this->Algorithm->Write(), 1) << messages.text();
    EXPECT_EQ(this->Algorithm->GetSteps(), static_cast<vtkIdType>(Steps));
    return messages.warnings();
  }

  bool isUsed() const
  {
    return this->Algorithm->GetBackendInUse() ==
           std::string("Fake device; volume in device memory");
  }
  bool isCpu() const
  {
    const std::string used = this->Algorithm->GetBackendInUse();
    return used.substr(0, 4) == "CPU " && used.find("; volume in host memory") != std::string::npos;
  }

  static constexpr std::uint64_t Steps = 20;
  TemporaryFolder Folder;
  FakeTrainingDevice Device;
  vtkNew<BackendWriter> Algorithm;
};

bool Holds(const std::vector<std::string>& warnings, const std::string& words)
{
  return warnings.size() == 1 && warnings[0].find(words) != std::string::npos;
}

} // namespace

TEST_F(WriterBackends, TrainTheSameModel)
{
  EXPECT_EQ(this->Algorithm->GetBackend(), vtkINRWriter::AUTO);
  EXPECT_STREQ(this->Algorithm->GetBackendInUse(), "");
  this->Algorithm->device = &this->Device;
  this->Algorithm->SetBackend(vtkINRWriter::CPU);
  EXPECT_TRUE(this->write().empty());
  EXPECT_TRUE(this->isCpu()) << this->Algorithm->GetBackendInUse();
  EXPECT_EQ(this->Algorithm->searches, 0);
  const double psnr = this->Algorithm->GetPSNR();
  for (const int backend : {vtkINRWriter::AUTO, vtkINRWriter::CUDA}) {
    this->Algorithm->SetBackend(backend);
    EXPECT_TRUE(this->write().empty());
    EXPECT_TRUE(this->isUsed()) << this->Algorithm->GetBackendInUse();
    EXPECT_EQ(this->Algorithm->GetPSNR(), psnr);
  }
}

TEST_F(WriterBackends, SayOnceThatThereIsNoGpuWhereOneIsAskedFor)
{
  EXPECT_TRUE(this->write().empty());
  EXPECT_EQ(this->Algorithm->searches, 1);
  this->Algorithm->SetBackend(vtkINRWriter::CUDA);
  const std::vector<std::string> warnings = this->write();
  EXPECT_TRUE(Holds(warnings, "There is no GPU for Backend CUDA (no device in this test)"));
  EXPECT_TRUE(this->isCpu());
}

TEST_F(WriterBackends, GiveALostDeviceUpForTheCpu)
{
  this->Algorithm->device = &this->Device;
  this->Device.failsAt = 15;
  EXPECT_TRUE(Holds(this->write(), "The GPU has failed and is not used any more: the fake device "
                                   "is lost. The CPU goes on with the training after"));
  EXPECT_EQ(std::string(this->Algorithm->GetBackendInUse()).find("Fake device, then CPU "), 0u);
  this->Device.failsAt = FakeTrainingDevice::Never; // the next one tries it again
  EXPECT_TRUE(this->write().empty());
  EXPECT_TRUE(this->isUsed());
}

TEST_F(WriterBackends, SayNothingOfShortMemoryUnlessAsked)
{
  this->Algorithm->device = &this->Device;
  this->Device.failsAt = 0;
  EXPECT_TRUE(this->write().empty());
  EXPECT_TRUE(this->isCpu());
  this->Algorithm->SetBackend(vtkINRWriter::CUDA);
  EXPECT_TRUE(Holds(this->write(), "The GPU cannot be used for this training: the fake device is "
                                   "lost. The CPU trains instead."));
}

TEST_F(WriterBackends, AreInTheProgressText)
{
  this->Algorithm->device = &this->Device;
  std::string text;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&text);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const char* said = vtkAlgorithm::SafeDownCast(caller)->GetProgressText();
    *static_cast<std::string*>(data) += said ? said : "";
  });
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  this->write();
  EXPECT_NE(text.find("Training INR on the GPU, from device memory"), std::string::npos) << text;
}

/// A training goes on as it has begun, and what there is to tell of it is told.
TEST_F(WriterBackends, MayBeSetWhileTheyTrain)
{
  this->Algorithm->device = &this->Device;
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    auto* const writer = vtkINRWriter::SafeDownCast(caller);
    if (writer->GetProgress() > 0) { // it has begun
      const bool isCpu = writer->GetBackend() == vtkINRWriter::CPU;
      writer->SetBackend(isCpu ? vtkINRWriter::AUTO : vtkINRWriter::CPU);
    }
  });
  const unsigned long observer = this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  EXPECT_TRUE(this->write().empty());
  EXPECT_TRUE(this->isUsed()) << this->Algorithm->GetBackendInUse();
  const double psnr = this->Algorithm->GetPSNR();

  this->Algorithm->SetBackend(vtkINRWriter::AUTO);
  this->Device.failsAt = this->Device.calls + 15;
  EXPECT_TRUE(Holds(this->write(), "The GPU has failed and is not used any more"));
  EXPECT_EQ(this->Algorithm->GetPSNR(), psnr);

  this->Algorithm->RemoveObserver(observer);
  this->Algorithm->SetBackend(vtkINRWriter::CPU); // that of the next one
  EXPECT_TRUE(this->write().empty());
  EXPECT_TRUE(this->isCpu()) << this->Algorithm->GetBackendInUse();
  EXPECT_EQ(this->Algorithm->GetPSNR(), psnr);
}

TEST_F(WriterBackends, OfWhichThereIsNoneAreRefused)
{
  const MessageCapture messages;
  for (const int backend : {-1, 3}) {
    this->Algorithm->SetBackend(backend);
    EXPECT_EQ(this->Algorithm->GetBackend(), vtkINRWriter::AUTO);
  }
  EXPECT_EQ(messages.errors().size(), 2u);
  EXPECT_NE(messages.text().find("Backend 3"), std::string::npos);
  this->Algorithm->SetBackend(vtkINRWriter::CUDA);
  std::ostringstream text;
  this->Algorithm->Print(text);
  EXPECT_NE(text.str().find("Backend: 2\n"), std::string::npos);
}
