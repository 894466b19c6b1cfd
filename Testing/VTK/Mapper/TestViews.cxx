// SPDX-License-Identifier: BSD-3-Clause
// One volume in several views at once: viewports of a window, and the eyes of one in stereo.
#include "OneVolume.h"
#include "Representations/Mapper/Pictures/ImageReduction.h"

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSmartPointer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace {

using test::OneVolume;

/// Whether the mapper has converged, for each picture that the latest window consists of.
class Watch
{
public:
  explicit Watch(OneVolume& one) : Mapper(one.mapper)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
      auto* watch = static_cast<Watch*>(data);
      if (vtkRenderWindow::SafeDownCast(caller)) {
        watch->Pictures.clear();
      } else {
        watch->Pictures.push_back(watch->Mapper->GetConverged());
      }
    });
    one.scene.window->AddObserver(vtkCommand::StartEvent, this->Command);
  }
  void watch(vtkRenderer* renderer) { renderer->AddObserver(vtkCommand::EndEvent, this->Command); }

  std::size_t pictures() const { return this->Pictures.size(); }
  bool allConverged() const
  {
    return std::all_of(this->Pictures.begin(), this->Pictures.end(), [](bool one) { return one; });
  }

private:
  vtkINRVolumeMapper* Mapper;
  vtkNew<vtkCallbackCommand> Command;
  std::vector<bool> Pictures;
};

/// Traced, a path through each pixel at a time.
void TraceInParts(OneVolume& one)
{
  one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  one.mapper->SetSamplesPerPixel(3);
  one.mapper->DeterministicOn();
  one.scene.window->SetDesiredUpdateRate(5);
}

void AddViewports(OneVolume& one, Watch& watch, int count)
{
  one.renderer->SetViewport(0, 0, 1. / count, 1);
  watch.watch(one.renderer);
  for (int k = 1; k < count; ++k) {
    vtkRenderer* other = one.scene.addRenderer(double(k) / count, double(k + 1) / count);
    other->AddVolume(one.volume);
    test::Scene::look(other);
    other->GetActiveCamera()->Azimuth(40 * k);
    watch.watch(other);
  }
}

void LookWithBothEyes(OneVolume& one, Watch& watch)
{
  one.renderer->GetActiveCamera()->SetEyeAngle(10);
  one.scene.window->SetStereoTypeToAnaglyph();
  one.scene.window->StereoRenderOn();
  watch.watch(one.renderer);
}

/// Renders until all pictures have converged; how often.
int RenderUntilConverged(OneVolume& one, const Watch& watch)
{
  constexpr int most = 40;
  int renders = 0;
  do {
    one.scene.window->Render();
    ++renders;
  } while (!watch.allConverged() && renders < most);
  return renders;
}

TEST(Views, OfAWindowConvergeEachWithPathsOfItsOwn)
{
  for (const int count : {1, 2, 4}) {
    OneVolume one;
    Watch watch(one);
    TraceInParts(one);
    AddViewports(one, watch, count);
    const int renders = RenderUntilConverged(one, watch);
    EXPECT_EQ(watch.pictures(), count);
    EXPECT_GE(renders, 3);
    EXPECT_LE(renders, 10) << count;
    one.scene.window->Render();
    EXPECT_TRUE(watch.allConverged());
    EXPECT_EQ(one.mapper->GetNumberOfPaths(), 3);
  }
}

TEST(Views, InStereoConvergeForBothEyes)
{
  OneVolume one;
  Watch watch(one);
  TraceInParts(one);
  LookWithBothEyes(one, watch);
  EXPECT_LE(RenderUntilConverged(one, watch), 10);
  EXPECT_EQ(watch.pictures(), 2);
}

TEST(Views, ShowTheSamePicturesAsOneByOne)
{
  OneVolume both;
  Watch watch(both);
  TraceInParts(both);
  AddViewports(both, watch, 2);
  RenderUntilConverged(both, watch);
  EXPECT_TRUE(watch.allConverged());
  const inr::Image together = both.scene.capture();
  OneVolume alone;
  Watch other(alone);
  TraceInParts(alone);
  AddViewports(alone, other, 2);
  alone.renderer->DrawOff();
  RenderUntilConverged(alone, other);
  alone.renderer->DrawOn();
  RenderUntilConverged(alone, other);
  EXPECT_EQ(alone.scene.capture().pixels, together.pixels);
}

TEST(Views, ThatHaveConvergedAreNotMadeAgain)
{
  for (const int mode : {vtkINRVolumeMapper::RAY_MARCHING, vtkINRVolumeMapper::PATH_TRACING}) {
    OneVolume one;
    Watch watch(one);
    one.mapper->SetRenderMode(mode);
    one.mapper->SetSamplesPerPixel(2);
    AddViewports(one, watch, 2);
    const inr::Image first = one.scene.capture();
    EXPECT_TRUE(watch.allConverged());
    EXPECT_GT(one.mapper->GetNumberOfVisitedCells(), 0);
    EXPECT_EQ(one.scene.capture().pixels, first.pixels);
    EXPECT_EQ(one.mapper->GetNumberOfVisitedCells(), 0);
  }
}

/// The window's event loop, until nobody has rendered for a moment, and `atRest` is done then;
/// whether that came.
bool RunUntilIdle(vtkRenderWindow* window, vtkRenderWindowInteractor* interactor,
                  const std::function<void()>& atRest)
{
  struct Idleness
  {
    const std::function<void()>& atRest;
    int ticks = 0; // since a picture, of 20 ms; pictures ask for the next one within half a second
    int all = 0;
  } idleness{atRest};
  vtkNew<vtkCallbackCommand> look;
  look->SetClientData(&idleness);
  look->SetCallback([](vtkObject* caller, unsigned long event, void* data, void*) {
    auto* seen = static_cast<Idleness*>(data);
    if (event != vtkCommand::TimerEvent) {
      seen->ticks = 0;
    } else if (++seen->ticks > 60 || ++seen->all > 500) {
      seen->atRest();
      static_cast<vtkRenderWindowInteractor*>(caller)->TerminateApp();
    }
  });
  interactor->AddObserver(vtkCommand::TimerEvent, look);
  const unsigned long tag = window->AddObserver(vtkCommand::EndEvent, look);
  interactor->CreateRepeatingTimer(20);
  interactor->Start();
  interactor->RemoveObserver(look);
  window->RemoveObserver(tag);
  return idleness.all <= 500;
}

/// One that is in its event loop, where a picture gains a sample, or what there is of one.
struct IdleWindow
{
  IdleWindow() : watch(one)
  {
    this->one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
    this->one.mapper->SetSamplesPerPixel(4);
    this->one.mapper->SetStillTimeLimit(1e-3);
    this->one.scene.window->SetOffScreenRendering(0);
    this->interactor->SetRenderWindow(this->one.scene.window);
    this->interactor->Initialize();
  }
  /// Whether it comes to rest with everything converged.
  bool clearsUp(const std::function<void()>& atRest = [] {})
  {
    this->one.scene.window->Render();
    EXPECT_FALSE(this->watch.allConverged());
    return RunUntilIdle(this->one.scene.window, this->interactor, atRest) &&
           this->watch.allConverged();
  }

  /// Whether the latest picture was none in haste.
  bool isStill() const
  {
    return this->one.scene.window->GetDesiredUpdateRate() < inr::ImageReduction::StillRate;
  }

  OneVolume one;
  Watch watch;
  vtkNew<vtkRenderWindowInteractor> interactor;
};

TEST(Views, OfIdleWindowsClearUpAndThenRest)
{
  IdleWindow viewports;
  AddViewports(viewports.one, viewports.watch, 2);
  EXPECT_TRUE(viewports.clearsUp());
  EXPECT_EQ(viewports.watch.pictures(), 2);
  IdleWindow stereo;
  LookWithBothEyes(stereo.one, stereo.watch);
  EXPECT_TRUE(stereo.clearsUp());
  EXPECT_EQ(stereo.watch.pictures(), 2);
}

TEST(Views, ClearUpWhateverOthersDo)
{
  IdleWindow idle;
  AddViewports(idle.one, idle.watch, 2);
  idle.one.scene.window->Render();
  idle.one.renderer->DrawOff(); // with its picture unfinished
  EXPECT_TRUE(idle.clearsUp());
  IdleWindow later; // interactors of VTK 9.1 start once
  AddViewports(later.one, later.watch, 2);
  later.one.renderer->DrawOff();
  EXPECT_LT(RenderUntilConverged(later.one, later.watch), 40);
  later.one.renderer->DrawOn(); // before the other one, which is finished
  EXPECT_TRUE(later.clearsUp());
}

/// Calls `then` at every timer of the interactor, whosever it is, as long as that says so. Added
/// before the mapper's observer, which has to come first all the same.
class TimerObserver
{
public:
  TimerObserver(IdleWindow& idle, std::function<bool()> then) : Then(std::move(then))
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
      auto* self = static_cast<TimerObserver*>(data);
      self->GoesOn = self->GoesOn && self->Then();
    });
    idle.interactor->AddObserver(vtkCommand::TimerEvent, this->Command);
  }

private:
  std::function<bool()> Then;
  bool GoesOn = true;
  vtkNew<vtkCallbackCommand> Command;
};

TEST(Views, GoOnAfterOneWasCapturedInTiles)
{
  IdleWindow idle;
  vtkRenderWindow* window = idle.one.scene.window;
  idle.one.mapper->SetSamplesPerPixel(8);
  vtkIdType paths = 0;
  for (int pictures = 0; paths < 2; ++pictures) {
    ASSERT_LT(pictures, 500);
    window->Render();
    paths = idle.one.mapper->GetNumberOfPaths();
  }
  window->SetTileScale(2);
  window->SetTileViewport(0, 0, 0.5, 0.5);
  window->Render();
  EXPECT_TRUE(idle.one.mapper->GetConverged());
  window->SetTileScale(1);
  window->SetTileViewport(0, 0, 1, 1);
  window->Render();
  EXPECT_FALSE(idle.one.mapper->GetConverged());
  EXPECT_GE(idle.one.mapper->GetNumberOfPaths(), paths);
  EXPECT_TRUE(RunUntilIdle(window, idle.interactor, [] {}));
  EXPECT_TRUE(idle.one.mapper->GetConverged());
}

// VTK's interactor for X must not lose the timer that it is telling of.
TEST(Views, MayBeRedrawnByTheTimersOfWhatRefinesThem)
{
  IdleWindow idle;
  int events = 0;
  const TimerObserver redraws(idle, [&] {
    idle.one.scene.window->Render();
    return ++events < 30;
  });
  idle.one.mapper->SetSamplesPerPixel(10);
  idle.one.scene.window->Render();
  EXPECT_FALSE(idle.one.mapper->GetConverged());
  EXPECT_TRUE(RunUntilIdle(idle.one.scene.window, idle.interactor, [] {}));
  EXPECT_TRUE(idle.one.mapper->GetConverged());
  EXPECT_EQ(events, 30);
}

TEST(Views, MayBeTakenAwayByTheTimersOfWhatRefinesThem)
{
  IdleWindow idle;
  const vtkSmartPointer<vtkRenderer> renderer = idle.one.renderer;
  int events = 0;
  const TimerObserver removes(idle, [&] {
    if (++events == 8) {
      idle.one.scene.window->RemoveRenderer(renderer);
    }
    return events < 8;
  });
  idle.one.mapper->SetSamplesPerPixel(1000);
  idle.one.scene.window->Render();
  EXPECT_TRUE(RunUntilIdle(idle.one.scene.window, idle.interactor, [] {}));
  EXPECT_EQ(events, 8);
  EXPECT_FALSE(idle.one.mapper->GetConverged());
}

/// The window must not stand still for the time of a first look, whatever was drawn before.
TEST(Views, GoOnInPiecesBehindOneThatIsFinished)
{
  IdleWindow idle;
  AddViewports(idle.one, idle.watch, 2);
  idle.one.renderer->GetActiveCamera()->Yaw(180); // sees nothing
  idle.one.mapper->SetSamplesPerPixel(4000);      // a second's work, or more
  idle.one.scene.window->Render();
  idle.one.mapper->SetStillTimeLimit(60);
  struct Count
  {
    vtkINRVolumeMapper* mapper;
    int renders;
  } count{idle.one.mapper, 0};
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&count);
  command->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
    auto& counted = *static_cast<Count*>(data);
    if (++counted.renders == 3) {
      counted.mapper->SetSamplesPerPixel(1); // it is shown: no need to see the rest
    }
  });
  idle.one.scene.window->AddObserver(vtkCommand::EndEvent, command);
  RunUntilIdle(idle.one.scene.window, idle.interactor, [] {});
  EXPECT_GE(count.renders, 3);
}

TEST(Views, ThatAreHiddenAskForNothing)
{
  IdleWindow idle;
  AddViewports(idle.one, idle.watch, 2);
  idle.one.scene.window->Render();
  idle.one.renderer->DrawOff(); // with its picture unfinished
  EXPECT_TRUE(idle.clearsUp([&] {
    idle.one.mapper->SetSamplesPerPixel(60); // more than there is time for while one is asked for
    idle.one.mapper->SetStillTimeLimit(60);
    idle.one.scene.window->Render();
  }));
}

TEST(Views, ThatAreRefusedAskForNothing)
{
  IdleWindow idle;
  idle.one.scene.window->Render();
  EXPECT_FALSE(idle.one.mapper->GetConverged());
  const test::Messages messages(idle.one.mapper);
  idle.one.mapper->SetBlendModeToMaximumIntensity(); // which paths do not know
  idle.one.scene.window->Render();
  EXPECT_EQ(messages.errors, 1);
  int asked = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&asked);
  count->SetCallback(
      [](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
  idle.one.mapper->AddObserver(vtkINRVolumeMapper::RefineEvent, count);
  EXPECT_TRUE(RunUntilIdle(idle.one.scene.window, idle.interactor, [] {}));
  EXPECT_EQ(asked, 0);
}

TEST(Views, MayBeTakenAwayWhenAskedWhetherTheyMayClearUp)
{
  IdleWindow idle;
  vtkNew<vtkCallbackCommand> remove;
  remove->SetClientData(&idle.one);
  remove->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
    auto* one = static_cast<OneVolume*>(data);
    one->renderer->RemoveVolume(one->volume);
    one->volume = nullptr;
    one->mapper = nullptr;
  });
  idle.one.mapper->AddObserver(vtkINRVolumeMapper::RefineEvent, remove);
  idle.one.scene.window->Render();
  EXPECT_FALSE(idle.one.mapper->GetConverged());
  EXPECT_TRUE(RunUntilIdle(idle.one.scene.window, idle.interactor, [] {}));
  EXPECT_EQ(idle.one.mapper, nullptr);
}

/// Renders what the interactor asks for as ParaView's views do: from the beginning of an
/// interaction to its end in haste.
class HastyView
{
public:
  explicit HastyView(IdleWindow& idle) : Idle(idle)
  {
    idle.interactor->SetInteractorStyle(nullptr); // which would render for itself
    idle.interactor->EnableRenderOff();
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long event, void* data, void*) {
      static_cast<HastyView*>(data)->on(event);
    });
    for (const auto event : {vtkCommand::StartInteractionEvent, vtkCommand::EndInteractionEvent,
                             vtkCommand::RenderEvent, vtkCommand::ExposeEvent}) {
      idle.interactor->AddObserver(event, this->Command);
    }
  }
  ~HastyView() { this->Idle.interactor->RemoveObserver(this->Command); }
  HastyView(const HastyView&) = delete;
  HastyView& operator=(const HastyView&) = delete;

  void beginInteraction() const
  {
    this->Idle.interactor->InvokeEvent(vtkCommand::LeftButtonPressEvent);
    this->Idle.interactor->InvokeEvent(vtkCommand::StartInteractionEvent);
  }
  /// As ParaView's selections do.
  void interactWithoutEnd() const
  {
    this->beginInteraction();
    this->Idle.interactor->InvokeEvent(vtkCommand::LeftButtonReleaseEvent);
  }
  bool interacts() const { return this->Interacts; }

private:
  void on(unsigned long event)
  {
    if (event == vtkCommand::ExposeEvent) { // of a window that has come up, for which it renders
      this->IsExposed = true;
    } else if (event == vtkCommand::RenderEvent) {
      if (!std::exchange(this->IsExposed, false)) {
        this->render();
      }
    } else {
      this->Interacts = event == vtkCommand::StartInteractionEvent;
    }
  }

  void render() const
  {
    vtkRenderWindow* window = this->Idle.one.scene.window;
    window->SetDesiredUpdateRate(this->Interacts ? 5 : 0.002);
    window->Render();
  }

  IdleWindow& Idle;
  vtkNew<vtkCallbackCommand> Command;
  bool Interacts = false;
  bool IsExposed = false;
};

TEST(Views, ClearUpAfterInteractionsThatNobodyEnds)
{
  IdleWindow meanwhile;
  meanwhile.watch.watch(meanwhile.one.renderer);
  const HastyView view(meanwhile);
  meanwhile.one.scene.window->Render(); // not complete, so there is more to come
  view.interactWithoutEnd();
  EXPECT_TRUE(meanwhile.clearsUp());
  EXPECT_TRUE(meanwhile.isStill());
  IdleWindow before;
  before.watch.watch(before.one.renderer);
  const HastyView other(before);
  other.interactWithoutEnd();
  EXPECT_TRUE(before.clearsUp());
  EXPECT_TRUE(before.isStill());
}

TEST(Views, LeaveAnInteractionToItself)
{
  IdleWindow idle;
  idle.watch.watch(idle.one.renderer);
  const HastyView view(idle);
  EXPECT_LE(RenderUntilConverged(idle.one, idle.watch), 40);
  view.beginInteraction();
  idle.interactor->InvokeEvent(vtkCommand::RightButtonPressEvent); // beside the left one
  idle.interactor->InvokeEvent(vtkCommand::RightButtonReleaseEvent);
  idle.one.mapper->SetSamplesPerPixel(1000);
  idle.one.scene.window->Render(); // somebody else's, and it is not complete
  EXPECT_TRUE(RunUntilIdle(idle.one.scene.window, idle.interactor, [] {}));
  EXPECT_TRUE(view.interacts());
  EXPECT_FALSE(idle.watch.allConverged());
}

} // namespace
