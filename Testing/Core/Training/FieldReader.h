// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Volume/VolumeReader.h"
#include "Testing/Core/Training/Fields.h"

#include <algorithm>
#include <functional>
#include <vector>

/// Hands out copies of boxes of a field, and keeps account of them.
template <class T> class FieldReader : public inr::VolumeReader
{
public:
  explicit FieldReader(const Field<T>& field) : Source(field) {}

  const glm::i64vec3& dims() const override { return this->Source.dims; }
  inr::ScalarType type() const override { return this->Source.type; }

  inr::VolumePiece read(const inr::GridBox& box) override
  {
    if (this->before) {
      this->before(++this->reads);
    }
    this->voxelsRead += box.count();
    this->largest = std::max(this->largest, box.count());
    this->Values.clear();
    for (std::int64_t z = box.first.z; z < box.end().z; ++z) {
      for (std::int64_t y = box.first.y; y < box.end().y; ++y) {
        const auto row = this->Source.values.begin() + box.first.x +
                         this->Source.dims.x * (y + this->Source.dims.y * z);
        this->Values.insert(this->Values.end(), row, row + box.size.x);
      }
    }
    return {{this->Values.data(), this->Source.type, box.size}, box.first};
  }

  std::function<void(int)> before; ///< each reading, with its number from 1
  int reads = 0;
  std::int64_t voxelsRead = 0;
  std::int64_t largest = 0; ///< voxels in one reading

private:
  const Field<T>& Source;
  std::vector<T> Values;
};
