// SPDX-License-Identifier: BSD-3-Clause
// What vtkINRVolumeRepresentation hands on to its mapper, and what it tells of it.
#include "PictureRefinement.h"
#include "vtkINRLODVolume.h"
#include "vtkINRVolumeMapper.h"
#include "vtkINRVolumeRepresentation.h"

void vtkINRVolumeRepresentation::SetRenderMode(int mode) { this->GetMapper()->SetRenderMode(mode); }

void vtkINRVolumeRepresentation::SetSamplesPerPixel(int paths)
{
  this->GetMapper()->SetSamplesPerPixel(paths);
}

void vtkINRVolumeRepresentation::SetScatteringAlbedo(double albedo)
{
  this->GetMapper()->SetScatteringAlbedo(albedo);
}

void vtkINRVolumeRepresentation::SetScatteringAnisotropy(double meanCosine)
{
  this->GetMapper()->SetAnisotropy(meanCosine);
}

void vtkINRVolumeRepresentation::SetMaximumBounces(int bounces)
{
  this->GetMapper()->SetMaximumBounces(bounces);
}

void vtkINRVolumeRepresentation::SetScalarOpacityUnitDistance(double distance)
{
  if (!(distance < 0)) {
    this->Superclass::SetScalarOpacityUnitDistance(distance);
  }
}

void vtkINRVolumeRepresentation::SetAmbientLight(double red, double green, double blue)
{
  this->GetMapper()->SetAmbientLight(red, green, blue);
}

void vtkINRVolumeRepresentation::SetSampleDistance(double voxels)
{
  this->GetMapper()->SetSampleDistance(voxels);
}

void vtkINRVolumeRepresentation::SetAdaptiveSampling(bool on)
{
  this->GetMapper()->SetAdaptiveSampling(on);
}

void vtkINRVolumeRepresentation::SetPreIntegration(bool on)
{
  this->GetMapper()->SetPreIntegration(on);
}

void vtkINRVolumeRepresentation::SetLevelOfDetailScale(double scale)
{
  this->GetMapper()->SetLevelOfDetailScale(scale);
}

void vtkINRVolumeRepresentation::SetErrorTolerance(double tolerance)
{
  this->GetMapper()->SetErrorTolerance(tolerance);
}

void vtkINRVolumeRepresentation::SetBackend(int backend) { this->GetMapper()->SetBackend(backend); }

void vtkINRVolumeRepresentation::SetCacheMode(int mode) { this->GetMapper()->SetCacheMode(mode); }

void vtkINRVolumeRepresentation::SetCacheSize(int mebibytes) { this->CacheSize = mebibytes; }

void vtkINRVolumeRepresentation::SetInferencePrecision(int precision)
{
  this->GetMapper()->SetInferencePrecision(precision);
}

void vtkINRVolumeRepresentation::SetCachePrecision(int precision)
{
  this->GetMapper()->SetCachePrecision(precision);
}

void vtkINRVolumeRepresentation::SetBrickSize(int voxels)
{
  this->GetMapper()->SetBrickSize(voxels);
}

void vtkINRVolumeRepresentation::SetMaximumRequests(int bricks)
{
  this->GetMapper()->SetMaximumRequests(bricks);
}

void vtkINRVolumeRepresentation::SetPriorityRanking(bool on)
{
  this->GetMapper()->SetPriorityRanking(on);
}

void vtkINRVolumeRepresentation::SetPreloading(bool on) { this->GetMapper()->SetPreloading(on); }

void vtkINRVolumeRepresentation::SetStillTimeLimit(double seconds)
{
  this->GetMapper()->SetStillTimeLimit(seconds);
}

void vtkINRVolumeRepresentation::SetNumberOfThreads(int threads)
{
  this->NumberOfThreads = threads;
}

void vtkINRVolumeRepresentation::SetSeed(int seed) { this->GetMapper()->SetSeed(seed); }

void vtkINRVolumeRepresentation::SetDeterministic(bool on)
{
  this->GetMapper()->SetDeterministic(on);
}

void vtkINRVolumeRepresentation::SetSampleChannels(bool on)
{
  this->GetMapper()->SetSampleChannels(on);
}

void vtkINRVolumeRepresentation::SetShownElsewhere(bool on)
{
  this->GetMapper()->SetShownElsewhere(on);
}

void vtkINRVolumeRepresentation::SetHurried(bool on) { this->GetMapper()->SetHurried(on); }

bool vtkINRVolumeRepresentation::GetConverged()
{
  const bool isComplete = this->GetVolume()->GetOutOfSight() ||
                          (this->GetMapper()->GetConverged() && !this->Refinement->goesOn());
  return this->IsShown() && isComplete;
}

double vtkINRVolumeRepresentation::GetCacheHitRate()
{
  const bool isOutOfSight = this->GetVolume()->GetOutOfSight();
  return this->IsShown() ? (isOutOfSight ? 1.0 : this->GetMapper()->GetCacheHitRate()) : 0.0;
}

double vtkINRVolumeRepresentation::GetCacheUsed() { return this->GetMapper()->GetCacheUsed(); }

double vtkINRVolumeRepresentation::GetFrameTime()
{
  const bool isDrawn = this->IsShown() && !this->GetVolume()->GetOutOfSight();
  return isDrawn ? this->GetMapper()->GetFrameTime() : 0.0;
}

const char* vtkINRVolumeRepresentation::GetBackendInUse()
{
  return this->GetMapper()->GetBackendInUse();
}
