// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkSMProxy;

/// Colours a representation that is an "INR Volume" by its data and gives it a unit distance for
/// its opacity, as ParaView itself does for "Volume" and for no representation type that it does
/// not know. Leaves what has been set already, and what a state file is being loaded into.
/// `isUnitDistanceStock`: as INRIsUnitDistanceStock said when that was last set.
void INRGiveFirstLook(vtkSMProxy* representation, bool isUnitDistanceStock = false);

/// Whether the unit distance is ParaView's own default by the grid that is there now, of which
/// another grid does not tell: nobody has chosen it.
bool INRIsUnitDistanceStock(vtkSMProxy* representation);

/// To be called when there are other data: looks again where the first look saw none, and colours
/// by the array that is there where the one coloured by is gone, since a reader's ArrayName has
/// changed or another file has come. (Of another time step ParaView does not tell.)
void INRFollowData(vtkSMProxy* representation);
