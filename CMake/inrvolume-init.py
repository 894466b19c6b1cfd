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
except ImportError:
    # A Python without VTK's rendering modules still reads, writes and decodes.
    pass
