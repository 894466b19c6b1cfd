// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkSMProxy;

/// Whether the type of such a representation is "INR Volume".
bool INRIsShown(vtkSMProxy* representation);
/// Whether it is ParaView's own "Volume".
bool INRIsStockVolume(vtkSMProxy* representation);

/// Hides what ParaView hides for "Volume", too: opacity, sizes and shine of surfaces, which do
/// nothing to a volume.
void INRHideSurfaceSettings(vtkSMProxy* representation);

/// Passes on what was changed in the panel under a name of its own to the stock property: scripts
/// and state files then find the same value under both names.
void INRPassOn(vtkSMProxy* representation, const char* changed);

/// The same of all that may have been changed while nothing was passed on, as something else was
/// shown; but for the unit distance, see INRGiveFirstLook.
void INRPassAllOn(vtkSMProxy* representation);

/// Sets BlendMode, which both kinds of volume share, to Composite where it is one that the panel of
/// the present kind cannot show. To be called when the one becomes the other.
void INROfferBlendMode(vtkSMProxy* representation);
