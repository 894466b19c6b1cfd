// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkVolume.h>

#include <functional>
#include <string>
#include <vector>

class vtkImageData;
class vtkINRVolumeMapper;
class vtkVolumeMapper;

namespace test {

/// A small window with a transparent black background, so that a captured picture's alpha says
/// where something was drawn.
class Scene
{
public:
  static constexpr int Width = 240;
  static constexpr int Height = 180;

  Scene();
  /// A renderer over [xmin, xmax] of the window's width.
  vtkRenderer* addRenderer(double xmin = 0, double xmax = 1);
  /// A volume with the tests' transfer function, added to `renderer`.
  vtkVolume* addVolume(vtkRenderer* renderer, vtkVolumeMapper* mapper);
  /// Looks at everything in `renderer` from a direction without symmetry.
  static void look(vtkRenderer* renderer);
  /// Renders and reads the window back: RGBA in [0, 1].
  inr::Image capture();

  vtkNew<vtkRenderWindow> window;
};

/// A named scene; `make` fills it with volumes whose mappers come from `mapper`.
using MapperFactory = std::function<vtkSmartPointer<vtkVolumeMapper>()>;
struct SceneCase
{
  std::string name;
  std::function<void(Scene&, const MapperFactory&)> make;
  bool oblique = false;   ///< on the model with a direction matrix
  bool comparable = true; ///< with VTK's mapper, which in stereo does not follow VTK's polygons
};
/// The scenes every picture test draws.
std::vector<SceneCase> SceneCases();

/// A mapper on the INR in `file`, read by the reader.
vtkSmartPointer<vtkINRVolumeMapper> InrMapper(const std::string& file,
                                              vtkIdType maximumGridPoints = 1 << 24);

/// VTK's own mapper on ordinary voxels, set to sample finely.
vtkSmartPointer<vtkVolumeMapper> VoxelMapper(vtkImageData* voxels);

/// Counts the errors and warnings of an object instead of printing them, and keeps the last one.
class Messages
{
public:
  explicit Messages(vtkObject* object);
  int errors = 0;
  int warnings = 0;
  std::string last;
};

/// PNG files, RGBA in [0, 1] in memory.
inr::Image ReadPng(const std::string& path);
void WritePng(const std::string& path, const inr::Image& image);

} // namespace test
