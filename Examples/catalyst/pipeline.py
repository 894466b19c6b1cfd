# SPDX-License-Identifier: BSD-3-Clause
# script-version: 2.0
"""What Catalyst does with the simulation's grid: a model file every so many steps.

INR_PLUGIN tells where INRVolume.so is (in the build folder), INR_EVERY the steps between two files (500), INR_STEPS the
steps of training for each (1000), INR_OUTPUT the folder (here)."""
import os

from paraview import catalyst
from paraview.simple import CreateExtractor, LoadPlugin, TrivialProducer

BUILT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "build", "lib",
                     "paraview-5.11", "plugins", "INRVolume", "INRVolume.so")
LoadPlugin(os.environ.get("INR_PLUGIN", BUILT), remote=False, ns=globals())

grid = TrivialProducer(registrationName="grid")
model = CreateExtractor("INR", grid, registrationName="model")
model.Trigger = "TimeStep"
model.Trigger.Frequency = int(os.environ.get("INR_EVERY", 500))
model.Writer.FileName = "grid_{timestep:06d}.inr"
model.Writer.Scalars = ["POINTS", "V"]
model.Writer.MaximumSteps = int(os.environ.get("INR_STEPS", 1000))

options = catalyst.Options()
options.ExtractsOutputDirectory = os.environ.get("INR_OUTPUT", ".")
