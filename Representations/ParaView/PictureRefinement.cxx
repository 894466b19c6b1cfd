// SPDX-License-Identifier: BSD-3-Clause
#include "PictureRefinement.h"

#include "Readers/Common/Processes.h"
#include "vtkCommunicator.h"
#include "vtkINRVolumeMapper.h"
#include "vtkMultiProcessController.h"
#include "vtkPVRenderView.h"

namespace inr {

namespace {

/// Whether the view is drawn for a selection, which it tells subclasses only.
bool IsSelecting(vtkPVRenderView& view)
{
  struct Subclass : vtkPVRenderView
  {
    static bool isSelecting(vtkPVRenderView& view)
    {
      return (view.*&Subclass::GetMakingSelection)();
    }
  };
  return Subclass::isSelecting(view);
}

} // namespace

PictureRefinement::PictureRefinement(vtkINRVolumeMapper& mapper)
    : Mapper(mapper), Observer(mapper.AddObserver(vtkINRVolumeMapper::RefineEvent, this,
                                                  &PictureRefinement::onRefine))
{}

PictureRefinement::~PictureRefinement() { this->Mapper.RemoveObserver(this->Observer); }

void PictureRefinement::begin(vtkPVRenderView& view)
{
  const bool isSelecting = IsSelecting(view);
  this->GoesOn = this->GoesOn && isSelecting;
  this->Mapper.SetForSelection(isSelecting);
  this->Client.update(view);
}

double PictureRefinement::pauseOfAll()
{
  const double own = this->Mapper.TakeRefinementPause();
  double longest = own;
  vtkMultiProcessController* processes = vtkMultiProcessController::GetGlobalController();
  if (AreSeveral(processes)) {
    processes->AllReduce(&own, &longest, 1, vtkCommunicator::MAX_OP);
  }
  this->GoesOn = longest > 0;
  return longest;
}

bool PictureRefinement::isPossible(vtkPVRenderView* view)
{
  return view && vtkINRVolumeMapper::MayRefine(view->GetRenderWindow());
}

void PictureRefinement::later(vtkPVRenderView* view, double pause)
{
  if (view) {
    this->Client.update(*view);
    this->Mapper.RefineLater(view->GetRenderWindow(), pause);
  }
}

void PictureRefinement::onRefine(vtkObject*, unsigned long, void* mayRefine)
{
  if (this->Client.isBusy()) {
    *static_cast<bool*>(mayRefine) = false;
  }
}

} // namespace inr
