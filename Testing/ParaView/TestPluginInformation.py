# SPDX-License-Identifier: BSD-3-Clause
"""The plugin manager can say which build is loaded."""
import os

from paraview.modules.vtkRemotingCore import vtkPVPluginsInformation, vtkPVPluginTracker
from pvtest import check, load_plugin

load_plugin()
# What the plugin manager asks for.
plugins = vtkPVPluginsInformation()
plugins.CopyFromObject(vtkPVPluginTracker.GetInstance())
found = [i for i in range(plugins.GetNumberOfPlugins()) if plugins.GetPluginName(i) == "INRVolume"]
check(len(found) == 1, "the plugin is not listed")
check(plugins.GetPluginLoaded(found[0]), "the plugin is not loaded")
check(plugins.GetPluginFileName(found[0]) == os.environ["INR_PLUGIN"], "another file is loaded")
version = plugins.GetPluginVersion(found[0])
print(version, "-", plugins.GetDescription(found[0]))
check(version == os.environ["INR_VERSION_TEXT"], "version is", version)
check("neural" in plugins.GetDescription(found[0]), "no description")
