// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkCubeSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkVolumeProperty.h>

#include <string>

namespace test {

/// Writes MakeModel() into the output folder.
inline std::string ModelFile() { return Write(*MakeModel(), "Frames.inr"); }

/// One volume seen in perspective.
struct OneVolume
{
  OneVolume() : OneVolume(InrMapper(ModelFile())) {}
  explicit OneVolume(vtkSmartPointer<vtkINRVolumeMapper> inr) : mapper(inr)
  {
    this->renderer = this->scene.addRenderer();
    this->volume = this->scene.addVolume(this->renderer, this->mapper);
    Scene::look(this->renderer);
  }

  vtkSmartPointer<vtkActor> addCube()
  {
    vtkNew<vtkCubeSource> cube;
    cube->SetCenter(this->volume->GetCenter());
    cube->SetXLength(20);
    cube->SetYLength(20);
    cube->SetZLength(20);
    vtkNew<vtkPolyDataMapper> polygons;
    polygons->SetInputConnection(cube->GetOutputPort());
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(polygons);
    this->renderer->AddActor(actor);
    return actor;
  }

  /// Makes it last: no machine finishes its pictures within a second.
  void slowDown()
  {
    this->mapper->SetNumberOfThreads(1);
    this->mapper->SetAdaptiveSampling(false);
    this->mapper->SetSampleDistance(0.001);
    this->volume->GetProperty()->SetScalarOpacityUnitDistance(
        this->mapper->GetRenderMode() == vtkINRVolumeMapper::PATH_TRACING ? 0.01 : 10);
  }

  Scene scene;
  vtkSmartPointer<vtkINRVolumeMapper> mapper;
  vtkRenderer* renderer = nullptr;
  vtkVolume* volume = nullptr;
};

} // namespace test
