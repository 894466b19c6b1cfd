# SPDX-License-Identifier: BSD-3-Clause
"""Volumes as implicit neural representations, for VTK in Python (with or without ParaView).

    from inrvolume import vtkINRReader, vtkINRVolumeMapper
"""
from inrvolume.vtkINRReaders import (
    vtkINRContour,
    vtkINRDecode,
    vtkINRReader,
    vtkINRSlice,
    vtkINRWriter,
)

try:
    from inrvolume.vtkINRMapper import vtkINRVolumeMapper
except ImportError as error:
    # A Python without VTK's rendering modules still reads, writes and decodes.
    _no_mapper = error  # why, for whoever asks for it

    def __getattr__(name):
        if name == "vtkINRVolumeMapper":
            raise ImportError(f"inrvolume cannot draw here: {_no_mapper}") from _no_mapper
        raise AttributeError(f"module 'inrvolume' has no attribute '{name}'")
