// SPDX-License-Identifier: BSD-3-Clause
//
// Renders a model file with VTK alone, no ParaView.
//
//     example_vtk_view MODEL.inr PICTURE.png
#include "vtkINRReader.h"
#include "vtkINRVolumeMapper.h"

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>
#include <vtkWindowToImageFilter.h>

#include <iostream>

namespace {

/// Blue and clear to orange and half opaque.
void Colour(vtkVolumeProperty* property, vtkImageData* image)
{
  double range[2];
  image->GetScalarRange(range);
  vtkNew<vtkColorTransferFunction> colours;
  colours->AddRGBPoint(range[0], 0.1, 0.2, 0.6);
  colours->AddRGBPoint(range[1], 1.0, 0.7, 0.3);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(range[0], 0.0);
  opacity->AddPoint(range[1], 0.5);
  property->SetColor(colours);
  property->SetScalarOpacity(opacity);
  property->SetScalarOpacityUnitDistance(image->GetLength() / 100);
}

/// Whether it was written.
bool WritePicture(vtkRenderWindow* window, const char* fileName)
{
  vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(window);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(capture->GetOutputPort());
  writer->SetFileName(fileName);
  writer->Write();
  return writer->GetErrorCode() == 0;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 3) {
    std::cerr << "usage: " << argv[0] << " MODEL.inr PICTURE.png\n";
    return 2;
  }
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(argv[1]);
  reader->Update();
  if (reader->GetOutput()->GetNumberOfPoints() == 0) {
    return 1; // the reader has said why
  }

  vtkNew<vtkINRVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  Colour(volume->GetProperty(), reader->GetOutput());

  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Azimuth(30);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(600, 600);
  window->AddRenderer(renderer);
  window->Render();
  if (*mapper->GetBackendInUse() == 0) {
    return 1; // the mapper has said why
  }
  if (!WritePicture(window, argv[2])) {
    std::cerr << argv[2] << " was not written: is there such a folder?\n";
    return 1;
  }
  std::cout << argv[2] << ": " << mapper->GetFrameTime() << " s on " << mapper->GetBackendInUse()
            << "\n";
  return 0;
}
