// SPDX-License-Identifier: BSD-3-Clause
#include "GrayScott.h"

#include <cmath>
#include <mpi.h>
#include <utility>

namespace {

constexpr double Feed = 0.03;
constexpr double Kill = 0.06;
constexpr double DiffusionU = 0.16;
constexpr double DiffusionV = 0.08;
constexpr double TimeStep = 0.9;

int Rank()
{
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int Ranks()
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

} // namespace

// Full of the first substance, with some of the second in three balls.
GrayScott::GrayScott(int size)
    : Size(size), First(size * Rank() / Ranks()), Layers(size * (Rank() + 1) / Ranks() - First)
{
  const std::size_t points = this->layerPoints() * static_cast<std::size_t>(this->Layers + 2);
  this->U.assign(points, 1.0);
  this->V.assign(points, 0.0);
  const std::array<double, 3> centres[] = {{0.5, 0.5, 0.5}, {0.3, 0.4, 0.6}, {0.7, 0.55, 0.35}};
  std::size_t at = this->layerPoints();
  for (int z = this->First; z < this->First + this->Layers; ++z) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x, ++at) {
        for (const std::array<double, 3>& centre : centres) {
          const double distance =
              std::hypot(x - centre[0] * size, y - centre[1] * size, z - centre[2] * size);
          if (distance < 0.08 * size) {
            this->U[at] = 0.25;
            this->V[at] = 0.33;
          }
        }
      }
    }
  }
  this->exchange(this->U);
  this->exchange(this->V);
  this->NextU = this->U;
  this->NextV = this->V;
}

void GrayScott::step()
{
  for (int layer = 1; layer <= this->Layers; ++layer) {
    this->stepLayer(layer);
  }
  std::swap(this->U, this->NextU);
  std::swap(this->V, this->NextV);
  this->exchange(this->U);
  this->exchange(this->V);
}

// Fills the two outer layers from the neighbours', around the whole cube.
void GrayScott::exchange(Field& field) const
{
  const int below = (Rank() + Ranks() - 1) % Ranks();
  const int above = (Rank() + 1) % Ranks();
  const auto count = static_cast<int>(this->layerPoints());
  double* const first = field.data() + count;
  double* const last = field.data() + static_cast<std::size_t>(count) * this->Layers;
  MPI_Sendrecv(last, count, MPI_DOUBLE, above, 0, field.data(), count, MPI_DOUBLE, below, 0,
               MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  MPI_Sendrecv(first, count, MPI_DOUBLE, below, 1, last + count, count, MPI_DOUBLE, above, 1,
               MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void GrayScott::stepLayer(int layer)
{
  const std::size_t n = static_cast<std::size_t>(this->Size);
  const std::size_t start = this->layerPoints() * static_cast<std::size_t>(layer);
  const auto change = [&](const Field& field, std::size_t x, std::size_t row, std::size_t above,
                          std::size_t below) {
    const std::size_t at = row + x;
    return field[row + (x + 1) % n] + field[row + (x + n - 1) % n] + field[above + x] +
           field[below + x] + field[at + n * n] + field[at - n * n] - 6 * field[at];
  };
  for (std::size_t y = 0; y < n; ++y) {
    const std::size_t row = start + n * y;
    const std::size_t above = start + n * ((y + 1) % n);
    const std::size_t below = start + n * ((y + n - 1) % n);
    for (std::size_t x = 0; x < n; ++x) {
      const double u = this->U[row + x];
      const double v = this->V[row + x];
      const double reaction = u * v * v;
      this->NextU[row + x] = u + TimeStep * (DiffusionU * change(this->U, x, row, above, below) -
                                             reaction + Feed * (1 - u));
      this->NextV[row + x] = v + TimeStep * (DiffusionV * change(this->V, x, row, above, below) +
                                             reaction - (Feed + Kill) * v);
    }
  }
}
