# SPDX-License-Identifier: BSD-3-Clause
"""How alike two pictures are."""
import numpy as np

# Of ParaView's pictures with the committed ones: leaves room for other kernels, which train to
# slightly other parameters, and other versions of Mesa.
BASELINE_FLOOR = 0.95


def box_mean(image, size=7):
    sums = np.cumsum(np.cumsum(np.pad(image, ((1, 0), (1, 0), (0, 0))), axis=0), axis=1)
    total = sums[size:, size:] - sums[:-size, size:] - sums[size:, :-size] + sums[:-size, :-size]
    return total / size**2


def ssim(a, b):
    """Mean structural similarity (Wang et al., IEEE TIP 2004) of pictures of (rows, columns, 3) values in
    [0, 1], or 8 bits; uniform 7x7 window."""
    assert a.shape == b.shape and a.shape[2] == 3, (a.shape, b.shape)
    a, b = (image / 255.0 if image.dtype == np.uint8 else image for image in (a, b))
    mean_a, mean_b = box_mean(a), box_mean(b)
    variance_a = box_mean(a * a) - mean_a**2
    variance_b = box_mean(b * b) - mean_b**2
    covariance = box_mean(a * b) - mean_a * mean_b
    c1, c2 = 0.01**2, 0.03**2
    return np.mean(
        (2 * mean_a * mean_b + c1)
        * (2 * covariance + c2)
        / ((mean_a**2 + mean_b**2 + c1) * (variance_a + variance_b + c2))
    )
