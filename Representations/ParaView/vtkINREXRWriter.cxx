// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINREXRWriter.h"

#include "vtkErrorCode.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkObjectFactory.h"
#include "vtkRenderer.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkVolume.h"
#include "vtkVolumeCollection.h"

#include <algorithm>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkINREXRWriter);

namespace {

using Mappers = std::vector<vtkINRVolumeMapper*>;

/// Those of the visible INR volumes that this process has drawn in a view.
Mappers MappersIn(vtkRenderer* renderer)
{
  Mappers found;
  vtkVolumeCollection* volumes = renderer->GetVolumes();
  vtkCollectionSimpleIterator place;
  volumes->InitTraversal(place);
  while (vtkVolume* volume = volumes->GetNextVolume(place)) {
    auto* mapper = vtkINRVolumeMapper::SafeDownCast(volume->GetMapper());
    if (mapper && volume->GetVisibility() && mapper->GetImageReduction() > 0) {
      found.push_back(mapper);
    }
  }
  return found;
}

vtkMTimeType LatestOf(const Mappers& mappers)
{
  vtkMTimeType latest = 0;
  for (const vtkINRVolumeMapper* mapper : mappers) {
    latest = std::max(latest, mapper->GetFrameMTime());
  }
  return latest;
}

/// Those of the view that was drawn last: a screenshot is drawn right before it is written.
Mappers MappersOfScreenshot()
{
  Mappers found;
  vtkSMSessionProxyManager* session =
      vtkSMProxyManager::IsInitialized()
          ? vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager()
          : nullptr;
  if (!session) {
    return found;
  }
  vtkNew<vtkSMProxyIterator> proxies;
  proxies->SetSessionProxyManager(session);
  for (proxies->Begin("views"); !proxies->IsAtEnd(); proxies->Next()) {
    auto* view = vtkSMRenderViewProxy::SafeDownCast(proxies->GetProxy());
    const Mappers mappers = view ? MappersIn(view->GetRenderer()) : Mappers();
    if (LatestOf(mappers) > LatestOf(found)) {
      found = mappers;
    }
  }
  return found;
}

/// Why the float picture of `mapper` is not the one in `screenshot`; empty when it is.
std::string WhyAnother(vtkINRVolumeMapper* mapper, vtkImageData* screenshot)
{
  if (mapper->GetHasPiece()) {
    return "This process has drawn a piece of the volume, and others the rest; save an OpenEXR "
           "file "
           "in a single process.";
  }
  int drawn[2];
  mapper->GetFrameSize(drawn);
  const int* wanted = screenshot->GetDimensions();
  if (drawn[0] == wanted[0] && drawn[1] == wanted[1]) {
    return {};
  }
  const auto size = [](const int* pixels) {
    return std::to_string(pixels[0]) + " x " + std::to_string(pixels[1]);
  };
  return "The picture of " + size(wanted) + " pixels was put together from parts, the last of " +
         size(drawn) +
         "; save a single view, in no more pixels than it has (make the window larger, or set "
         "ViewSize in a script).";
}

} // namespace

void vtkINREXRWriter::Fail(const std::string& problem)
{
  this->SetErrorCode(vtkErrorCode::UserError);
  vtkErrorMacro(<< problem);
}

void vtkINREXRWriter::Write()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkImageData* screenshot = this->GetInput();
  const Mappers mappers = MappersOfScreenshot();
  if (!screenshot || !this->FileName) {
    this->Fail("An OpenEXR file takes a screenshot and a file name.");
  } else if (mappers.size() != 1) {
    this->Fail("The view shows " + std::to_string(mappers.size()) +
               " INR volumes drawn by this process; an OpenEXR file takes the picture of one.");
  } else if (const std::string problem = WhyAnother(mappers[0], screenshot); !problem.empty()) {
    this->Fail(problem);
  } else if (!mappers[0]->WriteEXR(this->FileName)) {
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError); // the mapper has said why
  }
}
