// SPDX-License-Identifier: BSD-3-Clause
// What a hardware selector finds of a volume, whether or not the scene was drawn since it changed.
#include "OneVolume.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkHardwareSelector.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using Cells = std::set<vtkIdType>;

/// One that no picture was made of yet, in a window that was drawn: VTK's selector wants that.
struct OneVolume : test::OneVolume
{
  OneVolume()
  {
    this->volume->VisibilityOff();
    this->scene.window->Render();
    this->volume->VisibilityOn();
  }
};

/// Of the volume, in the pixels that `renderer` covers.
Cells Select(vtkRenderer* renderer, vtkVolume* volume)
{
  const int* origin = renderer->GetOrigin();
  const int* size = renderer->GetSize();
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(renderer);
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  selector->SetArea(origin[0], origin[1], origin[0] + size[0] - 1, origin[1] + size[1] - 1);
  const auto selection = vtkSmartPointer<vtkSelection>::Take(selector->Select());
  Cells cells;
  int nodes = 0;
  for (unsigned int k = 0; k < selection->GetNumberOfNodes(); ++k) {
    vtkSelectionNode* node = selection->GetNode(k);
    if (node->GetProperties()->Get(vtkSelectionNode::PROP()) != volume) {
      continue;
    }
    ++nodes;
    auto* list = vtkDataArray::SafeDownCast(node->GetSelectionList());
    for (vtkIdType i = 0; i < list->GetNumberOfTuples(); ++i) {
      cells.insert(static_cast<vtkIdType>(list->GetTuple1(i)));
    }
  }
  EXPECT_LE(nodes, 1) << "parts of the volume are told apart";
  return cells;
}

Cells Select(OneVolume& one) { return Select(one.renderer, one.volume); }

struct Change
{
  std::string name;
  std::function<void(OneVolume&)> make;
};

/// A cube on the line of sight: in the midst of the volume at 0, at the eye at 1.
vtkActor* AddCubeAt(OneVolume& one, double place)
{
  const double* center = one.volume->GetCenter();
  const double* eye = one.renderer->GetActiveCamera()->GetPosition();
  vtkActor* const cube = one.addCube();
  cube->SetOrigin(one.volume->GetCenter());
  cube->SetPosition(place * (eye[0] - center[0]), place * (eye[1] - center[1]),
                    place * (eye[2] - center[2]));
  return cube;
}

/// One that hides part of the volume.
vtkActor* AddBefore(OneVolume& one) { return AddCubeAt(one, 0.5); }

std::vector<Change> Changes()
{
  using One = OneVolume&;
  return {{"nothing", [](One) {}},
          {"camera",
           [](One one) {
             one.renderer->GetActiveCamera()->Azimuth(120);
             one.renderer->GetActiveCamera()->Zoom(0.4);
           }},
          {"place", [](One one) { one.volume->AddPosition(9, -3, 5); }},
          {"surface before it", [](One one) { AddBefore(one); }},
          {"opacity",
           [](One one) { one.volume->GetProperty()->GetScalarOpacity()->AddPoint(-20, 0.6); }},
          {"size", [](One one) { one.scene.window->SetSize(160, 170); }},
          {"out of sight", [](One one) { one.volume->AddPosition(1e5, 0, 0); }}};
}

TEST(Selection, IsOfTheSceneAsItIs)
{
  for (const bool drawnBefore : {false, true}) {
    OneVolume asked;
    OneVolume drawn;
    Cells before;
    for (const Change& change : Changes()) {
      SCOPED_TRACE(change.name);
      if (drawnBefore) {
        asked.scene.window->Render();
      }
      change.make(asked);
      change.make(drawn);
      drawn.scene.window->Render();
      const Cells cells = Select(drawn);
      EXPECT_EQ(Select(asked), cells);
      EXPECT_EQ(cells.empty(), change.name == "out of sight");
      EXPECT_NE(cells, before);
      before = cells;
    }
  }
}

TEST(Selection, IsOfOneVolumeWhateverIsBehind)
{
  OneVolume free;
  OneVolume before;
  AddCubeAt(before, -1)->SetScale(3); // it shows beside the volume, too
  before.renderer->ResetCameraClippingRange();
  const double* depths = before.renderer->GetActiveCamera()->GetClippingRange();
  free.renderer->GetActiveCamera()->SetClippingRange(depths[0],
                                                     depths[1]); // or they round otherwise
  for (OneVolume* one : {&free, &before}) {
    one->scene.window->Render();
  }
  EXPECT_EQ(Select(before), Select(free));
}

/// The highlight of what was selected before is such a thing.
TEST(Selection, SeesThroughWhatIsNotPicked)
{
  OneVolume free;
  OneVolume hidden;
  AddBefore(hidden);
  OneVolume highlit;
  AddBefore(highlit)->PickableOff();
  for (OneVolume* one : {&free, &hidden, &highlit}) {
    one->scene.window->Render();
  }
  const Cells cells = Select(free);
  EXPECT_NE(Select(hidden), cells);
  EXPECT_EQ(Select(highlit), cells);
}

/// Also where the volume in front comes first, and the one behind is marked after it.
TEST(Selection, IsOfTheVolumeInFront)
{
  for (const bool frontFirst : {true, false}) {
    SCOPED_TRACE(frontFirst);
    OneVolume one;
    const auto mapper = test::InrMapper(test::Write(*test::MakeModel(), "Selection.inr"));
    vtkVolume* const other = one.scene.addVolume(one.renderer, mapper);
    const double* center = one.volume->GetCenter();
    const double* eye = one.renderer->GetActiveCamera()->GetPosition();
    vtkVolume* const front = frontFirst ? one.volume : other;
    vtkVolume* const back = frontFirst ? other : one.volume;
    for (int axis = 0; axis < 3; ++axis) { // a third of the way to the eye
      const double way = (eye[axis] - center[axis]) / 3;
      front->AddPosition(axis == 0 ? way : 0, axis == 1 ? way : 0, axis == 2 ? way : 0);
    }
    const Cells alone = [&] {
      front->VisibilityOff();
      one.scene.window->Render();
      const Cells cells = Select(one.renderer, back);
      front->VisibilityOn();
      return cells;
    }();
    one.scene.window->Render();
    const Cells cells = Select(one.renderer, front);
    EXPECT_GT(cells.size(), 100u);
    EXPECT_LT(Select(one.renderer, back).size(), alone.size());
    back->VisibilityOff();
    one.scene.window->Render();
    EXPECT_EQ(Select(one.renderer, front), cells);
  }
}

TEST(Selection, IsOfEachViewport)
{
  for (const bool drawn : {false, true}) {
    OneVolume one;
    one.renderer->SetViewport(0, 0, 0.5, 1);
    vtkRenderer* other = one.scene.addRenderer(0.5, 1);
    other->AddVolume(one.volume);
    test::Scene::look(other);
    other->GetActiveCamera()->Azimuth(180);
    if (drawn) {
      one.scene.window->Render();
    }
    const Cells front = Select(one);
    const Cells back = Select(other, one.volume);
    one.renderer->GetActiveCamera()->DeepCopy(other->GetActiveCamera());
    EXPECT_EQ(Select(one), back);
    EXPECT_NE(front, back);
  }
}

TEST(Selection, OfTracedPathsWaitsForNone)
{
  OneVolume one;
  one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  one.mapper->SetSamplesPerPixel(VTK_INT_MAX);
  OneVolume marched;
  EXPECT_EQ(Select(one), Select(marched));
}

/// Indices of the first and the last cell along an axis.
std::pair<vtkIdType, vtkIdType> Extent(const Cells& cells, OneVolume& one, int axis)
{
  const int* dims = vtkImageData::SafeDownCast(one.mapper->GetInput())->GetDimensions();
  std::pair<vtkIdType, vtkIdType> extent(VTK_INT_MAX, -1);
  for (const vtkIdType cell : cells) {
    const vtkIdType row = cell / (dims[0] - 1);
    const vtkIdType index = axis == 0   ? cell % (dims[0] - 1)
                            : axis == 1 ? row % (dims[1] - 1)
                                        : row / (dims[1] - 1);
    extent = {std::min(extent.first, index), std::max(extent.second, index)};
  }
  return extent;
}

TEST(Selection, IsOfTheWholeViewWhileThereIsNoTimeForAllOfItsPixels)
{
  OneVolume quick;
  OneVolume slow;
  for (OneVolume* one : {&quick, &slow}) {
    one->volume->GetProperty()->SetScalarOpacityUnitDistance(10);
    one->scene.window->SetSize(400, 400);
    one->scene.window->Render();
    one->renderer->GetActiveCamera()->Zoom(1.01);
  }
  slow.mapper->SetStillTimeLimit(1e-3);
  slow.mapper->ShownElsewhereOn();
  slow.slowDown();
  const Cells all = Select(quick);
  const Cells some = Select(slow); // in fewer pixels
  for (int axis = 0; axis < 3; ++axis) {
    const auto [first, last] = Extent(all, quick, axis);
    const auto [low, high] = Extent(some, slow, axis);
    EXPECT_GT(last - first, 20) << axis;
    EXPECT_NEAR(low, first, 4) << axis;
    EXPECT_NEAR(high, last, 4) << axis;
  }
}

TEST(Selection, LooksAtThePictureThatIsThere)
{
  OneVolume one;
  one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  one.scene.window->SetDesiredUpdateRate(5);
  one.scene.window->Render();
  int size[2];
  one.mapper->GetFrameSize(size); // smaller than a first one of rays
  const std::size_t cells = Select(one).size();
  EXPECT_GT(cells, 0);
  EXPECT_LE(cells, size[0] * size[1]);
}

/// Also in a window on the screen, whose pictures come in limited time. Where paths come to is not
/// where rays do.
TEST(Selection, LooksAtThePictureThatIsOnTheScreen)
{
  OneVolume one;
  one.mapper->SetRenderMode(vtkINRVolumeMapper::PATH_TRACING);
  one.scene.window->SetOffScreenRendering(0);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(one.scene.window);
  interactor->Initialize();
  one.scene.window->Render();
  OneVolume marched;
  EXPECT_NE(Select(one), Select(marched));
}

TEST(Selection, LeavesTheFrameAsItIs)
{
  OneVolume one;
  const inr::Image drawn = one.scene.capture();
  const vtkMTimeType time = one.mapper->GetFrameMTime();
  const vtkIdType samples = one.mapper->GetNumberOfSamples();
  one.renderer->GetActiveCamera()->Zoom(0.5);
  EXPECT_FALSE(Select(one).empty());
  EXPECT_EQ(one.mapper->GetFrameMTime(), time);
  EXPECT_EQ(one.mapper->GetNumberOfSamples(), samples);
  one.renderer->GetActiveCamera()->Zoom(2);
  EXPECT_EQ(one.scene.capture().pixels, drawn.pixels);
}

TEST(Selection, SaysWhatIsWrong)
{
  OneVolume one;
  test::Messages messages(one.mapper);
  one.mapper->SetCacheSize(1);
  one.mapper->SetBrickSize(256);
  EXPECT_TRUE(Select(one).empty());
  EXPECT_EQ(messages.errors, 1);
  EXPECT_NE(messages.last.find("cache"), std::string::npos) << messages.last;
  one.mapper->SetBrickSize(40);
  EXPECT_FALSE(Select(one).empty());
}

} // namespace
