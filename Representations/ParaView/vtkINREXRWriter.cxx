// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINREXRWriter.h"

#include "vtkErrorCode.h"
#include "vtkINRLODVolume.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkObjectFactory.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSaveScreenshotProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkVector.h"
#include "vtkVolume.h"
#include "vtkVolumeCollection.h"

#include <algorithm>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkINREXRWriter);

namespace {

/// What a view shows of INRs.
struct ShownVolumes
{
  vtkSMViewProxy* view = nullptr;
  std::vector<vtkINRLODVolume*> volumes;

  vtkMTimeType latest() const
  {
    vtkMTimeType time = 0;
    for (const vtkINRLODVolume* volume : this->volumes) {
      time = std::max(time, volume->GetShownMTime());
    }
    return time;
  }
};

ShownVolumes ShownBy(vtkSMRenderViewProxy* view)
{
  ShownVolumes shown;
  shown.view = view;
  vtkVolumeCollection* volumes = view->GetRenderer()->GetVolumes();
  vtkCollectionSimpleIterator place;
  volumes->InitTraversal(place);
  while (vtkVolume* next = volumes->GetNextVolume(place)) {
    auto* volume = vtkINRLODVolume::SafeDownCast(next);
    if (volume && volume->GetVisibility() && volume->GetShownMTime() > 0) {
      shown.volumes.push_back(volume);
    }
  }
  return shown;
}

/// Of the view that was drawn last: a screenshot is drawn right before it is written.
ShownVolumes ShownInScreenshot()
{
  ShownVolumes found;
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
    const ShownVolumes shown = view ? ShownBy(view) : ShownVolumes();
    if (shown.latest() > found.latest()) {
      found = shown;
    }
  }
  return found;
}

/// While it exists, what a view shows is drawn by this process: a server hands over what is to be
/// drawn instead of the picture, unless a representation will not have that.
class DrawnHere
{
public:
  explicit DrawnHere(vtkSMViewProxy* view) : View(view), Threshold(view, "RemoteRenderThreshold")
  {
    this->Before = this->Threshold.GetAsDouble();
    this->set(AnySize);
  }
  ~DrawnHere() { this->set(this->Before); }
  DrawnHere(const DrawnHere&) = delete;
  DrawnHere& operator=(const DrawnHere&) = delete;

private:
  static constexpr double AnySize = 1e12; ///< MiB

  void set(double threshold)
  {
    this->Threshold.Set(threshold);
    this->View->UpdateVTKObjects();
  }

  vtkSMViewProxy* View;
  vtkSMPropertyHelper Threshold;
  double Before;
};

/// Why the float picture of `mapper` is not the one in `screenshot`; empty when it is.
std::string WhyAnother(vtkINRVolumeMapper* mapper, vtkImageData* screenshot)
{
  if (mapper->GetHasPiece()) {
    return "This process has drawn a piece of the volume, and others the rest; save an OpenEXR "
           "file in a single process, or in a client of theirs.";
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
  const ShownVolumes shown = ShownInScreenshot();
  if (!screenshot || !this->FileName) {
    this->Fail("An OpenEXR file takes a screenshot and a file name.");
  } else if (shown.volumes.size() != 1) {
    this->Fail("The view shows " + std::to_string(shown.volumes.size()) +
               " INR volumes; an OpenEXR file takes the picture of one.");
  } else if (shown.volumes[0]->GetDrawnHere()) {
    this->WriteFrom(shown.volumes[0], screenshot);
  } else {
    const DrawnHere here(shown.view);
    const int* size = screenshot->GetDimensions();
    vtkSMSaveScreenshotProxy::CaptureImage(shown.view, vtkVector2i(size[0], size[1]));
    this->WriteFrom(shown.volumes[0], screenshot);
  }
}

void vtkINREXRWriter::WriteFrom(vtkINRLODVolume* volume, vtkImageData* screenshot)
{
  auto* mapper =
      volume->GetDrawnHere() ? vtkINRVolumeMapper::SafeDownCast(volume->GetMapper()) : nullptr;
  if (!mapper || mapper->GetImageReduction() == 0) {
    this->Fail("This process cannot draw the view, and a server's picture has 8 bits only; hide "
               "what has to be drawn by the server, such as other volumes.");
  } else if (const std::string problem = WhyAnother(mapper, screenshot); !problem.empty()) {
    this->Fail(problem);
  } else if (!mapper->WriteEXR(this->FileName)) {
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError); // the mapper has said why
  }
}
