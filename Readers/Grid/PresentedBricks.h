// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"
#include "Readers/Grid/GridDecoder.h"
#include "Readers/Grid/Scalars.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

/// Values of part of a presented grid in the type of the source, decoded in bricks when they are
/// first asked for; the bricks used last are kept. Any number of threads may use one at once.
///
/// The cache is cut into shards with a lock each, so that threads rarely meet; a shard decodes
/// under its lock, so that no brick is decoded twice.
template <class T> class PresentedBricks
{
public:
  static constexpr std::int64_t Edge = 16;
  /// Bounds the memory to 4096 bricks of 4096 values: a default grid (2^24 points) just fits.
  static constexpr std::size_t Shards = 64;
  static constexpr std::size_t BricksPerShard = 64;

  PresentedBricks(std::shared_ptr<const GridDecoder> decoder, const inr::GridBox& part)
      : Decoder(std::move(decoder)), Part(part), Bricks((part.size + (Edge - 1)) / Edge)
  {}

  const GridDecoder& GetDecoder() const { return *this->Decoder; }
  const inr::GridBox& GetPart() const { return this->Part; }

  /// Value number `index` of the part, x fastest.
  T Get(std::int64_t index)
  {
    const glm::i64vec3 point = inr::GridPlace(index, this->Part.size);
    const glm::i64vec3 brick = point / Edge;
    const std::int64_t key = inr::GridNumber(brick, this->Bricks);
    Shard& shard = this->ShardTable[static_cast<std::size_t>(key) % Shards];
    const std::lock_guard<std::mutex> lock(shard.Mutex);
    return this->Find(shard, key, brick)[static_cast<std::size_t>(
        inr::GridNumber(point - brick * Edge, this->SizeOf(brick)))];
  }

  /// All values of the part into `values`, past the cache.
  void DecodeAll(T* values) const
  {
    // One slab of whole planes at a time bounds the intermediate floats to a few MiB.
    const std::int64_t plane = this->Part.size.x * this->Part.size.y;
    const std::int64_t planes = std::max<std::int64_t>(1, SlabValues / plane);
    for (std::int64_t z = 0; z < this->Part.size.z; z += planes) {
      const std::int64_t count = std::min(planes, this->Part.size.z - z);
      this->Decode({0, 0, z}, {this->Part.size.x, this->Part.size.y, count}, values + z * plane);
    }
  }

  /// Forgets the bricks.
  void Clear()
  {
    for (Shard& shard : this->ShardTable) {
      const std::lock_guard<std::mutex> lock(shard.Mutex);
      shard.Index.clear();
      shard.Recent.clear();
    }
  }

  std::size_t MemorySize() const
  {
    std::size_t values = 0;
    for (const Shard& shard : this->ShardTable) {
      const std::lock_guard<std::mutex> lock(shard.Mutex);
      for (const Entry& entry : shard.Recent) {
        values += entry.values.size();
      }
    }
    return values * sizeof(T);
  }

private:
  static constexpr std::int64_t SlabValues = std::int64_t{1} << 20;

  struct Entry
  {
    std::int64_t key;
    std::vector<T> values;
  };
  struct Shard
  {
    mutable std::mutex Mutex;
    std::list<Entry> Recent; ///< used last comes first
    std::unordered_map<std::int64_t, typename std::list<Entry>::iterator> Index;
  };

  /// Bricks at the far faces are smaller.
  glm::i64vec3 SizeOf(const glm::i64vec3& brick) const
  {
    return glm::min(glm::i64vec3(Edge), this->Part.size - brick * Edge);
  }

  const std::vector<T>& Find(Shard& shard, std::int64_t key, const glm::i64vec3& brick)
  {
    if (!shard.Recent.empty() && shard.Recent.front().key == key) {
      return shard.Recent.front().values;
    }
    const auto found = shard.Index.find(key);
    if (found != shard.Index.end()) {
      shard.Recent.splice(shard.Recent.begin(), shard.Recent, found->second);
      return found->second->values;
    }
    return this->Insert(shard, key, brick);
  }

  const std::vector<T>& Insert(Shard& shard, std::int64_t key, const glm::i64vec3& brick)
  {
    const glm::i64vec3 size = this->SizeOf(brick);
    std::vector<T> values(static_cast<std::size_t>(inr::GridCount(size)));
    this->Decode(brick * Edge, size, values.data());
    if (shard.Recent.size() == BricksPerShard) {
      shard.Index.erase(shard.Recent.back().key);
      shard.Recent.pop_back();
    }
    shard.Recent.push_front({key, std::move(values)});
    shard.Index[key] = shard.Recent.begin();
    return shard.Recent.front().values;
  }

  void Decode(const glm::i64vec3& first, const glm::i64vec3& size, T* values) const
  {
    std::vector<float> normalised(static_cast<std::size_t>(inr::GridCount(size)));
    this->Decoder->Decode(this->Part.first + first, size, normalised.data());
    std::transform(normalised.begin(), normalised.end(), values, [this](float y) {
      return ToScalar<T>(inr::ValueOf(this->Decoder->GetModel()->volume, y));
    });
  }

  std::shared_ptr<const GridDecoder> Decoder;
  inr::GridBox Part;
  glm::i64vec3 Bricks; ///< per axis
  std::array<Shard, Shards> ShardTable;
};
