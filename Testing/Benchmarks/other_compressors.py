# SPDX-License-Identifier: BSD-3-Clause
"""What others make of the same volumes: (name, ratio to the raw bytes, PSNR in dB)."""
import numpy
import zfpy

# TTHRESH and SZ3 are no packages of Debian: these were measured before, with their command line
# programs, on this kind of machine.
GIVEN = {
    "les_wmag91": (("TTHRESH", 354, 29.7), ("TTHRESH", 83, 36.4), ("TTHRESH", 30, 42.8),
                   ("SZ3", 294, 30.1), ("SZ3", 51, 36.7), ("SZ3", 21, 45.2)),
    "rm_mixing": (("TTHRESH", 160, 30.4), ("TTHRESH", 59, 36.7), ("TTHRESH", 26, 42.8),
                  ("SZ3", 80, 31.8), ("SZ3", 38, 40.6), ("SZ3", 20, 49.6)),
    "heptane_fire": (("TTHRESH", 1894, 29.1), ("TTHRESH", 322, 36.3), ("TTHRESH", 92, 42.5),
                     ("SZ3", 371, 36.7), ("SZ3", 159, 45.5)),
}

# Bounds as fractions of the range, far above the errors that zfp then makes; and bits a value.
TOLERANCES = [2.0 ** power for power in range(6, -3, -1)]
RATES = (0.5, 1, 2)


def psnr(voxels, decoded):
    """In dB; the peak is the voxels' range."""
    voxels = voxels.astype(numpy.float64)
    error = numpy.sqrt(numpy.mean((voxels - decoded) ** 2))
    return float(20 * numpy.log10((voxels.max() - voxels.min()) / error))


def zfp_stream(voxels, **mode):
    """zfp takes floats and 32-bit integers; small ones become floats."""
    return zfpy.compress_numpy(voxels if voxels.dtype.kind == "f" else
                               voxels.astype(numpy.float32), **mode)


def zfp(voxels):
    """zfp with a bound on the error, where it does best, and at a fixed rate, the only way that a
    part of a stream can be decompressed."""
    span = float(voxels.max()) - float(voxels.min())
    modes = [("zfp", {"tolerance": span * tolerance}) for tolerance in TOLERANCES]
    modes += [("zfp, fixed rate", {"rate": rate}) for rate in RATES]
    for name, mode in modes:
        stream = zfp_stream(voxels, **mode)
        yield name, voxels.nbytes / len(stream), psnr(voxels, zfpy.decompress_numpy(stream))
