// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRVolumeRepresentation
 * @brief ParaView's representation "INR Volume": an INR drawn by vtkINRVolumeMapper
 *
 * Takes what INRReader produces and draws it at its native resolution, whatever grid the reader
 * presents to filters. Colour, opacity and placement are those of ParaView's own volume
 * representation. The data never leave the process that has them: where that is not the process
 * that draws, the outline is shown. A colouring that leaves the picture blank is reported once.
 * Pictures are not refined while an animation plays or a modal dialog is open.
 */
#ifndef vtkINRVolumeRepresentation_h
#define vtkINRVolumeRepresentation_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkImageVolumeRepresentation.h"
#include "vtkNew.h" // for Status

#include <memory> // for Client
#include <string> // for LastProblem

class vtkINRStatusActor;
class vtkINRVolumeMapper;

namespace inr {
class ClientWatch;
}

class VTKINRREPRESENTATIONS_EXPORT vtkINRVolumeRepresentation : public vtkImageVolumeRepresentation
{
public:
  static vtkINRVolumeRepresentation* New();
  vtkTypeMacro(vtkINRVolumeRepresentation, vtkImageVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* in,
                         vtkInformation* out) override;

  /// Whether a text in the view's corner says how far the picture is; see vtkINRStatusActor.
  /// Default off.
  void SetShowStatus(bool on);
  void SetVisibility(bool on) override;

  ///@{
  /// Forwarded to vtkINRVolumeMapper, where they are documented.
  void SetRenderMode(int mode);
  void SetSamplesPerPixel(int paths);
  void SetScatteringAlbedo(double albedo);
  void SetAnisotropy(double meanCosine);
  void SetMaximumBounces(int bounces);
  void SetAmbientLight(double red, double green, double blue);
  void SetSampleDistance(double voxels);
  void SetAdaptiveSampling(bool on);
  void SetLevelOfDetailScale(double scale);
  void SetCacheMode(int mode);
  void SetCacheSize(int mebibytes);
  void SetCachePrecision(int precision);
  void SetBrickSize(int voxels);
  void SetMaximumRequests(int bricks);
  void SetPriorityRanking(bool on);
  void SetPreloading(bool on);
  void SetStillTimeLimit(double seconds);
  void SetNumberOfThreads(int threads);
  void SetSeed(int seed);
  void SetDeterministic(bool on);
  void SetSampleChannels(bool on);
  bool GetConverged();
  double GetCacheHitRate();
  double GetCacheUsed();
  double GetFrameTime();
  const char* GetBackendInUse();
  ///@}

protected:
  vtkINRVolumeRepresentation();
  ~vtkINRVolumeRepresentation() override;

  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;

private:
  vtkINRVolumeRepresentation(const vtkINRVolumeRepresentation&) = delete;
  void operator=(const vtkINRVolumeRepresentation&) = delete;

  vtkINRVolumeMapper* GetMapper();
  void UpdateStatus();
  void ForgetOutlines();
  void DeliverOutline(vtkInformation* in, vtkInformation* out);
  std::string WhyBlank();
  void ReportColouring();
  void OnRefine(vtkObject* mapper, unsigned long event, void* mayRefine);

  std::unique_ptr<inr::ClientWatch> Client;
  std::string LastProblem;
  vtkNew<vtkINRStatusActor> Status;
  bool ShowStatus = false;
};

#endif
