// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCubeSource.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>

#include <chrono>
#include <string>
#include <thread>

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

  /// The next picture lasts, on any machine: at its first look at the clock it waits for longer
  /// than one may take that is still refined. VTK allows such looks five times a second.
  void slowDown()
  {
    this->mapper->SetNumberOfThreads(1);
    if (!this->IsSlow) {
      vtkNew<vtkCallbackCommand> wait;
      wait->SetCallback([](vtkObject*, unsigned long, void*, void*) {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
      });
      this->scene.window->AddObserver(vtkCommand::AbortCheckEvent, wait);
      this->IsSlow = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
  }

  Scene scene;
  vtkSmartPointer<vtkINRVolumeMapper> mapper;
  vtkRenderer* renderer = nullptr;
  vtkVolume* volume = nullptr;

private:
  bool IsSlow = false;
};

} // namespace test
