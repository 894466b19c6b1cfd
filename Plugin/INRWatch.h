// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Called by ParaView when the plugin is loaded. From then on, representations that can be an "INR
/// Volume" get a first look (INRFirstLook.h) and a panel of their own (INRPanel.h), and the
/// pictures that views draw are known (vtkINREXRWriter.h). Does nothing in a server.
void INRWatchProxies();
