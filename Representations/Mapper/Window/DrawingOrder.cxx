// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/DrawingOrder.h"

#include "Representations/Mapper/Scene/MapperInput.h"
#include "Representations/Mapper/Scene/PlacedBox.h"
#include "Representations/Mapper/Window/Props.h"
#include "vtkINRVolumeMapper.h"

#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace inr {

namespace {

struct Box
{
  glm::dvec3 low;
  glm::dvec3 high;
};

/// Of the whole volume, in the world: processes that have a piece each agree upon an order.
Box BoxOf(vtkVolume* volume)
{
  double own[6];
  volume->GetBounds(own);
  vtkBoundingBox box(own);
  const MapperInput input = FindInput(vtkVolumeMapper::SafeDownCast(volume->GetMapper()));
  if (input.array) {
    double whole[6];
    WholeBounds(input.grid, whole);
    box = PlacedBox(whole, *volume->GetMatrix());
  }
  double low[3];
  double high[3];
  box.GetMinPoint(low[0], low[1], low[2]);
  box.GetMaxPoint(high[0], high[1], high[2]);
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

struct Eye
{
  glm::dvec3 position;
  glm::dvec3 direction; ///< in which a parallel one looks
  bool parallel;
};

Eye EyeOf(vtkCamera* camera)
{
  const double* p = camera->GetPosition();
  const double* d = camera->GetDirectionOfProjection();
  return {{p[0], p[1], p[2]}, {d[0], d[1], d[2]}, camera->GetParallelProjection() != 0};
}

double DistanceOf(const Eye& eye, const Box& box)
{
  const glm::dvec3 way = 0.5 * (box.low + box.high) - eye.position;
  return eye.parallel ? glm::dot(way, eye.direction) : glm::length(way);
}

/// Whether the eye sees everything below `place` on an axis in front of everything above it.
bool LooksUp(const Eye& eye, int axis, double place)
{
  return eye.parallel ? eye.direction[axis] > 0 : eye.position[axis] < place;
}

bool IsBehind(const Eye& eye, const Box& a, const Box& b)
{
  for (int axis = 0; axis < 3; ++axis) {
    if (a.low[axis] >= b.high[axis]) {
      return LooksUp(eye, axis, a.low[axis]);
    }
    if (b.low[axis] >= a.high[axis]) {
      return !LooksUp(eye, axis, b.low[axis]);
    }
  }
  return DistanceOf(eye, a) > DistanceOf(eye, b);
}

/// The other volumes of such mappers of which `isWanted`, called with both boxes, says so.
template <class Test>
std::vector<vtkVolume*> OtherVolumes(vtkRenderer* renderer, vtkVolume* volume, const Test& isWanted)
{
  std::vector<vtkVolume*> found;
  ForEachProp(renderer, [&](vtkProp* prop) {
    vtkVolume* other = vtkVolume::SafeDownCast(prop);
    // The volume itself may be part of a prop in the renderer, which then has the same mapper.
    const bool isOther = other && other != volume && other->GetMapper() != volume->GetMapper();
    auto* mapper = isOther ? vtkINRVolumeMapper::SafeDownCast(other->GetMapper()) : nullptr;
    if (mapper && mapper->GetDataObjectInput() && other->GetVisibility() && other->GetBounds() &&
        isWanted(BoxOf(other), BoxOf(volume))) {
      found.push_back(other);
    }
  });
  return found;
}

} // namespace

std::vector<vtkVolume*> VolumesBehind(vtkRenderer* renderer, vtkVolume* volume)
{
  const Eye eye = EyeOf(renderer->GetActiveCamera());
  return OtherVolumes(renderer, volume,
                      [&](const Box& other, const Box& own) { return IsBehind(eye, other, own); });
}

std::vector<vtkVolume*> VolumesBefore(vtkRenderer* renderer, vtkVolume* volume)
{
  const Eye eye = EyeOf(renderer->GetActiveCamera());
  return OtherVolumes(renderer, volume,
                      [&](const Box& other, const Box& own) { return IsBehind(eye, own, other); });
}

int VolumesWith(vtkRenderer* renderer, vtkVolume* volume)
{
  const auto others = OtherVolumes(renderer, volume, [](const Box&, const Box&) { return true; });
  return 1 + static_cast<int>(others.size());
}

DrawingOrder::DrawingOrder()
{
  this->Command->SetClientData(this);
  this->Command->SetCallback(&DrawingOrder::OnStart);
}

bool DrawingOrder::begin(vtkRenderer* renderer, vtkVolume* volume, bool isAhead)
{
  if (this->Renderer != renderer) {
    this->forget();
    this->Renderer = renderer;
    renderer->AddObserver(vtkCommand::StartEvent, this->Command);
  }
  std::vector<const vtkVolume*>& done = isAhead ? this->Drawn : this->Ahead;
  const auto found = std::find(done.begin(), done.end(), volume);
  if (found != done.end()) {
    if (!isAhead) {
      done.erase(found); // it has had its turn
    }
    return false;
  }
  this->Drawn.push_back(volume);
  if (isAhead) {
    this->Ahead.push_back(volume);
  }
  return true;
}

void DrawingOrder::forget()
{
  if (this->Renderer) {
    this->Renderer->RemoveObserver(this->Command);
  }
  this->Renderer = nullptr;
  this->Drawn.clear();
  this->Ahead.clear();
}

void DrawingOrder::OnStart(vtkObject*, unsigned long, void* self, void*)
{
  static_cast<DrawingOrder*>(self)->Drawn.clear();
  static_cast<DrawingOrder*>(self)->Ahead.clear();
}

} // namespace inr
