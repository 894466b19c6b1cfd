// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

class vtkDataSet;
class vtkImageData;
class vtkMatrix4x4;
class vtkMultiProcessController;
class vtkRenderer;
class vtkVolume;
class vtkVolumeProperty;

namespace inr {

/// Has all processes of a parallel server draw what `renderer` shows, whether that is in their
/// pictures or not: where they wait for each other, none may stay away. Call before each picture.
void DrawEverywhere(vtkRenderer* renderer);

/// The processes whose pictures are being composed in order of depth, that first whose lies over
/// the others; empty where none are, or not as one picture. They need not ask each other.
std::vector<int> ProcessOrder(vtkRenderer* renderer);

/// Whether it can be seen: a scale of zero makes it flat.
bool HasSize(vtkVolume* volume);

/// The INR volumes that `renderer` shows, in the same order in all processes; none that is
/// withheld.
std::vector<vtkVolume*> ShownVolumes(vtkRenderer* renderer);

/// Where an axis of an image in a volume with that matrix leads in the world, as long as a unit of
/// it is there.
void DirectionInWorld(int axis, vtkImageData& image, vtkMatrix4x4& matrix, double way[4]);

/// Whether the axes of an image in a volume with that matrix are not the world's, so that boxes
/// along these around its pieces meet. Not of no image.
bool IsTurned(vtkImageData* image, vtkMatrix4x4* matrix);

/// Whether lights may make a volume brighter than it is opaque: processes' pictures are composed in
/// 8 bits, which overflow then where pieces lie behind each other.
bool MayOutshineWhite(vtkVolumeProperty* property, vtkRenderer* renderer);

/// Whether processes' pictures are composed to one that they could as well draw parts of: pieces in
/// front of each other are rounded to 8 bits each, and are off by up to 3 of 255 for that. On tile
/// displays and in caves there is no such picture.
bool ComposesOnePicture(vtkRenderer* renderer);

/// Whether each of the processes has something to draw. All of them must ask, outside of drawing:
/// there one without anything does not know its turn among several volumes.
bool AllHave(vtkMultiProcessController* processes, bool something);

/// Whether those of the processes that have data have the same model, as far as its grid, range and
/// some thousands of its parameters tell, or none: in the point array `name`, which may be null, or
/// else in the first array that has one. All of them must ask, as above.
bool HaveSameModel(vtkMultiProcessController* processes, vtkDataSet* data, const char* name);

} // namespace inr
