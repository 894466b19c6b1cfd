// SPDX-License-Identifier: BSD-3-Clause
#include "vtkINREXRWriter.h"

#include "Core/Image/Exr.h"
#include "StillRenders.h"
#include "vtkErrorCode.h"
#include "vtkINRLODVolume.h"
#include "vtkINRVolumeMapper.h"
#include "vtkImageData.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindow.h" // for VTK_STEREO_LEFT
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSaveScreenshotProxy.h"
#include "vtkVector.h"
#include "vtkVolume.h"
#include "vtkVolumeCollection.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkINREXRWriter);

namespace {

/// The INRs that a view shows.
std::vector<vtkINRLODVolume*> ShownBy(vtkSMRenderViewProxy* view)
{
  std::vector<vtkINRLODVolume*> shown;
  vtkVolumeCollection* volumes = view->GetRenderer()->GetVolumes();
  vtkCollectionSimpleIterator place;
  volumes->InitTraversal(place);
  while (vtkVolume* next = volumes->GetNextVolume(place)) {
    auto* volume = vtkINRLODVolume::SafeDownCast(next);
    if (volume && volume->GetVisibility() && volume->GetShownMTime() > 0) {
      shown.push_back(volume);
    }
  }
  return shown;
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

/// Why a picture of so many pixels is none that a screenshot of `wanted` shows; empty where it is.
std::string WhyOtherSize(const int* drawn, const int* wanted)
{
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

/// Why the float picture of `mapper` is not the one in `screenshot`; empty when it is.
std::string WhyAnother(vtkINRVolumeMapper* mapper, vtkImageData* screenshot)
{
  if (mapper->GetHasPiece()) {
    return "This process has drawn a piece of the volume, and others the rest; save an OpenEXR "
           "file in a single process, or in a client of theirs.";
  }
  int drawn[2];
  mapper->GetFrameSize(drawn);
  return WhyOtherSize(drawn, screenshot->GetDimensions());
}

/// Whether the latest picture is that of the second of two eyes, which ParaView draws one after the
/// other and writes side by side, as colours, or into two files; between screenshots of one eye
/// each it switches stereo off.
bool IsOfBothEyes(const inr::StillRender& latest)
{
  const inr::StillRender& before = inr::StillRenderBefore();
  return latest.sameStereo && latest.stereoType == VTK_STEREO_RIGHT &&
         before.stereoType == VTK_STEREO_LEFT && before.view == latest.view;
}

/// Why a screenshot in stereo has no float picture; empty when it has one, or is not in stereo.
std::string WhyNoStereo(const inr::StillRender& latest, bool drawnHere)
{
  const bool ofBoth = IsOfBothEyes(latest);
  const bool ofOne = latest.stereoType == VTK_STEREO_LEFT || latest.stereoType == VTK_STEREO_RIGHT;
  if (latest.stereoType == 0 || (ofOne && !ofBoth && drawnHere)) {
    return {};
  }
  return drawnHere
             ? "An OpenEXR file has the picture of one eye; save \"Left Eye Only\" and \"Right "
               "Eye Only\" one after the other."
             : "A server's picture in stereo has 8 bits only; save an OpenEXR file without "
               "stereo.";
}

/// What there is of a volume that is out of sight.
void WriteNothing(const char* file, const int* size, bool withSamples)
{
  const inr::Image rgba(size[0], size[1], 4);
  inr::Image depth(size[0], size[1], 1);
  std::fill(depth.pixels.begin(), depth.pixels.end(), 1.0f);
  inr::Image samples;
  if (withSamples) {
    samples = inr::Image(size[0], size[1], 2);
    for (std::size_t k = 1; k < samples.pixels.size(); k += 2) {
      samples.pixels[k] = -1; // no level
    }
  }
  inr::WriteExr(file, rgba, depth, samples);
}

} // namespace

void vtkINREXRWriter::WatchView(vtkSMViewProxy* view) { inr::WatchStillRenders(view); }

void vtkINREXRWriter::Fail(const std::string& problem)
{
  this->SetErrorCode(vtkErrorCode::UserError);
  vtkErrorMacro(<< problem);
}

void vtkINREXRWriter::Write()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkImageData* screenshot = this->GetInput();
  if (!screenshot || !this->FileName) {
    this->Fail("An OpenEXR file takes a screenshot and a file name.");
    return;
  }
  // A screenshot is drawn right before it is written.
  const inr::StillRender& latest = inr::LatestStillRender();
  auto* view = vtkSMRenderViewProxy::SafeDownCast(latest.view);
  const std::vector<vtkINRLODVolume*> shown =
      view ? ShownBy(view) : std::vector<vtkINRLODVolume*>();
  if (vtkINRLODVolume::GetLatestShownMTime() > latest.time) {
    this->Fail(
        "A view that ParaView does not list by itself has drawn an INR volume, such as a part "
        "of a comparative view, and this may be its picture; save a render view, registered "
        "under \"views\".");
    return;
  }
  if (shown.size() != 1) {
    const std::string parts =
        shown.empty() ? WhyOtherSize(latest.size, screenshot->GetDimensions()) : std::string();
    this->Fail(!parts.empty() ? parts
                              : "The view shows " + std::to_string(shown.size()) +
                                    " INR volumes; an OpenEXR file takes the picture of one.");
    return;
  }
  const bool drawnHere = shown[0]->GetDrawnHere();
  const std::string whyNoStereo = WhyNoStereo(latest, drawnHere);
  if (!whyNoStereo.empty()) {
    this->Fail(whyNoStereo);
  } else if (drawnHere) {
    this->WriteFrom(shown[0], screenshot);
  } else {
    const DrawnHere here(view);
    const int* size = screenshot->GetDimensions();
    vtkSMSaveScreenshotProxy::CaptureImage(view, vtkVector2i(size[0], size[1]));
    this->WriteFrom(shown[0], screenshot);
  }
}

void vtkINREXRWriter::WriteFrom(vtkINRLODVolume* volume, vtkImageData* screenshot)
{
  auto* mapper =
      volume->GetDrawnHere() ? vtkINRVolumeMapper::SafeDownCast(volume->GetMapper()) : nullptr;
  if (mapper && !volume->GetDrawn() && !mapper->GetHasPiece()) {
    this->WriteOutOfSight(*mapper, screenshot);
  } else if (mapper && mapper->GetImageReduction() == 0) {
    const std::string why = mapper->GetWhyNotDrawn();
    this->Fail("The volume is not in the picture. " +
               (why.empty() ? "It was not drawn to its end." : why));
  } else if (!mapper) {
    this->Fail("This process cannot draw the view, and a server's picture has 8 bits only; hide "
               "what has to be drawn by the server, such as other volumes.");
  } else if (const std::string problem = WhyAnother(mapper, screenshot); !problem.empty()) {
    this->Fail(problem);
  } else if (!mapper->WriteEXR(this->FileName)) {
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError); // the mapper has said why
  }
}

void vtkINREXRWriter::WriteOutOfSight(vtkINRVolumeMapper& mapper, vtkImageData* screenshot)
{
  const int* wanted = screenshot->GetDimensions();
  const std::string problem = WhyOtherSize(inr::LatestStillRender().size, wanted);
  if (!problem.empty()) { // the volume may be in another part
    this->Fail(problem);
    return;
  }
  try {
    WriteNothing(this->FileName, wanted, mapper.GetSampleChannels());
  } catch (const std::exception& failure) {
    this->Fail(failure.what());
  }
}
