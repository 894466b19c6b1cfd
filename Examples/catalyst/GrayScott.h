// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

/// Two substances that react and diffuse in a periodic cube of `size`^3 points (Gray and Scott,
/// "Autocatalytic reactions in the isothermal, continuous stirred tank reactor", 1983), computed by
/// all MPI processes, each with a slab of layers in z.
class GrayScott
{
public:
  explicit GrayScott(int size);

  /// One explicit step, with the neighbours' layers exchanged before.
  void step();

  int size() const { return this->Size; }
  int firstLayer() const { return this->First; }
  int layers() const { return this->Layers; } ///< of this process

  /// The second substance, from this process's first layer on, x fastest: its layers and, but for
  /// the process with the last ones, one more of the next process.
  const double* values() const { return this->V.data() + this->layerPoints(); }
  int valueLayers() const { return this->Layers + (this->First + this->Layers < this->Size); }

private:
  using Field = std::vector<double>;

  std::size_t layerPoints() const
  {
    return static_cast<std::size_t>(this->Size) * static_cast<std::size_t>(this->Size);
  }
  void exchange(Field& field) const;
  void stepLayer(int layer);

  int Size;
  int First;
  int Layers;
  Field U, V;         ///< with a layer of the neighbours on both sides
  Field NextU, NextV; ///< likewise
};
