// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRVolumeRepresentation
 * @brief ParaView's representation "INR Volume": an INR drawn by vtkINRVolumeMapper
 *
 * Takes what INRReader produces and draws it at its native resolution, whatever grid the reader
 * presents to filters. Colour, opacity and placement are those of ParaView's own volume
 * representation. The values never leave the process that has them. Where that is not the process
 * that draws, the model is sent there, once, however many processes have it. A colouring that
 * leaves the picture blank is reported once. Pictures are not refined while an animation plays, a
 * modal dialog is open or another view is turned.
 */
#ifndef vtkINRVolumeRepresentation_h
#define vtkINRVolumeRepresentation_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkImageVolumeRepresentation.h"
#include "vtkNew.h" // for Carrier

#include <memory> // for Refinement
#include <string> // for LastProblem

class vtkINRLODVolume;
class vtkINRStatusActor;
class vtkINRVolumeMapper;
class vtkMultiProcessController;
class vtkPolyData;

namespace inr {
class ModelDelivery;
class PictureRefinement;
class VolumePlacement;
struct MachineShare;
} // namespace inr

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
  void SetBackend(int backend);
  void SetSamplesPerPixel(int paths);
  void SetScatteringAlbedo(double albedo);
  void SetScatteringAnisotropy(double meanCosine); // SetAnisotropy is for ParaView's own volumes
  void SetMaximumBounces(int bounces);
  void SetAmbientLight(double red, double green, double blue);
  /// Values below 0 stand for none that is known yet: what was there before stays.
  void SetScalarOpacityUnitDistance(double distance);
  void SetSampleDistance(double voxels);
  void SetAdaptiveSampling(bool on);
  void SetPreIntegration(bool on);
  void SetLevelOfDetailScale(double scale);
  void SetErrorTolerance(double tolerance);
  void SetCacheMode(int mode);
  void SetCacheSize(int mebibytes);
  void SetInferencePrecision(int precision);
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

  /// Whether this process has something to draw.
  bool DrawsHere();

  ///@{
  /// For pictures that a render server draws and a client shows. In the server's processes, by the
  /// client: whether it has pictures made again that are not complete, and, of all of them
  /// together, how many seconds after the latest one; 0: it is complete. Asked of all processes at
  /// once, and once of each picture.
  void SetShownElsewhere(bool on);
  double GetRefinementPause();
  ///@}
  /// In processes that draw, by the client before a still picture; see vtkINRVolumeMapper.
  void SetHurried(bool on);
  ///@{
  /// The client's part: whether its window may be refined, and to have it drawn again.
  bool MayRefine();
  void RefineLater(double pause);
  ///@}

  /// In place of the superclass', which would copy every point of the presented grid: a model holds
  /// one array, whose opacities no other one can give. Warns once when that is asked for.
  void SetUseSeparateOpacityArray(bool wants) { this->WantsOpacityArray = wants; }

protected:
  vtkINRVolumeRepresentation();
  ~vtkINRVolumeRepresentation() override;

  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;

private:
  vtkINRVolumeRepresentation(const vtkINRVolumeRepresentation&) = delete;
  void operator=(const vtkINRVolumeRepresentation&) = delete;

  vtkINRLODVolume* GetVolume();
  vtkINRVolumeMapper* GetMapper();
  void UpdateStatus();
  void FindOthers();
  const char* GetColorArrayName(); ///< null for none
  void ForgetOutlines();
  void Deliver(vtkInformation* in, vtkInformation* out);
  void TakeDelivery(vtkInformation* in);
  void ReportShared(bool drawsAll);
  void UpdateMapper();
  void DrawTogether();
  bool IsShown();                  ///< else there are pictures from before only
  bool IsGroup();                  ///< of data sets
  std::string WhyNothingIsDrawn(); ///< by this process; empty where something is
  void ReportProblem();
  void ReportOpacityArray();

  bool WantsOpacityArray = false;
  int NumberOfThreads = 0;
  int CacheSize = 0;                        ///< MiB
  std::unique_ptr<inr::MachineShare> Share; ///< for 0 of these; null = not known yet
  std::unique_ptr<inr::PictureRefinement> Refinement;
  std::unique_ptr<inr::ModelDelivery> Model;
  vtkNew<vtkPolyData> Carrier; ///< of the model to where it is drawn, if that is elsewhere
  std::unique_ptr<inr::VolumePlacement> Placement;
  int OutlinePort = 1; ///< of what is delivered; the model has 0
  int BoundsPort = 2;  ///< the same, with the bounds that the view sorts by
  std::string LastProblem;
  vtkMultiProcessController* Others = nullptr; ///< processes that draw a part each, if several do
  bool Differ = false; ///< the processes' models, each of which would draw another picture
  vtkNew<vtkINRStatusActor> Status;
  bool ShowStatus = false;
  bool SharedReported = false;
};

#endif
