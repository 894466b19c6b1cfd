// SPDX-License-Identifier: BSD-3-Clause
// What computes a picture: the choice, what is said of it, and a device that is not there, or lost.
#include "Core/Image/Metrics.h"
#include "OneVolume.h"
#include "Testing/Core/FakeAccelerator.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkObjectFactory.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace {

using test::OneVolume;

/// A mapper on a machine with such a device, or none.
class BackendMapper : public vtkINRVolumeMapper
{
public:
  static BackendMapper* New();
  vtkTypeMacro(BackendMapper, vtkINRVolumeMapper);

  std::shared_ptr<FakeDevice> device; ///< null: there is none
  int searches = 0;

protected:
  /// As with a GPU, the same one until it has failed.
  std::shared_ptr<const inr::Accelerator> FindAccelerator(std::string& reason) override
  {
    ++this->searches;
    if (!this->device) {
      reason = "no device in this test";
      return nullptr;
    }
    if (!this->Found || this->Found->hasFailed()) {
      this->Found = std::make_shared<FakeAccelerator>(this->device);
    }
    return this->Found;
  }

private:
  std::shared_ptr<const inr::Accelerator> Found;
};
vtkStandardNewMacro(BackendMapper);

struct OneBackend : OneVolume
{
  explicit OneBackend(std::shared_ptr<FakeDevice> device)
      : OneBackend(vtkSmartPointer<BackendMapper>::New(), std::move(device))
  {}

  /// From further round.
  inr::Image turn()
  {
    this->renderer->GetActiveCamera()->Azimuth(20);
    this->renderer->ResetCameraClippingRange();
    return this->scene.capture();
  }
  bool isAccelerated() const
  {
    return std::string(this->mapper->GetBackendInUse()).find("Fake device") != std::string::npos;
  }

  vtkSmartPointer<BackendMapper> own;
  test::Messages messages;

private:
  OneBackend(vtkSmartPointer<BackendMapper> made, std::shared_ptr<FakeDevice> device)
      : OneVolume(made), own(made), messages(made)
  {
    made->device = std::move(device);
    made->SetInputConnection(test::InrMapper(test::ModelFile())->GetInputConnection(0, 0));
    made->SetBrickSize(8);
    test::Scene::look(this->renderer);
  }
};

TEST(Backends, ComputeTheSamePicture)
{
  for (const int mode : {vtkINRVolumeMapper::CACHE_AND_NETWORK, vtkINRVolumeMapper::NETWORK_ONLY}) {
    OneBackend cpu(std::make_shared<FakeDevice>());
    cpu.mapper->SetBackend(vtkINRVolumeMapper::CPU);
    cpu.mapper->SetInferencePrecision(vtkINRVolumeMapper::SINGLE); // as beside a device
    cpu.mapper->SetCacheMode(mode);
    const inr::Image truth = cpu.scene.capture();
    EXPECT_EQ(cpu.own->searches, 0);
    EXPECT_EQ(cpu.own->device->made, 0);
    EXPECT_FALSE(cpu.isAccelerated());
    for (const int backend : {vtkINRVolumeMapper::AUTO, vtkINRVolumeMapper::CUDA}) {
      OneBackend one(std::make_shared<FakeDevice>());
      one.mapper->SetBackend(backend);
      one.mapper->SetCacheMode(mode);
      EXPECT_GE(inr::ImagePsnr(one.scene.capture(), truth), 50);
      EXPECT_EQ(one.mapper->GetBackendInUse(), std::string(cpu.mapper->GetBackendInUse()) +
                                                   (mode == 0 ? "; bricks by " : "; samples by ") +
                                                   "Fake device");
      EXPECT_GT(one.own->device->calls, 2);
      EXPECT_EQ(one.own->searches, 1);
      one.turn();
      EXPECT_EQ(one.own->searches, 1);
      EXPECT_EQ(one.messages.warnings + one.messages.errors, 0);
    }
  }
}

TEST(Backends, SayOnceThatThereIsNoGpuWhereOneIsAskedFor)
{
  OneBackend one(nullptr);
  EXPECT_EQ(one.mapper->GetBackend(), vtkINRVolumeMapper::AUTO);
  const inr::Image truth = one.scene.capture();
  EXPECT_EQ(one.messages.warnings, 0);
  one.mapper->SetBackend(vtkINRVolumeMapper::CUDA);
  EXPECT_EQ(inr::ImageMaximumError(one.scene.capture(), truth), 0);
  one.scene.capture();
  one.turn();
  EXPECT_EQ(one.messages.warnings, 1);
  EXPECT_EQ(one.messages.errors, 0);
  for (const char* part : {"no device in this test", "CPU", "Auto"}) {
    EXPECT_NE(one.messages.last.find(part), std::string::npos) << one.messages.last;
  }
  EXPECT_EQ(std::string(one.mapper->GetBackendInUse()).substr(0, 4), "CPU ");
  EXPECT_EQ(one.own->searches, 2);
  one.mapper->SetBackend(vtkINRVolumeMapper::CUDA); // looks again
  one.scene.capture();
  EXPECT_EQ(one.messages.warnings, 2);
  EXPECT_EQ(one.own->searches, 3);
}

/// Pictures from six sides; what the last call of the device is must not show.
TEST(Backends, GiveALostDeviceUpForTheCpu)
{
  OneBackend cpu(nullptr);
  std::vector<inr::Image> truth;
  for (int side = 0; side < 6; ++side) {
    truth.push_back(cpu.turn());
  }
  int lost = 0;
  for (int fails = 0; fails < 12; ++fails) {
    OneBackend one(std::make_shared<FakeDevice>());
    one.own->device->failsAt = fails;
    for (std::size_t side = 0; side < truth.size(); ++side) {
      ASSERT_GE(inr::ImagePsnr(one.turn(), truth[side]), 50) << fails << " " << side;
      EXPECT_TRUE(one.mapper->GetConverged());
    }
    if (one.own->device->refused == 0) {
      continue;
    }
    ++lost;
    EXPECT_LE(one.own->device->refused, 2);
    EXPECT_EQ(one.messages.warnings, 1) << one.messages.last;
    EXPECT_EQ(one.messages.errors, 0) << one.messages.last;
    EXPECT_NE(one.messages.last.find("the fake device is lost"), std::string::npos);
    EXPECT_FALSE(one.isAccelerated());
    EXPECT_EQ(one.own->device->alive, 0);
    EXPECT_EQ(one.own->searches, 1);
  }
  EXPECT_GT(lost, 8);
}

/// Whatever it had brought stays, and it is tried again when Backend is set, not before.
TEST(Backends, TryALostDeviceAgainWhenSet)
{
  OneBackend one(std::make_shared<FakeDevice>());
  FakeDevice& device = *one.own->device;
  one.scene.capture();
  ASSERT_TRUE(one.isAccelerated());
  device.failsAt = device.calls + 3; // two compare its first values with the CPU's
  one.mapper->SetBrickSize(9);
  one.scene.capture();
  ASSERT_GT(device.refused, 0);
  EXPECT_EQ(one.messages.warnings, 1);
  const int made = device.made;

  one.volume->GetProperty()->SetScalarOpacityUnitDistance(7);
  one.scene.capture();
  EXPECT_EQ(one.mapper->GetNumberOfDecodedBricks(), 0); // none is lost
  one.mapper->SetMaximumRequests(7);                    // the renderer is made anew
  one.scene.capture();
  EXPECT_EQ(one.mapper->GetNumberOfDecodedBricks(), 0);
  auto next = test::MakeModel(); // as the next step of a time series
  one.mapper->SetInputConnection(
      test::InrMapper(test::Write(*next, "Next.inr"))->GetInputConnection(0, 0));
  one.scene.capture();
  EXPECT_GT(one.mapper->GetNumberOfDecodedBricks(), 0);
  EXPECT_FALSE(one.isAccelerated());
  EXPECT_EQ(device.made, made);
  EXPECT_EQ(one.messages.warnings, 1);

  device.failsAt = FakeDevice::Never;
  one.mapper->SetBackend(vtkINRVolumeMapper::AUTO);
  one.scene.capture();
  EXPECT_TRUE(one.isAccelerated()) << one.mapper->GetBackendInUse();
  EXPECT_EQ(one.messages.warnings, 1);
}

/// Bricks come in behind the application, too.
TEST(Backends, GiveUpADeviceThatIsLostBetweenPictures)
{
  OneBackend cpu(nullptr);
  const inr::Image truth = cpu.scene.capture();
  OneBackend one(std::make_shared<FakeDevice>());
  one.own->device->failsAt = 4;
  one.scene.window->SetDesiredUpdateRate(1000);
  for (int frame = 0; frame < 2000 && !one.own->device->refused; ++frame) {
    one.turn();
  }
  ASSERT_GT(one.own->device->refused, 0);
  one.scene.window->SetDesiredUpdateRate(0.002);
  one.renderer->GetActiveCamera()->DeepCopy(cpu.renderer->GetActiveCamera());
  EXPECT_GE(inr::ImagePsnr(one.scene.capture(), truth), 50);
  EXPECT_EQ(one.messages.warnings, 1);
  EXPECT_EQ(one.messages.errors, 0);
  EXPECT_FALSE(one.isAccelerated());
}

/// A window asks its observers whether to go on: what these set is for the next frame.
TEST(Backends, MayBeSetWithinAFrame)
{
  OneBackend cpu(nullptr);
  const inr::Image truth = cpu.scene.capture();
  const inr::Image turned = cpu.turn();
  for (const int fails : {FakeDevice::Never, 5}) {
    OneBackend one(std::make_shared<FakeDevice>());
    one.own->device->failsAt = fails;
    vtkNew<vtkCallbackCommand> command;
    command->SetClientData(one.own);
    command->SetCallback([](vtkObject*, unsigned long, void* mapper, void*) {
      auto* const volume = static_cast<vtkINRVolumeMapper*>(mapper);
      volume->SetBackend(vtkINRVolumeMapper::CPU);
      volume->SetBackend(vtkINRVolumeMapper::CUDA);
      volume->SetBackend(vtkINRVolumeMapper::CPU);
    });
    const unsigned long tag = one.scene.window->AddObserver(vtkCommand::AbortCheckEvent, command);
    EXPECT_GE(inr::ImagePsnr(one.scene.capture(), truth), 50);
    ASSERT_EQ(one.mapper->GetBackend(), vtkINRVolumeMapper::CPU) << "nobody was asked";
    EXPECT_EQ(one.isAccelerated(), fails == FakeDevice::Never);
    one.scene.window->RemoveObserver(tag);
    EXPECT_GE(inr::ImagePsnr(one.turn(), turned), 50);
    EXPECT_FALSE(one.isAccelerated());
    EXPECT_EQ(one.messages.errors, 0) << one.messages.last;
  }
}

TEST(Backends, SayNothingOfShortMemoryUnlessAsked)
{
  OneBackend one(std::make_shared<FakeDevice>());
  one.own->device->hasMemory = false;
  one.scene.capture();
  EXPECT_EQ(one.messages.warnings, 0);
  EXPECT_FALSE(one.isAccelerated());
  one.mapper->SetBackend(vtkINRVolumeMapper::CUDA);
  one.scene.capture();
  one.turn();
  EXPECT_EQ(one.messages.warnings, 1);
  EXPECT_NE(one.messages.last.find("no memory"), std::string::npos) << one.messages.last;
}

TEST(Backends, OfWhichThereIsNoneAreRefused)
{
  OneBackend one(nullptr);
  for (const int backend : {-1, 3}) {
    one.mapper->SetBackend(backend);
    EXPECT_EQ(one.mapper->GetBackend(), vtkINRVolumeMapper::AUTO);
    EXPECT_NE(one.messages.last.find("Backend"), std::string::npos);
  }
  EXPECT_EQ(one.messages.errors, 2);
  one.mapper->SetBackend(vtkINRVolumeMapper::CUDA);
  one.mapper->SetLocalRank(3);
  std::ostringstream text;
  one.mapper->Print(text);
  EXPECT_NE(text.str().find("Backend: 2\n"), std::string::npos);
  EXPECT_NE(text.str().find("LocalRank: 3\n"), std::string::npos);
}

/// This machine's own, whatever it has.
TEST(Backends, OfThisMachineDraw)
{
  OneVolume cpu;
  cpu.mapper->SetBackend(vtkINRVolumeMapper::CPU);
  const inr::Image truth = cpu.scene.capture();
  OneVolume one;
  test::Messages messages(one.mapper);
  one.mapper->SetBackend(vtkINRVolumeMapper::CUDA);
  EXPECT_GE(inr::ImagePsnr(one.scene.capture(), truth), 50);
  const bool accelerated =
      std::string(one.mapper->GetBackendInUse()).find("CUDA float32") != std::string::npos;
  EXPECT_EQ(messages.warnings, accelerated ? 0 : 1) << messages.last;
}

} // namespace
