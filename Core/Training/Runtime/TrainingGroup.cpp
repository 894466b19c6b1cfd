// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Runtime/TrainingGroup.h"

#include "Core/Error.h"
#include "Core/Training/Runtime/NoMemory.h"

#include <algorithm>
#include <exception>
#include <new>

namespace inr {

namespace {

/// The error's code as a character, then its message.
std::string Described(const Error& error)
{
  return static_cast<char>(error.code()) + std::string(error.what());
}

} // namespace

void TrainingGroup::gatherInto(const char* bytes, std::size_t count, GatheredBytes& all) const
{
  const std::vector<std::string> parts = this->gather(std::string(bytes, count));
  all.bytes.clear();
  all.begins.clear();
  for (const std::string& part : parts) {
    all.begins.push_back(all.bytes.size());
    all.bytes.insert(all.bytes.end(), part.begin(), part.end());
  }
}

void TrainingGroup::distribute(const char* bytes, const std::vector<std::size_t>& begins,
                               GatheredBytes& mine) const
{
  const std::vector<std::string> parts = this->gather(std::string(bytes, begins.back()));
  const std::string own(reinterpret_cast<const char*>(begins.data()),
                        begins.size() * sizeof(begins[0]));
  const std::vector<std::string> places = this->gather(own);
  const auto rank = static_cast<std::size_t>(this->rank());
  mine.bytes.clear();
  mine.begins.clear();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const char* const place = places[k].data() + rank * sizeof(begins[0]);
    const auto first = FromBytes<std::size_t>(place);
    const auto end = FromBytes<std::size_t>(place + sizeof(begins[0]));
    mine.begins.push_back(mine.bytes.size());
    mine.bytes.insert(mine.bytes.end(), parts[k].data() + first, parts[k].data() + end);
  }
}

std::string TrainingGroup::fromFirst(const std::string& bytes) const
{
  return this->gather(this->rank() == 0 ? bytes : std::string()).front();
}

bool TrainingGroup::all(bool said) const
{
  const std::vector<bool> answers = this->valuesOfAll(said);
  return std::count(answers.begin(), answers.end(), false) == 0;
}

void TrainingGroup::together(const std::function<void()>& work) const
{
  if (this->size() == 1) {
    work();
    return;
  }
  std::string mine; // empty = it went well
  try {
    work();
  } catch (const Error& error) {
    mine = Described(error);
  } catch (const std::bad_alloc&) {
    mine = Described(NoMemoryBesideSteps());
  } catch (const std::exception& error) { // or the others would wait for ever
    mine = Described(Error(ErrorCode::InvalidArgument, error.what()));
  }
  const std::vector<std::string> all = this->gather(mine);
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    if (!all[rank].empty()) {
      const std::string other = "process " + std::to_string(rank) + ": ";
      throw Error(static_cast<ErrorCode>(all[rank][0]),
                  (static_cast<int>(rank) == this->rank() ? "" : other) + all[rank].substr(1));
    }
  }
}

} // namespace inr
