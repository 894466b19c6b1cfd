// SPDX-License-Identifier: BSD-3-Clause
//
// Trainings of a small volume from pieces by a group of threads.
#pragma once

#include "Core/Error.h"
#include "Core/Training/Parallel/ParallelTraining.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/FieldReader.h"
#include "Testing/Core/Training/ThreadGroup.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

constexpr std::int64_t MiB = std::int64_t{1} << 20;
constexpr glm::i64vec3 StreamedDims(60, 71, 83);

inline const Field<float>& StreamedField()
{
  static const auto* const field =
      new Field<float>(WaveField<float>(StreamedDims, inr::ScalarType::Float32, -3, 5));
  return *field;
}

inline inr::TrainingOptions StreamedOptions(std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.description = SmallDescription();
  options.storedAs = inr::ParameterType::Half; // packing takes longer than these trainings
  options.memoryLimit = 200 * MiB;
  options.threads = 1;
  return options;
}

/// What each process of the group gets, or what it is told.
struct Outcome
{
  inr::ModelPointer model;
  std::optional<inr::Error> error;
  std::int64_t voxelsRead = 0;
  int reads = 0;
  bool leftCheckpoint = false; ///< when it was told
};

using Before = std::function<void(int rank, int reading)>;
using Watch = std::function<bool(int rank, const inr::TrainingProgress&)>;

/// Nobody reads before all others do: as with files that are opened together.
template <class T = float>
std::vector<Outcome> TrainTogether(int size, const inr::TrainingOptions& options,
                                   const Before& before = {}, const Watch& watch = {},
                                   const Field<T>& field = StreamedField())
{
  Meeting readers(size);
  std::vector<Outcome> outcomes(static_cast<std::size_t>(size));
  InGroup(size, [&](const ThreadGroup& group) {
    Outcome& outcome = outcomes[static_cast<std::size_t>(group.rank())];
    FieldReader<T> reader(field);
    reader.before = [&](int reading) {
      readers.gather(group.rank(), "");
      before ? before(group.rank(), reading) : void();
    };
    try {
      outcome.model =
          inr::TrainModel(reader, {}, options, group, [&](const inr::TrainingProgress& now) {
            return !watch || watch(group.rank(), now);
          });
    } catch (const inr::Error& error) {
      outcome.error = error;
      outcome.leftCheckpoint = std::filesystem::exists(options.checkpoint.path);
    }
    outcome.voxelsRead = reader.voxelsRead;
    outcome.reads = reader.reads;
  });
  return outcomes;
}

inline void ExpectErrors(const std::vector<Outcome>& outcomes, const std::string& words)
{
  for (const Outcome& outcome : outcomes) {
    ASSERT_TRUE(outcome.error.has_value()) << "went on, instead of: " << words;
    EXPECT_NE(std::string(outcome.error->what()).find(words), std::string::npos)
        << outcome.error->what();
  }
}
