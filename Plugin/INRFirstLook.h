// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Called by ParaView when the plugin is loaded. From then on, the first time that a representation
/// is switched to "INR Volume" it is coloured by its data and gets a unit distance for its opacity,
/// as ParaView itself does for "Volume" and for no representation type that it does not know. Does
/// nothing in a server.
void INRWatchRepresentations();
