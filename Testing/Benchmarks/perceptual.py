# SPDX-License-Identifier: BSD-3-Clause
"""LPIPS between pictures (Zhang, Isola, Efros, Shechtman and Wang, "The Unreasonable Effectiveness of
Deep Features as a Perceptual Metric", CVPR 2018) by the package "lpips" of PyPI, with AlexNet.

Only where the package and AlexNet's weights are on this machine: nothing is ever fetched.
"""
import hashlib
import struct
from pathlib import Path


class Absent(Exception):
    """Says why it cannot be had here."""


def weights_file():
    """Where torchvision looks for AlexNet's weights before it would fetch them."""
    import torch
    from torchvision import models
    name = models.AlexNet_Weights.IMAGENET1K_V1.url.rsplit("/", 1)[1]
    return Path(torch.hub.get_dir()) / "checkpoints" / name


def require_weights(path, genuine):
    """The file's name ends with the first digits of its SHA-256."""
    if not path.is_file():
        raise Absent(f"there is no {path}, which holds AlexNet's weights")
    wanted = path.stem.rsplit("-", 1)[1]
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if genuine and not found.startswith(wanted):
        raise Absent(f"{path} does not hold AlexNet's weights: its SHA-256 is {found[:8]}...")


class Lpips:
    """Throws Absent. `genuine`: whether the weights have to be those that the metric is defined with;
    others are for tests of everything else."""

    def __init__(self, genuine=True):
        try:
            import lpips
            import torch
            import torchvision
        except (ImportError, OSError) as error:  # a library of theirs may be missing
            raise Absent(f"the package lpips cannot be imported: {error}") from error
        require_weights(weights_file(), genuine)

        def refuse(url, *unused, **more):
            raise Absent(f"{url} would have to be fetched")

        torch.hub.download_url_to_file = refuse
        self.torch = torch
        try:
            self.network = lpips.LPIPS(net="alex", verbose=False)
        except (RuntimeError, KeyError) as error:
            raise Absent(f"{weights_file()} does not fit: {error}") from error
        self.about = (f"LPIPS with AlexNet, lpips {version('lpips')}, torch {torch.__version__}, "
                      f"torchvision {torchvision.__version__}")

    def distance(self, reference, picture):
        """Of two pictures of height x width x 3 numbers in [0, 1], as a display gets them."""
        import numpy as np

        def tensor(values):
            values = np.clip(np.asarray(values, np.float32), 0, 1) * 2 - 1
            return self.torch.from_numpy(values.transpose(2, 0, 1)[None].copy())

        with self.torch.no_grad():
            return float(self.network(tensor(reference), tensor(picture)))

    def of_file(self, path):
        return self.distance(*read_pair(path))


def version(package):
    from importlib.metadata import PackageNotFoundError
    from importlib.metadata import version as of
    try:
        return of(package)
    except PackageNotFoundError:
        return "of unknown version"


def read_pair(path):
    """Two pictures as bench_tradeoff writes them: width and height as int32, then RGBA floats of
    both, premultiplied, from the lowest row up; laid over black, as a display has them."""
    import numpy as np
    data = Path(path).read_bytes()
    width, height = struct.unpack("<ii", data[:8])
    pictures = np.frombuffer(data, "<f4", offset=8).reshape(2, height, width, 4)[:, ::-1]
    return pictures[0, ..., :3], pictures[1, ..., :3]


def load():
    """The metric, or None; and for the reader of a result file what it is, or why there is none."""
    try:
        metric = Lpips()
    except Absent as why:
        return None, f"absent: {why}"
    return metric, metric.about
