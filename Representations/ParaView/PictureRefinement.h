// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ClientWatch.h"

class vtkINRVolumeMapper;
class vtkObject;
class vtkPVRenderView;

namespace inr {

/// When pictures of a representation are made again that are not complete: not while an animation
/// plays, a modal dialog is open or another view is turned, and of those that a render server
/// draws, when the client says so that shows them.
class PictureRefinement
{
public:
  /// `mapper` has to outlive it.
  explicit PictureRefinement(vtkINRVolumeMapper& mapper);
  ~PictureRefinement();
  PictureRefinement(const PictureRefinement&) = delete;
  PictureRefinement& operator=(const PictureRefinement&) = delete;

  /// Before a picture of the view is drawn.
  void begin(vtkPVRenderView& view);

  ///@{
  /// In a server's processes, by the client; see vtkINRVolumeRepresentation.
  double pauseOfAll();
  /// Whether a picture goes on, of this process or another.
  bool goesOn() const { return this->GoesOn; }
  ///@}
  ///@{
  /// The client's part.
  static bool isPossible(vtkPVRenderView* view);
  void later(vtkPVRenderView* view, double pause);
  ///@}

private:
  void onRefine(vtkObject* mapper, unsigned long event, void* mayRefine);

  ClientWatch Client;
  vtkINRVolumeMapper& Mapper;
  unsigned long Observer;
  bool GoesOn = false;
};

} // namespace inr
