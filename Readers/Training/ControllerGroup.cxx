// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/ControllerGroup.h"

#include "Core/Error.h"
#include "Core/Parallel.h"
#include "Readers/Common/Processes.h"

#include <vtkMultiProcessController.h>

#include <algorithm>
#include <numeric>

namespace {

constexpr vtkIdType PieceSize = vtkIdType{1} << 22;

/// How many processes have this key; one at least, since it is one's.
std::int64_t CountOf(std::uint64_t key, const std::vector<std::uint64_t>& keys)
{
  return std::max<std::int64_t>(1, std::count(keys.begin(), keys.end(), key));
}

/// For parts of these lengths, one after the other; returns where they go.
std::vector<vtkIdType> MakeRoom(const std::vector<vtkIdType>& lengths, inr::GatheredBytes& parts)
{
  std::vector<vtkIdType> offsets(lengths.size());
  std::partial_sum(lengths.begin(), lengths.end() - 1, offsets.begin() + 1);
  parts.begins.assign(offsets.begin(), offsets.end());
  const auto total = static_cast<std::size_t>(offsets.back() + lengths.back());
  parts.bytes.resize(std::max(parts.bytes.size(), total));
  return offsets;
}

} // namespace

ControllerGroup::ControllerGroup(vtkMultiProcessController* controller)
    : Controller(AreSeveral(controller) ? controller : nullptr)
{}

int ControllerGroup::rank() const
{
  return this->Controller ? this->Controller->GetLocalProcessId() : 0;
}

int ControllerGroup::size() const
{
  return this->Controller ? this->Controller->GetNumberOfProcesses() : 1;
}

std::vector<std::string> ControllerGroup::gather(const std::string& bytes) const
{
  if (!this->Controller) {
    return {bytes};
  }
  const auto own = static_cast<vtkIdType>(bytes.size());
  std::vector<vtkIdType> lengths(static_cast<std::size_t>(this->size()));
  RequireReached(this->Controller->AllGather(&own, lengths.data(), 1));
  std::vector<std::string> parts(lengths.size());
  const vtkIdType longest = *std::max_element(lengths.begin(), lengths.end());
  for (vtkIdType begin = 0; begin < longest; begin += PieceSize) {
    this->gatherPiece(bytes, begin, lengths, parts);
  }
  return parts;
}

void ControllerGroup::gatherInto(const char* bytes, std::size_t count,
                                 inr::GatheredBytes& all) const
{
  if (!this->Controller) {
    this->TrainingGroup::gatherInto(bytes, count, all);
    return;
  }
  const auto own = static_cast<vtkIdType>(count);
  std::vector<vtkIdType> lengths(static_cast<std::size_t>(this->size()));
  RequireReached(this->Controller->AllGather(&own, lengths.data(), 1));
  std::vector<vtkIdType> offsets = MakeRoom(lengths, all);
  RequireReached(
      this->Controller->AllGatherV(bytes, all.bytes.data(), own, lengths.data(), offsets.data()));
}

void ControllerGroup::distribute(const char* bytes, const std::vector<std::size_t>& begins,
                                 inr::GatheredBytes& mine) const
{
  if (!this->Controller) {
    this->TrainingGroup::distribute(bytes, begins, mine);
    return;
  }
  const auto size = static_cast<std::size_t>(this->size());
  std::vector<vtkIdType> own(size);
  for (std::size_t k = 0; k < size; ++k) {
    own[k] = static_cast<vtkIdType>(begins[k + 1] - begins[k]);
  }
  std::vector<vtkIdType> ofAll(size * size);
  RequireReached(this->Controller->AllGather(own.data(), ofAll.data(), this->size()));
  std::vector<vtkIdType> lengths(size);
  for (std::size_t k = 0; k < size; ++k) {
    lengths[k] = ofAll[k * size + static_cast<std::size_t>(this->rank())];
  }
  std::vector<vtkIdType> offsets = MakeRoom(lengths, mine);
  for (std::size_t k = 0; k < size; ++k) {
    RequireReached(this->Controller->GatherV(bytes + begins[k], mine.bytes.data(), own[k],
                                             lengths.data(), offsets.data(), static_cast<int>(k)));
  }
}

/// Of all that have so many bytes the next ones: MPI counts in 32 bits.
void ControllerGroup::gatherPiece(const std::string& bytes, vtkIdType begin,
                                  const std::vector<vtkIdType>& lengths,
                                  std::vector<std::string>& parts) const
{
  std::vector<vtkIdType> counts;
  std::vector<vtkIdType> offsets;
  vtkIdType total = 0;
  for (const vtkIdType length : lengths) {
    counts.push_back(std::clamp<vtkIdType>(length - begin, 0, PieceSize));
    offsets.push_back(total);
    total += counts.back();
  }
  std::string all(static_cast<std::size_t>(total), '\0');
  const vtkIdType count = counts[static_cast<std::size_t>(this->rank())];
  const char* const mine = bytes.data() + std::min(begin, static_cast<vtkIdType>(bytes.size()));
  RequireReached(
      this->Controller->AllGatherV(mine, all.data(), count, counts.data(), offsets.data()));
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k].append(all, static_cast<std::size_t>(offsets[k]), static_cast<std::size_t>(counts[k]));
  }
}

std::int64_t ControllerGroup::memoryShare(std::int64_t limit) const
{
  const std::vector<std::uint64_t> machines = this->valuesOfAll(inr::MachineKey());
  std::int64_t share = limit;
  const std::vector<std::int64_t> limits = this->valuesOfAll(limit);
  for (std::size_t k = 0; k < limits.size(); ++k) {
    share = std::min(share, limits[k] / CountOf(machines[k], machines));
  }
  return share;
}

std::string ControllerGroup::firstOf(const std::string& said) const
{
  for (const std::string& text : this->gather(said)) {
    if (!text.empty()) {
      return text;
    }
  }
  return {};
}

int ControllerGroup::threads() const
{
  if (!this->Controller) {
    return 0;
  }
  const std::uint64_t own = inr::AvailableCoresKey();
  const std::vector<std::uint64_t> keys = this->valuesOfAll(own);
  const auto sharers = static_cast<int>(CountOf(own, keys));
  return std::max(1, inr::AvailableCores() / sharers);
}
