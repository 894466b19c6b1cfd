# SPDX-License-Identifier: BSD-3-Clause
"""A hash grid and its network in PyTorch, for processors: what against_pytorch.py compares with.

Three ways to encode, all measured there:
- "plain": the table indexed with an array of corners, times the weights, summed: what is commonly
  written, in eager mode;
- "fused": corners and weights by one compiled loop, then embedding_bag with weights, PyTorch's own
  fused gather and sum, in chunks that stay in cache; the fastest found for points anywhere;
- "lattice": only for points on a lattice: each level's corners of the lattice are fetched once and
  interpolated along one axis after the other by matrix products, which leaves little but the
  network; the fastest found for bricks.

Also tried, and slower: compiling gather, sum and network as one (half the rate of "fused" or less),
also around embedding_bag (equal at best); one batch instead of chunks (0.6 to 0.9 of the rate);
inductor's frozen and tuned linear layers instead of plain products (0.5 to 0.98); large pages
(THP_MEM_ALLOC_ENABLE; no difference). In training: embedding_bag's own gradient (0.1 to 0.4 of the
rate), index_add and scatter_add (0.1 to 0.3), everything compiled (0.3 to 0.5), gradients of the
table in a fresh array instead of added in place (0.7 to 0.9), and added by two threads (0.5).
"""
import math

import torch
from torch.nn.functional import embedding_bag

PRIMES = (1, 2654435761, 805459861)


class HashGrid:
    """The model of a ModelFile with `parameters` (a float32 array in the file's order)."""

    def __init__(self, file, parameters):
        matrices, table = file.split(torch.from_numpy(parameters.copy()))
        self.levels, self.features = file.levels, file.features
        self.width = len(self.levels) * self.features
        # Padding's inputs are 0 and only the first output counts.
        matrices[0] = matrices[0][:, :self.width].contiguous()
        matrices[-1] = matrices[-1][:1].contiguous()
        self.matrices, self.table = matrices, table.contiguous()
        self.dense = sum(not hashed for *_, hashed in self.levels)
        self.scales = torch.tensor([level[0] for level in self.levels])
        self.resolutions, self.entries, self.firsts = (
            torch.tensor([level[k] for level in self.levels], dtype=torch.int32)[:, None]
            for k in (1, 2, 3))
        corner = torch.arange(8, dtype=torch.int32)
        self.corner = (corner & 1, corner >> 1 & 1, corner >> 2)
        self.compiled_corners = torch.compile(self.corners, dynamic=False)

    def network(self, encoded):
        for matrix in self.matrices[:-1]:
            encoded = (encoded @ matrix.t()).relu_()
        return encoded @ self.matrices[-1].t()

    def corners(self, positions):
        """Entries and weights of the corners around `positions`: samples x levels x 8."""
        scaled = positions[:, None, :] * self.scales[:, None] + 0.5
        cells = scaled.floor()
        inner = scaled - cells
        at = [cells[..., axis:axis + 1].int() + self.corner[axis] for axis in range(3)]
        dense, hashed = (slice(None, self.dense), slice(self.dense, None))
        entries = torch.cat([self.dense_entries([p[:, dense] for p in at], self.resolutions[dense],
                                                self.entries[dense]),
                             self.hashed_entries([p[:, hashed] for p in at])], 1)
        weights = [torch.where(self.corner[axis] == 1, inner[..., axis:axis + 1],
                               1 - inner[..., axis:axis + 1]) for axis in range(3)]
        return entries + self.firsts, weights[0] * weights[1] * weights[2]

    @staticmethod
    def dense_entries(at, resolution, entries):
        index = at[0] + at[1] * resolution + at[2] * (resolution * resolution)
        return torch.where(index >= entries, index - entries, index)  # less than twice as many

    def hashed_entries(self, at):
        if self.dense == len(self.levels):
            return at[0]  # none
        mask = self.levels[-1][2] - 1  # a power of two: low bits of products come of low bits
        x, y, z = (p * (prime & mask) for p, prime in zip(at, PRIMES))
        return (x ^ y ^ z) & mask

    def encode_plain(self, positions):
        entries, weights = self.corners(positions)
        return (self.table[entries.long()] * weights[..., None]).sum(2).flatten(1)

    def encode_fused(self, positions):
        return self.gather(*self.compiled_corners(positions))

    def gather(self, entries, weights):
        return embedding_bag(entries.view(-1, 8), self.table, mode="sum",
                             per_sample_weights=weights.view(-1, 8)).view(-1, self.width)

    def evaluate_lattice(self, axes, chunk):
        """Values at all points of the lattice of three axes' coordinates, x fastest."""
        size = [len(axis) for axis in reversed(axes)]
        encoded = torch.empty(self.width, *size)
        for level in range(len(self.levels)):
            part = slice(level * self.features, (level + 1) * self.features)
            self.encode_level(level, axes, encoded[part])
        values = []
        for columns in encoded.view(self.width, -1).split(chunk, 1):
            for matrix in self.matrices[:-1]:
                columns = (matrix @ columns).relu_()
            values.append(self.matrices[-1] @ columns)
        return torch.cat(values, 1).t()

    def encode_level(self, level, axes, out):
        """One level's features on a lattice: features x z x y x x."""
        scale, resolution, size, first, hashed = self.levels[level]
        (x, along_x), (y, along_y), (z, along_z) = (self.axis_corners(axis, scale) for axis in axes)
        at = [x[None, None, :], y[None, :, None], z[:, None, None]]
        entries = self.hashed_entries(at) if hashed else self.dense_entries(at, resolution, size)
        corners = self.table.index_select(0, entries.flatten() + first).t().contiguous()
        rows = torch.matmul(corners.view(-1, len(x)), along_x.t())
        planes = torch.matmul(along_y, rows.view(self.features * len(z), len(y), -1))
        torch.matmul(along_z, planes.view(self.features, len(z), -1),
                     out=out.view(self.features, len(axes[2]), -1))

    @staticmethod
    def axis_corners(coordinates, scale):
        """Grid coordinates of the corners along an axis, and the matrix that interpolates them."""
        scaled = coordinates * scale + 0.5
        cells = scaled.floor()
        first = int(cells[0])
        count = int(cells[-1]) - first + 2
        matrix = torch.zeros(len(coordinates), count)
        row, column = torch.arange(len(coordinates)), (cells - first).long()
        matrix[row, column] = 1 - (scaled - cells)
        matrix[row, column + 1] = scaled - cells
        return torch.arange(first, first + count, dtype=torch.int32), matrix


def nearly_orthogonal(x):
    """See Core/Training/Descent/NewtonSchulz.h."""
    tall = x.shape[0] >= x.shape[1]
    x = (x if tall else x.T) / x.norm()
    for _ in range(5):
        gram = x.T @ x
        polynomial = torch.addmm(gram, gram, gram, beta=-4.7750, alpha=2.0315)
        x = torch.addmm(x, x, polynomial, beta=3.4445)
    return x if tall else x.T


class OrthogonalisedMomentum:
    """See Core/Training/Descent/Optimiser.h."""

    def __init__(self, matrices, learning_rate):
        self.matrices, self.learning_rate, self.updates = matrices, learning_rate, 0
        self.momenta = [torch.zeros_like(matrix) for matrix in matrices]

    @torch.no_grad()
    def step(self):
        self.updates += 1
        rate = self.learning_rate * min(8, 40 / math.sqrt(self.updates))
        for matrix, momentum in zip(self.matrices, self.momenta):
            momentum.lerp_(matrix.grad, 0.05)
            matrix.sub_(nearly_orthogonal(matrix.grad.lerp(momentum, 0.95)), alpha=rate)


class Trainer:
    """Forward, backward and our update on a fixed batch of `positions` and `targets`.

    The batch goes through in chunks that stay in cache; each adds its share of the table's gradient
    in place, in one compiled loop."""

    def __init__(self, grid, learning_rate, chunk):
        self.grid, self.chunk = grid, chunk
        for parameter in (*grid.matrices, grid.table):
            parameter.requires_grad_()
            parameter.grad = torch.zeros_like(parameter)
        *hidden, last = grid.matrices
        self.momentum = OrthogonalisedMomentum(hidden, learning_rate)
        self.adam = torch.optim.Adam(
            [{"params": [last], "weight_decay": 1e-6}, {"params": [grid.table]}],
            lr=learning_rate, betas=(0.9, 0.99), eps=1e-15, fused=True)
        # One thread: several would add to one place at a time, by a loop around compare and swap.
        self.add_gradient = torch.compile(self.add_gradient_eager, dynamic=False,
                                          options={"cpp.threads": 1})

    def add_gradient_eager(self, target, entries, weights, gradient):
        shares = weights.view(-1, 8, 1) * gradient.view(-1, 1, self.grid.features)
        target.index_put_((entries.view(-1, 8).long(),), shares, accumulate=True)

    def clear_gradients(self):
        for parameter in (*self.grid.matrices, self.grid.table):
            parameter.grad.zero_()

    def update(self):
        self.momentum.step()
        self.adam.step()

    def step(self, positions, targets):
        """The mean squared error before the update."""
        self.clear_gradients()
        loss = 0.0
        for some, wanted in zip(positions.split(self.chunk), targets.split(self.chunk)):
            loss += self.accumulate(some, wanted, len(positions))
        self.update()
        return loss

    def accumulate(self, positions, targets, total):
        grid = self.grid
        with torch.no_grad():
            entries, weights = grid.compiled_corners(positions)
            encoded = grid.gather(entries, weights)
        encoded.requires_grad_()
        loss = (grid.network(encoded) - targets).square().sum() / total
        loss.backward()
        with torch.no_grad():
            self.add_gradient(grid.table.grad, entries, weights, encoded.grad)
        return loss.item()

    def step_plain(self, positions, targets):
        """The same in eager mode, all by PyTorch's own gradients."""
        self.clear_gradients()
        outputs = self.grid.network(self.grid.encode_plain(positions))
        loss = (outputs - targets).square().mean()
        loss.backward()
        self.update()
        return loss.item()
