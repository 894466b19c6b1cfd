# SPDX-License-Identifier: BSD-3-Clause
"""Compares a picture that was saved in ParaView's window with the committed one.

    compare.py PICTURE.png BASELINE.png
"""
import sys

import numpy as np
from PIL import Image
from similarity import BASELINE_FLOOR, ssim

picture, baseline = (np.asarray(Image.open(path).convert("RGB")) for path in sys.argv[1:])
similarity = ssim(picture, baseline)
print(f"SSIM of {sys.argv[1]} with its baseline: {similarity:.4f}")
sys.exit(0 if similarity >= BASELINE_FLOOR else f"{sys.argv[1]}: SSIM is below {BASELINE_FLOOR}")
